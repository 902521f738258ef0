#pragma once
// The lattice's own displacement as a deformation texture (design.md section 6): the inverse of the simulated
// field, made anew on the GPU for each picture. Nothing is read back.
//
// The field takes a place of a cell to where its eight corners carry it, trilinearly. Its inverse:
// 1. bounds of the nodes (and how far they go in a frame, in the mean), which the texture's box holds with a
//    voxel to spare. Where a piece fell off and a voxel would be more than half again as long as at rest, it
//    holds the place where most nodes lie, and what is beyond is not shown;
// 2. each cell goes over the voxels near it, inverts the trilinear map there (Newton), and claims those that
//    lie in it or, with less right, less than SRS_WARP_REACH of a cell beside it (an atomic minimum over how
//    far outside, then the cell's index): where tissue folds, the cell that holds a point first has it;
// 3. each claimed voxel takes D = p - p', in lattice units, and coverage 1; others none.
// Where blades cut (design.md section 6), the field has two inverses: one texture a side of the cuts, each of
// the nodes as its side carries them (render/side_nodes.h), so that a crossed cell counts twice and each
// copy goes on past the cut by SRS_WARP_ACROSS spacings. A point is of the side on which the finer mask finds
// its own rest position (shaders/raycast_lattice.glsl); in an opened cut it is of neither.
//
// What is interpolated between voxels is right to the second order of a voxel's size; outside of the covered
// part there is no tissue.

#include "base/result.h"
#include "gpu/program.h"
#include "gpu/sampled_texture.h"
#include "render/side_nodes.h"
#include "sim/lattice.h"
#include "sim/state_textures.h"

#include <glm/glm.hpp>

#include <array>
#include <optional>
#include <vector>

namespace serosa::render {

class LatticeWarp {
public:
    /// \param lattice outlives this, and so does its layout
    /// \param voxels a spacing, along each axis, at rest: 1 is the lattice's own resolution.
    /// Errors: more than 2^20 cells, a texture beyond what the context has, of the shaders.
    static Result<LatticeWarp> create(const sim::Lattice& lattice, const sim::TextureLayout& layout,
                                      double voxels = 2);

    /// The inverse of this state, from now on. \param mask of the same lattice, which outlives this: what
    /// blades cut; null: nothing. \param steps a frame, each as long as the state's increments: how fast it
    /// moves; 0: it rests. Errors: of the shaders, when first cut.
    Status update(const sim::StateTextures& state, const CutMask* mask = nullptr, int steps = 0);
    /// Is the inverse of two sides?
    bool isCut() const { return mask_ != nullptr; }
    /// Sets what shaders/raycast_lattice.glsl asks for.
    void bind(gpu::Program& program) const;

    const glm::ivec3& size() const { return sides_[0].size(); }
    std::size_t bytes() const {
        return sides_[0].bytes() + (sides_[1] ? sides_[1].bytes() : 0);
    } // on the GPU
    /// D (lattice units) and coverage, and the box of the voxels' middles; waits.
    struct Read {
        glm::dvec3 lowest{0}, step{1}; // lattice units
        std::vector<glm::vec4> texels;
    };
    /// \param side 0, or 1: below the cuts
    Read read(std::size_t side = 0) const;

private:
    struct Programs {
        gpu::Program bounds, bins, claim, write;
    };
    LatticeWarp() = default;
    static Result<Programs> compile(const std::vector<gpu::ShaderDefine>& defines);
    Status openSides();
    void setNodes(gpu::Program& program, const sim::StateTextures& state) const;

    const sim::Lattice* lattice_ = nullptr;
    const sim::TextureLayout* layout_ = nullptr;
    const CutMask* mask_ = nullptr;
    std::array<gpu::Texture3D, 2> sides_; // the second where it was cut
    gpu::Texture3D owner_;
    gpu::Buffer cells_, nodes_, box_;
    gpu::Program frame_, ways_;
    Programs whole_;
    std::optional<Programs> cut_;
    std::optional<SideNodes> sideNodes_;
    std::size_t cellCount_ = 0, nodeCount_ = 0;
    double mostStep_ = 0; // of a voxel, lattice units
};

} // namespace serosa::render
