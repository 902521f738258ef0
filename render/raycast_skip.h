#pragma once
// Empty-space skipping of the deformation shader (CS07 section 6.2; shaders/raycast_skip.glsl): how far a ray
// may go on from a place of a deformation texture's box without meeting anything.
//
// By the field: at rest nothing lies nearer than |f|, and p moves by at most |dp/dp'| times the ray's own
// way. That bound is local, the largest within `nearReach` or `reach` of a texel: a peel jumps in one place
// only, a narrow pull is steep in one. In a cell of the texture the Jacobian I + J_D is multilinear, so that
// its norm is the largest in a corner: the bound is one, not an estimate. By the cut: what is cut away shows
// nothing until the ray comes to what is kept, by a distance field of the mask in texture space, and near its
// border by the mask's own slope. Where neither allows more than a step of the search, a bound within a texel
// keeps samples a step apart at rest (eq. 4 for the direction in which it is shortest), for one fetch instead
// of a Jacobian's six.
//
// Texture space is where both are stored: M carries them over by the least and the largest stretch of its
// affine part, which may change from picture to picture; a wound box's own stretch is in the bound.

#include "render/deformation_texture.h"

#include <vector>

namespace serosa::render {

struct RaycastSkip {
    /// Of the texture's size: bounds on |dp/dp'| within nearReach and within reach; way to what is kept, m.
    /// Of all places whose nearest texel it is.
    std::vector<glm::vec3> texels;
    double nearReach = 0, reach = 0; // m of texture space
    double maskSlope = 1;            // 1/m: largest of the mask

    /// \param cylinderRadius of the mapping; 0: affine
    static RaycastSkip of(const DeformationTexture& texture, double cylinderRadius);
};

/// Largest and least factor by which a linear map changes a length.
double largestStretch(const glm::dmat3& map);
double leastStretch(const glm::dmat3& map);

} // namespace serosa::render
