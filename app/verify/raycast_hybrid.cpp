// The part of group `raycast` about the hybrid (CS07 section 6.3): a coarse map by the vertex stage and a
// texture in the pixel, against rays cast in double through the map's closed-form inverse; and how what it is
// off by falls with the size of its tetrahedra.
#include "app/verify/raycast.h"

#include <algorithm>
#include <string>

namespace serosa::app {

namespace {

using render::MapKind;
using render::Solid;

constexpr int kSamples = 48, kTexels = 48, kCells = 16;
constexpr double kThickness = 0.008; // m: of a shell

struct Mode {
    const char* name;
    Solid solid;
    MapKind coarse, fine;
};
constexpr Mode kModes[] = {{"hollow, bend + knife", Solid::hollow, MapKind::bend, MapKind::knife},
                           {"solid, bend + knife", Solid::solid, MapKind::bend, MapKind::knife},
                           {"shell, bend + knife", Solid::shell, MapKind::bend, MapKind::knife},
                           {"solid, twist + pull", Solid::solid, MapKind::twist, MapKind::pull}};

render::DeformationMap mapOf(MapKind kind) {
    render::DeformationMap map;
    map.kind = kind;
    map.half = glm::dvec3(0.055);
    map.amount = kind == MapKind::knife ? 0.008 : kind == MapKind::pull ? 0.04 : 0.9;
    map.radius = 0.015;
    map.extent = 0.07;
    map.depth = 0.06;
    return map;
}

/// m: the median over a picture's pixels, of where the closed form has what they show, at rest.
Result<double> offBy(render::Raycaster& caster, const render::CoarseWarp& warp,
                     const render::RaycastView& view) {
    SEROSA_ASSIGN(const std::vector<render::RaycastProbe> probes,
                  caster.probe(view.frame, {}, view.width, view.height));
    std::vector<double> off;
    for (std::size_t i = 0; i < probes.size(); ++i)
        if (probes[i].kind == render::RaycastProbe::surface) {
            const render::RaycastView::Ray ray = view.ray(i);
            const double t = view.distanceOf(caster, ray, probes[i]);
            off.push_back(glm::distance(warp.back(ray.from + t * ray.along), probes[i].rest));
        }
    if (off.empty())
        return 0.0;
    std::nth_element(off.begin(), off.begin() + std::ptrdiff_t(off.size() / 2), off.end());
    return off[off.size() / 2];
}

} // namespace

Status verifyRaycastHybrid(const VerifyOptions& options, CheckList& checks) {
    SEROSA_ASSIGN(const RaycastModel ball, raycastBall(kSamples));
    const std::vector<float> field = ball.field.read();
    const int width = options.full ? 128 : 96, height = 3 * width / 4;
    const glm::dvec3 directions[] = {{-0.3, -0.7, -1}, {0.8, -0.5, 0.4}};
    for (const Mode& mode : kModes) {
        SEROSA_ASSIGN(const render::DeformationTexture texture,
                      render::DeformationTexture::bake(mapOf(mode.fine), glm::ivec3(kTexels),
                                                       render::TexelFormat::half));
        const render::Warp fine{&texture, {}};
        SEROSA_ASSIGN(const render::CoarseWarp coarse,
                      render::CoarseWarp::create({{mapOf(mode.coarse), {}}}));
        SEROSA_ASSIGN(render::Raycaster caster, ball.caster(fine));
        caster.setCoarse(coarse, kCells);
        render::RaycastLook look;
        look.solid = mode.solid;
        look.thickness = kThickness;
        render::RaycastTwin twin(field, ball.field.grid(), fine, look.solid, look.thickness,
                                 ball.field.grid().step / 10);
        twin.setCoarse(&coarse);
        render::RaycastAgreement sum;
        for (const glm::dvec3& direction : directions) {
            const render::RaycastView view =
                ball.view(glm::normalize(direction), sim::Projection::perspective, width, height);
            SEROSA_ASSIGN(const std::vector<render::RaycastProbe> probes,
                          caster.probe(view.frame, look, width, height));
            addAgreement(sum, view, caster, probes, twin);
        }
        const std::string of =
            std::string("hybrid, ") + mode.name + ", " + std::to_string(sum.object) + " pixels: ";
        checks.atLeast(of + "pixels with something to see", double(sum.object) / (2 * width * height), 0.1,
                       "of the picture");
        checks.atMost(of + "silhouettes differ in", 100 * sum.silhouetteShare(), 0.5, "%");
        checks.atMost(of + "depth off by half a pixel's footprint in", 100 * sum.deepShare(), 1, "%");
        checks.atMost(of + "normals, median", sum.medianTurn(), 2, "deg");
    }
    SEROSA_ASSIGN(const render::CoarseWarp bend, render::CoarseWarp::create({{mapOf(MapKind::bend), {}}}));
    const render::RaycastView view = ball.view(directions[0], sim::Projection::perspective, width, height);
    double off[2];
    for (const int k : {0, 1}) {
        SEROSA_ASSIGN(render::Raycaster caster, ball.caster(std::nullopt));
        caster.setCoarse(bend, kCells << k);
        SEROSA_ASSIGN(off[k], offBy(caster, bend, view));
    }
    checks.atMost("hybrid, bend: places at rest off by, 16 cells", 1e3 * off[0], 0.15, "mm");
    checks.atLeast("the same, 16 cells over 32 (4: second order)", off[0] / off[1], 3, "1");
    checks.atMost("the same", off[0] / off[1], 5, "1");
    return {};
}

} // namespace serosa::app
