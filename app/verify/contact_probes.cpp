// Part of group `contact`: probes of 0.5 mm to three spacings come at 1 m/s at a sheet one cell thick, from
// random directions at random places. None may pass, nor come into it: the segment from the probe's centre
// back to where it came from never crosses either face of the sheet an odd number of times. (A surface
// halfway between the faces is no witness: where a thin tip crushes a column of cells until its far end is
// the nearer one, the tip can lie beyond the column's middle and yet outside of both faces.)
#include "app/organ_setup.h"
#include "app/solver_choice.h"
#include "app/verify/contact_pieces.h"
#include "app/verify/random_scenario.h"
#include "sim/cpu_solver.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace serosa::app {

namespace {

constexpr double kSpacing = 0.003, kSpeed = 1, kFrameTime = 1.0 / 60; // m, m/s, s
constexpr double kThinnest = 0.0005;                                  // radius of a probe, m
constexpr int kSide = 16;                                             // cells
constexpr std::uint32_t kFirstSeed = 5000;

/// Held at its rim.
std::unique_ptr<ContactPiece> makeSheet() {
    sim::Tissue tissue;
    tissue.dampingTime = 0.001;
    auto sheet = std::make_unique<ContactPiece>(glm::ivec3(kSide, 1, kSide), kSpacing,
                                                glm::dvec3(-0.5 * kSide, 0, -0.5 * kSide) * kSpacing, tissue);
    for (const glm::ivec3& node : sheet->lattice.nodes)
        sheet->setup.fixed.push_back(node.x == 0 || node.x == kSide || node.z == 0 || node.z == kSide);
    return sheet;
}

/// Does the segment from a to b cross the triangle?
bool crosses(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& p, const glm::dvec3& q,
             const glm::dvec3& r) {
    const auto volume = [](const glm::dvec3& u, const glm::dvec3& v, const glm::dvec3& w) {
        return glm::dot(glm::cross(u, v), w);
    };
    const double atA = volume(q - p, r - p, a - p), atB = volume(q - p, r - p, b - p);
    if ((atA > 0) == (atB > 0))
        return false;
    const glm::dvec3 d = b - a;
    const bool first = volume(p - a, q - a, d) > 0, second = volume(q - a, r - a, d) > 0,
               third = volume(r - a, p - a, d) > 0;
    return first == second && second == third;
}

/// Is one of the sheet's faces between the two points, an odd number of times?
bool enters(const sim::Lattice& lattice, const sim::LatticeState& state, const glm::dvec3& a,
            const glm::dvec3& b) {
    for (int face = 0; face < 2; ++face) {
        const auto at = [&](int x, int z) {
            return state.positions[std::size_t(lattice.nodeAt({x, face, z}))];
        };
        int crossings = 0;
        for (int z = 0; z < kSide; ++z)
            for (int x = 0; x < kSide; ++x) { // cut as the lattice's boundary is
                const glm::dvec3 p = at(x, z), q = at(x + 1, z), r = at(x, z + 1), s = at(x + 1, z + 1);
                crossings += crosses(a, b, p, q, s);
                crossings += crosses(a, b, p, s, r);
            }
        if (crossings % 2 == 1)
            return true;
    }
    return false;
}

struct Approach {
    bool touched = false, passed = false, finite = true;
    std::string words;
    Status status;
};

Approach approach(std::uint32_t seed, sim::StepMethod method, const std::string& name) {
    Random random(seed);
    const std::unique_ptr<ContactPiece> sheet = makeSheet();
    Approach result;
    sim::Tool probe;
    probe.name = "probe";
    probe.radius = random.logNumber(kThinnest, 3 * kSpacing);
    glm::dvec3 direction = random.direction();
    while (direction.y > -0.5) // within 60 degrees
        direction = random.direction();
    const double middle = 0.2 * kSide * kSpacing;
    const glm::dvec3 aim{random.number(-middle, middle), 0.5 * kSpacing, random.number(-middle, middle)};
    // Clear of the sheet for more than a frame; deeper by four spacings than where it would be through.
    const double before = (probe.radius + 2 * kSpacing) / 0.5 + 1.2 * kSpeed * kFrameTime,
                 beyond = probe.radius + 4 * kSpacing;
    const glm::dvec3 start = aim - before * direction, end = aim + beyond * direction;
    const double seconds = (before + beyond) / kSpeed;
    probe.friction = random.chance(0.5) ? 0.5 : 0;
    if (random.chance(0.3)) { // a rod behind the tip, as wide
        probe.shape.kind = sim::ShapeKind::capsule;
        probe.shape.length = 0.05;
        const glm::dquat turn(glm::dvec3(0, 0, 1), -direction);
        probe.keys = {{0, start, turn}, {seconds, end, turn}};
    } else {
        probe.keys = {{0, start}, {seconds, end}};
    }
    sheet->setup.tools = {probe};
    sheet->setup.method = method;
    if (method == sim::StepMethod::implicit)
        sheet->setup.timeStep = kFrameTime;
    result.words = "seed " + std::to_string(seed) + ", radius " + shortNumber(1e3 * probe.radius) + " mm";
    std::unique_ptr<sim::Solver> solver;
    if (name == "cpu") {
        sim::CpuOptions one;
        one.threads = 1;
        solver = sim::makeCpuSolver(sheet->setup, one);
    } else {
        Result<std::unique_ptr<sim::Solver>> made = makeSolver(name, sheet->setup);
        if (!made.ok()) {
            result.status = made.error();
            return result;
        }
        solver = std::move(*made);
    }
    const double dt = sheet->setup.timeStep;
    const int steps = int(std::ceil(seconds / dt)) + (method == sim::StepMethod::implicit ? 2 : 20);
    for (int step = 1; step <= steps; ++step) {
        solver->advance(1);
        const sim::LatticeState state = solver->state();
        for (const glm::dvec3& x : state.positions)
            result.finite = result.finite && std::isfinite(x.x + x.y + x.z);
        const glm::dvec3 tip = sheet->lattice.toLattice(probe.centreAt(step * dt));
        result.passed = result.passed || enters(sheet->lattice, state, tip, sheet->lattice.toLattice(start));
    }
    result.touched = glm::length(solver->takeLoads()[0].impulse) > 0;
    return result;
}

Status approaches(sim::StepMethod method, const std::string& name, std::uint32_t count, CheckList& checks) {
    std::vector<Approach> results(count);
    if (name == "cpu" || name == "reference")
        tbb::parallel_for(std::uint32_t(0), count,
                          [&](std::uint32_t i) { results[i] = approach(kFirstSeed + i, method, name); });
    else
        for (std::uint32_t i = 0; i < count; ++i)
            results[i] = approach(kFirstSeed + i, method, name);
    double passed = 0, touched = 0, notFinite = 0;
    std::string which;
    for (const Approach& result : results) {
        SEROSA_TRY(result.status);
        touched += result.touched;
        notFinite += !result.finite;
        passed += result.passed;
        if (result.passed && which.size() < 200)
            which += (which.empty() ? " (" : "; ") + result.words;
    }
    which += which.empty() ? "" : ")";
    const std::string of = std::to_string(count) + " probes from " + shortNumber(1e3 * kThinnest) +
                           " mm radius at 1 m/s against a sheet one cell thick, " +
                           (method == sim::StepMethod::implicit ? "steps of 16.7 ms, " : "explicit steps, ") +
                           name + ": ";
    checks.equalAbs(of + "came in" + which, passed, 0, 0, "");
    checks.equalAbs(of + "touched", touched, count, 0, "");
    checks.equalAbs(of + "states that are not finite", notFinite, 0, 0, "");
    return {};
}

} // namespace

Status verifyProbes(const VerifyOptions& options, CheckList& checks) {
    for (const sim::StepMethod method : {sim::StepMethod::explicitSteps, sim::StepMethod::implicit}) {
        std::vector<std::string> names = comparedSolvers(options);
        names.push_back("reference");
        for (const std::string& name : names) {
            const bool many = name == "cpu";
            // A step of a whole frame is hundreds of passes: software GL takes few of them.
            const bool slow = method == sim::StepMethod::implicit && !many;
            const std::uint32_t count = options.full ? (many   ? 1000
                                                        : slow ? 20
                                                               : 100)
                                                     : (many   ? 60
                                                        : slow ? 2
                                                               : 6);
            SEROSA_TRY(approaches(method, name, count, checks));
        }
    }
    return {};
}

} // namespace serosa::app
