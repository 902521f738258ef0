#pragma once
// One organ by two methods: the lattice of springs, and quadratic tetrahedra (app/verify/fem_solid.h). All
// that lies below a plane is held, the rest is pulled by an even acceleration.

#include "app/verify/fem_solid.h"
#include "app/verify/plane_cut.h"
#include "sim/lattice.h"
#include "sim/solver.h"

#include <glm/glm.hpp>

#include <functional>
#include <memory>
#include <vector>

namespace serosa::app {

/// Displacements of a lattice's nodes, m, and in between (trilinear in a cell).
struct LatticeField {
    const sim::Lattice* lattice = nullptr;
    std::vector<glm::dvec3> displacements; // m, one a node
    /// At a place of the rest state (m); where a corner is no node, of the others. Zero far from the lattice.
    glm::dvec3 at(const glm::dvec3& world) const;
};

/// The organ as the finite elements have it.
struct FemModel {
    TetMesh mesh;
    FemMatrix stiffness;
    std::vector<bool> held; // one a node: those in the plane
    double density = 0;     // kg/m3
};
/// \param largestVolume of a tetrahedron, m3. Errors: as fillWithTets.
Result<FemModel> makeFemModel(const PlaneCut& cut, const ElasticSolid& solid, double density,
                              double largestVolume);

/// At rest under an even acceleration.
struct FemRest {
    glm::dvec3 acceleration{0};    // m/s2
    Eigen::VectorXd displacements; // m, three a node
};
Result<FemRest> femUnder(const FemModel& model, const glm::dvec3& acceleration);
/// The same with a load such that the largest principal strain is this.
FemRest scaledToStrain(const FemModel& model, FemRest rest, double strain);

/// One flag a node: rests at or below this height, m.
std::vector<bool> nodesBelow(const sim::Lattice& lattice, double height);

/// The lattice at rest by linear statics. `setup` says tissue, gravity and what is fixed.
LatticeField latticeStatics(const sim::SolverSetup& setup);

/// The lattice at rest by a solver's own steps from the rest state, with a drag (setup.tissue.airDrag) near
/// the critical one of the slowest motion, which `statics` tells.
struct SettledLattice {
    LatticeField field;
    int steps = 0;
    double unrest = 0; // largest displacement of the last tenth of the steps over the largest of all
};
/// \param make the solver of a setup, such as sim::makeReferenceSolver
SettledLattice
settleLattice(sim::SolverSetup setup, const LatticeField& statics,
              const std::function<std::unique_ptr<sim::Solver>(const sim::SolverSetup&)>& make);

/// Over the volume of the tetrahedra, at their Gauss points.
struct FieldDifference {
    double mean = 0;     // mean |u - u of the elements| / mean |u of the elements|
    double largest = 0;  // largest |u - u of the elements| / mean |u of the elements|
    double meanSize = 0; // mean |u of the elements|, m
};
FieldDifference compareFields(const FemModel& model, const FemRest& rest, const LatticeField& lattice);

} // namespace serosa::app
