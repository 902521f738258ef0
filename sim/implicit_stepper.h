#pragma once
// One implicit step: Newton's method on Phi (sim/implicit_system.h), each of its linear systems by
// preconditioned conjugate gradients, each of its steps cut back until Phi falls. What it does on nodes that
// contact moved is in docs/methods/implicit.md.

#include "sim/implicit_system.h"

#include <functional>

namespace serosa::sim {

/// How far a step is solved.
struct ImplicitLimits {
    int rounds = 0;          // Newton's
    int iterations = 0;      // of conjugate gradients, at most, a round
    double accuracy = 0;     // a linear system is solved where its residual in the preconditioner's norm has
                             // fallen to this share of the first round's,
    double floor = 0;        // or to this, h a step: root of the mean over the mass
    int supportedRounds = 0; // Newton's, where anything touches; each to a tenth of `accuracy` of its own
                             // first residual
};
/// What reference and oracle use: as far as double goes.
ImplicitLimits exactLimits();
/// What fits a frame.
ImplicitLimits frameLimits();

/// What the last step did, for tests and tables.
struct ImplicitEffort {
    int rounds = 0, iterations = 0;
    double leastShare = 1; // smallest of the shares of Newton's steps that were taken
};

template <class Real>
class ImplicitStepper {
public:
    using Vector = typename ImplicitSystem<Real>::Vector;
    using Vectors = typename ImplicitSystem<Real>::Vectors;

    ImplicitStepper(const SolverSetup& setup, bool parallel, const ImplicitLimits& limits);

    ImplicitSystem<Real>& system() { return system_; }
    /// Called before each of Newton's rounds with the increments so far: may support() the system's nodes
    /// there. Did it?
    using BeforeRound = std::function<bool(const Vectors& increments, int round)>;
    /// Finds the increments of a step that system().begin() described. \param increments in: those of held
    /// nodes; out: of all
    void solve(Vectors& increments, const BeforeRound& beforeRound = {});
    /// Newton's last step, as far as it was taken: what changed since supports were asked for.
    const Vectors& lastStep() const { return step_; }
    const ImplicitEffort& effort() const { return effort_; }

private:
    void start(Vectors& increments);
    double newtonStep(Vectors& increments, int round);
    double takeShare(const Vectors& increments);

    ImplicitSystem<Real> system_;
    ImplicitLimits limits_;
    ImplicitEffort effort_;
    double firstResidual_ = 0;
    Vectors held_, gradient_, step_, residual_, preconditioned_, direction_, product_;
};

} // namespace serosa::sim
