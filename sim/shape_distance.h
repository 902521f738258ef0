#pragma once
// Signed distance to the surface of a rigid shape (sim/rigid_shape.h), negative inside, in the shape's own
// frame. Rounded shapes: the distance to the core less the rounding; this is exact outside and, for convex
// cores, inside. Boxes: Quilez, Distance functions (2008). shaders/shape_distance.glsl is the twin.

#include "sim/rigid_shape.h"

namespace serosa::sim {

struct ShapeSample {
    double distance = 0;        // to the surface, in the shape's unit
    glm::dvec3 normal{0, 1, 0}; // its gradient, of length 1; on a core, where there is none, (0, 1, 0)
};

/// \param own in the shape's frame and unit. Mesh: interpolated (sim/distance_field.h).
ShapeSample sampleShape(const RigidShape& shape, const glm::dvec3& own);
double shapeDistance(const RigidShape& shape, const glm::dvec3& own);
/// Never more than the distance, for what leaves out all that is far: a mesh away from its grid is not known.
double shapeLowerBound(const RigidShape& shape, const glm::dvec3& own);

/// How far the surface lies from the middle of the shape where it is thinnest; infinity for a half-space.
double thinnestHalfWidth(const RigidShape& shape);

/// Of a sphere about the reference point that holds the shape; infinity for a half-space.
double boundingRadius(const RigidShape& shape);

/// The shape in another unit. \param scale new unit = old unit times this
RigidShape scaledShape(RigidShape shape, double scale);

} // namespace serosa::sim
