// MS05 3.1 on all cores: structure-of-arrays state in two halves, ping-pong, cut into chunks of blocks that
// threads take in any order. No chunk reads what another writes in the same step: threads and their timing
// change no bit. The arithmetic is in sim/cpu_kernel.cpp; contact follows (sim/contact_stage.h). Tissue with
// a volumetric term or that stiffens has passes over its cells before the step (sim/cpu_cells.h).
#include "sim/cpu_solver.h"

#include "sim/contact_stage.h"
#include "sim/cpu_arrays.h"
#include "sim/cpu_cells.h"
#include "sim/cpu_kernel.h"
#include "sim/cpu_layout.h"
#include "sim/implicit_solver.h"
#include "sim/tissue_field.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace serosa::sim {

namespace {

constexpr std::size_t kChunkSlots =
    512; // a chunk: about 5 microseconds of work, and all in a first-level cache

/// The halves of the state before and after the forces of a step.
class SlotNodes final : public ContactNodes {
public:
    SlotNodes(const CpuLayout& layout, const VectorArray& before, const VectorArray& after,
              const VectorArray& increments)
        : layout_(layout), before_(before), after_(after), increments_(increments) {}
    glm::dvec3 start(std::uint32_t node) const override { return before_.get(slotOf(node)); }
    glm::dvec3 end(std::uint32_t node) const override { return after_.get(slotOf(node)); }
    void move(std::uint32_t node, const glm::dvec3& by) override {
        const std::size_t slot = slotOf(node);
        after_.set(slot, glm::vec3(glm::dvec3(after_.get(slot)) + by));
        increments_.set(slot, glm::vec3(glm::dvec3(increments_.get(slot)) + by));
    }

private:
    std::size_t slotOf(std::uint32_t node) const { return std::size_t(layout_.slotOfNode[node]); }
    const CpuLayout& layout_;
    const VectorArray &before_, &after_, &increments_;
};

class CpuSolver final : public Solver {
public:
    CpuSolver(const SolverSetup& setup, const CpuOptions& options)
        : setup_(setup), options_(options), kernel_(cpuKernel()),
          layout_(makeCpuLayout(*setup.lattice, kernel_.lanes)), field_(*setup.lattice, setup.tissue),
          arena_(options.threads > 0 ? options.threads : tbb::task_arena::automatic),
          positions_{VectorArray(layout_.slots()), VectorArray(layout_.slots())},
          increments_{VectorArray(layout_.slots()), VectorArray(layout_.slots())},
          weights_(layout_.blocks() * SRS_NEIGHBOURS * layout_.lanes), acceleration_(layout_.slots()),
          normals_(layout_.slots()), heldBy_(setup.lattice->nodeCount()),
          contact_(setup, field_.massShares()),
          blocksPerChunk_(std::max<std::size_t>(1, kChunkSlots / layout_.lanes)),
          chunks_((layout_.blocks() + blocksPerChunk_ - 1) / blocksPerChunk_), chunkLongest2_(chunks_) {
        const Lattice& lattice = *setup.lattice;
        const double h = lattice.spacing, dt = setup.timeStep;
        const double acceleration = dt * dt * setup.tissue.stiffnessOverMass(h);
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
            const std::size_t slot = slotOf(node);
            const bool fixed = !setup.fixed.empty() && setup.fixed[node];
            acceleration_[slot] = fixed ? 0.0F : float(acceleration / field_.massShare(node));
        }
        if (setup.tissue.ownDampers())
            dampers_.emplace(layout_.blocks() * SRS_NEIGHBOURS * layout_.lanes);
        if (setup.tissue.needsCellPass())
            cells_.emplace(lattice, layout_, field_, setup.tissue);
        setWeights(lattice.connections);
        setState(restState(lattice));
    }

    const char* name() const override { return "cpu"; }
    const SolverSetup& setup() const override { return setup_; }

    void advance(int count) override {
        arena_.execute([this, count] {
            for (int i = 0; i < count; ++i)
                takeStep(options_.normalsEveryStep || i + 1 == count);
        });
    }

    LatticeState state() const override {
        const std::size_t count = layout_.slotOfNode.size();
        LatticeState state;
        state.step = step_;
        state.connections = connections_;
        state.positions.reserve(count);
        state.increments.reserve(count);
        for (std::size_t node = 0; node < count; ++node) {
            const std::size_t slot = slotOf(node);
            state.positions.emplace_back(positions_[current_].get(slot));
            state.increments.emplace_back(increments_[current_].get(slot));
            state.normals.push_back(normals_[slot]);
        }
        state.heldBy = heldBy_;
        return state;
    }

    void setState(const LatticeState& state) override {
        const std::size_t count = layout_.slotOfNode.size();
        SEROSA_CHECK(state.positions.size() == count &&
                         (state.connections.empty() || state.connections.size() == count),
                     "a state of this lattice");
        step_ = state.step;
        if (state.connections != connections_) {
            connections_ = state.connections;
            const auto& left = connections_.empty() ? setup_.lattice->connections : connections_;
            setWeights(left);
            contact_.connect(left);
            if (cells_)
                cells_->connect(left);
        }
        for (std::size_t node = 0; node < count; ++node) {
            const std::size_t slot = slotOf(node);
            positions_[current_].set(slot, glm::vec3(state.positions[node]));
            increments_[current_].set(slot, glm::vec3(state.increments[node]));
            normals_[slot] = state.normals[node];
        }
        heldBy_ = state.heldBy;
        contact_.reset();
    }

    std::vector<ToolLoad> takeLoads() override { return contact_.takeLoads(); }

    void readNodes(std::span<const std::uint32_t> nodes, std::span<NodeMotion> motions) const override {
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const std::size_t slot = slotOf(nodes[i]);
            motions[i] = {glm::dvec3(positions_[current_].get(slot)),
                          glm::dvec3(increments_[current_].get(slot)), heldBy_[nodes[i]] != 0};
        }
    }
    void moveNodes(std::span<const std::uint32_t> nodes, std::span<const glm::dvec3> by) override {
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const std::size_t slot = slotOf(nodes[i]);
            for (const VectorArray* array : {&positions_[current_], &increments_[current_]})
                array->set(slot, glm::vec3(glm::dvec3(array->get(slot)) + by[i]));
        }
    }

private:
    std::size_t slotOf(std::size_t node) const { return std::size_t(layout_.slotOfNode[node]); }

    /// The weights and dampers of the springs that `connections` (18 bits a node) leaves.
    void setWeights(const std::vector<std::uint32_t>& connections) {
        for (std::size_t node = 0; node < connections.size(); ++node) {
            const std::size_t place = slotOf(node) - layout_.first;
            const std::size_t first =
                place / layout_.lanes * SRS_NEIGHBOURS * layout_.lanes + place % layout_.lanes;
            for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
                const bool connected = connections[node] >> d & 1u;
                const std::size_t at = first + std::size_t(d) * layout_.lanes;
                weights_[at] = connected ? float(field_.springWeight(node, d)) : 0.0F;
                if (dampers_)
                    (*dampers_)[at] =
                        connected ? float(field_.dampingWeight(node, d) / setup_.timeStep / (d < 6 ? 1 : 2))
                                  : 0.0F;
            }
        }
    }

    CpuStep stepParameters(bool withNormals) const {
        const double h = setup_.lattice->spacing, dt = setup_.timeStep;
        CpuStep step{};
        for (int axis = 0; axis < 3; ++axis) {
            step.positions[axis] = positions_[current_].axis[axis].get();
            step.increments[axis] = increments_[current_].axis[axis].get();
            step.nextPositions[axis] = positions_[1 - current_].axis[axis].get();
            step.nextIncrements[axis] = increments_[1 - current_].axis[axis].get();
            step.gravity[axis] = float(setup_.gravity[axis] * (dt * dt / h));
        }
        step.weights = weights_.get();
        step.acceleration = acceleration_.get();
        step.normals = normals_.get();
        step.rows = layout_.rows.front().data();
        step.first = layout_.first;
        step.drag = float(1 - setup_.tissue.airDrag * dt);
        step.damping = float(setup_.tissue.dampingTime / dt);
        step.dampers = dampers_ ? dampers_->get() : nullptr;
        if (cells_)
            cells_->enter(step);
        step.withNormals = withNormals;
        return step;
    }

    /// Calls work(chunk, its first block, behind its last block), in any order, on all threads.
    template <class Work>
    void forEveryChunk(const Work& work) const {
        tbb::parallel_for(std::size_t(0), chunks_, [this, &work](std::size_t chunk) {
            work(chunk, chunk * blocksPerChunk_, std::min((chunk + 1) * blocksPerChunk_, layout_.blocks()));
        });
    }

    void takeStep(bool withNormals) {
        const CpuStep step = stepParameters(withNormals);
        if (cells_) {
            const CpuCellPass pass = cells_->pass(positions_[current_]);
            if (cells_->stiffens())
                forEveryChunk([&](std::size_t, std::size_t first, std::size_t last) {
                    kernel_.stretch(pass, first, last);
                });
            forEveryChunk(
                [&](std::size_t, std::size_t first, std::size_t last) { kernel_.cells(pass, first, last); });
        }
        forEveryChunk([&](std::size_t chunk, std::size_t first, std::size_t last) {
            kernel_.step(step, first, last, &chunkLongest2_[chunk]);
        });
        if (!contact_.empty()) {
            SlotNodes nodes(layout_, positions_[current_], positions_[1 - current_],
                            increments_[1 - current_]);
            const float longest2 = *std::max_element(chunkLongest2_.begin(), chunkLongest2_.end());
            contact_.run(step_, nodes, std::sqrt(double(longest2)) * 1.000001, heldBy_);
        }
        current_ = 1 - current_;
        ++step_;
    }

    SolverSetup setup_;
    CpuOptions options_;
    CpuKernel kernel_;
    CpuLayout layout_;
    TissueField field_;
    std::optional<CpuCells> cells_; // where passes over cells are needed
    tbb::task_arena arena_;
    VectorArray positions_[2], increments_[2]; // lattice units
    SlotArray<float> weights_;                 // a block: 18 directions of `lanes` weights
    std::optional<SlotArray<float>> dampers_;  // the same: c/k over dt and squared rest length; or none
    SlotArray<float> acceleration_;
    SlotArray<std::uint32_t> normals_;
    std::vector<std::uint32_t> heldBy_; // a node
    ContactStage contact_;
    std::size_t blocksPerChunk_, chunks_;
    std::vector<float> chunkLongest2_;       // of the increments, a chunk
    std::vector<std::uint32_t> connections_; // as LatticeState::connections
    int current_ = 0;
    std::int64_t step_ = 0;
};

} // namespace

std::unique_ptr<Solver> makeCpuSolver(const SolverSetup& setup, const CpuOptions& options) {
    SEROSA_CHECK(setup.lattice && setup.timeStep > 0, "a lattice and a time step");
    SEROSA_CHECK(setup.tools.size() <= SRS_MAX_TOOLS, "at most SRS_MAX_TOOLS tools");
    if (setup.method == StepMethod::implicit)
        return makeImplicitCpuSolver(setup, options.threads);
    return std::make_unique<CpuSolver>(setup, options);
}

const char* cpuSolverTarget() {
    return cpuKernel().target;
}

} // namespace serosa::sim
