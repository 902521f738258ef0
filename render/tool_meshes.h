#pragma once
// Triangles of rigid shapes for drawing (sim/rigid_shape.h). A vertex lies at core + radius * normal in the
// shape's own frame: the rounding is applied where it is drawn, and normals are exact.

#include "sim/rigid_shape.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace serosa::render {

struct ToolVertex {
    glm::vec3 core;   // the shape's unit; mesh: metres
    glm::vec3 normal; // unit
};

struct ToolMesh {
    std::vector<ToolVertex> vertices;
    std::vector<std::uint32_t> indices; // three a triangle, counter-clockwise seen from outside
};

/// All kinds but half-spaces, which have none; mesh: nothing where the shape has no surface.
ToolMesh toolMesh(const sim::RigidShape& shape);

/// A square of side 2 in the plane y = 0, seen from above: the patch of a floor.
ToolMesh floorPatch();

} // namespace serosa::render
