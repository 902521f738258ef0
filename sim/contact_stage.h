#pragma once
// The second half of a step (sim/solver.h): contact, friction and grasps, in place on what the forces alone
// made of it. Shared by the reference and the cpu solver; shaders/contact_*.comp are the GPU's twin. Order:
//   1. grasps: a held node goes with its tool, by no more than the grip can give;
//   2. SRS_CONTACT_ITERATIONS rounds over the triangles that close the organ: each that touches asks for a
//      move of its corners, dx_i = move (b_i/m_i) / sum_j (b_j^2/m_j), which moves the touched point by
//      `move` (sim/contact_triangle.h). All are asked at the same positions; a node then goes, triangle after
//      triangle, as far along each move asked of it as it does not yet: moves of one direction count once,
//      and what it does follows steadily from what is asked. (The mean of them halves a correction that its
//      neighbours do not need, and thin probes sink in.)
//   3. every node by itself, collider after collider: none ends inside.
// A half-space has no second: what holds for the corners of a triangle holds for all of it.
//
// What a collider gave to a node: the impulse m dx, and (x - r) x m dx about its reference point r at the
// step's end, with x the node at the step's start, where the forces are taken, too. The sums over all nodes
// of m u' and of m x x u', which the springs keep, then change by just the loads.
//
// Cost: blocks of nodes and of triangles (sim/contact_surface.h) stand in spheres that are made anew once
// motion may have left them; one distance says that a block is far from a collider. The same bytes whatever
// the number of threads.

#include "sim/contact_surface.h"
#include "sim/tool_motion.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace serosa::sim {

/// A solver's state during the step, in lattice units.
class ContactNodes {
public:
    virtual ~ContactNodes() = default;
    /// Where a node was when the step began, and where forces alone took it. From several threads at once.
    virtual glm::dvec3 start(std::uint32_t node) const = 0;
    virtual glm::dvec3 end(std::uint32_t node) const = 0;
    /// Adds to the node's end and to its increment. Not called for what is only asked.
    virtual void move(std::uint32_t node, const glm::dvec3& by) = 0;
};

class ContactStage {
public:
    /// Keeps a copy of the setup. \param mass shares, one a node
    ContactStage(const SolverSetup& setup, std::vector<double> mass);

    /// Nothing ever to do: neither tools nor bodies.
    bool empty() const { return setup_.tools.empty() && setup_.bodies.empty(); }
    /// What cuts left: 18 bits a node.
    void connect(const std::vector<std::uint32_t>& connections);
    /// Nodes that nothing moves until the next call: a grasp without limit has them where it wants them.
    void keep(std::vector<std::uint32_t> nodes);
    /// Positions came from elsewhere.
    void reset() { drift_ = -1; }

    /// \param step its number, as toolMotions. \param fastest no node's increment is longer
    /// \param heldBy one a node, as LatticeState::heldBy; changed
    void run(std::int64_t step, ContactNodes& nodes, double fastest, std::vector<std::uint32_t>& heldBy);

    /// Points 2 and 3 alone, for implicit steps: whoever is held by no grasp of this stage. \param fastest as
    /// run
    enum class Loads { count, forget };
    void push(std::int64_t step, ContactNodes& nodes, double fastest, StepPart part = {},
              Loads loads = Loads::count);

    /// Of one node, lattice units: where points 2 and 3 would move it.
    struct Push {
        std::uint32_t node = 0, collider = 0; // the one that moved it last
        glm::dvec3 move{0};
    };
    /// What push() would do were there no friction, without doing it: nothing moves, and no load is counted.
    /// \param part of the step
    std::vector<Push> pushes(std::int64_t step, const ContactNodes& nodes, double fastest,
                             StepPart part = {});
    /// Of the last step asked for.
    const std::vector<ToolMotion>& colliders() const { return colliders_; }
    /// Counts what a collider gave to a node in another way. \param x where it began the step, lattice units.
    /// \param impulse mass shares times lattice units
    void addLoad(std::size_t collider, const glm::dvec3& x, const glm::dvec3& impulse) {
        loads_[collider].add(colliders_[collider], 1, x, impulse);
    }
    /// The collider that moved a node last.
    std::uint32_t mover(std::uint32_t node) const { return mover_[node]; }
    /// 0 for fixed and kept nodes.
    double inverseMass(std::uint32_t node) const { return inverseMass_[node]; }

    /// Since the last call, one a collider.
    std::vector<ToolLoad> takeLoads();

private:
    using Mask = std::uint32_t; // a bit a collider
    struct Sphere {
        glm::dvec3 centre{0};
        double radius = 0;
    };
    struct Near { // a block of items, and what it may touch
        std::uint32_t block = 0;
        Mask colliders = 0;
    };
    struct Candidate {
        std::uint32_t triangle = 0, collider = 0;
    };
    struct Asked { // of a triangle's corners
        std::uint32_t triangle = 0;
        std::array<std::uint32_t, 3> colliders{};
        std::array<glm::dvec3, 3> moves{};
    };
    struct Load { // mass shares times lattice units (squared)
        glm::dvec3 impulse{0}, angular{0};
        void add(const ToolMotion& collider, double mass, const glm::dvec3& x, const glm::dvec3& by) {
            impulse += mass * by;
            angular += glm::cross(x - collider.to, mass * by);
        }
        void add(const Load& other) {
            impulse += other.impulse;
            angular += other.angular;
        }
    };

    void place(std::int64_t step, const ContactNodes& nodes, double fastest, StepPart part = {});
    void pushAll(const ContactNodes& nodes);
    void applyMoves(ContactNodes& nodes);
    void updateHeld(const ContactNodes& nodes, std::vector<std::uint32_t>& heldBy);
    void moveHeld(std::vector<std::uint32_t>& heldBy);
    void makeSpheres(const ContactNodes& nodes, double fastest);
    std::vector<Near> nearBlocks(const std::vector<Sphere>& spheres, bool triangles) const;
    void load(const ContactNodes& nodes, const ContactBlocks& blocks, const std::vector<Near>& near);
    void loadNode(const ContactNodes& nodes, std::uint32_t node);
    std::vector<Candidate> candidates(const std::vector<Near>& near) const;
    /// One round: did anything move? \param again those whose corners the last round left alone have no more
    /// to ask.
    bool pushTriangles(const std::vector<Candidate>& candidates, bool again);
    bool movedLast(std::uint32_t triangle) const {
        const glm::uvec3& t = surface_.triangles[triangle];
        return asked_[t.x] == round_ || asked_[t.y] == round_ || asked_[t.z] == round_;
    }
    bool ask(const Candidate& candidate, Asked& asked) const;
    void pushNodes(const std::vector<Near>& near);

    SolverSetup setup_;
    std::vector<double> mass_, inverseMass_, depth_; // one a node; fixed ones have an inverse of 0
    ContactSurface surface_;
    std::vector<ToolMotion> colliders_; // of this step
    std::vector<double> thin_;          // of each
    std::vector<Sphere> nodeSpheres_, triangleSpheres_;
    Sphere whole_;
    double drift_ = -1; // how far a node may have moved since the spheres were made; < 0: none are

    // Of the nodes that this step looks at; `seen_` says of which step they are.
    std::vector<glm::dvec3> start_, end_, free_;
    std::vector<std::int64_t> seen_;
    std::vector<std::uint32_t> loaded_, mover_; // mover_: the collider that moved it last
    std::int64_t run_ = 0;
    // Of the nodes that this round moves.
    std::vector<std::int64_t> asked_;
    std::vector<glm::dvec3> granted_;
    std::int64_t round_ = 0;

    std::vector<std::uint32_t> held_; // nodes, ascending; as of heldBy
    std::vector<std::uint32_t> heldSeen_;
    std::vector<std::uint32_t> kept_;
    std::vector<Load> loads_;
};

} // namespace serosa::sim
