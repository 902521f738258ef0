#pragma once
// An indexed triangle soup: what the readers give, the phantoms make and the surface passes draw.

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace serosa::sim {

/// Positions are in the unit of their file until `scaled` by the scene's length unit; then metres.
/// Faces wind counter-clockwise seen from outside.
struct TriangleMesh {
    std::vector<glm::dvec3> positions;
    std::vector<glm::uvec3> faces;    // indices into positions
    std::vector<glm::u8vec3> colours; // sRGB, one a vertex, or empty
    std::vector<glm::vec2> uvs; // texture coordinates, three a face in the order of its corners, or empty

    std::vector<glm::dvec3> normals; // unit, one a vertex, or empty: as the faces have them

    /// Bounds of all positions; both zero for an empty mesh.
    glm::dvec3 lowest() const;
    glm::dvec3 highest() const;
    /// Signed volume (positive when wound outward), cubic units of the positions.
    double volume() const;
    /// Surface area, square units of the positions.
    double area() const;
    /// Those that the mesh has, or area-weighted unit normals, one a vertex; (0, 1, 0) where undefined.
    std::vector<glm::dvec3> vertexNormals() const;
};

} // namespace serosa::sim
