#pragma once
// Draws threads and clips from the state textures of the organs that they are tied to: nothing is read back.

#include "base/result.h"
#include "gpu/program.h"
#include "render/frame.h"
#include "sim/state_textures.h"

#include <array>
#include <vector>

namespace serosa::render {

/// A thread as it is drawn, between two material points (sim/thread_hold.h).
struct DrawnThread {
    struct End {
        std::size_t organ = 0; // of those that are drawn
        std::array<std::uint32_t, 8> nodes{};
        std::array<double, 8> weights{};
    };
    End ends[2];
    double radius = 0; // m
    bool clip = false; // of steel; a thread is blue
};

class ThreadRenderer {
public:
    static Result<ThreadRenderer> create();
    /// Its program from another source. Errors: as gpu::Program::create.
    static Result<gpu::Program> compile(const gpu::ShaderLibrary& library);
    gpu::Program& program() { return program_; }

    /// Draws into the bound target with its depth test.
    /// \param placements spacing and origin of each organ; the frame is in units of the first
    void draw(const Frame& frame, const std::vector<const sim::Lattice*>& placements,
              const std::vector<const sim::StateTextures*>& states, const std::vector<DrawnThread>& threads);

private:
    ThreadRenderer() = default;

    gpu::Program program_;
    gpu::VertexArray array_;
    gpu::Buffer vertices_, indices_;
    int indexCount_ = 0;
};

} // namespace serosa::render
