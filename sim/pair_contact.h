#pragma once
// Contact between organs, and of an organ with itself: nodes of one skin against triangles of another
// (sim/pair_contact_skin.h), both ways round, after each step. For CPU solvers, in double;
// shaders/pair_find.comp and pair_solve.comp are its twin on the GPU.
//
// Which triangle. Node a, on the skin at p_a with normal n_a, meets the closest point of those triangles of
// the other skin whose normal there is against n_a, n . n_a < -0.1: it can only come through a skin from
// outside, however thin the other organ is. n is the mean of -n_a and the normals of the triangle's corners
// by their weights, each weighed by how flat the skin is there: smooth skins have one normal, what an edge
// lies on says what the edge's is, and nothing jumps between triangles. Of its own organ a node leaves out
// triangles near it along the springs.
//
// When. The step is looked at in K = ceil(fastest motion / half a spacing) parts. At the start s of a part
// the gap is g = n . (p_a - p_b); the node touches in it if the motion along n against the triangle closes
// the gap. Then at the end of the step n . (p_a - p_b) >= 0 is required; of a gap that is negative at s, that
// it closes by SRS_EJECTION spacings a step. The plane is that at s, so that what slides stays fast, and what
// comes is stopped, not thrown back: no energy is given but to what is pushed out. What lies beside the skin
// rather than over or under it (the gap is less than 0.7 of the distance), does not touch. A node further
// inside than SRS_PAIR_DEEPEST spacings, or than 0.45 of both organs' thickness there (then it may be
// outside, on the far side of both), is let alone.
//
// Solve. All constraints at once, by projected Jacobi iteration with mass splitting (Tonge, Benevolenski &
// Voroshilov 2012, Mass Splitting for Jitter-Free Parallel Rigid Body Simulation): a node of c constraints
// gives each of them m/c of its mass, with which the plain iteration cannot overshoot; each round starts
// ahead of the last one by Nesterov's rule (Mazhar, Heyn, Negrut & Tasora 2015, Using Nesterov's Method to
// Accelerate Multibody Dynamics with Friction and Contact): 8 rounds leave as little as 40 without. An
// impulse J on the node is -J on the triangle, shared by the weights b of the point: momentum is kept
// whatever the iteration does. Friction (Coulomb, on positions) takes from the sliding over the step at most
// mu times the normal impulse.

#include "sim/pair_contact_boxes.h"
#include "sim/pair_contact_skin.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace serosa::sim {

/// What moves in a step, one a node of a CoupledGroup, in group units.
struct CoupledMotion {
    std::vector<glm::dvec3> positions;  // at the start of the step
    std::vector<glm::dvec3> increments; // the step; the end is the sum
    std::vector<double> inverseMass;    // 0: fixed, or held by a tool
};

/// A node against a triangle in one step.
struct PairContact {
    std::uint32_t node = 0, organ = 0; // the triangle's organ
    glm::uvec3 corners{0};             // nodes of the triangle
    glm::dvec3 weights{0};             // of the point that is touched
    glm::dvec3 normal{0};
    double gap = 0; // at the end of the step along `normal`, less than what is required of it, 0 where kept
    double normalImpulse = 0; // group units
    glm::dvec3 friction{0};   // impulse on the node

    glm::dvec3 impulse() const { return normalImpulse * normal + friction; } // on the node
};

class PairContacts {
public:
    /// \param friction Coulomb's coefficient, at least 0. \param group outlives this.
    PairContacts(const CoupledGroup& group, double friction);

    /// Finds what touches in this step and changes the increments so that it does not pass.
    void solve(CoupledMotion& motion);
    /// Of the last solve(), by node.
    const std::vector<PairContact>& contacts() const { return contacts_; }

private:
    void find(const CoupledMotion& motion);
    std::optional<PairContact> touch(std::uint32_t node, std::uint32_t organ,
                                     const CoupledMotion& motion) const;
    bool isNear(std::uint32_t node, const glm::uvec3& corners) const;

    const CoupledGroup& group_;
    double friction_;
    std::vector<glm::dvec3> offsets_, normals_, points_; // one a node; normals times their flatness
    std::vector<SkinBoxes> boxes_;                       // one an organ
    std::vector<double> fastest_;                        // one an organ: longest increment of its skin
    std::vector<PairContact> contacts_;
};

} // namespace serosa::sim
