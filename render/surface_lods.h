#pragma once
// Levels of detail of the surface itself: fewer triangles over the same vertices, for where the organ is
// small in the picture. meshoptimizer's simplifier (Garland and Heckbert 1997, Surface Simplification Using
// Quadric Error Metrics).

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace serosa::render {

struct SurfaceLod {
    std::vector<glm::uvec3> faces; // over the vertices that were given
    double error = 0;              // how far it may lie from the surface, in the unit of the positions
};

/// Levels of a quarter of the faces each, down to 10,000: none for a surface of less than 40,000.
std::vector<SurfaceLod> surfaceLods(const std::vector<glm::dvec3>& positions,
                                    const std::vector<glm::uvec3>& faces);

} // namespace serosa::render
