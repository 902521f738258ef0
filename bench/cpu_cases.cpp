// The CPU solver on all cores beside the fragment solver, the processor's multiply-add peak and Bullet's soft
// body.

#include "bench/bullet_body.h"
#include "bench/cases.h"
#include "bench/fma_peak.h"
#include "gpu/gl.h"
#include "sim/cpu_solver.h"

#include <algorithm>
#include <bit>
#include <thread>

namespace serosa::bench {

namespace {

constexpr double kYoung = 3000; // Pa

// Floating-point operations of the law without damping, with normals: a spring counts 23 (difference 3,
// squared length 5, reciprocal root 5, force 9, its share of the normal 1), the rest of a node 26. What a
// spring needs beyond that (most of the normals, the guard against length 0) is not counted: the share is a
// lower bound.
constexpr double kFlopsOfSpring = 23, kFlopsOfNode = 26;

Spread scaled(Spread spread, double factor) {
    spread.median *= factor;
    spread.min *= factor;
    spread.max *= factor;
    return spread;
}

void addSolver(Rounds& rounds, const std::string& name, sim::Solver& solver, bool onGpu) {
    rounds.add(name, [&solver, onGpu](int repeats) {
        solver.advance(repeats);
        if (onGpu)
            glFinish();
    });
}

/// The times mean something only if both do the same: 100 steps of the same sagging body.
Status checkAgreement(const Block& block, Report& report) {
    const auto cpu = sim::makeCpuSolver(block.setup);
    SEROSA_ASSIGN(const std::unique_ptr<sim::Solver> fragment, fragmentSolver(block));
    cpu->advance(100);
    fragment->advance(100);
    const sim::LatticeState a = cpu->state(), b = fragment->state();
    double apart = 0;
    for (std::size_t i = 0; i < a.positions.size(); ++i)
        apart = std::max(apart, glm::distance(a.positions[i], b.positions[i]));
    report.line("\nAfter 100 steps the CPU and the fragment solver differ by at most " + figure(apart) +
                " h.");
    if (!(apart <= 1e-3))
        return Error{"bench: the CPU and the fragment solver differ by " + figure(apart) +
                         " h after 100 steps: their times cannot be compared",
                     exitCheckFailed};
    return {};
}

/// fragment / cpu with everything that a run has: damping, and normals in every step of both.
Status benchBlock(const std::string& title, const char* ratio, const Block& block, const Options& options,
                  Report& report) {
    SEROSA_ASSIGN(const std::unique_ptr<sim::Solver> fragment, fragmentSolver(block));
    const auto cpu = sim::makeCpuSolver(block.setup, {0, true}),
               one = sim::makeCpuSolver(block.setup, {1, true}), last = sim::makeCpuSolver(block.setup);
    Rounds rounds;
    addSolver(rounds, "fragment", *fragment, true);
    addSolver(rounds, "cpu", *cpu, false);
    addSolver(rounds, "cpu, one thread", *one, false);
    addSolver(rounds, "cpu, normals in the last step only", *last, false);
    rounds.measure(options.rounds, options.seconds);
    report.heading("CPU solver (" + std::string(sim::cpuSolverTarget()) + "), " + title);
    std::vector<std::vector<std::string>> rows;
    for (const char* name : {"fragment", "cpu", "cpu, one thread", "cpu, normals in the last step only"})
        rows.push_back({name, figure(rounds.milliseconds(name)), figure(rounds.ratio(name, "cpu"))});
    report.table({"solver", "ms a step", "over cpu"}, rows);
    report.ratio(ratio, rounds.ratio("fragment", "cpu"));
    return checkAgreement(block, report);
}

/// Plain springs, without damping: share of the peak, and Bullet.
Status benchPlainSprings(const Options& options, Report& report) {
    Block block(denseLattice(27), kYoung);
    block.setup.tissue.dampingTime = 0;
    SEROSA_ASSIGN(const std::unique_ptr<sim::Solver> fragment, fragmentSolver(block));
    const auto cpu = sim::makeCpuSolver(block.setup, {0, true});
    BulletBody bullet(block.setup);
    Rounds rounds;
    addSolver(rounds, "fragment", *fragment, true);
    addSolver(rounds, "cpu", *cpu, false);
    rounds.add("multiply-adds", [](int repeats) { runMultiplyAdds(repeats); });
    rounds.add("Bullet", [&bullet](int repeats) { bullet.advance(repeats); });
    rounds.measure(options.rounds, options.seconds);
    if (!(bullet.largestMovement() > 0))
        return Error{"bench: Bullet's body does not move", exitCheckFailed};

    std::size_t springs = 0;
    for (std::size_t node = 0; node < block.lattice.nodeCount(); ++node)
        springs += std::size_t(std::popcount(block.lattice.connections[node]));
    const double flops = kFlopsOfSpring * double(springs) + kFlopsOfNode * double(block.lattice.nodeCount());
    const double peakFlops = double(flopsOfMultiplyAdds());
    const Spread share = scaled(rounds.ratio("multiply-adds", "cpu"), flops / peakFlops);
    report.heading("Plain springs, dense block of 27^3 = 19,683 nodes, " + std::to_string(bullet.links()) +
                   " springs");
    std::vector<std::vector<std::string>> rows;
    for (const char* name : {"cpu", "fragment", "Bullet"})
        rows.push_back({name, figure(rounds.milliseconds(name)), figure(rounds.ratio(name, "cpu"))});
    report.table({"without damping, with normals (Bullet has none)", "ms a step", "over cpu"}, rows);
    const Spread turn = rounds.milliseconds("multiply-adds");
    report.line("\nMultiply-add peak in the same rounds: " + figure(peakFlops / turn.median * 1e-6) +
                " GFLOP/s on " + std::to_string(std::thread::hardware_concurrency()) + " cores, " +
                sim::cpuSolverTarget() + "; the CPU solver does " +
                figure(flops / rounds.milliseconds("cpu").median * 1e-6) + ".");
    report.ratio("cpu_share_of_fma_peak", share);
    report.ratio("bullet_over_cpu", rounds.ratio("Bullet", "cpu"));
    report.ratio("bullet_over_fragment", rounds.ratio("Bullet", "fragment"));
    return {};
}

} // namespace

Status benchCpu(const Options& options, Report& report) {
    SEROSA_TRY(benchPlainSprings(options, report));
    {
        const Block dense(denseLattice(27), kYoung);
        SEROSA_TRY(benchBlock("dense block of 27^3 = 19,683 nodes", "fragment_over_cpu_dense20k", dense,
                              options, report));
    }
    {
        SEROSA_ASSIGN(const sim::TriangleMesh* heart, heartSurface());
        SEROSA_ASSIGN(sim::Lattice lattice, sim::buildLattice(*heart, {}));
        const Block sparse(std::move(lattice), kYoung);
        const std::string title = "heart phantom, " + std::to_string(sparse.lattice.nodeCount()) + " nodes";
        SEROSA_TRY(benchBlock(title, "fragment_over_cpu_sparse20k", sparse, options, report));
    }
    if (options.largest < 1000000)
        return {};
    const Block large(denseLattice(100), kYoung);
    return benchBlock("dense block of 100^3 nodes", "fragment_over_cpu_dense1m", large, options, report);
}

} // namespace serosa::bench
