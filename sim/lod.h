#pragma once
// Level of detail: one organ on lattices of spacing h, 2h, 4h, of one surface and one material, and the
// motion handed from one to the next (MS05 3.6). sim/lod_pass.h does the same on the GPU with nothing read
// back; here in double.
//
// What a switch keeps. Positions: displacements by the rows of sim/lod_map.h. What the coarse lattice cannot
// hold of the fine shape is kept as *detail*, a vector a fine node in the moving frame of its coarse cell
// (the cell's mean deformation gradient), and added again when the fine lattice takes over. Velocities: by
// the rows; then the rigid motion is added that makes linear momentum, and angular momentum about the centre
// of mass, of the nodes that are not fixed exactly what they were. (About their own centre: those of the two
// lattices' lumped masses differ by some hundredths of a spacing, and a body that falls shall not begin to
// turn.) Fixed nodes rest.
//
// Increments are velocities half a step before: u h / dt = v(t - dt/2). Steps differ between levels, so a
// body in free fall would gain or lose g (dt - dt')/2; the acceleration of the last step takes that off:
//   v(t - dt'/2) = h/dt (u + beta (u - u before)),  beta = (1 - dt'/dt)/2
//
// Lattices of one organ hold its mass up to the rounding of fills; matchedTissue takes that up in the
// density.

#include "sim/lod_map.h"
#include "sim/solver.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

/// Levels: 1 is the organ's own lattice, each further one has twice the spacing of the one before.
constexpr int kMostLevels = 3;

/// The tissue with densities that give the coarse lattice the mass of the fine one.
Tissue matchedTissue(const Tissue& tissue, const Lattice& fine, const Lattice& coarse);

/// From one level to the next finer or coarser one. Setups (their lattices, tissues, time steps and fixed
/// nodes) are of one organ; nothing of them is kept.
struct LodTransfer {
    bool finer = false;
    LodRows places, velocities;                     // of the target's nodes over the source's
    std::vector<glm::dvec3> sourceRest, targetRest; // lattice units of each
    std::vector<double> sourceMasses, targetMasses; // in the target's mass shares; 0: fixed
    std::vector<bool> targetFixed;
    double lengthScale = 1; // source's spacing over the target's
    double stepScale = 1;   // target's time step over the source's

    static LodTransfer make(const SolverSetup& from, const SolverSetup& to);
};

/// beta above, from a time step to another.
inline double lodLead(double fromStep, double toStep) {
    return 0.5 * (1 - toStep / fromStep);
}

/// Detail of a fine shape over a coarse one, fine lattice units in the frames of coarse cells; empty: none.
using LodDetail = std::vector<glm::dvec3>;

/// \param toFiner from `coarse` to `fine`
LodDetail detailOf(const LodTransfer& toFiner, const LatticeState& coarse, const LatticeState& fine);

/// The state on the other level; normals are made anew, nothing is held and nothing cut.
/// \param before increments of the step before the last; empty: not known, no acceleration
/// \param lead lodLead to the level that goes on: on a way over a level between, that is not the target
/// \param step that the target's time is at
LatticeState transferState(const LodTransfer& transfer, const Lattice& target, const LatticeState& from,
                           const std::vector<glm::dvec3>& before, double lead, std::int64_t step,
                           const LodDetail& detail = {});

/// Momentum of the nodes that are not fixed, by the increments: kg m/s, kg m2/s about their centre of mass.
struct Momentum {
    glm::dvec3 linear{0}, angular{0};
};
Momentum momentumOf(const SolverSetup& setup, const LatticeState& state);

} // namespace serosa::sim
