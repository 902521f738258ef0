#pragma once
// Cuts on the GPU, for every solver whose state lies in StateTextures: passes over the node info, with no
// readback (shaders/cut.frag, undo_cut.frag, pieces.frag).

#include "base/result.h"
#include "gpu/program.h"
#include "sim/blade.h"
#include "sim/solver.h"
#include "sim/state_textures.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

/// Of one StateTextures, which every call gets; programs are made when first needed. Needs a current context
/// (double precision in shaders is core since GL 4.0). Errors: of the shaders.
class CutPass {
public:
    /// Clears the bits of what the stroke cuts at the current positions, and keeps them in a layer of 4 bytes
    /// a texel.
    Status cut(StateTextures& textures, const Lattice& lattice, const Stroke& stroke);
    /// Gives the last stroke's bits back. False: none left.
    bool undo(StateTextures& textures);
    void forget() { layers_.clear(); }
    /// As Solver::cutLayers and Solver::setCutLayers. Reading back stalls.
    std::vector<CutLayer> layers(const StateTextures& textures) const;
    Status setLayers(const StateTextures& textures, const std::vector<CutLayer>& layers);
    /// Labels of the pieces (sim/pieces.h), one a node. Reads back (stalls).
    Result<std::vector<std::uint32_t>> pieces(const StateTextures& textures);

private:
    Status initialize(const StateTextures& textures);
    /// Draws over the other node info texture and makes it the current one.
    void rewriteInfo(StateTextures& textures, gpu::Program& program);

    gpu::Program cutProgram_, undoProgram_, pieceProgram_;
    gpu::Framebuffer infoTargets_[2], labelTargets_[2];
    gpu::Texture2D labels_[2], changed_;
    std::vector<gpu::Texture2D> layers_; // one a stroke
    gpu::VertexArray emptyVertices_;
};

} // namespace serosa::sim
