#pragma once
// Shapes of what is rigid: tools (sim/tool.h) and bodies (sim/body.h). All but half-space and mesh are
// rounded: the points within `radius` of a core. sim/shape_distance.h measures the distance to one.
//
// In a shape's own frame the origin is its reference point, which poses name and torques are about:
//   sphere      core: the origin
//   capsule     core: the segment from the origin to (0, 0, length): a rod that ends in the origin, as a
//   probe's tip box         core: from middle - halfSize to middle + halfSize. A blade is a thin one hook
//   core: half a circle of radius `bend` about the origin in the plane x = 0, z <= 0, from the tip
//               (0, bend, 0) over (0, 0, -bend) to (0, -bend, 0), and a shank from there to (0, -bend,
//               length)
//   half-space  y <= 0 is solid: a floor
//   mesh        a small closed surface, by its distance field

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <memory>

namespace serosa::sim {

class DistanceField; // sim/distance_field.h
struct TriangleMesh; // sim/triangle_mesh.h

/// world = at + turn * own
struct RigidPose {
    glm::dvec3 at{0};            // m
    glm::dquat turn{1, 0, 0, 0}; // unit; w, x, y, z

    glm::dvec3 toWorld(const glm::dvec3& own) const { return at + turn * own; }
    glm::dvec3 toOwn(const glm::dvec3& world) const { return glm::conjugate(turn) * (world - at); }
};

/// From a (share 0) to b (1): places in a straight line, turns at an even rate; a turn that stays is not
/// rounded.
inline RigidPose poseBetween(const RigidPose& a, const RigidPose& b, double share) {
    return {a.at + (b.at - a.at) * share, a.turn == b.turn ? a.turn : glm::slerp(a.turn, b.turn, share)};
}

enum class ShapeKind { sphere, capsule, box, hook, halfSpace, mesh };

/// Lengths in metres; in lattice units where it says so (ToolMotion).
struct RigidShape {
    ShapeKind kind = ShapeKind::sphere;
    double radius = 0.005;                      // of the rounding; half-space and mesh: 0
    double length = 0;                          // capsule, hook
    double bend = 0;                            // hook
    glm::dvec3 middle{0};                       // box
    glm::dvec3 halfSize{0};                     // box, without the rounding
    std::shared_ptr<const DistanceField> field; // mesh: not null; in metres whatever the rest is in
    double fieldScale = 1;                      // mesh: this shape's unit over a metre
    std::shared_ptr<const TriangleMesh> surface = nullptr; // mesh: what is drawn, metres; null: nothing is
};

} // namespace serosa::sim
