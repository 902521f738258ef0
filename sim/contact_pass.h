#pragma once
// The second half of a step on the GPU: contact, friction and grasps as compute passes in place on what the
// force pass wrote, for every solver whose state lies in StateTextures. Twin of sim/contact_stage.h, which
// says what is done; the order of passes of a step:
//
//   contact_close      where a grasp opens or closes: who is held
//   contact_held       where a grasp is closed: held nodes go with their tools, slip, and are let go
//   contact_near, contact_cull          nodes and triangles that may touch, into lists
//   contact_triangles, contact_moves    SRS_CONTACT_ITERATIONS rounds over these: what triangles ask of their
//                      corners, and each node's largest move
//   contact_push       every node of the list by itself
//
// Nothing is read back: how many groups a pass over a list takes is written by the pass that fills it. Lists
// are filled in any order, but no result depends on theirs, and sums are of whole numbers: the same input
// gives the same bytes.

#include "base/result.h"
#include "gpu/program.h"
#include "sim/contact_colliders.h"
#include "sim/solver.h"
#include "sim/state_textures.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

/// Of one StateTextures. Needs a current context.
class ContactPass {
public:
    /// Makes programs and buffers, as far as the setup's tools and bodies need them; `loads` is what they add
    /// to, and outlives this. Errors: of the shaders.
    /// \param purpose asks: push() leaves positions as they are, see shaders/contact_ends.glsl, and adds no
    /// loads
    enum class Purpose { moves, asks };
    Status initialize(const SolverSetup& setup, const StateTextures& textures, const gpu::Buffer& loads,
                      Purpose purpose = Purpose::moves);
    /// Nothing ever to do.
    bool empty() const { return colliders_.count() == 0; }

    /// What cuts left: 18 bits a node. Makes the triangles anew, if that changes anything.
    void connect(const StateTextures& textures, const std::vector<std::uint32_t>& connections);
    /// A stroke changed the connections, or gave some back: they are read back before the next step.
    void connectionsChanged() { stale_ = true; }
    /// Positions and held nodes came from elsewhere.
    void restart() { recount_ = true; }

    /// Before steps `step` to `step + count - 1`. Waits for the GPU only where connections changed.
    void prepare(const StateTextures& textures, std::int64_t step, int count);
    /// After the force pass of a step that was prepared: its result is `textures.positions()`, the start of
    /// the step the other half. The barriers that its reads need are its own; what follows needs those for
    /// what it reads of images.
    void run(StateTextures& textures, std::int64_t step);

    // The parts of run() that implicit steps take by themselves (sim/implicit_contact_pass.h).

    /// Opens and closes grasps, and counts the mass that each holds. The step's start is
    /// `textures.positions()`.
    void close(const StateTextures& textures, std::int64_t step);
    /// Pushes alone, as run().
    void push(StateTextures& textures, std::int64_t step);
    const ContactColliders& colliders() const { return colliders_; }
    /// What grasps hold (shaders/contact_grasp.glsl), for programs with u_now = step % 3.
    const gpu::Buffer& heldNodes() const { return heldNodes_; }

    /// Memory of its buffers.
    std::size_t bytes() const;

private:
    Status createPrograms(const TextureLayout& layout);
    void createTriangles(const StateTextures& textures);
    void setPositions(gpu::Program& program, const StateTextures& textures, bool moves) const;
    void runGrasps(const StateTextures& textures, std::int64_t step);
    bool idle(std::int64_t step) const;
    void bind(std::int64_t step);
    void closeGrasps(const gpu::Texture2D& start, const StateTextures& textures, std::int64_t step);
    void runPushes(const StateTextures& textures);

    SolverSetup setup_;
    ContactColliders colliders_;
    bool pushes_ = false, grasps_ = false, triangles_ = false; // some collider does, or has passes over these
    std::vector<double> mass_;                                 // shares, one a node
    std::vector<std::uint32_t> connections_;
    std::size_t triangleCount_ = 0;
    bool stale_ = false, recount_ = true, asking_ = false;
    bool keeps_ = false; // steps are implicit and grasps may have no limit: contact leaves held nodes alone
    int set_ = 0;        // of lists, in turns
    std::uint32_t stamp_ = 0;

    gpu::Program close_, held_, listNear_, cull_, triangle_, move_, push_;
    gpu::Buffer nodes_, trianglesData_, corners_, candidates_, asks_, marks_, movers_, work_, listed_, near_,
        heldNodes_;
};

} // namespace serosa::sim
