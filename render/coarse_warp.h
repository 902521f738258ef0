#pragma once
// The hybrid of CS07 section 6.3: "coarse deformation can be implemented on a vertex shader, while
// fine-grained deformation and cuts can be done at the pixel level". Closed-form maps that go forward, p' =
// C(p): the vertex stage moves the corners of tetrahedra by them (render/ray_proxy.h), within which a ray is
// straight at rest, and what the pixel does (textures, masks) lies between that rest and the body's. No
// inverse is sampled, so that no box has to hold the bent body.
//
// Unlike a texture's, a map is not cut off at its box: the formulas go on beyond. Where the box may cross the
// body the map vanishes (render/deformation_faces.h), and beyond the other faces there is no body, so that
// what is shown is the same; the tetrahedra just have no tear.

#include "base/result.h"
#include "gpu/program.h"
#include "render/deformation_map.h"
#include "render/texture_mapping.h"

#include <optional>
#include <string>
#include <vector>

namespace serosa::render {

struct CoarseMap {
    DeformationMap map;
    TextureMapping mapping; // affine
};

class CoarseWarp {
public:
    /// Can the vertex stage do it? twist, bend, pull, wave.
    static bool knows(MapKind kind);
    /// The first acts next to rest. Errors: none or more than SRS_COARSE_MAPS, a kind that it does not know,
    /// a wound box, as problemOf.
    static Result<CoarseWarp> create(std::vector<CoarseMap> maps);

    /// p' and d p' / d p; object space, m.
    glm::dvec3 forward(const glm::dvec3& rest) const;
    glm::dmat3 jacobian(const glm::dvec3& rest) const;
    /// p, and d p / d p': the inverse. No picture asks for it: what the vertex stage shows is tested by it.
    glm::dvec3 back(const glm::dvec3& shown) const;
    glm::dmat3 backJacobian(const glm::dvec3& shown) const;
    /// Where it turns the inside out around one of these places of the body at rest; nothing: nowhere.
    std::optional<glm::dvec3> foldsAt(const std::vector<glm::dvec3>& body) const;

    /// Sets what shaders/coarse_map.glsl asks for. \param buffer what it reads from; made where it is none
    /// \param origin, unit m: of the object space of the program
    void set(gpu::Program& program, gpu::Buffer& buffer, const glm::dvec3& origin, double unit) const;

private:
    std::vector<CoarseMap> maps_;
};

} // namespace serosa::render
