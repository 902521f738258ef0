#pragma once
// Nodes as each side of the blades' cuts carries them (design.md section 6: a cell that a cut crosses counts
// twice, each copy extrapolated from one side's nodes). Two textures over the layout of the positions, made
// anew on the GPU from a state and the sides that the mask knows (render/cut_mask.h):
//
// - a node on the side, or far from every cut, lies where it is;
// - one on the other side, or that no spring holds to either any more, lies where the side's nodes within
//   two grid steps would have it: weighted least squares of an affine displacement. The more of its springs
//   to the side are left, the more it is where it is: so the two sides meet where a cut ends.
//
// A cell over one of the textures is whole, whatever crosses it, and neighbouring cells share corners: each
// side's tissue goes on past the cut without a jump. Sides are those of the nearest cut: where cuts cross,
// what lies between them follows the nearer one. A node in the blade's very way (less than SRS_SIDE_ON from
// it) is of the side to which it lost fewer of its springs, whatever the rounded distance says, and of none
// where it lost all to both: else a cell would hang between halves that fall apart.

#include "base/result.h"
#include "gpu/program.h"
#include "render/cut_mask.h"
#include "sim/lattice.h"
#include "sim/state_textures.h"

namespace serosa::render {

class SideNodes {
public:
    /// Needs a current context. Errors: more than 1024 nodes along an axis, of the shader.
    static Result<SideNodes> create(const sim::Lattice& lattice, const sim::TextureLayout& layout);
    /// \param mask of the same lattice
    void update(const sim::StateTextures& state, const CutMask& mask);

    /// RGBA32F, at the nodes' texels: lattice units; alpha: spacings that the node lies on the side, less
    /// than 0 on the other, SRS_SIDE_FAR or SRS_SIDE_NONE.
    const gpu::Texture2D& above() const { return above_; }
    const gpu::Texture2D& below() const { return below_; }

private:
    SideNodes() = default;
    gpu::Program find_, program_;
    gpu::Buffer nodes_, grid_, sides_;
    gpu::Texture2D above_, below_;
    int count_ = 0;
    glm::ivec3 dims_{0}, centre_{0};
};

} // namespace serosa::render
