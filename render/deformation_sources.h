#pragma once
// Deformation textures from what is known at points (CS07 section 4): control points that a user moves, and a
// forward displacement from elsewhere (a registration, a finite element method), inverted.

#include "render/deformation_texture.h"

#include <vector>

namespace serosa::render {

struct ControlPoint {
    glm::dvec3 from{0}, to{0}; // texture space, m: at rest, and where it was moved to
};

/// D at each texel by inverse-distance weighted interpolation between the control points where they were
/// moved to (Shepard 1968; Ruprecht & Mueller 1995), weights ((R - d)+ / (R d))^2 after Franke & Nielson, R
/// the distance within which a point counts. It takes each control point from where it was moved to just to
/// where it rests. Towards the box's faces it fades to nothing over its last fifth. Errors: no points, two of
/// them moved to one place, a point outside of the box, as DeformationTexture::create.
Result<DeformationTexture> interpolateControlPoints(const std::vector<ControlPoint>& points,
                                                    const glm::ivec3& size, const glm::dvec3& half,
                                                    double reach, TexelFormat format);

/// How well a forward displacement was inverted: |p + F(p) - p'| over the texels, m.
struct InversionResidual {
    double largest = 0, median = 0;
    std::size_t unresolved = 0; // texels with more than a hundredth of a texel: folds, or rims
};

struct InvertedDisplacement {
    DeformationTexture texture;
    InversionResidual residual;
};

/// The inverse of a forward displacement F on a grid of the same box (texels as DeformationTexture's, m, x
/// fastest; outside of the box F is 0): for each p' the p with p + F(p) = p', by Newton's steps on the
/// trilinear F, halved until the residual falls. Where F folds, one of the solutions, or what comes nearest
/// to one: the residual says so. Errors: as DeformationTexture::create.
Result<InvertedDisplacement> invertDisplacement(const std::vector<glm::dvec3>& forward,
                                                const glm::ivec3& size, const glm::dvec3& half,
                                                TexelFormat format);

} // namespace serosa::render
