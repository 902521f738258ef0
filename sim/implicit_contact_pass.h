#pragma once
// Contact, friction and grasps inside an implicit step on the GPU: what sim/implicit_contact.h says, as
// compute passes between those of sim/implicit_passes.h. Where contact would move nodes is asked of a second
// ContactPass, whose colliders have no friction.
//
//   close                      grasps open and close
//   before a round: place      what the last round's supports gave; where contact is asked
//                   (contact)  where it would move nodes
//                   support    force and stiffness of each node
//   at the step's end: place, (gradient), loads, (finish), contact's own pushes, grip, settle

#include "base/result.h"
#include "gpu/program.h"
#include "sim/contact_pass.h"
#include "sim/solver.h"
#include "sim/state_textures.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace serosa::sim {

/// Of one StateTextures. Needs a current context where there is any collider.
class ImplicitContactPass {
public:
    /// \param pushes contact that moves nodes, of the same setup, which outlives this. \param share gives a
    /// program what all passes of the implicit step read. Errors: of the shaders.
    Status initialize(const SolverSetup& setup, const StateTextures& textures, ContactPass& pushes,
                      const gpu::Buffer& loads, const std::function<void(gpu::Program&)>& share);
    /// Nothing ever to do.
    bool empty() const { return !pushes_ || pushes_->empty(); }
    /// Of what asks: as ContactPass, whose own are called by whoever has it.
    ContactPass& asks() { return asks_; }
    /// For a program that includes contact_colliders.glsl.
    void bind(gpu::Program& program, std::int64_t step) const;

    /// Before the step's first pass. The state is `textures.positions()`.
    void close(const StateTextures& textures, std::int64_t step);
    /// Before a round; from here on the start of the step is the other half of the textures.
    void support(StateTextures& textures, std::int64_t step, int round);
    /// After the last round: what it gave.
    void take(StateTextures& textures, int rounds);
    /// After the gradient at the step's end.
    void countLoads(const StateTextures& textures, std::int64_t step);
    /// After the new state was written.
    void finish(StateTextures& textures, std::int64_t step);

    std::size_t bytes() const { return asks_.bytes(); }

private:
    void place(StateTextures& textures, int round);
    void run(gpu::Program& program);

    std::size_t nodes_ = 0;
    ContactPass* pushes_ = nullptr;
    ContactPass asks_;
    bool pushing_ = false, finite_ = false; // some collider pushes; some grip is finite
    gpu::Program place_, support_, loads_, grip_, settle_;
};

} // namespace serosa::sim
