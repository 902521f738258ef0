// What a scene says beyond its file: number of frames, the scene made of a model alone, and rules
// over all.

#include "sim/scene.h"

#include "base/check.h"
#include "sim/quantity.h"

#include <algorithm>
#include <cmath>

namespace serosa::sim {

namespace {
constexpr double kMostFrames = 1e6;
}

std::string organFileName(const Organ& organ) {
    std::string name = organ.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
}

OrganCoupling couplingOf(const Scene& scene, std::size_t index) {
    const Organ& organ = scene.organs[index];
    OrganCoupling coupling;
    if (organ.pose)
        return coupling;
    for (const Thread& thread : scene.threads)
        for (const ThreadEnd& end : thread.ends)
            if (end.organ == organ.name) {
                coupling.tied = true;
                coupling.line = end.line;
            }
    coupling.touchesItself = organ.selfContact;
    if (organ.selfContact)
        coupling.line = organ.selfContactLine;
    coupling.touches = scene.organsTouch;
    if (scene.organsTouch)
        coupling.line = scene.organsTouchLine;
    return coupling;
}

int Scene::frames() const {
    return std::max(1, int(std::lround(std::min(duration * frameRate, kMostFrames))));
}

std::optional<SceneProblem> findSceneProblem(const Scene& scene) {
    if (scene.duration * scene.frameRate >
        kMostFrames + 0.5) // half a frame: a count divided by the rate and multiplied again
        return SceneProblem{"", "duration",
                            "gives " + formatNumber(scene.duration * scene.frameRate) +
                                " frames, at most 1e6 are possible: lower duration or frame_rate"};
    // Half a frame of tolerance: the last frame of a rounded duration may lie before a time that was asked
    // for.
    const double end = (scene.frames() + 0.5) / scene.frameRate;
    const Output& output = scene.output;
    for (const auto& [key, times] :
         {std::pair{"surfaces_at", &output.surfacesAt}, std::pair{"snapshots_at", &output.snapshotsAt},
          std::pair{"displacements_at", &output.displacementsAt}, std::pair{"sheet_at", &output.sheetAt}})
        for (const double time : *times)
            if (time > end)
                return SceneProblem{"output", key,
                                    formatQuantity(time, Dimension::time) +
                                        " is after the end of the run at " +
                                        formatQuantity(scene.frames() / scene.frameRate, Dimension::time)};
    const std::size_t places = std::size_t(output.sheetColumns) * std::size_t(output.sheetRows);
    if (output.sheetAt.size() > places)
        return SceneProblem{"output", "sheet_at",
                            "has " + std::to_string(output.sheetAt.size()) +
                                " times, but the contact sheet has " + std::to_string(places) +
                                " places: raise sheet_columns or sheet_rows"};
    const Look& look = scene.look;
    if (look.field != Field::distance && look.show == Show::both)
        return SceneProblem{
            "look", "field",
            "is of depth maps, which fill hollows: beside the surface they would hide it; take "
            "\"distance\", or show = \"implicit\""};
    if (look.field != Field::distance && look.search == RaySearch::threshold)
        return SceneProblem{"look", "search",
                            "by threshold asks how near the surface is, and depth maps do not know: take "
                            "\"jacobian\" or \"linear\""};
    // What a scene file says of these has the line of its own key; here `show` was replaced.
    if (!scene.deformations.empty() && look.show != Show::implicit)
        return SceneProblem{
            "look", "show",
            "deformations move what is ray-cast, and have no effect on surfaces: take \"implicit\""};
    if (look.cutVolume && look.show == Show::surface)
        return SceneProblem{"look", "show",
                            "look.cut_volume has no effect on surfaces: take \"implicit\" or \"both\""};
    if (look.sectionAt && look.show != Show::surface)
        return SceneProblem{"look", "section_at",
                            "has no effect on what is ray-cast: take show = \"surface\", or cut it open by a "
                            "[[deformation]] of kind = \"box\""};
    return std::nullopt;
}

Scene defaultScene(const std::filesystem::path& model, double lengthUnit, const TriangleMesh& metres) {
    SEROSA_CHECK(!metres.positions.empty(), "a default scene needs a surface");
    const glm::dvec3 lowest = metres.lowest(), highest = metres.highest(), middle = (lowest + highest) / 2.0;
    const glm::dvec3 extent = highest - lowest;
    const double size = std::max({extent.x, extent.y, extent.z});

    // The top: of the vertices close to the greatest height, the one nearest to the middle of the organ seen
    // from above.
    glm::dvec3 top = middle;
    double least = -1;
    for (const glm::dvec3& p : metres.positions) {
        if (p.y < highest.y - 0.02 * size)
            continue;
        const double aside = std::hypot(p.x - middle.x, p.z - middle.z);
        if (least < 0 || aside < least) {
            least = aside;
            top = p;
        }
    }

    Scene scene;
    // A scanned organ has its shape with its weight on it, and rests on all that surrounds it. Held at its
    // lowest 5% alone a soft one would fall over: the default leaves gravity out.
    scene.gravity = glm::dvec3(0);
    Organ organ;
    organ.model = model;
    organ.name = model.stem().string();
    organ.lengthUnit = lengthUnit;
    organ.fixedLowestShare = 0.05;
    scene.organs.push_back(organ);

    Tool probe;
    probe.name = "probe";
    probe.radius = 0.12 * size; // several spacings: a smaller sphere slips between nodes
    const auto at = [&](double height) { return top + glm::dvec3(0, probe.radius + height * size, 0); };
    probe.keys = {{0.0, at(0.05)}, {0.8, at(-0.05)}, {1.1, at(-0.05)}, {1.5, at(0.1)}};
    scene.tools.push_back(probe);
    return scene;
}

} // namespace serosa::sim
