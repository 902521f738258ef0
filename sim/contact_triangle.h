#pragma once
// Contact of a triangle of the organ's surface with a rigid shape during a step: the point of it that lies
// deepest (Macklin, Erleben, Mueller, Chentanez, Jeschke & Kim 2020, Local Optimization for Robust Signed
// Distance Field Collision), then the rule of sim/contact_point.h for this point.
//
// A triangle that the shape comes to from inside, through what lies before it, is kept SRS_WALL off: a sheet
// one cell thick that a thin probe presses would turn inside out under its tip and let it through.

#include "sim/contact_point.h"

#include <array>

namespace serosa::sim {

/// Corners in the shape's own frame, lattice units.
using Corners = std::array<glm::dvec3, 3>;

struct TriangleGap {
    glm::dvec3 weights{1, 0, 0}; // of the corners: >= 0, sum 1
    double gap = 0;
};

/// Least of phi(sum b_i p_i) - sum b_i depth_i over a triangle. On a sphere exact, on other convex shapes to
/// some 0.01 of an edge; on others the least near the best of corners, edge middles and centroid.
TriangleGap deepestPoint(const RigidShape& shape, const Corners& p, const glm::dvec3& depth);

struct TriangleContact {
    glm::dvec3 weights{0};
    glm::dvec3 move{0}; // of the point with these weights, in the shape's frame; zero: no contact
};

/// \param surface depths as contactDepthFor gives them; the corners wind counter-clockwise seen from outside
TriangleContact triangleContact(const ContactShape& collider, const Corners& y0, const Corners& y1,
                                const glm::dvec3& surface);

} // namespace serosa::sim
