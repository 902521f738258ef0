#pragma once
// MS05 3.5: "The triangle-basis based mapping can be simplified somewhat if we assume that the offset is
// always along the dynamically calculated normal": v = r + d N_c, with one number for the offset.
//
// For a vertex to return at rest its reference point must be the one whose normal goes through it. With eq.
// 8's N_c = sum w_i N_i, linear over the triangle, r + d' N_c runs through the triangle of the points p_i +
// d' N_i: v lies in its plane for a root of a cubic in d'. Where none lies near the triangle, or the nodes'
// normals are not well defined, the triangle's own normal serves: the foot of the perpendicular always
// exists.

#include "render/basis_choice.h"

#include <glm/glm.hpp>

namespace serosa::render {

struct NormalOffset {
    glm::vec3 weights{0};   // of r, sum 1; may be negative: r lies beside the triangle then
    float distance = 0;     // d, lattice units
    bool corrected = false; // along eq. 8's N_c; else along the triangle's normal
};

/// \param point its weights do not matter
NormalOffset offsetAlongNormal(const RestNormals& rest, const BoundPoint& point);

} // namespace serosa::render
