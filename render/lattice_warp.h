#pragma once
// The lattice's own displacement as a deformation texture (design.md section 6): the inverse of the simulated
// field, made anew on the GPU for each picture. Nothing is read back.
//
// The field takes a place of a cell to where its eight corners carry it, trilinearly. Its inverse:
// 1. bounds of the nodes, which the texture's box holds with a voxel to spare;
// 2. each cell goes over the voxels near it, inverts the trilinear map there (Newton), and claims those that
//    lie in it or, with less right, less than SRS_WARP_REACH of a cell beside it (an atomic minimum over how
//    far outside, then the cell's index): where tissue folds, the cell that holds a point first has it;
// 3. each claimed voxel takes D = p - p', in lattice units, and coverage 1; others none.
// What is interpolated between voxels is right to the second order of a voxel's size; outside of the covered
// part there is no tissue.

#include "base/result.h"
#include "gpu/program.h"
#include "gpu/sampled_texture.h"
#include "sim/lattice.h"
#include "sim/state_textures.h"

#include <glm/glm.hpp>

#include <vector>

namespace serosa::render {

class LatticeWarp {
public:
    /// \param voxels a spacing, along each axis, at rest: 1 is the lattice's own resolution.
    /// Errors: more than 2^20 cells, a texture beyond what the context has, of the shaders.
    static Result<LatticeWarp> create(const sim::Lattice& lattice, const sim::TextureLayout& layout,
                                      double voxels = 2);

    /// The inverse of this state, from now on.
    void update(const sim::StateTextures& state);
    /// Sets what shaders/raycast_lattice.glsl asks for.
    void bind(gpu::Program& program) const;

    const glm::ivec3& size() const { return texture_.size(); }
    std::size_t bytes() const { return texture_.bytes(); } // of the texture
    /// D (lattice units) and coverage, and the box of the voxels' middles; waits.
    struct Read {
        glm::dvec3 lowest{0}, step{1}; // lattice units
        std::vector<glm::vec4> texels;
    };
    Read read() const;

private:
    LatticeWarp() = default;
    gpu::Texture3D texture_, owner_;
    gpu::Buffer cells_, nodes_, box_;
    gpu::Program bounds_, frame_, claim_, write_;
    std::size_t cellCount_ = 0, nodeCount_ = 0;
};

} // namespace serosa::render
