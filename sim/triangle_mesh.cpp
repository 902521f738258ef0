// Measures of a triangle soup. Sums run over corners relative to the first position: an organ may lie far
// from the origin, where the products of absolute coordinates would cancel.
#include "sim/triangle_mesh.h"

namespace serosa::sim {

glm::dvec3 TriangleMesh::lowest() const {
    if (positions.empty())
        return glm::dvec3(0);
    glm::dvec3 bound = positions.front();
    for (const auto& p : positions)
        bound = glm::min(bound, p);
    return bound;
}

glm::dvec3 TriangleMesh::highest() const {
    if (positions.empty())
        return glm::dvec3(0);
    glm::dvec3 bound = positions.front();
    for (const auto& p : positions)
        bound = glm::max(bound, p);
    return bound;
}

double TriangleMesh::volume() const {
    double sum = 0;
    for (const auto& face : faces) {
        const glm::dvec3& origin = positions.front();
        const glm::dvec3 a = positions[face.x] - origin, b = positions[face.y] - origin,
                         c = positions[face.z] - origin;
        sum += glm::dot(a, glm::cross(b, c));
    }
    return sum / 6;
}

double TriangleMesh::area() const {
    double sum = 0;
    for (const auto& face : faces) {
        const glm::dvec3& a = positions[face.x];
        sum += glm::length(glm::cross(positions[face.y] - a, positions[face.z] - a));
    }
    return sum / 2;
}

std::vector<glm::dvec3> TriangleMesh::vertexNormals() const {
    if (!normals.empty())
        return normals;
    std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0));
    for (const auto& face : faces) {
        const glm::dvec3& a = positions[face.x];
        const glm::dvec3 twiceArea = glm::cross(positions[face.y] - a, positions[face.z] - a);
        for (int corner = 0; corner < 3; ++corner)
            sums[face[corner]] += twiceArea;
    }
    for (auto& normal : sums) {
        const double length = glm::length(normal);
        normal = length > 0 ? normal / length : glm::dvec3(0, 1, 0);
    }
    return sums;
}

} // namespace serosa::sim
