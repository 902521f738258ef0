// The part of group `raycast` about two ways to one thing (CS07): normals by eq. 5 or by the gradient of the
// deformed field (section 3.3), and a hollow body's cut by passing by what the mask cuts away or by one
// implicit of body and cut (section 5.1.1), which misses what is thin beside a sharp cut.
#include "app/verify/raycast.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace serosa::app {

namespace {

using render::MapKind;
using render::RaycastProbe;

constexpr int kSamples = 48;
const glm::dvec3 kDirection = glm::normalize(glm::dvec3(-0.3, -0.7, -1)); // onto what is cut

Status checkNormals(const RaycastModel& ball, int size, CheckList& checks) {
    struct Case {
        const char* name;
        MapKind kind;
        double amount; // rad or m
        double most;   // deg, 95%: a spike is hardly wider than the two voxels of a difference (14 in
                       // a small picture, 24 in a large one, where more of its edge is seen)
    };
    for (const Case& one : {Case{"twist", MapKind::twist, 0.9, 2}, Case{"bend", MapKind::bend, 0.9, 2},
                            Case{"pull", MapKind::pull, 0.03, 30}, Case{"wave", MapKind::wave, 0.006, 2}}) {
        render::DeformationMap map;
        map.kind = one.kind;
        map.half = glm::dvec3(0.06);
        map.amount = one.amount;
        map.extent = one.kind == MapKind::wave ? 0.04 : 0.07;
        map.radius = 0.015;
        SEROSA_ASSIGN(const render::DeformationTexture texture,
                      render::DeformationTexture::bake(map, glm::ivec3(kSamples), render::TexelFormat::half));
        SEROSA_ASSIGN(render::Raycaster caster, ball.caster(render::Warp{&texture, {}}));
        const render::RaycastView view = ball.view(kDirection, sim::Projection::perspective, size, size, 1.5);
        render::RaycastLook look;
        SEROSA_ASSIGN(const std::vector<RaycastProbe> warped, caster.probe(view.frame, look, size, size));
        look.normals = render::Normals::gradient;
        SEROSA_ASSIGN(const std::vector<RaycastProbe> gradient, caster.probe(view.frame, look, size, size));
        std::vector<double> apart;
        for (std::size_t i = 0; i < warped.size(); ++i)
            if (warped[i].kind == RaycastProbe::surface)
                apart.push_back(
                    std::acos(std::clamp(glm::dot(warped[i].normal, gradient[i].normal), -1.0, 1.0)) * 180 /
                    std::numbers::pi);
        std::sort(apart.begin(), apart.end());
        const std::string of = std::string("normals by eq. 5 and of the gradient, ") + one.name + ": ";
        checks.atLeast(of + "pixels", double(apart.size()), 0.1 * size * size, "1");
        if (apart.empty())
            continue;
        checks.atMost(of + "angle between them, median", apart[apart.size() / 2], 0.5, "deg");
        checks.atMost(of + "the same, 95%", apart[apart.size() * 95 / 100], one.most, "deg");
    }
    return {};
}

Status checkHollow(const RaycastModel& ball, int size, CheckList& checks) {
    render::DeformationMap map;
    map.kind = MapKind::knife;
    map.half = glm::dvec3(0.055);
    map.amount = 0.004; // m: a slit, whose edges are sharp
    map.extent = 0.07;
    map.depth = 0.06;
    SEROSA_ASSIGN(const render::DeformationTexture texture,
                  render::DeformationTexture::bake(map, {96, 48, 96}, render::TexelFormat::half));
    const render::Warp warp{&texture, {}};
    SEROSA_ASSIGN(render::Raycaster caster, ball.caster(warp));
    const double voxel = ball.field.grid().step;
    const render::RaycastTwin twin(ball.field.read(), ball.field.grid(), warp, render::Solid::hollow, 0,
                                   voxel / 20);
    const render::RaycastView view = ball.view(kDirection, sim::Projection::perspective, size, size, 1.2);
    const auto missed = [&](render::Solid solid) -> Result<int> {
        render::RaycastLook look;
        look.solid = solid;
        look.search = render::Search::linear;
        look.skipField = look.skipCut = false;
        SEROSA_ASSIGN(const std::vector<RaycastProbe> probes, caster.probe(view.frame, look, size, size));
        render::RaycastAgreement sum;
        addAgreement(sum, view, caster, probes, twin);
        return sum.silhouettes + sum.deep;
    };
    SEROSA_ASSIGN(const int passing, missed(render::Solid::hollow));
    SEROSA_ASSIGN(const int combined, missed(render::Solid::combined));
    const std::string of = "hollow, a knife's slit, pixels missed: ";
    checks.atMost(of + "what is cut away is passed by", passing, 0.0005 * size * size, "1");
    checks.atLeast(of + "by one implicit of body and cut", combined, passing + 1, "1");
    return {};
}

} // namespace

Status verifyRaycastWays(const VerifyOptions& options, CheckList& checks) {
    SEROSA_ASSIGN(const RaycastModel ball, raycastBall(kSamples));
    SEROSA_TRY(checkNormals(ball, options.full ? 240 : 120, checks));
    return checkHollow(ball, options.full ? 400 : 240, checks);
}

} // namespace serosa::app
