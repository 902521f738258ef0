// See sim/implicit_stepper.h.
#include "sim/implicit_stepper.h"

#include "shaders/implicit_constants.h"
#include "sim/implicit_system-inl.h"

#include <cmath>

namespace serosa::sim {

namespace {

// Of a Newton step, largest first: the first that lets Phi fall is taken.
constexpr std::array<double, 4> kShares = {1, 0.5, 0.2, 0.04};
constexpr double kFall = 1e-4; // of what the gradient promises (Armijo)

} // namespace

ImplicitLimits exactLimits() {
    return {20, 400, 1e-6, 1e-9, 20};
}

ImplicitLimits frameLimits() {
    return {3, 40, 1e-2, 1e-5, 6};
}

template <class Real>
ImplicitStepper<Real>::ImplicitStepper(const SolverSetup& setup, bool parallel, const ImplicitLimits& limits)
    : system_(setup, parallel), limits_(limits) {
    for (Vectors* vectors :
         {&held_, &gradient_, &step_, &residual_, &preconditioned_, &direction_, &product_})
        vectors->assign(system_.nodes(), Vector(0));
}

/// Begins with v, or as much of it as is better than to stay: no step then ends with more energy than it
/// began with.
template <class Real>
void ImplicitStepper<Real>::start(Vectors& increments) {
    const auto& step = system_.step();
    held_ = increments;
    for (std::size_t i = 0; i < increments.size(); ++i) {
        direction_[i] = step.isHeld(i) ? Vector(0) : step.guess[i];
        increments[i] = Vector(0);
    }
    const std::array<double, 4> shares = {1, 0.75, 0.5, 0.25},
                                changes = system_.changes(increments, direction_, shares);
    const auto best = std::min_element(changes.begin(), changes.end());
    const Real share = *best < 0 ? Real(shares[std::size_t(best - changes.begin())]) : Real(0);
    for (std::size_t i = 0; i < increments.size(); ++i)
        increments[i] = share * direction_[i];
}

template <class Real>
double ImplicitStepper<Real>::takeShare(const Vectors& increments) {
    const std::array<double, 4> changes = system_.changes(increments, step_, kShares);
    const double promised = system_.dot(gradient_, step_);
    for (std::size_t k = 0; k < changes.size(); ++k)
        if (changes[k] <= kFall * kShares[k] * promised)
            return kShares[k];
    return 0;
}

/// Returns how far the nodes moved: root of the mean square over the mass.
template <class Real>
double ImplicitStepper<Real>::newtonStep(Vectors& increments, int round) {
    const auto& step = system_.step();
    const std::size_t count = increments.size();
    system_.gradient(increments, gradient_);
    system_.linearize(increments);
    // Held nodes go where they must; the others follow as the matrix has it.
    bool pulled = false;
    for (std::size_t i = 0; i < count; ++i) {
        const bool held = step.isHeld(i);
        step_[i] = held ? held_[i] - increments[i] : Vector(0);
        pulled = pulled || step_[i] != Vector(0);
        residual_[i] = held ? Vector(0) : -gradient_[i];
    }
    if (pulled) {
        system_.apply(step_, product_);
        for (std::size_t i = 0; i < count; ++i)
            residual_[i] -= product_[i];
    }
    system_.precondition(residual_, preconditioned_);
    double size = system_.dot(residual_, preconditioned_);
    if (round == 0 || !system_.supports().empty())
        firstResidual_ = size;
    // What supports give is settled round by round, each from the last one's.
    const double accuracy =
        system_.supports().empty() ? limits_.accuracy : SRS_SUPPORTED_ACCURACY * limits_.accuracy;
    const double goal =
        std::max(accuracy * accuracy * firstResidual_, limits_.floor * limits_.floor * system_.totalMass());
    direction_ = preconditioned_;
    for (int i = 0; i < limits_.iterations && size > goal; ++i) {
        system_.apply(direction_, product_);
        const double curvature = system_.dot(direction_, product_);
        if (!(curvature > 0))
            break;
        const Real share = Real(size / curvature);
        system_.forEachRun(count, [&](std::size_t first, std::size_t last) {
            for (std::size_t k = first; k < last; ++k) {
                step_[k] += share * direction_[k];
                residual_[k] -= share * product_[k];
            }
        });
        system_.precondition(residual_, preconditioned_);
        const double before = size;
        size = system_.dot(residual_, preconditioned_);
        const Real keep = Real(size / before);
        system_.forEachRun(count, [&](std::size_t first, std::size_t last) {
            for (std::size_t k = first; k < last; ++k)
                direction_[k] = preconditioned_[k] + keep * direction_[k];
        });
        ++effort_.iterations;
    }
    ++effort_.rounds;
    const double share = pulled ? 1.0 : takeShare(increments);
    effort_.leastShare = std::min(effort_.leastShare, share);
    double moved = 0;
    for (std::size_t i = 0; i < count; ++i) {
        step_[i] *= Real(share);
        increments[i] += step_[i];
        moved += system_.mass(i) * double(glm::dot(step_[i], step_[i]));
    }
    return std::sqrt(moved / system_.totalMass());
}

template <class Real>
void ImplicitStepper<Real>::solve(Vectors& increments, const BeforeRound& beforeRound) {
    SEROSA_CHECK(increments.size() == system_.nodes(), "an increment of every node");
    effort_ = {};
    start(increments);
    for (int round = 0, wanted = limits_.rounds; round < wanted; ++round) {
        const bool supported = beforeRound && beforeRound(increments, round);
        wanted = supported ? limits_.supportedRounds : wanted;
        if (newtonStep(increments, round) <= limits_.floor && (!supported || round + 1 >= limits_.rounds))
            break;
    }
    for (std::size_t i = 0; i < increments.size(); ++i)
        if (system_.step().isHeld(i))
            increments[i] = held_[i];
}

template class ImplicitStepper<double>;
template class ImplicitStepper<float>;

} // namespace serosa::sim
