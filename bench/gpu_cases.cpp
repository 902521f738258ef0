// A step from 20,000 to 8 million nodes, by fragments and by compute passes, beside the time that the memory
// alone would take: 48 bytes a node (position, increment and node info, once each) over the copy bandwidth
// measured in the same rounds. Works on software too; meant for a GPU.

#include "app/solver_choice.h"
#include "bench/cases.h"
#include "gpu/gl.h"
#include "gpu/handles.h"

#include <algorithm>
#include <cmath>

namespace serosa::bench {

namespace {

constexpr int kEdges[] = {27, 100, 200}; // nodes along an edge of a dense block
constexpr double kYoung = 3000;          // Pa
constexpr std::size_t kCopyBytes = std::size_t(256) << 20;
constexpr double kBytesOfNode = 48;
constexpr const char* kSolvers[] = {"fragment", "compute"};

} // namespace

Status benchGpu(const Options& options, Report& report) {
    // The stable step of a large block is that of a small one within a thousandth, and is found at once.
    const double timeStep = Block(denseLattice(12), kYoung).setup.timeStep;
    gpu::Buffer from("copied from", kCopyBytes, nullptr), to("copied to", kCopyBytes, nullptr);
    std::vector<std::vector<std::string>> rows;
    double least = 0, most = 0; // bandwidths of the rounds, GB/s
    for (const int edge : kEdges) {
        if (double(edge) * edge * edge > double(options.largest))
            break;
        const Block block(denseLattice(edge), kYoung, timeStep);
        std::unique_ptr<sim::Solver> solvers[std::size(kSolvers)];
        Rounds rounds;
        rounds.add("copy", [&](int repeats) {
            for (int i = 0; i < repeats; ++i)
                glCopyNamedBufferSubData(from.id(), to.id(), 0, 0, GLsizeiptr(kCopyBytes));
            glFinish();
        });
        for (std::size_t i = 0; i < std::size(kSolvers); ++i) {
            SEROSA_ASSIGN(solvers[i], app::makeSolver(kSolvers[i], block.setup));
            addSolver(rounds, kSolvers[i], *solvers[i]);
        }
        rounds.measure(options.rounds, options.seconds);
        // Read once and written once.
        const double bandwidth = 2.0 * double(kCopyBytes) / (1e-3 * rounds.milliseconds("copy").median);
        least = least == 0 ? bandwidth : std::min(least, bandwidth);
        most = std::max(most, bandwidth);
        const double nodes = double(block.lattice.nodeCount());
        const double floor = 1e6 * kBytesOfNode * nodes / bandwidth; // microseconds
        for (const char* name : kSolvers) {
            const Spread time = rounds.milliseconds(name);
            rows.push_back({std::to_string(block.lattice.nodeCount()), name,
                            figure({1e3 * time.median, 1e3 * time.min, 1e3 * time.max, time.rounds}),
                            figure(1e6 * time.median / nodes), figure(floor),
                            figure(1e3 * time.median / floor)});
        }
    }
    report.heading("Steps beside the copy bandwidth, dense blocks");
    report.table({"nodes", "solver", "microseconds a step", "ns a node", "48 bytes a node, microseconds",
                  "step over that"},
                 rows);
    report.line("\nCopy bandwidth, " + std::to_string(kCopyBytes >> 20) +
                " MiB, read and written: " + figure(1e-9 * least) + " to " + figure(1e-9 * most) +
                " GB/s. Normals in the last step of a turn.");
    if (options.largest < 8000000)
        report.line("8 million nodes: with --largest 8000000.");
    return {};
}

} // namespace serosa::bench
