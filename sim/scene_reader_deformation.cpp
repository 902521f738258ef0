// See sim/scene_reader_deformation.h.
#include "sim/scene_reader_deformation.h"

#include "sim/scene_reader_organ.h"
#include "sim/suggest.h"

#include <algorithm>
#include <string>

namespace serosa::sim {

namespace {

using Kind = DeformationKind;

/// Keys that a kind needs, and those that it knows besides.
struct KindKeys {
    std::vector<const char*> needed, known;
};

KindKeys keysOf(Kind kind) {
    switch (kind) {
    case Kind::twist:
        return {{"size", "angle"}, {}};
    case Kind::bend:
        return {{"size", "angle", "extent"}, {}};
    case Kind::pull:
        return {{"size", "amount", "radius"}, {"narrow"}};
    case Kind::wave:
        return {{"size", "amount", "extent"}, {}};
    case Kind::peel:
        return {{"size", "amount", "radius", "depth", "width"}, {}};
    case Kind::knife:
    case Kind::seam:
        return {{"size", "amount", "extent", "depth"}, {}};
    case Kind::incision:
        return {{"size", "amount", "depth", "width", "path"}, {}};
    case Kind::sphere:
        return {{"size", "radius"}, {}};
    case Kind::box:
        return {{"size", "extent", "depth", "width"}, {}};
    case Kind::points:
        return {{"size", "points", "reach"}, {}};
    case Kind::image:
    case Kind::texture:
        return {{"file"}, {}};
    }
    return {};
}

Status checkKind(const SceneTable& table, Kind kind) {
    const auto [needed, known] = keysOf(kind);
    for (const char* const key : needed)
        if (!table.has(key))
            return table.errorAt(key, std::string("'") + key + "' is missing: this kind needs it");
    static const char* const kOfKinds[] = {"size",  "angle",  "amount", "radius", "extent", "depth",
                                           "width", "narrow", "path",   "points", "reach",  "file"};
    const auto holds = [](const std::vector<const char*>& keys, const char* wanted) {
        return std::any_of(keys.begin(), keys.end(),
                           [wanted](const char* key) { return std::string(key) == wanted; });
    };
    for (const char* const key : kOfKinds)
        if (table.has(key) && !holds(needed, key) && !holds(known, key))
            return table.errorAt(key, "has no effect on a deformation of this kind: remove it");
    if ((kind == Kind::image || kind == Kind::texture) && table.has("texels"))
        return table.errorAt("texels", "has no effect on a file, which has its own: remove it");
    return {};
}

/// What the vertex stage can do, and what it has no use for.
Status checkBy(const SceneTable& table, const Deformation& made) {
    if (made.by == DeformationBy::pixels)
        return {};
    if (made.kind != Kind::twist && made.kind != Kind::bend && made.kind != Kind::pull &&
        made.kind != Kind::wave)
        return table.errorAt("by",
                             "\"vertices\" can twist, bend, pull and wave: leave this kind to \"pixels\"");
    for (const char* const key : {"wound", "texels", "format"})
        if (table.has(key))
            return table.errorAt(
                key, "has no effect on a deformation by vertices, which has no texture: remove it");
    return {};
}

Status readPath(const SceneSource& source, const SceneTable& table, const std::string& path,
                Deformation& made) {
    SEROSA_ASSIGN(const auto places, table.tables("path"));
    for (std::size_t i = 0; i < places.size(); ++i) {
        const SceneTable place(source, "deformation.path", itemPath(path, "path", i), places[i]);
        SEROSA_TRY(place.checkKeys());
        glm::dvec2 at(0);
        SEROSA_TRY(place.read("x", at.x));
        SEROSA_TRY(place.read("z", at.y));
        if (!made.path.empty() && glm::distance(at, made.path.back()) < 1e-9)
            return place.errorAt("x", "is the place before it once more: a path leads on");
        made.path.push_back(at);
    }
    if (made.kind == Kind::incision && made.path.size() < 2)
        return table.errorAt("path",
                             "has " + std::to_string(made.path.size()) + " places: take at least two");
    return {};
}

Status readPoints(const SceneSource& source, const SceneTable& table, const std::string& path,
                  Deformation& made) {
    SEROSA_ASSIGN(const auto points, table.tables("points"));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SceneTable point(source, "deformation.points", itemPath(path, "points", i), points[i]);
        SEROSA_TRY(point.checkKeys());
        auto& [from, to] = made.points.emplace_back();
        SEROSA_TRY(point.read("from", from));
        SEROSA_TRY(point.read("to", to));
    }
    return {};
}

Status readKeys(const SceneSource& source, const SceneTable& table, const std::string& path,
                Deformation& made) {
    SEROSA_ASSIGN(const auto keys, table.tables("keys"));
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const SceneTable keyTable(source, "deformation.keys", itemPath(path, "keys", i), keys[i]);
        SEROSA_TRY(keyTable.checkKeys());
        DeformationKey key;
        key.at = made.at;
        SEROSA_TRY(keyTable.read("t", key.time));
        SEROSA_TRY(keyTable.read("at", key.at));
        SEROSA_TRY(keyTable.read("turn", key.turn));
        SEROSA_TRY(keyTable.read("scale", key.scale));
        if (!made.keys.empty() && key.time <= made.keys.back().time)
            return keyTable.errorAt("t", "is not after the key before it: times must increase");
        made.keys.push_back(key);
    }
    return {};
}

Status readAxes(const SceneTable& table, Deformation& made) {
    SEROSA_TRY(table.read("up", made.up));
    SEROSA_TRY(table.read("along", made.along));
    if (glm::length(made.up) < 1e-9)
        return table.errorAt("up", "has no length: give a direction, such as [0, 1, 0]");
    made.up = glm::normalize(made.up);
    made.along -= made.up * glm::dot(made.up, made.along);
    if (glm::length(made.along) < 1e-6)
        return table.errorAt("along", "is along `up`: give a direction across it");
    made.along = glm::normalize(made.along);
    return {};
}

Status readOrgans(const SceneTable& table, const std::vector<Organ>& organs, Deformation& made) {
    std::vector<std::string> wanted, names;
    if (!table.has("organs"))
        return {};
    SEROSA_TRY(table.read("organs", wanted));
    for (const Organ& organ : organs)
        names.push_back(organ.name);
    for (const std::string& name : wanted) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end())
            return table.errorAt("organs", "no organ is named " + inQuotes(name) + suggestion(name, names));
        const auto organ = std::size_t(found - names.begin());
        if (std::find(made.organs.begin(), made.organs.end(), organ) != made.organs.end())
            return table.errorAt("organs", "names " + inQuotes(name) + " twice: keep one");
        made.organs.push_back(organ);
    }
    return {};
}

Status readOne(const SceneSource& source, const SceneTable& table, const std::string& path,
               const std::filesystem::path& folder, const std::vector<Organ>& organs, Deformation& made) {
    SEROSA_TRY(table.checkKeys());
    SEROSA_TRY(table.readWord("kind", made.kind));
    made.line = table.lineOf("kind");
    SEROSA_TRY(readOrgans(table, organs, made));
    SEROSA_TRY(checkKind(table, made.kind));
    SEROSA_TRY(table.readWord("by", made.by));
    SEROSA_TRY(checkBy(table, made));
    SEROSA_TRY(table.read("at", made.at));
    SEROSA_TRY(table.read("size", made.size));
    SEROSA_TRY(readAxes(table, made));
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
    SEROSA_TRY(table.readWord("format", made.format));
    if (made.kind == Kind::twist || made.kind == Kind::bend)
        made.amount = angle;
    SEROSA_TRY(readPath(source, table, path, made));
    SEROSA_TRY(readPoints(source, table, path, made));
    SEROSA_TRY(table.read("reach", made.reach));
    std::string file;
    SEROSA_TRY(table.read("file", file));
    if (!file.empty())
        made.file = folder / file;
    return readKeys(source, table, path, made);
}

/// Vertices move what pixels have left.
Status checkOrder(const SceneTable& table, const std::vector<Deformation>& before, const Deformation& made) {
    for (const Deformation& other : before) {
        const bool both = made.organs.empty() || other.organs.empty() ||
                          std::any_of(made.organs.begin(), made.organs.end(),
                                      [&other](std::size_t organ) { return other.isOf(organ); });
        if (both && other.by == DeformationBy::vertices && made.by == DeformationBy::pixels)
            return table.errorAt("kind", "comes after one by vertices, which act last: put it before");
    }
    return {};
}

} // namespace

Status readDeformations(const SceneSource& source, const SceneTable& top, const std::filesystem::path& folder,
                        Scene& scene) {
    SEROSA_ASSIGN(const auto all, top.tableOrTables("deformation"));
    const Look& look = scene.look;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::string path = "deformation[" + std::to_string(i) + "]";
        const SceneTable table(source, "deformation", path, all[i]);
        Deformation made;
        SEROSA_TRY(readOne(source, table, path, folder, scene.organs, made));
        if (look.show != Show::implicit)
            return table.errorAt("kind", "has no effect: surfaces are drawn; set look.show = \"implicit\"");
        SEROSA_TRY(checkOrder(table, scene.deformations, made));
        scene.deformations.push_back(std::move(made));
    }
    SEROSA_ASSIGN(const toml::table* const lookTable, top.table("look"));
    const SceneTable table(source, "look", "look", lookTable);
    if (look.stage != Stage::whole && scene.deformations.size() != 1)
        return table.errorAt("stage", "needs one [deformation], whose box it speaks of");
    if (look.stage != Stage::whole && look.show != Show::implicit)
        return table.errorAt("stage", "has no effect: set look.show = \"implicit\"");
    const bool vertices =
        std::any_of(scene.deformations.begin(), scene.deformations.end(),
                    [](const Deformation& one) { return one.by == DeformationBy::vertices; });
    if (look.stage != Stage::whole && vertices)
        return table.errorAt("stage", "does not go with a deformation by vertices, which leaves its box");
    if (look.proxyCells != Look().proxyCells && !vertices)
        return table.errorAt("proxy_cells", "has no effect: no [[deformation]] says by = \"vertices\"");
    return {};
}

bool Deformation::isOf(std::size_t organ) const {
    return organs.empty() || std::find(organs.begin(), organs.end(), organ) != organs.end();
}

DeformationKey Deformation::placeAt(double time) const {
    if (keys.empty())
        return {time, at, 0, 1};
    const auto next =
        std::find_if(keys.begin(), keys.end(), [time](const auto& key) { return key.time > time; });
    if (next == keys.begin())
        return keys.front();
    if (next == keys.end())
        return keys.back();
    const DeformationKey &a = *(next - 1), &b = *next;
    const double share = (time - a.time) / (b.time - a.time);
    return {time, glm::mix(a.at, b.at, share), glm::mix(a.turn, b.turn, share),
            glm::mix(a.scale, b.scale, share)};
}

} // namespace serosa::sim
