#pragma once
// Bodies of the group `implicit` and of the benchmark of the same name, all with one implicit step a frame.

#include "sim/solver.h"

#include <memory>

namespace serosa::app {

inline constexpr double kImplicitFrame = 1.0 / 60; // s

/// A lattice with what is done to it; kept where it is, since the setup points at the lattice.
struct ImplicitBody {
    sim::Lattice lattice;
    sim::SolverSetup setup;

    /// In gravity, of one tissue, without damping.
    ImplicitBody(sim::Lattice made, double young);
    ImplicitBody(const ImplicitBody&) = delete;
    ImplicitBody& operator=(const ImplicitBody&) = delete;

    void fixWhere(bool (*where)(const glm::ivec3& node));
    /// The same with explicit steps.
    sim::SolverSetup withExplicitSteps() const;
};

/// So many whole cells along each axis. \param spacing m
sim::Lattice blockOfCells(const glm::ivec3& cells, double spacing);
/// A ball of 60 mm of tissue of 1 kPa in a capsule of 1 MPa, one cell thick, held at its bottom.
/// \param across cells
std::unique_ptr<ImplicitBody> capsuleBody(int across);

/// Of two states of one lattice, h: the farthest that a node lies from itself.
double largestDistance(const sim::LatticeState& a, const sim::LatticeState& b);

} // namespace serosa::app
