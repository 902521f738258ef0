// The CPU solver on all cores beside the fragment solver, the processor's multiply-add peak and Bullet's soft
// body.

#include "bench/bullet_body.h"
#include "bench/cases.h"
#include "bench/fma_peak.h"
#include "sim/cpu_solver.h"

#include <hwy/highway.h>

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

/// The same solver on vectors half as wide, where this processor has AVX-512; null where it has not. llvmpipe
/// and the machine that the targets come from take 256 bits.
std::unique_ptr<sim::Solver> cpuSolverWithAvx2(const sim::SolverSetup& setup) {
#if HWY_ARCH_X86
    const std::int64_t all = hwy::SupportedTargets(), upToAvx2 = all & ~(std::int64_t(HWY_AVX2) - 1);
    if (upToAvx2 == all || (all & HWY_AVX2) == 0)
        return nullptr;
    hwy::SetSupportedTargetsForTest(upToAvx2);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    std::unique_ptr<sim::Solver> solver = sim::makeCpuSolver(setup, {0, true}); // keeps its kernel
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return solver;
#else
    (void)setup;
    return nullptr;
#endif
}

/// With normals in every step, as the CPU solvers beside it.
Result<std::unique_ptr<sim::Solver>> fragmentWithNormals(const Block& block) {
    sim::FragmentOptions options;
    options.normalsEveryStep = true;
    return fragmentSolver(block, options);
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
/// \param lattice "dense20k" and the like, of the ratios' names
Status benchBlock(const std::string& title, const std::string& lattice, const Block& block,
                  const Options& options, Report& report) {
    SEROSA_ASSIGN(const std::unique_ptr<sim::Solver> fragment, fragmentWithNormals(block));
    SEROSA_ASSIGN(const std::unique_ptr<sim::Solver> fragmentLast, fragmentSolver(block));
    const auto cpu = sim::makeCpuSolver(block.setup, {0, true}),
               one = sim::makeCpuSolver(block.setup, {1, true}), last = sim::makeCpuSolver(block.setup),
               narrow = cpuSolverWithAvx2(block.setup);
    std::vector<std::pair<std::string, sim::Solver*>> solvers{
        {"fragment", fragment.get()},
        {"fragment, normals in the last step only", fragmentLast.get()},
        {"cpu", cpu.get()},
        {"cpu, one thread", one.get()},
        {"cpu, normals in the last step only", last.get()}};
    if (narrow)
        solvers.emplace_back("cpu, AVX2", narrow.get());
    Rounds rounds;
    for (const auto& [name, solver] : solvers)
        addSolver(rounds, name, *solver);
    rounds.measure(options.rounds, options.seconds);
    report.heading("CPU solver (" + std::string(sim::cpuSolverTarget()) + "), " + title);
    std::vector<std::vector<std::string>> rows;
    for (const auto& [name, solver] : solvers)
        rows.push_back({name, figure(rounds.milliseconds(name)), figure(rounds.ratio(name, "cpu"))});
    report.table({"solver", "ms a step", "over cpu"}, rows);
    report.ratio("fragment_over_cpu_" + lattice, rounds.ratio("fragment", "cpu"));
    if (narrow)
        report.ratio("fragment_over_cpu_avx2_" + lattice, rounds.ratio("fragment", "cpu, AVX2"));
    return checkAgreement(block, report);
}

/// Plain springs, without damping: share of the peak, and Bullet.
Status benchPlainSprings(const Options& options, Report& report) {
    Block block(denseLattice(27), kYoung);
    block.setup.tissue.dampingTime = 0;
    SEROSA_ASSIGN(const std::unique_ptr<sim::Solver> fragment, fragmentWithNormals(block));
    const auto cpu = sim::makeCpuSolver(block.setup, {0, true}), narrow = cpuSolverWithAvx2(block.setup);
    BulletBody bullet(block.setup);
    Rounds rounds;
    addSolver(rounds, "fragment", *fragment);
    addSolver(rounds, "cpu", *cpu);
    if (narrow)
        addSolver(rounds, "cpu, AVX2", *narrow);
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
    std::vector<std::string> names{"cpu", "fragment", "Bullet"};
    if (narrow)
        names.insert(names.begin() + 1, "cpu, AVX2");
    for (const std::string& name : names)
        rows.push_back({name, figure(rounds.milliseconds(name)), figure(rounds.ratio(name, "cpu"))});
    report.table({"without damping, with normals (Bullet has none)", "ms a step", "over cpu"}, rows);
    const Spread turn = rounds.milliseconds("multiply-adds");
    report.line("\nMultiply-add peak in the same rounds: " + figure(peakFlops / turn.median * 1e-6) +
                " GFLOP/s on " + std::to_string(std::thread::hardware_concurrency()) + " cores, " +
                sim::cpuSolverTarget() + "; the CPU solver does " +
                figure(flops / rounds.milliseconds("cpu").median * 1e-6) + ".");
    report.ratio("cpu_share_of_fma_peak", share);
    report.ratio("bullet_over_cpu", rounds.ratio("Bullet", "cpu"));
    if (narrow)
        report.ratio("bullet_over_cpu_avx2", rounds.ratio("Bullet", "cpu, AVX2"));
    report.ratio("bullet_over_fragment", rounds.ratio("Bullet", "fragment"));
    return {};
}

} // namespace

Status benchCpu(const Options& options, Report& report) {
    SEROSA_TRY(benchPlainSprings(options, report));
    {
        const Block dense(denseLattice(27), kYoung);
        SEROSA_TRY(benchBlock("dense block of 27^3 = 19,683 nodes", "dense20k", dense, options, report));
    }
    {
        SEROSA_ASSIGN(sim::Lattice lattice, heartLattice(20000));
        const Block sparse(std::move(lattice), kYoung);
        const std::string title = "heart phantom, " + std::to_string(sparse.lattice.nodeCount()) + " nodes";
        SEROSA_TRY(benchBlock(title, "sparse20k", sparse, options, report));
    }
    if (options.largest < 1000000)
        return {};
    const Block large(denseLattice(100), kYoung);
    return benchBlock("dense block of 100^3 nodes", "dense1m", large, options, report);
}

} // namespace serosa::bench
