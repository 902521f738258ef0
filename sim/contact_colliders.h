#pragma once
// Tools and bodies as the contact passes see them (shaders/contact_colliders.glsl, shape_distance.glsl):
// where they are in each step, and the distance fields of meshes, in one 2D texture.

#include "gpu/program.h"
#include "sim/solver.h"
#include "sim/tool_motion.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

/// Of one setup. Needs a current context where there is any collider.
class ContactColliders {
public:
    ContactColliders() = default;
    explicit ContactColliders(const SolverSetup& setup);

    std::size_t count() const { return columns_.size(); }
    /// SRS_COLLIDERS, SRS_TOOLS, SRS_SHAPES: those that occur, and SRS_PUSHING: a bit for each that pushes.
    std::vector<gpu::ShaderDefine> defines() const;

    /// Uploads steps `step` to `step + count - 1`.
    void prepare(std::int64_t step, int count);
    /// Of a step that was prepared.
    const std::vector<ToolMotion>& motions(std::int64_t step) const;
    /// Single: for programs that define SRS_SINGLE.
    enum class Precision { exact, single };
    /// Lets a program that includes contact_colliders.glsl read them. \param shapes includes
    /// shape_distance.glsl
    void bind(gpu::Program& program, std::int64_t step, Precision precision, bool shapes) const;

    std::size_t bytes() const; // of buffer and texture

private:
    SolverSetup setup_;
    std::vector<int> columns_; // one a collider: of its field in the texture
    gpu::Texture2D fields_;
    std::size_t stride_ = 0, near_ = 0; // bytes of a step; of them before those in single precision
    gpu::Buffer steps_;
    std::int64_t first_ = 0;
    std::vector<std::vector<ToolMotion>> motions_;
};

} // namespace serosa::sim
