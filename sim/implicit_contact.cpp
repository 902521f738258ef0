// See sim/implicit_contact.h.
#include "sim/implicit_contact.h"

#include "base/check.h"
#include "sim/implicit_system-inl.h"
#include "sim/shape_distance.h"

#include <algorithm>
#include <cmath>

namespace serosa::sim {

namespace {

constexpr double kPenalty = 5; // r over the stiffness of a node against its neighbours
constexpr double kPart = 0.5;  // spacings that tools come further in a round; at most kParts rounds do so
constexpr int kParts = 3;
constexpr int kPushParts = 32; // of the step, at most, that the last pushes are done in
constexpr double kFarInside =
    0.05;                        // spacings: what the last pushes move by more is held so in the last round
constexpr double kFirm = 20;     // times r
constexpr double kCreeps = 1e-4; // spacings a step: what was slower sticks
constexpr double kSticks = -1, kSlid = -2; // LatticeState::earlier

template <class Real>
std::vector<double> massShares(const ImplicitSystem<Real>& system) {
    std::vector<double> mass;
    for (std::size_t node = 0; node < system.nodes(); ++node)
        mass.push_back(system.mass(node));
    return mass;
}

} // namespace

std::vector<double> contactStiffness(const SolverSetup& setup, const TissueField& field) {
    const Lattice& lattice = *setup.lattice;
    const double dt = setup.timeStep, scale = dt * dt * setup.tissue.stiffnessOverMass(lattice.spacing);
    std::vector<double> stiffness;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        double sum = 2 * field.massShare(node);
        for (int d = 0; d < SRS_NEIGHBOURS; ++d)
            if (lattice.connections[node] >> d & 1u)
                sum += scale / 3 * (field.springWeight(node, d) + field.dampingWeight(node, d) / dt);
        stiffness.push_back(sum);
    }
    for (std::size_t i = 0; i < lattice.cells.size(); ++i)
        for (int corner = 0; corner < 8; ++corner) {
            const std::int64_t node = lattice.nodeAt(lattice.cells[i].grid + cornerOffset(corner));
            stiffness[std::size_t(node)] +=
                scale * lattice.cells[i].fill / 255.0 * field.materialOf(i).bulk / 16; // |g|^2 / 3
        }
    for (double& r : stiffness)
        r *= kPenalty;
    return stiffness;
}

/// Nodes that went by these increments, and by w where it is given.
template <class Real>
class ImplicitContact<Real>::Nodes final : public ContactNodes {
public:
    Nodes(const Vectors& positions, Vectors& increments, const std::vector<glm::dvec3>* offset)
        : positions_(positions), increments_(increments), offset_(offset) {}
    glm::dvec3 start(std::uint32_t node) const override { return glm::dvec3(positions_[node]); }
    glm::dvec3 end(std::uint32_t node) const override {
        return glm::dvec3(positions_[node]) + glm::dvec3(increments_[node]) +
               (offset_ ? (*offset_)[node] : glm::dvec3(0));
    }
    void move(std::uint32_t node, const glm::dvec3& by) override {
        moved.push_back(node);
        increments_[node] = Vector(glm::dvec3(increments_[node]) + by);
    }
    double fastest() const {
        double longest2 = 0;
        for (std::size_t i = 0; i < increments_.size(); ++i) {
            const glm::dvec3 way = glm::dvec3(increments_[i]) + (offset_ ? (*offset_)[i] : glm::dvec3(0));
            longest2 = std::max(longest2, glm::dot(way, way));
        }
        return std::sqrt(longest2) * 1.000001;
    }
    std::vector<std::uint32_t> moved;

private:
    const Vectors& positions_;
    Vectors& increments_;
    const std::vector<glm::dvec3>* offset_;
};

template <class Real>
ImplicitContact<Real>::ImplicitContact(const SolverSetup& setup, const ImplicitSystem<Real>& system,
                                       int rounds)
    : setup_(setup), rounds_(rounds), stage_(setup, massShares(system)) {
    if (empty())
        return;
    stiffness_ = contactStiffness(setup, TissueField(*setup.lattice, setup.tissue));
    for (const ToolMotion& collider : colliderMotions(setup, 0))
        frictions_.push_back(collider.friction);
}

template <class Real>
void ImplicitContact<Real>::begin(std::int64_t step, const std::vector<ToolMotion>& tools,
                                  const std::vector<glm::dvec4>& earlier,
                                  std::vector<std::uint32_t>& heldBy) {
    step_ = step;
    tools_ = tools;
    heldBy_ = &heldBy;
    held_.clear();
    double farthest = 0;
    for (const ToolMotion& tool : tools)
        farthest = std::max(farthest, glm::distance(tool.from, tool.to));
    parts_ = std::clamp(int(std::ceil(farthest / kPart)), 1, kParts);
    heldMass_.fill(0);
    offset_.assign(heldBy.size(), glm::dvec3(0));
    touches_.assign(heldBy.size(), {});
    for (std::size_t node = 0; node < earlier.size(); ++node)
        if (earlier[node].w < 0) {
            touches_[node].touches = true;
            touches_[node].given = glm::dvec3(earlier[node]);
            touches_[node].slides = earlier[node].w < kSticks;
            offset_[node] = touches_[node].given / -stiffness_[node];
        }
    std::vector<std::uint32_t> kept;
    for (std::uint32_t node = 0; node < heldBy.size(); ++node)
        if (const std::uint32_t holder = heldBy[node]; holder != 0)
            (std::isfinite(tools[holder - 1].grip) ? held_ : kept).push_back(node);
    stage_.keep(std::move(kept));
    for (const std::uint32_t node : held_)
        heldMass_[heldBy[node] - 1] += 1 / stage_.inverseMass(node);
}

/// What the supports of the last round give after its step.
template <class Real>
void ImplicitContact<Real>::takeGiven(const ImplicitSystem<Real>& system, const Vectors& lastStep) {
    for (std::size_t i = 0; i < touches_.size(); ++i) {
        Touch& touch = touches_[i];
        offset_[i] = glm::dvec3(0);
        if (!touch.touches)
            continue;
        const auto& support = system.supports()[i];
        touch.given = glm::dvec3(support.force - support.stiffness * lastStep[i]);
        touch.pressure = std::max(0.0, glm::dot(touch.given, touch.normal));
        offset_[i] = touch.normal * (-touch.pressure / stiffness_[i]);
    }
}

/// Does a node slide? Where it touches since this round: if it moves along. Else it sticks until more was
/// needed than `most`, and slides until it would turn back.
template <class Real>
void ImplicitContact<Real>::classify(Touch& touch, const glm::dvec3& way, double most) {
    const glm::dvec3 given = touch.given - touch.normal * glm::dot(touch.normal, touch.given);
    const double far = glm::length(way), gave = glm::length(given);
    if (!touch.known || touch.begins) {
        touch.slides = touch.slides || far > kCreeps;
        touch.along = touch.slides && far > 0 ? way / far : glm::dvec3(0);
    } else if (!touch.slides && gave > most) {
        touch.slides = true;
        touch.along = given * (-1 / gave);
    } else if (touch.slides) {
        touch.slides = glm::dot(way, touch.along) > 0;
        touch.along = touch.slides ? way / far : glm::dvec3(0);
    }
}

/// Holds a node against moving on by `way`, as far as `most` allows.
template <class Real>
void ImplicitContact<Real>::resist(Support& support, Touch& touch, const glm::dvec3& way, double most,
                                   double stiffness) const {
    using Matrix = typename ImplicitSystem<Real>::Matrix;
    const glm::dvec3 n = touch.normal, given = touch.given - n * glm::dot(n, touch.given);
    const Matrix plane = Matrix::identity(Real(1)) + Real(-1) * Matrix::dyad(Vector(n));
    classify(touch, way, most);
    if (!touch.slides) {
        support.force += Vector((touch.known ? given : glm::dvec3(0)) - stiffness * way);
        support.stiffness += Real(stiffness) * plane;
        return;
    }
    const double turning = std::min(stiffness, most / std::max(glm::length(way), 1e-12));
    support.force += Vector(touch.along * -most);
    support.stiffness += Real(turning) * (plane + Real(-1) * Matrix::dyad(Vector(touch.along)));
}

/// The last round: what the rounds left inside by far, the last pushes will move at once; its neighbours are
/// to know.
template <class Real>
void ImplicitContact<Real>::holdPushed(const ImplicitSystem<Real>& system, const Vectors& increments,
                                       std::vector<Support>& supports) {
    using Matrix = typename ImplicitSystem<Real>::Matrix;
    Vectors pushed = increments;
    stage_.reset();
    std::vector<std::uint32_t> moved = pushOut(system.step().positions, pushed, ContactStage::Loads::forget);
    std::sort(moved.begin(), moved.end());
    moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
    for (const std::uint32_t node : moved) {
        const Vector by = pushed[node] - increments[node];
        if (system.step().isHeld(node) || glm::length(by) < Real(kFarInside))
            continue;
        const Real firm = Real(kFirm * stiffness_[node]);
        supports[node].force = firm * by;
        supports[node].stiffness = Matrix::identity(firm);
        Touch& touch = touches_[node];
        if (!touch.touches)
            touch.collider = stage_.mover(node);
        touch.touches = true;
        touch.normal = glm::normalize(glm::dvec3(by));
    }
}

template <class Real>
bool ImplicitContact<Real>::support(ImplicitSystem<Real>& system, const Vectors& increments,
                                    const Vectors& lastStep, int round) {
    using Matrix = typename ImplicitSystem<Real>::Matrix;
    if (round > 0)
        takeGiven(system, lastStep);
    Vectors ends = increments;
    const Nodes nodes(system.step().positions, ends, &offset_);
    const auto pushes =
        stage_.pushes(step_, nodes, nodes.fastest(), {0, std::min(1.0, (round + 1) / double(parts_))});
    for (Touch& touch : touches_) {
        touch.known = touch.touches;
        touch.touches = false;
    }
    if (pushes.empty() && held_.empty()) {
        system.support({});
        return round + 1 < parts_; // the colliders are still on their way
    }
    std::vector<Support> supports(system.nodes());
    for (const ContactStage::Push& push : pushes) {
        if (system.step().isHeld(push.node))
            continue;
        const double r = stiffness_[push.node], friction = frictions_[push.collider];
        Touch& touch = touches_[push.node];
        touch.touches = true;
        touch.collider = push.collider;
        touch.normal = glm::normalize(push.move);
        touch.begins = round == 0;
        if (round == 0)
            touch.pressure = std::max(0.0, glm::dot(touch.given, touch.normal));
        supports[push.node].force = Vector(r * push.move);
        supports[push.node].stiffness = Real(r) * Matrix::dyad(Vector(touch.normal));
        if (!(friction > 0))
            continue;
        const glm::dvec3 x = nodes.start(push.node),
                         moved = x + glm::dvec3(increments[push.node]) -
                                 stage_.colliders()[push.collider].carried(x),
                         way = moved - touch.normal * glm::dot(touch.normal, moved);
        // How hard it is pressed is known after a round.
        const double most = touch.known ? friction * touch.pressure : 0;
        resist(supports[push.node], touch, way, most, r);
    }
    for (const std::uint32_t node : held_) {
        const std::uint32_t holder = (*heldBy_)[node] - 1;
        const glm::dvec3 x = nodes.start(node),
                         way = x + glm::dvec3(increments[node]) - tools_[holder].carried(x);
        Touch& touch = touches_[node];
        touch.touches = true;
        touch.collider = holder;
        touch.normal = glm::dvec3(0);
        supports[node] = {};
        const double most = tools_[holder].grip / (stage_.inverseMass(node) * heldMass_[holder]);
        resist(supports[node], touch, way, most, stiffness_[node]);
    }
    if (round + 1 == rounds_)
        holdPushed(system, increments, supports);
    system.support(std::move(supports));
    return true;
}

/// The stage's own pushes, along the way of the step in parts so short that none is jumped over.
template <class Real>
std::vector<std::uint32_t> ImplicitContact<Real>::pushOut(const Vectors& positions, Vectors& increments,
                                                          ContactStage::Loads loads) {
    const Vectors way = increments;
    double farthest = Nodes(positions, increments, nullptr).fastest();
    for (const ToolMotion& tool : tools_)
        farthest = std::max(farthest, glm::distance(tool.from, tool.to));
    const int parts = std::clamp(int(std::ceil(farthest / kPart)), 1, kPushParts);
    std::vector<std::uint32_t> moved;
    Vectors at = positions, part(way.size());
    for (int k = 0; k < parts; ++k) {
        for (std::size_t i = 0; i < way.size(); ++i)
            part[i] = way[i] / Real(parts);
        Nodes nodes(at, part, nullptr);
        stage_.push(step_, nodes, nodes.fastest(), {k / double(parts), (k + 1) / double(parts)}, loads);
        for (const std::uint32_t node : nodes.moved)
            increments[node] += part[node] - way[node] / Real(parts);
        moved.insert(moved.end(), nodes.moved.begin(), nodes.moved.end());
        for (std::size_t i = 0; i < way.size(); ++i)
            at[i] += part[i];
    }
    return moved;
}

template <class Real>
void ImplicitContact<Real>::finish(ImplicitSystem<Real>& system, const std::vector<glm::dvec3>& before,
                                   const Vectors& lastStep, Vectors& increments,
                                   std::vector<glm::dvec4>& touched) {
    touched.assign(system.nodes(), glm::dvec4(0));
    if (empty())
        return;
    const auto& step = system.step();
    takeGiven(system, lastStep);
    system.support({});
    Vectors given(increments.size());
    system.gradient(increments, given);
    stage_.reset();
    const Vectors solved = increments;
    const std::vector<std::uint32_t> moved = pushOut(step.positions, increments, ContactStage::Loads::count);
    for (const std::uint32_t node : moved)
        touched[node] = glm::dvec4(0, 0, 0, kSticks);
    for (std::size_t node = 0; node < given.size(); ++node) {
        const glm::dvec3 x(step.positions[node]);
        if (touches_[node].touches) {
            glm::dvec3 impulse(given[node]);
            if (step.share[node] < 1) // Houbolt's: from here on momentum is counted otherwise
                impulse += system.mass(node) * (before[node] - glm::dvec3(solved[node]));
            stage_.addLoad(touches_[node].collider, x, impulse);
            touched[node] = glm::dvec4(touches_[node].given, touches_[node].slides ? kSlid : kSticks);
        } else if (const std::uint32_t holder = (*heldBy_)[node]; holder != 0) {
            stage_.addLoad(holder - 1, x, glm::dvec3(given[node]));
        }
    }
    for (const std::uint32_t node : held_) {
        std::uint32_t& holder = (*heldBy_)[node];
        const ToolMotion& tool = tools_[holder - 1];
        const glm::dvec3 x(step.positions[node]);
        if (!touches_[node].slides) { // what the penalty left
            const glm::dvec3 left = tool.carried(x) - x - glm::dvec3(increments[node]);
            increments[node] = Vector(tool.carried(x) - x);
            stage_.addLoad(holder - 1, x, left / stage_.inverseMass(node));
        }
        if (shapeDistance(tool.shape, tool.ownAtEnd(x + glm::dvec3(increments[node]))) > SRS_GRIP_SLACK)
            holder = 0;
    }
}

template class ImplicitContact<double>;
template class ImplicitContact<float>;

} // namespace serosa::sim
