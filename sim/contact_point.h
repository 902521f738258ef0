#pragma once
// Contact of one material point with a rigid shape during a step: the rule that nodes (sim/tool_motion.h) and
// points of triangles (sim/contact_triangle.h) share. shaders/contact_point.glsl is the twin.
//
// In the shape's own frame the point goes straight from y0 to y1. Its gap is the distance to the shape less
// the depth that it lies below the organ's surface.
//   - It begins outside: the motion is sampled, closer than half of the shape's thinnest half-width, and the
//     first touch found between two samples. n is the shape's normal there. A point that ends inside is moved
//     out along n, no further than needed; one that went through is stopped at the plane through the touch.
//   - It begins inside: n is the normal at its start, and it comes out by at most SRS_EJECTION a step.
// n points against the approach, so that on a convex shape the motion along n only becomes less: contact
// takes energy and never gives any. Along the normal at the step's end, a fast point that crosses a part of a
// sphere would leave it with more than it came with.
//
// Friction (Coulomb, on positions): with t the move along n, ejection apart, the motion along the surface
// within the step is reduced by at most friction * t.

#include "sim/rigid_shape.h"

namespace serosa::sim {

/// A shape as contact asks for it. Lengths in lattice units.
struct ContactShape {
    const RigidShape& shape;
    double thin; // thinnestHalfWidth(shape)
    double friction = 0;
};

/// A node that rests further outside of the organ's surface than a thin shape is thick could enter it
/// unfelt: contact counts it as half of the thinnest half-width outside at most.
double contactDepthFor(double depth, double thin);

/// Samples of a motion of this length: 1 to SRS_SWEEP_SAMPLES.
int sweepSamples(double path, double thin);

/// What moves the point out at the step's end, in the shape's frame; zero where nothing touches.
/// \param depth as contactDepthFor gives it. \param samples at least 1
glm::dvec3 pointContact(const ContactShape& collider, const glm::dvec3& y0, const glm::dvec3& y1,
                        double depth, int samples);

} // namespace serosa::sim
