// See sim/implicit_solver.h.
#include "sim/implicit_solver.h"

#include "base/check.h"
#include "shaders/shared_constants.h"
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
          stepper_(setup, parallel, limits), state_(restState(*setup.lattice)),
          impulses_(setup.tools.size(), glm::dvec3(0)) {
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
        if (state.connections != state_.connections)
            stepper_.system().connect(state.connections.empty() ? setup_.lattice->connections
                                                                : state.connections);
        state_ = state;
        for (std::size_t i = 0; i < count; ++i) { // as this solver keeps them
            state_.positions[i] = glm::dvec3(Vector(state.positions[i]));
            state_.increments[i] = glm::dvec3(Vector(state.increments[i]));
        }
        state_.earlier.resize(count, glm::dvec4(0));
        for (glm::dvec4& earlier : state_.earlier)
            earlier = glm::dvec4(glm::vec<4, Real>(earlier));
    }

    std::vector<ToolLoad> takeLoads() override {
        const double unit =
            setup_.tissue.nodeMass(setup_.lattice->spacing) * setup_.lattice->spacing / setup_.timeStep;
        std::vector<ToolLoad> taken(setup_.tools.size() + setup_.bodies.size()); // of bodies: none yet
        for (std::size_t tool = 0; tool < impulses_.size(); ++tool)
            taken[tool].impulse = impulses_[tool] * unit;
        impulses_.assign(impulses_.size(), glm::dvec3(0));
        return taken;
    }

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
            if (state_.heldBy[i] != 0) {
                const ToolMotion& tool = tools[state_.heldBy[i] - 1];
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
        stepper_.system().begin(std::move(step));
        stepper_.solve(increments);
        finish(increments, tools);
    }

    void finish(const Vectors& increments, const std::vector<ToolMotion>& tools) {
        ImplicitSystem<Real>& system = stepper_.system();
        if (!tools.empty()) {
            Vectors given(increments.size());
            system.gradient(increments, given);
            for (std::size_t i = 0; i < given.size(); ++i)
                if (state_.heldBy[i] != 0)
                    impulses_[state_.heldBy[i] - 1] += glm::dvec3(given[i]);
        }
        for (std::size_t i = 0; i < increments.size(); ++i) {
            const bool free = !system.step().isHeld(i);
            state_.earlier[i] = free ? glm::dvec4(state_.increments[i], 1) : glm::dvec4(0);
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
    LatticeState state_;
    std::vector<glm::dvec3> impulses_; // mass shares times lattice units a step
};

void checkSetup(const SolverSetup& setup) {
    SEROSA_CHECK(setup.lattice && setup.timeStep > 0, "a lattice and a time step");
    const bool firm = std::all_of(setup.tools.begin(), setup.tools.end(), [](const Tool& tool) {
        return tool.mode == ToolMode::grasp && !std::isfinite(tool.gripForce);
    });
    SEROSA_CHECK(firm && setup.bodies.empty(),
                 "grasps that do not slip, and no contact: implicit steps know no more yet");
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
