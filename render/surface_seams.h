#pragma once
// The vertices that are drawn of a mesh with texture coordinates: along a seam of the texture a vertex has
// several, and is drawn once for each. The mesh itself stays as it is, closed.

#include "sim/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace serosa::render {

struct TextureVertex {
    glm::vec2 uv{0};
    glm::vec4 tangent{1, 0, 0,
                      1}; // along u, unit, in the mesh's axes; w: 1, or -1 where v runs the other way
};
static_assert(sizeof(TextureVertex) == 24);

struct DrawnVertices {
    std::vector<glm::uvec3> faces;       // over the drawn vertices, in the mesh's order
    std::vector<std::uint32_t> origin;   // mesh vertex of each; the first ones are the mesh's, in its order
    std::vector<TextureVertex> textures; // one each; empty without texture coordinates
};

/// \param normals one a mesh vertex, unit
DrawnVertices drawnVertices(const sim::TriangleMesh& mesh, const std::vector<glm::dvec3>& normals);

} // namespace serosa::render
