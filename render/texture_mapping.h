#pragma once
// The mapping M between object space (p, p') and texture space (q) of a deformation texture (CS07 section
// 3.2): q = M^-1 p', p = M(q + D(q)). As printed, eq. 2 puts M around D alone, which would also translate the
// displacement; the whole map is meant. Its Jacobian is J_M(q + D(q)) (I + J_D(q)) J_M(q)^-1.
//
// Affine: a rotation, a scale and a place, which move, turn and scale a deformation interactively.
// Cylindrical: the same into a local frame, whose x - z plane is then wound around y: q = (r - r0, y, r0
// phi), phi = 0 on +x; the plane q.x = 0 becomes a cylinder of radius r0 ("round" cuts).

#include "render/bounds.h"

namespace serosa::render {

struct TextureMapping {
    glm::dmat4 objectFromLocal{1}; // no shear that is not meant: lengths of D are scaled by it, too
    double cylinderRadius = 0;     // r0, local unit; 0: affine

    glm::dvec3 toTexture(const glm::dvec3& object) const;
    glm::dvec3 toObject(const glm::dvec3& texture) const;
    /// d toObject / d texture; column j in [j].
    glm::dmat3 jacobian(const glm::dvec3& texture) const;

    /// Of the box |q| <= half in object space. A box that is wound or turned bulges between its corners: from
    /// samples.
    Bounds boundsOf(const glm::dvec3& half) const;
};

} // namespace serosa::render
