// The part of group `raycast` about random views: every search with every kind of body, over several maps,
// against rays cast in double through the same textures with samples a tenth of a voxel apart.
#include "app/verify/raycast.h"

#include <random>
#include <string>

namespace serosa::app {

namespace {

using render::MapKind;
using render::Search;
using render::Solid;

constexpr int kSamples = 48, kTexels = 48;
constexpr double kThickness = 0.008; // m: of a shell

struct Mode {
    const char* name;
    Search search;
    Solid solid;
    MapKind map;
    double wound; // m: radius of the cylinder that the map's box is wound around; 0: it is not
};
constexpr Mode kModes[] = {
    {"linear, hollow, knife", Search::linear, Solid::hollow, MapKind::knife, 0},
    {"linear, solid, twist", Search::linear, Solid::solid, MapKind::twist, 0},
    {"linear, shell, wave", Search::linear, Solid::shell, MapKind::wave, 0},
    {"threshold, hollow, bend", Search::threshold, Solid::hollow, MapKind::bend, 0},
    {"threshold, solid, peel", Search::threshold, Solid::solid, MapKind::peel, 0},
    {"threshold, shell, knife", Search::threshold, Solid::shell, MapKind::knife, 0},
    {"Jacobian, hollow, seam", Search::jacobian, Solid::hollow, MapKind::seam, 0},
    {"Jacobian, solid, pull", Search::jacobian, Solid::solid, MapKind::pull, 0},
    {"Jacobian, solid, round knife", Search::jacobian, Solid::solid, MapKind::knife, 0.02},
    {"Jacobian, shell, peel", Search::jacobian, Solid::shell, MapKind::peel, 0},
};

render::DeformationMap mapOf(MapKind kind) {
    const bool peel = kind == MapKind::peel;
    render::DeformationMap map;
    map.kind = kind;
    map.half = glm::dvec3(0.055);
    map.amount = kind == MapKind::twist || kind == MapKind::bend ? 0.9
                 : kind == MapKind::pull                         ? 0.04
                 : peel                                          ? -0.01
                                                                 : 0.008;
    map.radius = peel ? 0.035 : 0.015;
    map.extent = kind == MapKind::wave ? 0.04 : 0.07;
    map.depth = peel ? 0.08 : 0.06;
    map.width = 0.06;
    return map;
}

} // namespace

Status verifyRaycastTwin(const VerifyOptions& options, CheckList& checks) {
    SEROSA_ASSIGN(const RaycastModel ball, raycastBall(kSamples));
    const std::vector<float> field = ball.field.read();
    const int views = options.full ? 20 : 5, width = options.full ? 128 : 96, height = 3 * width / 4;
    std::mt19937 engine(11);
    const auto number = [&] { return 2.0 * double(engine()) / 4294967296.0 - 1.0; };
    for (const Mode& mode : kModes) {
        SEROSA_ASSIGN(const render::DeformationTexture texture,
                      render::DeformationTexture::bake(mapOf(mode.map), glm::ivec3(kTexels),
                                                       render::TexelFormat::half));
        render::Warp warp{&texture, {}};
        warp.mapping.objectFromLocal = glm::dmat4(1.02);
        warp.mapping.objectFromLocal[3] = glm::dvec4(0.002, 0.001, -0.003, 1);
        warp.mapping.cylinderRadius = mode.wound;
        render::RaycastLook look;
        look.solid = mode.solid;
        look.search = mode.search;
        look.thickness = kThickness;
        const render::RaycastTwin twin(field, ball.field.grid(), warp, look.solid, look.thickness,
                                       ball.field.grid().step / 10);
        SEROSA_ASSIGN(render::Raycaster caster, ball.caster(warp));
        render::RaycastAgreement sum;
        for (int k = 0; k < views; ++k) {
            glm::dvec3 direction;
            for (int axis = 0; axis < 3; ++axis)
                direction[axis] = number();
            direction.y -= 0.6; // rather from above, where what is cut or peeled is seen
            const render::RaycastView view = ball.view(
                glm::normalize(direction),
                k % 2 ? sim::Projection::orthographic : sim::Projection::perspective, width, height);
            SEROSA_ASSIGN(const std::vector<render::RaycastProbe> probes,
                          caster.probe(view.frame, look, width, height));
            addAgreement(sum, view, caster, probes, twin);
        }
        const std::string of = std::string(mode.name) + ", " + std::to_string(views) + " views, " +
                               std::to_string(sum.object) + " pixels: ";
        checks.atLeast(of + "pixels with something to see", double(sum.object) / (views * width * height),
                       0.1, "of the picture");
        checks.atMost(of + "silhouettes differ in", 100 * sum.silhouetteShare(), 0.5, "%");
        checks.atMost(of + "depth off by half a pixel's footprint in", 100 * sum.deepShare(), 1, "%");
        checks.atMost(of + "normals, median", sum.medianTurn(), 2, "deg");
    }
    return {};
}

} // namespace serosa::app
