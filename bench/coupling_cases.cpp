// What organs that touch each other, or themselves, and threads cost: steps of a group (sim/organ_group.h)
// over steps of the same solvers without, in one interleaved table.

#include "app/solver_choice.h"
#include "bench/cases.h"
#include "gpu/gl.h"
#include "sim/organ_group.h"

#include <map>

namespace serosa::bench {

namespace {

constexpr double kYoung = 5000;
constexpr int kEdge = 20; // nodes along an edge of a block
constexpr int kSteps = 8; // a frame
constexpr int kSettle = 120;
constexpr const char* kSolvers[] = {"fragment", "compute", "cpu"};

enum class Coupled { none, apart, itself, touching, threads };

struct Row {
    const char* name;
    int organs;
    Coupled coupled;
};
// Each is compared with the first of its number of organs.
constexpr Row kRows[] = {{"one block", 1, Coupled::none},
                         {"one block, self-contact", 1, Coupled::itself},
                         {"two blocks", 2, Coupled::none},
                         {"two blocks, contact, 4 spacings apart", 2, Coupled::apart},
                         {"two blocks, contact, one lies on the other", 2, Coupled::touching},
                         {"two blocks, 16 threads", 2, Coupled::threads}};

struct Measured {
    std::vector<std::unique_ptr<Block>> blocks;
    std::map<std::string, std::vector<std::unique_ptr<sim::Solver>>> solvers;
    std::map<std::string, std::unique_ptr<sim::OrganGroup>> groups;
};

std::vector<sim::TiedThread> threadsBetween(const Measured& measured) {
    std::vector<sim::TiedThread> threads;
    const sim::Lattice &low = measured.blocks[0]->lattice, &high = measured.blocks[1]->lattice;
    for (int i = 0; i < 16; ++i) {
        const glm::dvec3 at(i % 4 - 1.5, 0.5 * (kEdge - 1), i / 4 - 1.5);
        sim::TiedThread tied;
        double outside = 0;
        tied.organs[1] = 1;
        tied.thread.length = low.spacing;
        tied.anchors[0] = sim::anchorAt(low, low.toWorld(at), outside);
        tied.anchors[1] = sim::anchorAt(high, high.toWorld(at - glm::dvec3(0, kEdge - 1, 0)), outside);
        threads.push_back(tied);
    }
    return threads;
}

Result<Measured> prepare(const Row& row) {
    Measured measured;
    for (int i = 0; i < row.organs; ++i) {
        sim::Lattice lattice = denseLattice(kEdge);
        const double gap = row.coupled == Coupled::apart ? 4 : 0;
        lattice.origin += i * (kEdge - 1 + gap) * lattice.spacing * glm::dvec3(0, 1, 0);
        measured.blocks.push_back(std::make_unique<Block>(std::move(lattice), kYoung));
        sim::SolverSetup& setup = measured.blocks.back()->setup;
        setup.tissue.airDrag = 10; // comes to rest
        if (i > 0 && row.coupled == Coupled::touching)
            setup.fixed.assign(setup.fixed.size(), false);
    }
    for (const char* name : kSolvers) {
        std::vector<sim::GroupMember> members;
        for (const auto& block : measured.blocks) {
            SEROSA_ASSIGN(auto solver, app::makeSolver(name, block->setup));
            const bool contact = row.coupled == Coupled::apart || row.coupled == Coupled::touching;
            members.push_back({solver.get(), contact, row.coupled == Coupled::itself});
            measured.solvers[name].push_back(std::move(solver));
        }
        if (row.coupled == Coupled::none)
            continue;
        sim::GroupSettings settings;
        if (row.coupled == Coupled::threads)
            settings.threads = threadsBetween(measured);
        SEROSA_ASSIGN(measured.groups[name], sim::OrganGroup::create(members, settings));
        measured.groups[name]->advance(kSettle);
    }
    return measured;
}

void playFrames(Measured& measured, const std::string& name, int frames) {
    for (int frame = 0; frame < frames; ++frame)
        if (const auto& group = measured.groups[name])
            group->advance(kSteps);
        else
            for (const auto& solver : measured.solvers[name])
                solver->advance(kSteps);
    if (measured.solvers[name].front()->textures())
        glFinish();
}

/// Of a share 1 - 1/x of a step that is x times as long.
std::string shareOf(const Spread& ratio) {
    return figure(Spread{1 - 1 / ratio.median, 1 - 1 / ratio.min, 1 - 1 / ratio.max, ratio.rounds});
}

} // namespace

Status benchCoupling(const Options& options, Report& report) {
    std::vector<Measured> measured;
    Rounds rounds;
    for (const Row& row : kRows) {
        SEROSA_ASSIGN(Measured one, prepare(row));
        measured.push_back(std::move(one));
    }
    for (std::size_t i = 0; i < measured.size(); ++i)
        for (const char* solver : kSolvers)
            rounds.add(std::string(solver) + kRows[i].name,
                       [&one = measured[i], solver](int repeats) { playFrames(one, solver, repeats); });
    rounds.measure(options.rounds, options.seconds);

    report.heading("Organs that touch: frames of " + std::to_string(kSteps) + " steps, blocks of " +
                   std::to_string(kEdge) + "^3 nodes");
    std::vector<std::string> columns = {""};
    for (const char* solver : kSolvers) {
        columns.push_back(std::string(solver) + ", ms a frame");
        columns.push_back("share of a step");
    }
    std::vector<std::vector<std::string>> table;
    for (const Row& row : kRows) {
        table.push_back({row.name});
        for (const char* solver : kSolvers) {
            table.back().push_back(figure(rounds.milliseconds(std::string(solver) + row.name).median));
            const std::string base = std::string(solver) + kRows[row.organs == 1 ? 0 : 2].name;
            table.back().push_back(row.coupled == Coupled::none
                                       ? "-"
                                       : shareOf(rounds.ratio(std::string(solver) + row.name, base)));
        }
    }
    report.table(columns, table);
    return {};
}

} // namespace serosa::bench
