#pragma once
// From an organ of a scene to what a solver needs: surface, lattice, fixed nodes, time step. Shared by run,
// inspect and scene check.

#include "base/result.h"
#include "sim/lattice.h"
#include "sim/scene.h"
#include "sim/solver.h"
#include "sim/triangle_mesh.h"

#include <string>
#include <vector>

namespace serosa::app {

/// A closed solid as its file has it, and in metres.
struct OrganSurface {
    sim::TriangleMesh file;   // the file's own unit
    sim::TriangleMesh metres; // same vertex and face order
};

/// Reads and checks. Errors of the file itself; where the scene has a line for it, the message leads with
/// that. \param scene for messages; may be empty.
Result<OrganSurface> loadSurface(const sim::Organ& organ, const std::filesystem::path& scene);

/// One flag a node. Errors: a region that holds no node (its unit or position is wrong), naming its line.
Result<std::vector<bool>> fixedNodes(const sim::Organ& organ, const sim::Lattice& lattice,
                                     const sim::TriangleMesh& metres, const std::filesystem::path& scene);

/// The lattice of an organ, by nodes or spacing.
Result<sim::Lattice> organLattice(const sim::Organ& organ, const sim::TriangleMesh& metres);

/// The stable step, refused where a frame would take more than 100,000 steps.
Result<sim::StableStep> organStep(const sim::Organ& organ, const sim::Lattice& lattice, double frameTime);

/// "12,345"
std::string grouped(std::size_t number);
/// Four significant digits.
std::string shortNumber(double value);

} // namespace serosa::app
