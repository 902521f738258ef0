// The oracle: MS05 eq. 1 in double precision with plain loops, one node after another. What a step does
// stands in sim/solver.h; the fragment solver's twin is shaders/solver_kernel.glsl.
#include "shaders/shared_constants.h"
#include "sim/contact_stage.h"
#include "sim/implicit_solver.h"
#include "sim/packed_normal.h"
#include "sim/solver.h"
#include "sim/stiffening.h"
#include "sim/tissue_field.h"
#include "sim/volume_term.h"

#include <algorithm>
#include <cmath>

namespace serosa::sim {

namespace {

class StepNodes final : public ContactNodes {
public:
    StepNodes(const LatticeState& before, LatticeState& after) : before_(before), after_(after) {}
    glm::dvec3 start(std::uint32_t node) const override { return before_.positions[node]; }
    glm::dvec3 end(std::uint32_t node) const override { return after_.positions[node]; }
    void move(std::uint32_t node, const glm::dvec3& by) override {
        after_.positions[node] += by;
        after_.increments[node] += by;
    }

private:
    const LatticeState& before_;
    LatticeState& after_;
};

class ReferenceSolver final : public Solver {
public:
    explicit ReferenceSolver(const SolverSetup& setup)
        : setup_(setup), field_(*setup.lattice, setup.tissue), state_(restState(*setup.lattice)),
          mass_(field_.massShares()), contact_(setup, mass_) {
        const Lattice& lattice = *setup.lattice;
        const std::size_t count = lattice.nodeCount();
        if (setup_.fixed.empty())
            setup_.fixed.assign(count, false);
        neighbours_.resize(count * SRS_NEIGHBOURS);
        weights_.resize(count * SRS_NEIGHBOURS);
        damping_.resize(count * SRS_NEIGHBOURS);
        connect(lattice.connections);
    }

    const char* name() const override { return "reference"; }
    const SolverSetup& setup() const override { return setup_; }

    void advance(int count) override {
        for (int i = 0; i < count; ++i)
            step();
    }

    LatticeState state() const override { return state_; }

    void setState(const LatticeState& state) override {
        SEROSA_CHECK(state.positions.size() == state_.positions.size(), "a state of this lattice");
        const bool cut = !state.connections.empty();
        SEROSA_CHECK(!cut || state.connections.size() == state.positions.size(),
                     "connections of this lattice");
        if (cut || !state_.connections.empty())
            connect(cut ? state.connections : setup_.lattice->connections);
        state_ = state;
        contact_.reset();
    }

    std::vector<ToolLoad> takeLoads() override { return contact_.takeLoads(); }

    void readNodes(std::span<const std::uint32_t> nodes, std::span<NodeMotion> motions) const override {
        for (std::size_t i = 0; i < nodes.size(); ++i)
            motions[i] = {state_.positions[nodes[i]], state_.increments[nodes[i]],
                          state_.heldBy[nodes[i]] != 0};
    }
    void moveNodes(std::span<const std::uint32_t> nodes, std::span<const glm::dvec3> by) override {
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            state_.positions[nodes[i]] += by[i];
            state_.increments[nodes[i]] += by[i];
        }
    }

private:
    /// Springs and whole cells by what cuts left of the lattice's connections.
    void connect(const std::vector<std::uint32_t>& connections) {
        const Lattice& lattice = *setup_.lattice;
        for (std::size_t node = 0; node < connections.size(); ++node)
            for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
                const std::size_t slot = node * SRS_NEIGHBOURS + std::size_t(d);
                const bool connected = (connections[node] >> d) & 1u;
                neighbours_[slot] = connected ? lattice.neighbour(node, d) : -1;
                weights_[slot] = connected ? field_.springWeight(node, d) : 0;
                damping_[slot] = connected ? field_.dampingWeight(node, d) : 0;
            }
        contact_.connect(connections);
        volume_ = VolumeTerm(lattice, setup_.tissue, connections);
        stiffening_ = Stiffening(lattice, setup_.tissue, connections);
    }

    /// Weights of all springs as the cells are stretched at `positions`.
    void stiffen(const std::vector<double>& cellFactors) {
        for (std::size_t slot = 0; slot < weights_.size(); ++slot)
            if (neighbours_[slot] >= 0)
                weights_[slot] =
                    field_.springWeight(slot / SRS_NEIGHBOURS, int(slot % SRS_NEIGHBOURS), cellFactors);
    }

    void step() {
        const Lattice& lattice = *setup_.lattice;
        const double dt = setup_.timeStep;
        const double acceleration = dt * dt * setup_.tissue.stiffnessOverMass(lattice.spacing);
        const double drag = 1 - setup_.tissue.airDrag * dt;
        const glm::dvec3 gravity = setup_.gravity * (dt * dt / lattice.spacing);

        const std::vector<glm::dvec3>& x = state_.positions;
        const std::vector<glm::dvec3>& u = state_.increments;
        LatticeState next = state_;
        pressure_.assign(x.size(), glm::dvec3(0));
        const std::vector<double> cellFactors = stiffening_.factors(x);
        if (!stiffening_.empty())
            stiffen(cellFactors);
        volume_.addForces(x, pressure_, cellFactors);
        double fastest2 = 0;
        for (std::size_t node = 0; node < x.size(); ++node) {
            glm::dvec3 force = pressure_[node], normal(0);
            for (std::size_t slot = node * SRS_NEIGHBOURS; slot < (node + 1) * SRS_NEIGHBOURS; ++slot) {
                if (weights_[slot] <= 0)
                    continue;
                const std::size_t other = std::size_t(neighbours_[slot]);
                const double rest = slot % SRS_NEIGHBOURS < 6 ? 1.0 : std::sqrt(2.0);
                const glm::dvec3 d = x[node] - x[other];
                const double length = std::max(glm::length(d), 1e-6);
                const glm::dvec3 unit = d / length;
                normal += unit;
                force += weights_[slot] * (rest - length) * unit -
                         damping_[slot] / dt * glm::dot(unit, u[node] - u[other]) * unit;
            }
            next.normals[node] = packNormal(glm::vec3(normal));
            if (setup_.fixed[node]) {
                next.increments[node] = glm::dvec3(0);
                continue;
            }
            next.increments[node] = drag * u[node] + acceleration / mass_[node] * force + gravity;
            next.positions[node] = x[node] + next.increments[node];
            fastest2 = std::max(fastest2, glm::dot(next.increments[node], next.increments[node]));
        }
        StepNodes nodes(state_, next);
        contact_.run(state_.step, nodes, std::sqrt(fastest2), next.heldBy);
        next.step = state_.step + 1;
        state_ = std::move(next);
    }

    SolverSetup setup_;
    TissueField field_;
    LatticeState state_;
    std::vector<double> mass_; // share of a full node's
    ContactStage contact_;
    std::vector<std::int64_t> neighbours_; // 18 a node, -1 where none
    std::vector<double> weights_;          // 18 a node, 0 where none
    std::vector<double> damping_;          // the same: TissueField::dampingWeight, s
    VolumeTerm volume_;
    Stiffening stiffening_;
    std::vector<glm::dvec3> pressure_; // the volumetric term's forces, k h
};

} // namespace

std::unique_ptr<Solver> makeReferenceSolver(const SolverSetup& setup) {
    SEROSA_CHECK(setup.lattice && setup.timeStep > 0, "a lattice and a time step");
    SEROSA_CHECK(setup.tools.size() <= SRS_MAX_TOOLS, "at most SRS_MAX_TOOLS tools");
    if (setup.method == StepMethod::implicit)
        return makeImplicitReferenceSolver(setup);
    return std::make_unique<ReferenceSolver>(setup);
}

LatticeState startState(const SolverSetup& setup) {
    LatticeState state = restState(*setup.lattice);
    const glm::dvec3 increment =
        -0.5 * setup.timeStep * setup.timeStep / setup.lattice->spacing * setup.gravity;
    for (std::size_t node = 0; node < state.increments.size(); ++node)
        if (setup.fixed.empty() || !setup.fixed[node])
            state.increments[node] = increment;
    return state;
}

Energies energies(const SolverSetup& setup, const LatticeState& state) {
    const Lattice& lattice = *setup.lattice;
    const double h = lattice.spacing, k = setup.tissue.springConstant(h), m = setup.tissue.nodeMass(h);
    const bool cut = !state.connections.empty();
    const std::vector<std::uint32_t>& connections = cut ? state.connections : lattice.connections;
    Energies sum;
    const TissueField field(lattice, setup.tissue);
    const VolumeTerm volume(lattice, setup.tissue, connections);
    const Stiffening stiffening(lattice, setup.tissue, connections);
    sum.elastic =
        k * h * h *
        (stiffening.empty() ? volume.energy(state.positions)
                            : volume.recoveryEnergy(state.positions) + stiffening.energy(state.positions));
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        const double mass = m * field.massShare(node);
        const glm::dvec3 velocity = state.increments[node] * (h / setup.timeStep);
        sum.kinetic += 0.5 * mass * glm::dot(velocity, velocity);
        sum.gravitational -=
            mass * glm::dot(setup.gravity, h * (state.positions[node] - lattice.restPosition(node)));
        for (int d = 0; d < SRS_NEIGHBOURS && stiffening.empty(); d += 2) {
            const std::int64_t other = lattice.neighbour(node, d);
            if (other < 0 || !((connections[node] >> d) & 1u))
                continue;
            const double rest = d < 6 ? 1.0 : std::sqrt(2.0);
            const double stretch =
                glm::length(state.positions[node] - state.positions[std::size_t(other)]) - rest;
            sum.elastic += 0.5 * k * field.springWeight(node, d) * stretch * stretch * h * h;
        }
    }
    return sum;
}

} // namespace serosa::sim
