// See sim/implicit_solver.h.
#include "sim/implicit_solver.h"

#include "base/check.h"
#include "shaders/shared_constants.h"
#include "sim/implicit_contact.h"
#include "sim/implicit_system-inl.h"
#include "sim/packed_normal.h"
#include "sim/tool_motion.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

namespace serosa::sim {

namespace {

template <class Real>
class ImplicitSolver final : public Solver, public HasImplicitEffort {
    using Vector = typename ImplicitSystem<Real>::Vector;
    using Vectors = typename ImplicitSystem<Real>::Vectors;

public:
    ImplicitSolver(const SolverSetup& setup, const char* name, bool parallel, int threads,
                   const ImplicitLimits& limits)
        : setup_(setup), name_(name), arena_(threads > 0 ? threads : tbb::task_arena::automatic),
          stepper_(setup, parallel, limits), contact_(setup, stepper_.system(), limits.supportedRounds),
          state_(restState(*setup.lattice)) {
        if (setup_.fixed.empty())
            setup_.fixed.assign(setup.lattice->nodeCount(), false);
        setState(state_);
    }

    const char* name() const override { return name_; }
    const SolverSetup& setup() const override { return setup_; }
    ImplicitEffort effort() const override { return stepper_.effort(); }

    void advance(int count) override {
        arena_.execute([this, count] {
            for (int i = 0; i < count; ++i)
                step();
        });
    }

    LatticeState state() const override { return state_; }

    void setState(const LatticeState& state) override {
        const std::size_t count = setup_.lattice->nodeCount();
        SEROSA_CHECK(state.positions.size() == count &&
                         (state.connections.empty() || state.connections.size() == count) &&
                         (state.earlier.empty() || state.earlier.size() == count),
                     "a state of this lattice");
        if (state.connections != state_.connections) {
            const auto& left = state.connections.empty() ? setup_.lattice->connections : state.connections;
            stepper_.system().connect(left);
            contact_.connect(left);
        }
        state_ = state;
        for (std::size_t i = 0; i < count; ++i) { // as this solver keeps them
            state_.positions[i] = glm::dvec3(Vector(state.positions[i]));
            state_.increments[i] = glm::dvec3(Vector(state.increments[i]));
        }
        state_.earlier.resize(count, glm::dvec4(0));
        for (glm::dvec4& earlier : state_.earlier)
            earlier = glm::dvec4(glm::vec<4, Real>(earlier));
    }

    std::vector<ToolLoad> takeLoads() override { return contact_.takeLoads(); }

private:
    void step() {
        const std::size_t count = state_.positions.size();
        const double dt = setup_.timeStep;
        const std::vector<ToolMotion> tools = toolMotions(setup_, state_.step);
        updateHeldNodes(setup_, tools, state_);

        typename ImplicitSystem<Real>::Step step;
        Vectors increments(count, Vector(0));
        step.gravity = Vector(setup_.gravity * (dt * dt / setup_.lattice->spacing));
        step.positions.assign(state_.positions.begin(), state_.positions.end());
        step.share.assign(count, Real(0));
        for (std::size_t i = 0; i < count; ++i) {
            const Vector u(state_.increments[i]);
            const glm::dvec4& earlier = state_.earlier[i];
            step.expected.push_back(u);
            step.guess.push_back(u);
            const std::uint32_t holder = state_.heldBy[i];
            if (holder != 0 && !std::isfinite(tools[holder - 1].grip)) {
                const ToolMotion& tool = tools[holder - 1];
                increments[i] = Vector(tool.carried(state_.positions[i]) - state_.positions[i]);
            } else if (!setup_.fixed[i]) {
                step.share[i] = earlier.w > 0 ? Real(0.5) : Real(1);
                if (earlier.w > 0) {
                    const Vector change = u - Vector(glm::dvec3(earlier));
                    step.expected[i] = u + Real(0.5) * change;
                    step.guess[i] = u + change;
                }
            }
        }
        guessTouched(step);
        ImplicitSystem<Real>& system = stepper_.system();
        system.begin(std::move(step));
        if (contact_.empty()) {
            stepper_.solve(increments);
        } else {
            contact_.begin(state_.step, tools, state_.earlier, state_.heldBy);
            stepper_.solve(increments, [&](const Vectors& at, int round) {
                return contact_.support(system, at, stepper_.lastStep(), round);
            });
        }
        finish(increments);
    }

    /// Touched nodes have no increment before the last: the search begins with the mean change of their
    /// neighbours' that have one.
    void guessTouched(typename ImplicitSystem<Real>::Step& step) const {
        const Lattice& lattice = *setup_.lattice;
        const auto& connections = state_.connections.empty() ? lattice.connections : state_.connections;
        for (std::size_t i = 0; i < step.guess.size(); ++i) {
            if (state_.earlier[i].w >= 0 || step.isHeld(i))
                continue;
            Vector sum(0);
            int count = 0;
            for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
                if (!(connections[i] >> d & 1u))
                    continue;
                const std::size_t other = std::size_t(lattice.neighbour(i, d));
                if (state_.earlier[other].w > 0 && !step.isHeld(other)) {
                    sum += Vector(state_.increments[other] - glm::dvec3(state_.earlier[other]));
                    ++count;
                }
            }
            if (count > 0)
                step.guess[i] += sum / Real(count);
        }
    }

    void finish(Vectors& increments) {
        ImplicitSystem<Real>& system = stepper_.system();
        std::vector<glm::dvec4> touched;
        contact_.finish(system, state_.increments, stepper_.lastStep(), increments, touched);
        for (std::size_t i = 0; i < increments.size(); ++i) {
            const bool free = !system.step().isHeld(i) && touched[i].w == 0;
            state_.earlier[i] =
                free ? glm::dvec4(state_.increments[i], 1) : glm::dvec4(glm::vec<4, Real>(touched[i]));
            state_.positions[i] = glm::dvec3(system.step().positions[i] + increments[i]);
            state_.increments[i] = glm::dvec3(increments[i]);
        }
        writeNormals();
        ++state_.step;
    }

    /// MS05 eq. 3, at the end of the step.
    void writeNormals() {
        const Lattice& lattice = *setup_.lattice;
        const auto& connections = state_.connections.empty() ? lattice.connections : state_.connections;
        stepper_.system().forEachRun(connections.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                glm::dvec3 sum(0);
                for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
                    if (!(connections[i] >> d & 1u))
                        continue;
                    const glm::dvec3 apart =
                        state_.positions[i] - state_.positions[std::size_t(lattice.neighbour(i, d))];
                    sum += apart / std::max(glm::length(apart), 1e-6);
                }
                state_.normals[i] = packNormal(glm::vec3(sum));
            }
        });
    }

    SolverSetup setup_;
    const char* name_;
    tbb::task_arena arena_;
    ImplicitStepper<Real> stepper_;
    ImplicitContact<Real> contact_;
    LatticeState state_;
};

void checkSetup(const SolverSetup& setup) {
    SEROSA_CHECK(setup.lattice && setup.timeStep > 0, "a lattice and a time step");
    SEROSA_CHECK(setup.tools.size() <= SRS_MAX_TOOLS, "at most SRS_MAX_TOOLS tools");
}

} // namespace

std::unique_ptr<Solver> makeImplicitReferenceSolver(const SolverSetup& setup, const ImplicitLimits& limits) {
    checkSetup(setup);
    return std::make_unique<ImplicitSolver<double>>(setup, "reference", false, 1, limits);
}

std::unique_ptr<Solver> makeImplicitCpuSolver(const SolverSetup& setup, int threads,
                                              const ImplicitLimits& limits) {
    checkSetup(setup);
    return std::make_unique<ImplicitSolver<float>>(setup, "cpu", true, threads, limits);
}

std::optional<ImplicitEffort> implicitEffort(const Solver& solver) {
    const auto* effort = dynamic_cast<const HasImplicitEffort*>(&solver);
    return effort ? std::optional(effort->effort()) : std::nullopt;
}

} // namespace serosa::sim
