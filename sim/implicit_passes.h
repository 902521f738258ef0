#pragma once
// The implicit step (sim/implicit_system.h) in compute passes over StateTextures, for the fragment and the
// compute solver alike: shaders/implicit_*. Nothing is read back; the twin in float32 on the processor is
// ImplicitStepper<float>.
//
//   begin                      state textures to arrays
//   changes, take              how much of the guess to begin with
//   a round of Newton's, each
//     cells, linearize         gradient, matrix; of cells only where the tissue needs them or levels do
//     coarsen (cells, nodes)   a pass a level; invert: the last level
//     restrict, tail, prolong  the preconditioner: passes down, one for the coarse levels, passes up
//     direction                of conjugate gradients, begins
//     an iteration, each       (pull,) apply, update, restrict, tail, prolong, direction
//     changes, take            the share of the step that lets Phi fall
//   finish                     arrays to state textures
//
// What contact and grasps add between them is in sim/implicit_contact_pass.h.
//
// How many rounds and iterations there are is fixed; once an iteration finds the residual small enough, the
// passes of those that follow return at once.

#include "base/result.h"
#include "gpu/program.h"
#include "shaders/implicit_constants.h"
#include "shaders/shared_constants.h"
#include "sim/implicit_contact_pass.h"
#include "sim/implicit_levels.h"
#include "sim/implicit_stepper.h"
#include "sim/solver.h"
#include "sim/state_textures.h"

#include <string>
#include <vector>

namespace serosa::sim {

/// Of one StateTextures, which every call gets and which keeps earlier increments. Needs a current context.
class ImplicitPasses {
public:
    /// \param pushes contact of the same setup, which outlives this, as the buffer of loads does. Errors: of
    /// the shaders.
    Status initialize(const SolverSetup& setup, StateTextures& textures, const ImplicitLimits& limits,
                      ContactPass& pushes, const gpu::Buffer& loads);
    /// One step, whose colliders are prepared: in place, or into the other half of the textures where there
    /// are any. What earlier passes wrote must be visible to image loads.
    void step(StateTextures& textures, std::int64_t step);
    /// Where contact would move nodes is asked of this one: as ContactPass.
    ContactPass& asks() { return contact_.asks(); }
    /// Of the last step; reads back.
    ImplicitEffort effort() const;
    /// Buffer memory.
    std::size_t bytes() const;

private:
    Status createPrograms(const ContactPass& pushes);
    void share(gpu::Program& program) const;
    void createTables(const TextureLayout& layout);
    void createConstants(bool contact);
    void precondition(int prepared, int wanted);
    void newtonRound(int round, bool pulled);
    void linearize();
    void run(gpu::Program& program, std::size_t items);
    void runSums(gpu::Program& program) { run(program, std::size_t(groups_) * SRS_IMPLICIT_GROUP); }

    SolverSetup setup_;
    ImplicitLimits limits_;
    std::vector<ImplicitLevel> levels_;
    double totalMass_ = 0;
    int groups_ = 0;                  // of passes that leave sums
    int neighbours_ = 0, texels_ = 0; // places in tables_
    int tail_ = 1; // the first level that one work group takes care of, with all that follow
    gpu::Program begin_, cells_, linearize_, coarsenCells_, coarsenNodes_, invert_, pull_, apply_, update_,
        restrict_, tailProgram_, prolong_, direction_, changes_, take_, finish_;
    ImplicitContactPass contact_;
    gpu::Buffer vectors_, sums_, progress_, tables_, cellArrays_, cellShares_, connections_, masses_,
        weights_, springs_, levelArrays_, quadratures_, coarsest_;
};

} // namespace serosa::sim
