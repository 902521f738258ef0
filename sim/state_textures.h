#pragma once
// The state of one lattice on the GPU: positions (RGBA32F: xyz lattice units, alpha packed normal),
// increments (RGBA32F), node info (RGBA32UI). Drawing passes read positions() and texelOfNode of the layout.

#include "base/result.h"
#include "gpu/handles.h"
#include "sim/lattice_state.h"
#include "sim/texture_layout.h"

#include <array>
#include <cstdint>
#include <vector>

namespace serosa::sim {

class StateTextures {
public:
    /// Uploads the rest state. Needs a current context. Errors: as makeTextureLayout.
    static Result<StateTextures> create(const Lattice& lattice, const std::vector<bool>& fixed,
                                        int layoutKind = -1);

    const TextureLayout& layout() const { return layout_; }
    const gpu::Texture2D& positions() const { return positions_[current_]; }
    const gpu::Texture2D& increments() const { return increments_[current_]; }
    const gpu::Texture2D& nodeInfo() const { return nodeInfo_[currentInfo_]; }

    /// From now on a state's earlier increments (LatticeState::earlier) are kept, too: none yet.
    void keepEarlier();
    /// Replaces positions, increments, normals, held flags and connections.
    void upload(const LatticeState& state);
    /// Reads all back (stalls).
    LatticeState download(std::int64_t step) const;
    /// Connections alone, 18 bits a node (stalls).
    std::vector<std::uint32_t> downloadConnections() const;
    /// Texture memory, double buffering included.
    std::size_t bytes() const;

private:
    friend class CellPass;
    friend class ContactPass;
    friend class CutPass;
    friend class LodPass;
    friend class TextureSolver;
    friend class FragmentSolver;
    friend class ComputeSolver;
    friend class ImplicitContactPass;
    friend class ImplicitPasses;
    friend class ImplicitTextureSolver;
    StateTextures() = default;
    std::size_t linearTexel(std::size_t node) const;

    TextureLayout layout_;
    std::vector<std::array<std::uint32_t, 4>> info_; // CPU copy of node info without held flags, one a texel
    gpu::Texture2D positions_[2], increments_[2], nodeInfo_[2], rowOffsets_[2];
    gpu::Texture2D earlier_; // RGBA32F: LatticeState::earlier; or empty
    int current_ = 0, currentInfo_ = 0;
};

} // namespace serosa::sim
