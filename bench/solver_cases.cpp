// One step: fragment shader against a plain CPU program, and what its parts cost (MS05 3.1, eq. 1-3).

#include "bench/cases.h"
#include "bench/scalar_kernel.h"
#include "gpu/gl.h"
#include "shaders/shared_constants.h"

#include <algorithm>
#include <map>

namespace serosa::bench {

namespace {

constexpr double kYoung = 3000; // Pa

/// The two must agree before their times mean anything: 100 steps of the same sagging block.
Status checkAgreement(const Block& block, sim::Solver& fragment, Report& report) {
    ScalarKernel scalar(block.setup);
    scalar.advance(100);
    fragment.advance(100);
    const sim::LatticeState state = fragment.state();
    double moved = 0, apart = 0;
    for (std::size_t i = 0; i < state.positions.size(); ++i) {
        moved = std::max(moved, glm::distance(state.positions[i], block.lattice.restPosition(i)));
        apart = std::max(apart, glm::distance(state.positions[i], glm::dvec3(scalar.position(i))));
    }
    report.line("After 100 steps the scalar kernel and the fragment solver differ by at most " +
                figure(apart) + " h (nodes moved up to " + figure(moved) + " h).\n");
    if (!(apart <= 1e-3))
        return Error{"bench: the scalar kernel and the fragment solver differ by " + figure(apart) +
                         " h after 100 steps: their times cannot be compared",
                     exitCheckFailed};
    return {};
}

struct Variant {
    const char* name;
    sim::FragmentOptions options;
    bool damping = true;
};

std::vector<Variant> variants() {
    std::vector<Variant> list;
    const auto add = [&list](const char* name) -> sim::FragmentOptions& {
        list.push_back({name, {}, true});
        list.back().options.normalsEveryStep = true;
        return list.back().options;
    };
    add("eq. 2, normals in every step, damping, imageLoad");
    add("normals (eq. 3) in the last step only, as run by default").normalsEveryStep = false;
    add("eq. 1, spring by spring").printedForm = false;
    add("texelFetch").useTexelFetch = true;
    add("without damping");
    list.back().damping = false;
    add("the other layout"); // comes last: benchVariants says which
    return list;
}

Status benchVariants(const char* title, const Block& block, int ownLayout, const Options& options,
                     Report& report) {
    Block undamped(block.lattice, kYoung);
    undamped.setup.tissue.dampingTime = 0;
    std::vector<Variant> list = variants();
    list.back().options.layout = SRS_LAYOUT_GRID + SRS_LAYOUT_ROWS - ownLayout;

    ScalarKernel scalar(block.setup);
    std::vector<std::unique_ptr<sim::Solver>> solvers;
    Rounds rounds;
    for (const Variant& variant : list) {
        SEROSA_ASSIGN(std::unique_ptr<sim::Solver> solver,
                      fragmentSolver(variant.damping ? block : undamped, variant.options));
        solvers.push_back(std::move(solver));
        rounds.add(variant.name, [&solver = *solvers.back()](int repeats) {
            solver.advance(repeats);
            glFinish();
        });
    }
    rounds.add("CPU, scalar", [&scalar](int repeats) { scalar.advance(repeats); });
    rounds.measure(options.rounds, options.seconds);

    report.heading(std::string("One step, ") + title);
    std::vector<std::vector<std::string>> rows;
    for (const Variant& variant : list)
        rows.push_back({variant.name, figure(rounds.milliseconds(variant.name)),
                        figure(rounds.ratio(variant.name, list[0].name))});
    rows.push_back({"CPU, one thread, float32 array of structures, -O2",
                    figure(rounds.milliseconds("CPU, scalar")),
                    figure(rounds.ratio("CPU, scalar", list[0].name))});
    report.table({"fragment solver", "ms a step", "over the first"}, rows);
    if (ownLayout == SRS_LAYOUT_GRID)
        report.ratio("scalar_over_fragment_dense20k", rounds.ratio("CPU, scalar", list[0].name));
    return {};
}

} // namespace

Status benchSolver(const Options& options, Report& report) {
    const Block dense(denseLattice(27), kYoung);
    SEROSA_ASSIGN(std::unique_ptr<sim::Solver> fragment, fragmentSolver(dense));
    SEROSA_TRY(checkAgreement(dense, *fragment, report));
    SEROSA_TRY(benchVariants("dense block of 27^3 = 19,683 nodes", dense, SRS_LAYOUT_GRID, options, report));

    SEROSA_ASSIGN(sim::Lattice lattice, heartLattice(20000));
    const Block sparse(std::move(lattice), kYoung);
    const std::string title = "heart phantom, " + std::to_string(sparse.lattice.nodeCount()) + " nodes";
    return benchVariants(title.c_str(), sparse, SRS_LAYOUT_ROWS, options, report);
}

} // namespace serosa::bench
