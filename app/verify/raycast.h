#pragma once
// The parts of group `raycast` of `serosa verify`.

#include "app/verify/verify.h"
#include "render/raycast_measures.h"
#include "sim/triangle_mesh.h"

namespace serosa::app {

/// A model that is ray-cast: its field, in an object space of some thirty units.
struct RaycastModel {
    sim::TriangleMesh mesh; // m
    sim::Lattice space;
    render::DistanceVolume field;

    /// \param samples along the longest side. \param band m: distances are exact to here
    static Result<RaycastModel> of(sim::TriangleMesh mesh, int samples, double band);
    /// \param around how much more than the model the picture holds
    render::RaycastView view(const glm::dvec3& direction, sim::Projection projection, int width, int height,
                             double around = 1.3) const;
    Result<render::Raycaster> caster(const std::optional<render::Warp>& warp) const;
};

inline constexpr double kBallRadius = 0.04; // m
/// About the origin.
Result<RaycastModel> raycastBall(int samples);

Status verifyRaycastTwin(const VerifyOptions& options, CheckList& checks);  // app/verify/raycast_twin.cpp
Status verifyRaycastDepth(const VerifyOptions& options, CheckList& checks); // app/verify/raycast_depth.cpp
Status verifyRaycastKnown(const VerifyOptions& options, CheckList& checks); // app/verify/raycast_known.cpp
Status verifyRaycastFigure3(const VerifyOptions& options,
                            CheckList& checks);                              // app/verify/raycast_figure3.cpp
Status verifyRaycastHybrid(const VerifyOptions& options, CheckList& checks); // app/verify/raycast_hybrid.cpp
Status verifyRaycastWays(const VerifyOptions& options, CheckList& checks);   // app/verify/raycast_ways.cpp

} // namespace serosa::app
