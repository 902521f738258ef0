#pragma once
// The two moving bases of MS05 3.3 in double, in one formula: a normal N (eq. 6 or eq. 8) and the triangle's
// first edge give B = N x T and T = B x N. Twin of shaders/mapping.glsl.
//
// Departure: eq. 6 as printed leaves N = T x B_t shorter than one (T and B_t are not orthogonal), eq. 8
// leaves N_c (a mean of unit vectors) and B_c too; then eq. 7 is not inverted by eq. 9. N and B are
// normalized here, T follows.

#include <glm/glm.hpp>

namespace serosa::render {

struct TriangleBasis {
    glm::dvec3 t, n, b; // T, N, B: orthonormal
};

/// \param normal along N, of any length. \param edge p2 - p1, of any length, not parallel to it.
inline TriangleBasis basisAlong(const glm::dvec3& normal, const glm::dvec3& edge) {
    TriangleBasis basis;
    basis.n = glm::normalize(normal);
    basis.b = glm::normalize(glm::cross(basis.n, edge));
    basis.t = glm::cross(basis.b, basis.n);
    return basis;
}

/// Eq. 6: N of the triangle p1, p2, p3.
inline glm::dvec3 triangleNormal(const glm::dvec3& p1, const glm::dvec3& p2, const glm::dvec3& p3) {
    return glm::cross(p2 - p1, p3 - p1);
}

/// Eq. 7: coordinates of a vector in the basis.
inline glm::dvec3 inBasis(const TriangleBasis& basis, const glm::dvec3& v) {
    return {glm::dot(v, basis.t), glm::dot(v, basis.n), glm::dot(v, basis.b)};
}

/// Eq. 9: the vector with these coordinates.
inline glm::dvec3 fromBasis(const TriangleBasis& basis, const glm::dvec3& o) {
    return o.x * basis.t + o.y * basis.n + o.z * basis.b;
}

} // namespace serosa::render
