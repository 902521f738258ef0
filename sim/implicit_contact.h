#pragma once
// Contact, friction and grasps of finite grip inside an implicit step (sim/implicit_stepper.h). Where nodes
// may not go is the rule of explicit steps without friction (sim/contact_stage.h), P: where would it move
// nodes that are at y? Before each of Newton's rounds the nodes that it would move get a force and a
// stiffness (ImplicitSystem::Support):
//
// - out: the force r (P(y) - y) with the stiffness r n n^T, n along P(y) - y, y = x + u' - n p/r: a penalty
// of
//   stiffness r, and the pressure p that the last round ended with (augmented Lagrangian), so that little is
//   left inside;
// - along, by Coulomb's law (active sets, as Alart & Curnier 1991): a node sticks, with stiffness r, until
// that
//   took more than friction times its pressure in the round before; then it slides against just that force,
//   until it would turn back. Across its way it is as stiff as the force's turning makes it.
//
// Each step begins with what the last one ended with (LatticeState::earlier). A grasp of finite grip holds in
// the same way, with the node's share of the grip for friction times pressure; one without limit holds its
// nodes by themselves (ImplicitSystem::Step::share).
//
// Tools that go far in the step come in parts, round by round; what is still far inside in the last round is
// held outside. When the rounds are done, push() of the stage moves out what is left, along the way in parts:
// no tissue ends a step inside a tool. What a tool gave is the gradient at the nodes that it touches, and m
// times what push() moved them by.

#include "shaders/shared_constants.h"
#include "sim/contact_stage.h"
#include "sim/implicit_system.h"

#include <array>
#include <cstdint>
#include <vector>

namespace serosa::sim {

/// r of the penalty, one a node, in units of mass shares: some times the stiffness of the node against its
/// neighbours at rest, a third of the trace of its block in the matrix.
std::vector<double> contactStiffness(const SolverSetup& setup, const TissueField& field);

template <class Real>
class ImplicitContact {
public:
    using Vector = typename ImplicitSystem<Real>::Vector;
    using Vectors = typename ImplicitSystem<Real>::Vectors;

    /// \param rounds of Newton's, where anything touches
    ImplicitContact(const SolverSetup& setup, const ImplicitSystem<Real>& system, int rounds);

    /// Nothing ever to do.
    bool empty() const { return stage_.empty(); }
    void connect(const std::vector<std::uint32_t>& connections) { stage_.connect(connections); }
    std::vector<ToolLoad> takeLoads() { return stage_.takeLoads(); }

    /// A step begins. \param tools of it. \param heldBy as LatticeState::heldBy: nodes of finite grips are
    /// asked here, the others are the system's. Both are kept until finish().
    void begin(std::int64_t step, const std::vector<ToolMotion>& tools,
               const std::vector<glm::dvec4>& earlier, std::vector<std::uint32_t>& heldBy);
    /// Supports the system's nodes at these increments. Did anything touch?
    bool support(ImplicitSystem<Real>& system, const Vectors& increments, const Vectors& lastStep, int round);
    /// Counts what the supports gave, moves out what is left inside, lets slip what slips.
    /// \param before the increments of the step before, of the same kind as momentum was counted by: a node
    /// that is touched goes on by backward Euler, which counts m u' as its momentum, not m (2 u' - u). \param
    /// touched gets one a node: it was touched, or was held by a finite grip
    void finish(ImplicitSystem<Real>& system, const std::vector<glm::dvec3>& before, const Vectors& lastStep,
                Vectors& increments, std::vector<glm::dvec4>& touched);

private:
    using Support = typename ImplicitSystem<Real>::Support;
    class Nodes;
    struct Touch {                           // of one node
        bool touches = false, known = false; // in this round, and in the one before
        bool begins = false;                 // in a step's first round
        std::uint32_t collider = 0;
        glm::dvec3 normal{0};
        glm::dvec3 given{0}; // what its support gives after the round's step, mass shares times lattice units
        double pressure = 0; // the part of it along the normal
        bool slides = false;
        glm::dvec3 along{0}; // where to
    };
    std::vector<std::uint32_t> pushOut(const Vectors& positions, Vectors& increments,
                                       ContactStage::Loads loads);
    void holdPushed(const ImplicitSystem<Real>& system, const Vectors& increments,
                    std::vector<Support>& supports);
    void takeGiven(const ImplicitSystem<Real>& system, const Vectors& lastStep);
    static void classify(Touch& touch, const glm::dvec3& way, double most);
    void resist(Support& support, Touch& touch, const glm::dvec3& way, double most, double stiffness) const;

    SolverSetup setup_;
    int rounds_;
    ContactStage stage_;
    std::vector<double> frictions_;  // one a collider
    std::vector<double> stiffness_;  // r, one a node
    std::vector<glm::dvec3> offset_; // w, one a node
    std::vector<Touch> touches_;     // one a node
    std::int64_t step_ = 0;
    int parts_ = 1; // rounds in which the colliders come to where the step ends
    std::vector<ToolMotion> tools_;
    std::vector<std::uint32_t>* heldBy_ = nullptr;
    std::vector<std::uint32_t> held_; // nodes, by finite grips
    std::array<double, SRS_MAX_TOOLS> heldMass_{};
};

} // namespace serosa::sim
