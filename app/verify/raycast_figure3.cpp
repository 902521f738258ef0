// The part of group `raycast` about figure 3 of CS07: a narrow pull on a golf ball, and the pixels in which
// the searches miss what a ray meets first, against rays cast in double with samples a tenth of a voxel
// apart. What the searches make of a pull shows where samples are few, a voxel apart; there the number of
// pixels hangs on where rays begin (0.07 to 0.12% by the Jacobian alone, over boxes of other sizes). How many
// are missed at most is asked of samples as they are drawn.
#include "app/verify/raycast.h"
#include "models/phantom.h"

#include <string>

namespace serosa::app {

namespace {

using render::Search;

constexpr std::size_t kFaces = 245'000; // the paper's
constexpr double kThreshold = 0.04;     // the paper's: of the ball's width
constexpr double kFew = 1;              // voxels between samples, at rest
constexpr int kSamples = 96;
constexpr double kBand = 0.001; // m

render::DeformationMap narrowPull(double radius) {
    render::DeformationMap map;
    map.kind = render::MapKind::pull;
    map.profile = render::PullProfile::narrow;
    map.half = glm::dvec3(0.4, 1.3, 0.4) * radius;
    map.amount = 1.2 * radius;
    map.radius = 0.1 * radius;
    return map;
}

} // namespace

Status verifyRaycastFigure3(const VerifyOptions& options, CheckList& checks) {
    SEROSA_ASSIGN(sim::TriangleMesh mesh, models::phantomInMetres("golfball", kFaces));
    SEROSA_ASSIGN(const RaycastModel ball, RaycastModel::of(std::move(mesh), kSamples, kBand));
    const double radius = 0.5 * (ball.mesh.highest().y - ball.mesh.lowest().y);
    SEROSA_ASSIGN(
        const render::DeformationTexture texture,
        render::DeformationTexture::bake(narrowPull(radius), {96, 64, 96}, render::TexelFormat::half));
    render::Warp warp{&texture, {}};
    warp.mapping.objectFromLocal[3] = glm::dvec4(0, 1.0 * radius, 0, 1);
    SEROSA_ASSIGN(render::Raycaster caster, ball.caster(warp));
    const int width = options.full ? 400 : 240, height = width;
    const render::RaycastTwin twin(ball.field.read(), ball.field.grid(), warp, render::Solid::solid, 0,
                                   ball.field.grid().step / 10);
    const render::RaycastView view =
        ball.view({-0.3, -0.25, -1}, sim::Projection::perspective, width, height, 1.6);
    const auto missed = [&](Search search, bool skip, double step) -> Result<double> {
        render::RaycastLook look;
        look.search = search;
        look.step = step;
        look.threshold = kThreshold * kSamples;
        look.skipField = look.skipCut = skip;
        SEROSA_ASSIGN(const std::vector<render::RaycastProbe> probes,
                      caster.probe(view.frame, look, width, height));
        render::RaycastAgreement sum;
        addAgreement(sum, view, caster, probes, twin);
        return 100.0 * (sum.silhouettes + sum.deep) / sum.object;
    };
    const std::string of = "figure 3, narrow pull on a golf ball of " +
                           std::to_string(ball.mesh.faces.size()) + " faces, missed pixels: ";
    SEROSA_ASSIGN(const double linear, missed(Search::linear, false, kFew));
    SEROSA_ASSIGN(const double threshold, missed(Search::threshold, false, kFew));
    SEROSA_ASSIGN(const double jacobian, missed(Search::jacobian, false, kFew));
    SEROSA_ASSIGN(const double skipping, missed(Search::jacobian, true, kFew));
    checks.atLeast(of + "linear search, a voxel apart", linear, 1e-3, "%");
    checks.atMost(of + "by threshold, of linear", threshold / linear, 1, "1");
    checks.atMost(of + "by the Jacobian, of linear", jacobian / linear, 0.9, "1");
    checks.atMost(of + "by the Jacobian, skipping empty space, a voxel apart", skipping, 0.1, "%");
    const double drawn = render::RaycastLook().step;
    SEROSA_ASSIGN(const double jacobianDrawn, missed(Search::jacobian, false, drawn));
    SEROSA_ASSIGN(const double skippingDrawn, missed(Search::jacobian, true, drawn));
    checks.atMost(of + "by the Jacobian, as drawn", jacobianDrawn, 0.1, "%");
    checks.atMost(of + "by the Jacobian, skipping empty space, as drawn", skippingDrawn, 0.1, "%");
    return {};
}

} // namespace serosa::app
