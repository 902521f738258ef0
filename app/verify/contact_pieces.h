#pragma once
// Test pieces of the groups `contact` and `grasp`: blocks of whole cells, and what is measured on them.

#include "app/verify/verify.h"
#include "sim/solver.h"

#include <memory>
#include <string>
#include <vector>

namespace serosa::app {

/// A lattice with what is done to it; kept where it is, since the setup points at the lattice.
struct ContactPiece {
    sim::Lattice lattice;
    sim::SolverSetup setup;

    /// `cells` whole cells along each axis; the lowest corner rests at `corner`, m.
    ContactPiece(const glm::ivec3& cells, double spacing, const glm::dvec3& corner,
                 const sim::Tissue& tissue);
    /// \param lattice m, world
    ContactPiece(sim::Lattice lattice, const sim::Tissue& tissue);
    ContactPiece(const ContactPiece&) = delete;
    ContactPiece& operator=(const ContactPiece&) = delete;

    double mass(std::size_t node) const; // kg
    double totalMass() const;            // kg
    /// Centre of mass, m, world, of the lattice.
    glm::dvec3 centre(const sim::LatticeState& state) const;
    /// kg m/s
    glm::dvec3 momentum(const sim::LatticeState& state) const;
    /// About a point, kg m2/s: of the positions a step before the velocities, as steps keep it.
    glm::dvec3 angularMomentum(const sim::LatticeState& state, const glm::dvec3& about) const;
};

/// y <= height is solid.
sim::Body floorAt(double height, double friction);

/// The solvers that a group compares: options.solver, or all but the reference.
std::vector<std::string> comparedSolvers(const VerifyOptions& options);

Status verifyContactImpulses(const VerifyOptions& options,
                             CheckList& checks);                      // app/verify/contact_impulses.cpp
Status verifyProbes(const VerifyOptions& options, CheckList& checks); // app/verify/contact_probes.cpp
Status verifyOrganContact(const VerifyOptions& options,
                          CheckList& checks);                          // app/verify/contact_organs.cpp
Status verifyThreads(const VerifyOptions& options, CheckList& checks); // app/verify/grasp_threads.cpp

} // namespace serosa::app
