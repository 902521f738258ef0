// Group `raycast` of `serosa verify`: the deformation shader (CS07) against rays cast in double, against what
// is known in closed form, and the misses of its searches (figure 3).
#include "app/verify/raycast.h"

#include "models/phantom.h"

namespace serosa::app {

namespace {

constexpr int kMargin = 3;                 // voxels around a model
constexpr std::size_t kBallFaces = 20'000; // 4e-5 of its radius off a ball
constexpr double kUnits = 30;              // of object space, across a model

} // namespace

Result<RaycastModel> RaycastModel::of(sim::TriangleMesh mesh, int samples, double band) {
    const glm::dvec3 low = mesh.lowest(), high = mesh.highest();
    SEROSA_ASSIGN(
        render::DistanceVolume field,
        render::DistanceVolume::create(mesh, render::VolumeGrid::around(low, high, samples, kMargin), band));
    return RaycastModel{std::move(mesh), render::objectSpace(glm::distance(low, high) / kUnits),
                        std::move(field)};
}

render::RaycastView RaycastModel::view(const glm::dvec3& direction, sim::Projection projection, int width,
                                       int height, double around) const {
    const glm::dvec3 middle = 0.5 * (mesh.lowest() + mesh.highest()),
                     half = 0.5 * around * (mesh.highest() - mesh.lowest());
    return render::RaycastView::of(space, middle - half, middle + half, direction, projection, width, height);
}

Result<render::Raycaster> RaycastModel::caster(const std::optional<render::Warp>& warp) const {
    SEROSA_ASSIGN(render::Raycaster made, render::Raycaster::create(space, field));
    made.setWarp(warp);
    return made;
}

Result<RaycastModel> raycastBall(int samples) {
    SEROSA_ASSIGN(sim::TriangleMesh mesh, models::phantomInMetres("ball", kBallFaces));
    for (glm::dvec3& p : mesh.positions)
        p = kBallRadius * glm::normalize(p);
    return RaycastModel::of(std::move(mesh), samples, 0.3 * kBallRadius);
}

Status verifyRaycast(const VerifyOptions& options, CheckList& checks) {
    SEROSA_TRY(verifyRaycastKnown(options, checks));
    SEROSA_TRY(verifyRaycastTwin(options, checks));
    SEROSA_TRY(verifyRaycastHybrid(options, checks));
    SEROSA_TRY(verifyRaycastWays(options, checks));
    SEROSA_TRY(verifyRaycastDepth(options, checks));
    return verifyRaycastFigure3(options, checks);
}

} // namespace serosa::app
