#pragma once
// What a deformation does on the faces of its box (CS07 section 3): beyond them nothing moves, so that an
// object which crosses a face is torn there, unless the map vanishes on it.

#include "render/deformation_texture.h"

#include <array>
#include <functional>
#include <string>

namespace serosa::render {

struct FaceOfBox {
    bool still = true;    // nothing moves and nothing is cut anywhere on it
    bool tears = false;   // the object crosses it where something does
    double moved = 0;     // m: there, at most; texture space
    glm::dvec3 at{0};     // object space: where it moves most, or is cut
    bool ends = false;    // what is moved to it ends there: beyond it the object's rest is shown
    glm::dvec3 endsAt{0}; // object space
};

/// -x, +x, -y, +y, -z, +z, from samples just inside of them. Less than a tenth of a texel counts as still.
/// \param inside of the object at rest
std::array<FaceOfBox, 6> examineFaces(const Warp& warp, const std::function<bool(const glm::dvec3&)>& inside);

/// The faces that tear the object, for a message; empty: none.
std::string tornFaces(const std::array<FaceOfBox, 6>& faces);

/// The faces at which something ends that is moved to them, for a message; empty: none.
std::string endingFaces(const std::array<FaceOfBox, 6>& faces);

/// Share of the texels in which the map turns the inside out (its Jacobian is not positive), of those that
/// are kept: there two places at rest are shown at one, and what is shown is one of them.
double foldedShare(const DeformationTexture& texture);

} // namespace serosa::render
