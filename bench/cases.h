#pragma once
// The cases of serosa_bench. Each function measures some of them in interleaved rounds and reports.

#include "base/result.h"
#include "bench/report.h"
#include "gpu/context.h"
#include "sim/solver.h"

#include <cstddef>

namespace serosa::bench {

struct Options {
    int rounds = 5;
    double seconds = 0.4;          // a turn of a case
    std::size_t largest = 1000000; // nodes, of the growth, realtime, gpu and large tables
};

/// A lattice with all that a solver needs, at rest, loaded by gravity. Does not move.
struct Block {
    sim::Lattice lattice;
    sim::SolverSetup setup;
    /// \param young Pa \param timeStep s; 0: the stable one, which takes long for millions of nodes
    Block(sim::Lattice made, double young, double timeStep = 0);
    Block(const Block&) = delete;
};
/// n^3 nodes, all cells full, spacing 2.5 mm.
sim::Lattice denseLattice(int nodesAlongAnEdge);
/// The heart phantom's surface in metres (made once).
Result<const sim::TriangleMesh*> heartSurface();

/// Each face in four, until there are enough.
sim::TriangleMesh refined(sim::TriangleMesh mesh, std::size_t least);

/// The heart phantom in about so many nodes.
Result<sim::Lattice> heartLattice(std::size_t nodes);

/// Adds the steps of a solver as a case; those of a solver in textures are waited for.
void addSolver(Rounds& rounds, const std::string& name, sim::Solver& solver);
/// A fragment solver behind the `advance, then wait` that Rounds wants.
Result<std::unique_ptr<sim::Solver>> fragmentSolver(const Block& block,
                                                    const sim::FragmentOptions& options = {});

/// scalar_over_fragment_dense20k, and what normals, eq. 2, imageLoad and damping cost
/// (bench/solver_cases.cpp).
Status benchSolver(const Options& options, Report& report);
/// fragment_over_cpu_..., cpu_share_of_fma_peak, bullet_over_cpu and bullet_over_fragment
/// (bench/cpu_cases.cpp).
Status benchCpu(const Options& options, Report& report);
/// compute_over_fragment_(dense|sparse)20k, and what work groups and tiles do (bench/compute_cases.cpp).
Status benchCompute(const Options& options, Report& report);
/// mapping_over_static, corrected_over_constant(_frame), vertex fetch against readback, and MS05's own table
/// (bench/mapping_cases.cpp).
Status benchMapping(const Options& options, Report& report);
/// Skipping hidden clusters and levels of detail of a surface of a million faces; textures, shadows,
/// occlusion (bench/look_cases.cpp).
Status benchLook(const Options& options, Report& report);
/// Table 1 and figure 7 of CS07, what searching and warping cost, memory of maps (bench/raycast_cases.cpp).
Status benchRaycast(const Options& options, Report& report);
/// What fills, normals, damping, the volumetric term, materials, cuts and tools cost as shares of a step, and
/// what a stroke takes (bench/tissue_cases.cpp).
Status benchTissue(const Options& options, Report& report);
/// What contact, friction, grasps and the readback of forces cost as shares of a frame
/// (bench/contact_cases.cpp).
Status benchContact(const Options& options, Report& report);
/// The part of it about organs that touch each other or themselves, and threads (bench/coupling_cases.cpp).
Status benchCoupling(const Options& options, Report& report);
/// A step at h, 2h, 4h, a switch between them, and the tree of boxes beside a step (bench/lod_cases.cpp).
Status benchLod(const Options& options, Report& report);
/// Simulated seconds a second with one implicit step a frame, and with explicit ones
/// (bench/implicit_cases.cpp).
Status benchImplicit(const Options& options, Report& report);
/// What else could solve such a step: projective dynamics, XPBD (bench/implicit_rivals.cpp).
Status benchRivals(const Options& options, Report& report);
/// Simulated seconds a second, and how many nodes keep up with time (bench/realtime_cases.cpp).
Status benchRealtime(const Options& options, Report& report);
/// Microseconds a step from 20,000 to 8 million nodes beside the copy bandwidth (bench/gpu_cases.cpp).
Status benchGpu(const Options& options, Report& report);
/// Time and bytes a node from 5,000 nodes upwards, for both layouts (bench/growth_cases.cpp).
Status benchGrowth(const Options& options, Report& report);
/// Time and memory of whole runs, up to a million nodes and faces (bench/large_cases.cpp).
Status benchLarge(const Options& options, Report& report);

} // namespace serosa::bench
