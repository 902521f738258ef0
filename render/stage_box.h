#pragma once
// Two-stage drawing (CS07 section 3, figure 2): the part of the mesh outside of a deformation's box by the
// surface pass, the box by ray casting, both into one depth buffer. Near those faces on which the map
// vanishes both are drawn, and the ray-cast colour goes over the mesh's with a weight that rises from 0 on
// the face to 1 at the seam's end.

#include "gpu/program.h"
#include "render/deformation_faces.h"

namespace serosa::render {

struct StageBox {
    TextureMapping mapping;             // m
    glm::dvec3 half{1};                 // of the box, texture space, m
    glm::dvec3 seamLow{0}, seamHigh{0}; // m, texture space: width of the seam at each face; 0: none is there

    /// \param width of the seam, m, object space; at most a quarter of the box
    static StageBox of(const Warp& warp, const std::array<FaceOfBox, 6>& faces, double width);

    /// Sets what shaders/stage_box.glsl asks for. \param origin, unit m: of the object space of the program
    void set(gpu::Program& program, const glm::dvec3& origin, double unit) const;
};

} // namespace serosa::render
