// How time and memory a node grow with the lattice, for both texture layouts.

#include "bench/cases.h"
#include "gpu/gl.h"
#include "shaders/shared_constants.h"
#include "sim/state_textures.h"

#include <cmath>

namespace serosa::bench {

namespace {

constexpr std::size_t kNodes[] = {5000, 10000, 20000, 50000, 100000, 200000, 500000, 1000000};
constexpr double kYoung = 3000; // Pa

/// Columns of one layout: ms a step, ns a node, bytes a node; or why not.
struct LayoutColumns {
    std::string step = "does not fit", perNode = "-", bytes = "-";
};

Result<std::vector<std::string>> growthRow(const char* what, sim::Lattice lattice, const Options& options) {
    const Block block(std::move(lattice), kYoung);
    const std::size_t count = block.lattice.nodeCount();
    const glm::ivec3 dims = block.lattice.nodeDims;
    const double filled = double(count) / (double(dims.x) * dims.y * dims.z);
    constexpr int kLayouts[] = {SRS_LAYOUT_ROWS, SRS_LAYOUT_GRID};
    std::unique_ptr<sim::Solver> solvers[2];
    Rounds rounds;
    for (const int layout : kLayouts) {
        sim::FragmentOptions fragment;
        fragment.layout = layout;
        auto made = fragmentSolver(block, fragment);
        if (!made.ok())
            continue; // the strips of a large sparse grid are longer than a texture may be
        std::unique_ptr<sim::Solver>& solver = solvers[layout];
        solver = std::move(made).value();
        rounds.add(std::to_string(layout), [&solver](int repeats) {
            solver->advance(repeats);
            glFinish();
        });
    }
    rounds.measure(std::min(options.rounds, 3), options.seconds);
    std::vector<std::string> row{what, std::to_string(count), figure(100 * filled)};
    for (const int layout : kLayouts) {
        LayoutColumns columns;
        if (solvers[layout]) {
            const Spread time = rounds.milliseconds(std::to_string(layout));
            columns.step = figure(time);
            columns.perNode = figure(1e6 * time.median / double(count));
            columns.bytes = figure(double(solvers[layout]->textures()->bytes()) / double(count));
        }
        row.insert(row.end(), {columns.step, columns.perNode, columns.bytes});
    }
    return row;
}

} // namespace

Status benchGrowth(const Options& options, Report& report) {
    std::vector<std::vector<std::string>> rows;
    for (const std::size_t nodes : kNodes) {
        if (nodes > options.largest)
            break;
        SEROSA_ASSIGN(
            std::vector<std::string> dense,
            growthRow("dense block", denseLattice(int(std::lround(std::cbrt(double(nodes))))), options));
        rows.push_back(std::move(dense));
        SEROSA_ASSIGN(sim::Lattice lattice, heartLattice(nodes));
        SEROSA_ASSIGN(std::vector<std::string> sparse, growthRow("heart", std::move(lattice), options));
        rows.push_back(std::move(sparse));
    }
    report.heading("Growth with the number of nodes, one step");
    report.table({"lattice", "nodes", "grid filled, %", "rows: ms a step", "ns a node", "bytes a node",
                  "grid: ms a step", "ns a node", "bytes a node"},
                 rows);
    report.line("\nBytes: state textures, double buffered, with the row offsets of the rows layout.");
    return {};
}

} // namespace serosa::bench
