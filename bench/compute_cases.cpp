// One step: compute passes against the fragment pass, and what work groups and shared-memory tiles do.

#include "bench/cases.h"
#include "gpu/gl.h"
#include "shaders/shared_constants.h"

namespace serosa::bench {

namespace {

constexpr double kYoung = 3000; // Pa

struct Variant {
    std::string name;
    sim::ComputeOptions options;
};

std::string sizeName(const glm::ivec2& group) {
    return std::to_string(group.x) + " x " + std::to_string(group.y);
}

std::vector<Variant> variants(int layout) {
    std::vector<Variant> list{{"compute, as run by default", {}}};
    list[0].options.layout = layout;
    const auto add = [&list](const std::string& name) -> sim::ComputeOptions& {
        list.push_back({name, list[0].options});
        return list.back().options;
    };
    for (const glm::ivec2 group :
         {glm::ivec2(16, 1), glm::ivec2(64, 1), glm::ivec2(128, 1), glm::ivec2(16, 8), glm::ivec2(32, 8)}) {
        sim::ComputeOptions& options = add("groups of " + sizeName(group));
        options.gridGroup = options.rowsGroup = group;
    }
    add("texelFetch").useTexelFetch = true;
    if (layout == SRS_LAYOUT_GRID)
        for (const glm::ivec3 group : {glm::ivec3(16, 8, 1), glm::ivec3(8, 4, 4)}) {
            sim::ComputeOptions& options = add("shared-memory tiles of " + sizeName(glm::ivec2(group)) +
                                               " x " + std::to_string(group.z));
            options.tiles = true;
            options.tileGroup = group;
        }
    return list;
}

Status benchBlock(const std::string& title, const std::string& ratio, const Block& block, int layout,
                  const Options& options, Report& report) {
    const std::vector<Variant> list = variants(layout);
    std::vector<std::unique_ptr<sim::Solver>> solvers;
    Rounds rounds;
    const auto add = [&](const std::string& name, std::unique_ptr<sim::Solver> solver) {
        solvers.push_back(std::move(solver));
        rounds.add(name, [&stepped = *solvers.back()](int repeats) {
            stepped.advance(repeats);
            glFinish();
        });
    };
    SEROSA_ASSIGN(std::unique_ptr<sim::Solver> fragment, fragmentSolver(block));
    add("fragment", std::move(fragment));
    for (const Variant& variant : list) {
        SEROSA_ASSIGN(std::unique_ptr<sim::Solver> solver,
                      sim::makeComputeSolver(block.setup, variant.options));
        add(variant.name, std::move(solver));
    }
    rounds.measure(options.rounds, options.seconds);

    report.heading("One step in compute passes, " + title);
    std::vector<std::vector<std::string>> rows{
        {"fragment, as run by default", figure(rounds.milliseconds("fragment")), "1"}};
    for (const Variant& variant : list)
        rows.push_back({variant.name, figure(rounds.milliseconds(variant.name)),
                        figure(rounds.ratio(variant.name, "fragment"))});
    report.table({"solver", "ms a step", "over fragment"}, rows);
    report.ratio(ratio, rounds.ratio(list[0].name, "fragment"));
    return {};
}

} // namespace

Status benchCompute(const Options& options, Report& report) {
    const Block dense(denseLattice(27), kYoung);
    SEROSA_TRY(benchBlock("dense block of 27^3 = 19,683 nodes, grid layout", "compute_over_fragment_dense20k",
                          dense, SRS_LAYOUT_GRID, options, report));
    SEROSA_ASSIGN(sim::Lattice lattice, heartLattice(20000));
    const Block sparse(std::move(lattice), kYoung);
    return benchBlock("heart phantom, " + std::to_string(sparse.lattice.nodeCount()) + " nodes, rows layout",
                      "compute_over_fragment_sparse20k", sparse, SRS_LAYOUT_ROWS, options, report);
}

} // namespace serosa::bench
