// Level of detail and the tree of boxes on the heart phantom: a step at h, 2h, 4h; a switch; refitting the
// tree, and what it answers, beside a step.

#include "bench/cases.h"
#include "gpu/gl.h"
#include "sim/lod_pass.h"
#include "sim/node_tree.h"

#include <random>

namespace serosa::bench {

namespace {

constexpr std::size_t kNodes = 20000;
constexpr int kRays = 4096;

Result<sim::Lattice> coarser(const sim::Lattice& own, int times) {
    SEROSA_ASSIGN(const sim::TriangleMesh* heart, heartSurface());
    sim::LatticeRequest request;
    request.spacing = own.spacing * times;
    request.gridPoint = own.toWorld(-glm::dvec3(own.centre));
    return sim::buildLattice(*heart, request);
}

} // namespace

Status benchLod(const Options& options, Report& report) {
    SEROSA_ASSIGN(sim::Lattice own, heartLattice(kNodes));
    SEROSA_ASSIGN(sim::Lattice twice, coarser(own, 2));
    SEROSA_ASSIGN(sim::Lattice four, coarser(own, 4));
    const Block blocks[] = {{std::move(own), 5000}, {std::move(twice), 5000}, {std::move(four), 5000}};
    const char* const names[] = {"step, h", "step, 2h", "step, 4h"};
    std::unique_ptr<sim::Solver> solvers[3];
    Rounds rounds;
    for (std::size_t i = 0; i < 3; ++i) {
        SEROSA_ASSIGN(solvers[i], fragmentSolver(blocks[i]));
        addSolver(rounds, names[i], *solvers[i]);
    }
    const sim::StateTextures& state = *solvers[0]->textures();
    SEROSA_ASSIGN(sim::LodPass pass, sim::LodPass::create(blocks[0].setup, state.layout(), blocks[1].setup,
                                                          solvers[1]->textures()->layout()));
    rounds.add("switch, h to 2h", [&](int repeats) {
        for (int i = 0; i < repeats; ++i)
            pass.toCoarser(state, *solvers[1]->replaceState(0), 0);
        glFinish();
    });
    rounds.add("switch, 2h to h", [&](int repeats) {
        for (int i = 0; i < repeats; ++i)
            pass.toFiner(*solvers[1]->textures(), *solvers[0]->replaceState(0), 0);
        glFinish();
    });
    SEROSA_ASSIGN(sim::NodeTree tree, sim::NodeTree::create(blocks[0].lattice, state.layout()));
    tree.refit(state);
    rounds.add("refit of the tree", [&](int repeats) {
        for (int i = 0; i < repeats; ++i)
            tree.refit(state);
        glFinish();
    });
    const glm::dvec3 eye = blocks[0].lattice.toWorld({0, 0, 200});
    rounds.add("picking, with its answer", [&](int repeats) {
        for (int i = 0; i < repeats; ++i)
            static_cast<void>(tree.pick(state, eye, {0, 0, -1}));
    });
    std::mt19937 random(1);
    std::vector<sim::NodeTree::Ray> rays;
    const auto number = [&random] { return 40.0 * double(random()) / 4294967296.0 - 20; };
    for (int i = 0; i < kRays; ++i) {
        const double x = number(), y = number();
        rays.push_back({{x, y, 100}, {0, 0, -1}, 1e6});
    }
    rounds.add("4096 rays, with their answers", [&](int repeats) {
        for (int i = 0; i < repeats; ++i)
            static_cast<void>(tree.cast(state, rays));
    });
    rounds.measure(options.rounds, options.seconds);

    report.heading("Level of detail and the tree of boxes, heart");
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < 3; ++i)
        rows.push_back({names[i], std::to_string(blocks[i].lattice.nodeCount()),
                        figure(rounds.milliseconds(names[i])), figure(rounds.ratio(names[i], names[0]))});
    for (const char* name : {"switch, h to 2h", "switch, 2h to h", "refit of the tree",
                             "picking, with its answer", "4096 rays, with their answers"})
        rows.push_back({name, "", figure(rounds.milliseconds(name)), figure(rounds.ratio(name, names[0]))});
    report.table({"what", "nodes", "ms", "of a step at h"}, rows);
    report.line("\nThe tree holds " + std::to_string(blocks[0].lattice.boundary.size()) +
                " triangles. A step of a coarser level is longer, too: by the spacing, so that a frame costs "
                "as much less again.");
    report.ratio("tree_refit_over_step", rounds.ratio("refit of the tree", names[0]));
    report.ratio("step_2h_over_h", rounds.ratio(names[1], names[0]));
    report.ratio("step_4h_over_h", rounds.ratio(names[2], names[0]));
    return {};
}

} // namespace serosa::bench
