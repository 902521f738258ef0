// Two triangles meet if an edge of one meets the other. All is decided by the sign of the volume of a
// tetrahedron, first in float64 with an error bound (Shewchuk 1997, Adaptive precision floating-point
// arithmetic, section 4.4: the coarsest bound, doubled), and where that cannot tell, in 113 bits.
#include "sim/mesh_crossings.h"

#include "sim/triangle_tree.h"

#include <algorithm>
#include <cmath>

namespace serosa::sim {
namespace {

#if defined(__SIZEOF_FLOAT128__)
__extension__ typedef __float128 Wide;
#else
using Wide = long double;
#endif

/// The sign of the volume of abcd: positive if d sees abc clockwise.
int side(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    const glm::dvec3 ad = a - d, bd = b - d, cd = c - d;
    const double determinant = glm::dot(ad, glm::cross(bd, cd));
    const glm::dvec3 aa = glm::abs(ad), ab = glm::abs(bd), ac = glm::abs(cd);
    const double permanent = aa.x * (ab.y * ac.z + ab.z * ac.y) + aa.y * (ab.z * ac.x + ab.x * ac.z) +
                             aa.z * (ab.x * ac.y + ab.y * ac.x);
    if (std::abs(determinant) > 1.6e-15 * permanent)
        return determinant > 0 ? 1 : -1;
    Wide m[3][3];
    for (int i = 0; i < 3; ++i) {
        m[0][i] = Wide(a[i]) - Wide(d[i]);
        m[1][i] = Wide(b[i]) - Wide(d[i]);
        m[2][i] = Wide(c[i]) - Wide(d[i]);
    }
    const Wide exact = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) +
                       m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
                       m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    return exact > 0 ? 1 : exact < 0 ? -1 : 0;
}

/// The sign of the area of abc seen along `axis`.
int turn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, int axis) {
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    const Wide area = (Wide(b[x]) - Wide(a[x])) * (Wide(c[y]) - Wide(a[y])) -
                      (Wide(b[y]) - Wide(a[y])) * (Wide(c[x]) - Wide(a[x]));
    return area > 0 ? 1 : area < 0 ? -1 : 0;
}

bool insideFlat(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                int axis) {
    const int i = turn(a, b, p, axis), j = turn(b, c, p, axis), k = turn(c, a, p, axis);
    return (i >= 0 && j >= 0 && k >= 0) || (i <= 0 && j <= 0 && k <= 0);
}

bool segmentsMeetFlat(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a, const glm::dvec3& b,
                      int axis) {
    const int i = turn(p, q, a, axis), j = turn(p, q, b, axis), k = turn(a, b, p, axis),
              l = turn(a, b, q, axis);
    if (i == 0 && j == 0) { // on one line: their ranges overlap
        const glm::dvec3 low = glm::max(glm::min(p, q), glm::min(a, b)),
                         high = glm::min(glm::max(p, q), glm::max(a, b));
        return glm::all(glm::lessThanEqual(low, high));
    }
    return i * j <= 0 && k * l <= 0;
}

/// The axis along which abc shows an area, the largest component of its normal; -1 if it has none.
int flatAxis(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 n = glm::abs(glm::cross(b - a, c - a));
    if (n == glm::dvec3(0))
        return -1;
    return n.x >= n.y ? (n.x >= n.z ? 0 : 2) : (n.y >= n.z ? 1 : 2);
}

bool segmentMeetsTriangle(const glm::dvec3& p, const glm::dvec3& q, int sideP, int sideQ, const glm::dvec3& a,
                          const glm::dvec3& b, const glm::dvec3& c) {
    if (sideP * sideQ > 0)
        return false;
    if (sideP == 0 && sideQ == 0) {
        const int axis = flatAxis(a, b, c);
        return axis >= 0 && (insideFlat(p, a, b, c, axis) || insideFlat(q, a, b, c, axis) ||
                             segmentsMeetFlat(p, q, a, b, axis) || segmentsMeetFlat(p, q, b, c, axis) ||
                             segmentsMeetFlat(p, q, c, a, axis));
    }
    const int i = side(p, q, a, b), j = side(p, q, b, c), k = side(p, q, c, a);
    return (i >= 0 && j >= 0 && k >= 0) || (i <= 0 && j <= 0 && k <= 0);
}

bool anyEdgeMeets(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const int sides[3],
                  const glm::dvec3& d, const glm::dvec3& e, const glm::dvec3& f) {
    return segmentMeetsTriangle(a, b, sides[0], sides[1], d, e, f) ||
           segmentMeetsTriangle(b, c, sides[1], sides[2], d, e, f) ||
           segmentMeetsTriangle(c, a, sides[2], sides[0], d, e, f);
}

bool oneSide(const int sides[3]) {
    return sides[0] != 0 && sides[0] == sides[1] && sides[1] == sides[2];
}

} // namespace

bool trianglesMeet(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d,
                   const glm::dvec3& e, const glm::dvec3& f) {
    if (flatAxis(a, b, c) < 0 || flatAxis(d, e, f) < 0)
        return false;
    const int sidesOfAbc[3] = {side(d, e, f, a), side(d, e, f, b), side(d, e, f, c)};
    if (oneSide(sidesOfAbc))
        return false;
    const int sidesOfDef[3] = {side(a, b, c, d), side(a, b, c, e), side(a, b, c, f)};
    if (oneSide(sidesOfDef))
        return false;
    return anyEdgeMeets(a, b, c, sidesOfAbc, d, e, f) || anyEdgeMeets(d, e, f, sidesOfDef, a, b, c);
}

namespace {

/// Triangles that share vertices, turned so that the shared ones come first: t[0] == u[0], and t[1] == u[1]
/// if there are two.
bool neighboursMeet(const std::vector<glm::dvec3>& positions, const glm::uvec3& t, const glm::uvec3& u,
                    int shared) {
    const glm::dvec3 &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
    const glm::dvec3 &e = positions[u[1]], &f = positions[u[2]];
    if (flatAxis(a, b, c) < 0 || flatAxis(a, e, f) < 0)
        return false;
    if (shared == 1) // beyond the common corner, the side opposite to it passes through the other triangle
        return segmentMeetsTriangle(b, c, side(a, e, f, b), side(a, e, f, c), a, e, f) ||
               segmentMeetsTriangle(e, f, side(a, b, c, e), side(a, b, c, f), a, b, c);
    if (side(a, b, c, f) != 0)
        return false;
    const int axis = flatAxis(a, b, c);
    return turn(a, b, c, axis) == turn(a, b, f, axis);
}

/// Brings the corners of t that are also in u to the front of both; returns how many.
int alignShared(glm::uvec3& t, glm::uvec3& u) {
    int shared = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = shared; j < 3; ++j)
            if (i >= shared && t[i] == u[j]) {
                std::swap(t[shared], t[i]);
                std::swap(u[shared], u[j]);
                ++shared;
                break;
            }
    return shared;
}

} // namespace

bool facesMeet(const std::vector<glm::dvec3>& positions, glm::uvec3 first, glm::uvec3 second) {
    const int shared = alignShared(first, second);
    if (shared == 0)
        return trianglesMeet(positions[first.x], positions[first.y], positions[first.z], positions[second.x],
                             positions[second.y], positions[second.z]);
    return shared == 3 || neighboursMeet(positions, first, second, shared);
}

std::uint64_t countCrossings(const TriangleMesh& mesh) {
    const TriangleTree tree(mesh.positions, mesh.faces);
    std::uint64_t count = 0;
    for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) {
        const glm::uvec3 t = mesh.faces[i];
        const glm::dvec3 &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
        tree.overlapping(glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)), [&](std::uint32_t j) {
            if (j <= i)
                return;
            glm::uvec3 first = t, second = mesh.faces[j];
            if (alignShared(first, second) < 3)
                count += facesMeet(mesh.positions, t, mesh.faces[j]);
        });
    }
    return count;
}

} // namespace serosa::sim
