#pragma once
// From an organ of a scene to what a solver needs: surface, lattice, fixed nodes, time step. Shared by run,
// inspect and scene check.

#include "base/result.h"
#include "sim/lattice.h"
#include "sim/mesh_repair.h"
#include "sim/scene.h"
#include "sim/solver.h"
#include "sim/triangle_mesh.h"

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace serosa::app {

/// A closed solid as its file has it (mended if that was asked for), and in the world.
struct OrganSurface {
    sim::TriangleMesh file;   // the file's own unit and axes
    sim::TriangleMesh metres; // turned so that y is up; the same vertices first, the same faces until split
    std::optional<sim::RepairReport> repair; // where the organ asks for it
};

/// Reads a model and checks it, or mends it where `repair` is set. Errors: of the file; a fault that a repair
/// would mend is refused with a hint at it.
Result<sim::RepairedMesh> readSolid(const std::filesystem::path& file, bool repair);

/// The surface with the displacement of each vertex (m, world) in the file's own unit and axes.
sim::TriangleMesh deformedFile(const sim::Organ& organ, const OrganSurface& surface,
                               const std::vector<glm::dvec3>& deformed, const std::vector<glm::dvec3>& rest);

/// Reads and checks. Errors of the file itself; where the scene has a line for it, the message leads with
/// that. \param scene for messages; may be empty.
Result<OrganSurface> loadSurface(const sim::Organ& organ, const std::filesystem::path& scene);

/// One flag a node. Errors: a region that holds no node (its unit or position is wrong), naming its line;
/// everything is fixed.
Result<std::vector<bool>> fixedNodes(const sim::Organ& organ, const sim::Lattice& lattice,
                                     const sim::TriangleMesh& metres, const std::filesystem::path& scene);

/// The lattice of an organ, by nodes or spacing, with the material of each cell. Errors name the line of the
/// organ's model or of a region in `scene`.
Result<sim::Lattice> organLattice(const sim::Organ& organ, const sim::TriangleMesh& metres,
                                  const std::filesystem::path& scene);

/// The step of the organ's method. Explicit: the stable one, refused where a frame would take more than
/// 100,000. Implicit: the frame's own, or as many as the scene's tools ask for (sim::implicitStepsPerFrame);
/// what else is known of explicit steps stands beside it.
Result<sim::StableStep> organStep(const sim::Organ& organ, const sim::Lattice& lattice,
                                  const sim::Scene& scene);

/// "one a frame", or how many, and why.
std::string implicitStepsText(const sim::StableStep& step);

/// "explicit" or "implicit"
const char* methodName(sim::StepMethod method);
/// How many explicit steps a frame of `frameTime` seconds would take, by the bound and its margin.
double explicitSteps(const sim::StableStep& step, double frameTime);

/// A line for each kind of fault that was mended, or that there was none.
void printRepair(const sim::RepairReport& repair, std::ostream& out);
/// The same where a repair was asked for.
void printRepair(const OrganSurface& surface, std::ostream& out);

/// "12,345"
std::string grouped(std::size_t number);
/// Four significant digits.
std::string shortNumber(double value);

} // namespace serosa::app
