#pragma once
// The lattice made visible (MS05 figures 1 and 2b): springs as thin lines, axis springs brighter than
// diagonals, nodes as points.

#include "base/result.h"
#include "gpu/program.h"
#include "render/frame.h"
#include "sim/state_textures.h"

namespace serosa::render {

class LatticeOverlay {
public:
    /// Springs with a connection bit that lie in boundary faces, and the nodes of those.
    static Result<LatticeOverlay> create(const sim::Lattice& lattice, const sim::TextureLayout& layout);

    /// Its program from another source. Errors: as gpu::Program::create.
    static Result<gpu::Program> compile(const gpu::ShaderLibrary& library);
    gpu::Program& program() { return program_; }

    enum class Ink { light, dark }; // dark: over the colours of normals
    /// Draws into the bound target with its depth test; leaves blending off.
    void draw(const sim::StateTextures& state, const Frame& frame, Ink ink);

    std::size_t springs() const { return std::size_t(springs_); }

private:
    LatticeOverlay() = default;
    gpu::Program program_;
    gpu::VertexArray springArray_, nodeArray_;
    gpu::Buffer springBuffer_, nodeBuffer_;
    int springs_ = 0, nodes_ = 0;
};

} // namespace serosa::render
