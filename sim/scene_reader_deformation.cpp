// See sim/scene_reader_deformation.h.
#include "sim/scene_reader_deformation.h"

#include <initializer_list>

namespace serosa::sim {

namespace {

/// Lengths that a kind needs: keys of the table.
std::initializer_list<const char*> neededBy(DeformationKind kind) {
    static const std::initializer_list<const char*> kBend = {"angle", "extent"}, kTwist = {"angle"},
                                                    kPull = {"amount", "radius"},
                                                    kWave = {"amount", "extent"},
                                                    kPeel = {"amount", "radius", "depth", "width"},
                                                    kCut = {"amount", "extent", "depth"};
    switch (kind) {
    case DeformationKind::twist:
        return kTwist;
    case DeformationKind::bend:
        return kBend;
    case DeformationKind::pull:
        return kPull;
    case DeformationKind::wave:
        return kWave;
    case DeformationKind::peel:
        return kPeel;
    default:
        return kCut;
    }
}

} // namespace

Status readDeformation(const SceneSource& source, const SceneTable& top, Scene& scene) {
    SEROSA_ASSIGN(const toml::table* content, top.table("deformation"));
    if (!content)
        return {};
    const SceneTable table(source, "deformation", "deformation", content);
    SEROSA_TRY(table.checkKeys());
    Deformation made;
    SEROSA_TRY(table.readWord("kind", made.kind));
    made.line = table.lineOf("kind");
    SEROSA_TRY(table.read("at", made.at));
    SEROSA_TRY(table.read("size", made.size));
    SEROSA_TRY(table.read("up", made.up));
    SEROSA_TRY(table.read("along", made.along));
    double angle = 0;
    SEROSA_TRY(table.read("angle", angle));
    SEROSA_TRY(table.read("amount", made.amount));
    SEROSA_TRY(table.read("radius", made.radius));
    SEROSA_TRY(table.read("extent", made.extent));
    SEROSA_TRY(table.read("depth", made.depth));
    SEROSA_TRY(table.read("width", made.width));
    SEROSA_TRY(table.read("narrow", made.narrow));
    SEROSA_TRY(table.read("wound", made.wound));
    SEROSA_TRY(table.read("texels", made.texels));
    for (const char* const key : neededBy(made.kind))
        if (!table.has(key))
            return table.errorAt(key, std::string("'") + key + "' is missing: this kind needs it");
    if (made.kind == DeformationKind::twist || made.kind == DeformationKind::bend)
        made.amount = angle;
    if (glm::length(made.up) < 1e-9)
        return table.errorAt("up", "has no length: give a direction, such as [0, 1, 0]");
    made.up = glm::normalize(made.up);
    made.along -= made.up * glm::dot(made.up, made.along);
    if (glm::length(made.along) < 1e-6)
        return table.errorAt("along", "is along `up`: give a direction across it");
    made.along = glm::normalize(made.along);
    if (scene.look.show != Show::implicit)
        return table.errorAt("kind", "has no effect: surfaces are drawn; set look.show = \"implicit\"");
    scene.deformation = made;
    return {};
}

} // namespace serosa::sim
