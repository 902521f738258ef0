// Group `cuts`: random strokes through a heart on the CPU and the GPU, and a beam cut in two. That no spring
// is left across a blade is checked by another method than the one that cuts: the quadratic equation of a
// line and a bilinear patch, in long double.
#include "app/verify/cuts.h"

#include "models/phantom.h"
#include "shaders/shared_constants.h"
#include "sim/cut_list.h"
#include "sim/pieces.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace serosa::app {

namespace {

using sim::Lattice;
using sim::LatticeState;
using sim::Solver;
using sim::SolverSetup;
using sim::Stroke;

constexpr std::size_t kHeartFaces = 12000; // its fewest, and enough for the lattice

Lattice beam() {
    std::vector<sim::LatticeCell> cells;
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 16; ++x)
                cells.push_back({{x, y, z}, 255});
    return sim::latticeFromCells(cells, 0.003, glm::dvec3(0));
}

SolverSetup setupOf(const Lattice& lattice) {
    SolverSetup setup;
    setup.lattice = &lattice;
    setup.tissue.dampingTime = 0;
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1).timeStep;
    return setup;
}

double number(std::mt19937& random, double low, double high) {
    return low + (high - low) * double(random()) / 4294967296.0;
}

/// Mostly twisted; every fourth has its corners on nodes, every eighth is a ball.
Stroke randomStroke(const Lattice& lattice, std::mt19937& random) {
    const glm::dvec3 half = 0.5 * glm::dvec3(lattice.nodeDims);
    const double reach = 0.2 * std::max({half.x, half.y, half.z});
    const bool onNodes = random() % 4 == 0, ball = random() % 8 == 0;
    const double x = number(random, -half.x, half.x), y = number(random, -half.y, half.y),
                 z = number(random, -half.z, half.z);
    const auto point = [&] {
        const double dx = number(random, -reach, reach), dy = number(random, -reach, reach),
                     dz = number(random, -reach, reach);
        const glm::dvec3 at(x + dx, y + dy, z + dz);
        return lattice.toWorld(onNodes ? glm::round(at) : at);
    };
    Stroke stroke;
    stroke.kind = ball ? sim::StrokeKind::cauterize : sim::StrokeKind::blade;
    stroke.radius = number(random, 0.2, 1.5) * lattice.spacing;
    for (glm::dvec3* end : {&stroke.from[0], &stroke.from[1], &stroke.to[0], &stroke.to[1]})
        *end = point();
    return stroke;
}

using Real = long double;
using Vec = glm::tvec3<Real>;

/// Does the open segment pq pass through the inside of the patch? By the roots of (p q A(v)) x B(v) = 0.
bool passesThrough(const sim::LatticeStroke& stroke, const glm::vec3& from, const glm::vec3& to) {
    const Vec p(from), d = Vec(to) - p, a0 = Vec(stroke.corners[0]) - p, b0 = Vec(stroke.corners[1]) - p,
                       a = Vec(stroke.corners[2]) - p - a0, b = Vec(stroke.corners[3]) - p - b0;
    const Real c2 = glm::dot(d, glm::cross(a, b)),
               c1 = glm::dot(d, glm::cross(a0, b)) + glm::dot(d, glm::cross(a, b0)),
               c0 = glm::dot(d, glm::cross(a0, b0));
    Real roots[2] = {-1, -1};
    const Real scale = std::abs(c0) + std::abs(c1) + std::abs(c2), disc = c1 * c1 - 4 * c2 * c0;
    if (std::abs(c2) < 1e-12L * scale) {
        roots[0] = -c0 / c1;
    } else if (disc >= 0) {
        const Real q = -(c1 + (c1 < 0 ? -1 : 1) * std::sqrt(disc)) / 2;
        roots[0] = q / c2;
        roots[1] = q != 0 ? c0 / q : roots[0];
    }
    constexpr Real kInside = 1e-6L; // nearer to an outline than this, either answer is right
    for (const Real v : roots) {
        if (!(v > kInside && v < 1 - kInside))
            continue;
        const Vec start = a0 + v * a, edge = b0 + v * b - start; // t d = start + u edge
        const Vec n = glm::cross(d, edge);
        const Real n2 = glm::dot(n, n);
        if (n2 < 1e-16L)
            continue;
        const Real t = glm::dot(glm::cross(start, edge), n) / n2, u = glm::dot(glm::cross(start, d), n) / n2;
        if (t > kInside && t < 1 - kInside && u > kInside && u < 1 - kInside)
            return true;
    }
    return false;
}

const std::vector<std::uint32_t>& connectionsOf(const Lattice& lattice, const LatticeState& state) {
    return state.connections.empty() ? lattice.connections : state.connections;
}

struct Findings {
    std::size_t unmatched = 0, decidedOtherwise = 0, leftAcross = 0, labelsDiffer = 0, moved = 0;
};

void inspect(const Lattice& lattice, const Stroke& stroke, const LatticeState& before,
             const LatticeState& after, Findings& findings) {
    const sim::LatticeStroke local = sim::toLattice(stroke, lattice);
    const auto& bits = connectionsOf(lattice, after);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        findings.moved += before.positions[node] != after.positions[node] ||
                          before.increments[node] != after.increments[node];
        for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
            if (!((bits[node] >> d) & 1u))
                continue;
            const auto other = std::size_t(lattice.neighbour(node, d));
            findings.unmatched += !((bits[other] >> (d ^ 1)) & 1u);
            if (stroke.kind == sim::StrokeKind::blade && d % 2 == 0)
                findings.leftAcross +=
                    passesThrough(local, glm::vec3(after.positions[node]), glm::vec3(after.positions[other]));
        }
    }
}

glm::dvec3 momentum(const Lattice& lattice, const LatticeState& state) {
    glm::dvec3 sum(0);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        sum += lattice.massShare(node) * state.increments[node];
    return sum;
}

Status heartStrokes(const VerifyOptions& options, CheckList& checks) {
    const int strokes = options.full ? 1000 : 120;
    SEROSA_ASSIGN(const Lattice lattice,
                  models::phantomLattice("heart", kHeartFaces, options.full ? 20000 : 3000));
    const SolverSetup setup = setupOf(lattice);
    SEROSA_ASSIGN(const std::unique_ptr<Solver> gpu, sim::makeFragmentSolver(setup));
    // Stroke after stroke on the moving organ; the CPU decides again from what the GPU had.
    LatticeState state = sim::restState(lattice);
    std::mt19937 random(41);
    for (glm::dvec3& u : state.increments)
        u = glm::dvec3(glm::vec3(1e-3f * float(number(random, -1, 1)), 2e-3f, 0));
    gpu->setState(state);
    const glm::dvec3 first = momentum(lattice, state);
    sim::CutList list;
    Findings findings;
    for (int i = 0; i < strokes; ++i) {
        const LatticeState before = gpu->state();
        const Stroke stroke = randomStroke(lattice, random);
        SEROSA_TRY(list.cut(*gpu, before.step, stroke));
        const LatticeState after = gpu->state();
        std::vector<std::uint32_t> expected = connectionsOf(lattice, before);
        sim::cutConnections(lattice, before.positions, sim::toLattice(stroke, lattice), expected);
        const auto& got = connectionsOf(lattice, after);
        for (std::size_t node = 0; node < expected.size(); ++node)
            findings.decidedOtherwise += expected[node] != got[node];
        inspect(lattice, stroke, before, after, findings);
        if (i % 10 == 9) {
            SEROSA_ASSIGN(const std::vector<std::uint32_t> labels, gpu->pieces());
            const std::vector<std::uint32_t> flooded = sim::pieceLabels(lattice, got);
            for (std::size_t node = 0; node < labels.size(); ++node)
                findings.labelsDiffer += labels[node] != flooded[node];
            gpu->advance(3);
        }
    }
    const LatticeState last = gpu->state();
    const std::string of = std::to_string(strokes) + " strokes through a heart: ";
    checks.atLeast(of + "springs cut", double(sim::springsCut(lattice, connectionsOf(lattice, last))), 500,
                   "");
    checks.equalAbs(of + "bits without their other end", double(findings.unmatched), 0, 0, "");
    checks.equalAbs(of + "nodes that CPU and GPU decide otherwise", double(findings.decidedOtherwise), 0, 0,
                    "");
    checks.equalAbs(of + "springs left across a blade", double(findings.leftAcross), 0, 0, "");
    checks.equalAbs(of + "nodes moved by cutting", double(findings.moved), 0, 0, "");
    checks.equalAbs(of + "labels of pieces that differ, GPU and flood fill", double(findings.labelsDiffer), 0,
                    0, "");
    checks.equalAbs(of + "drift of momentum, float32",
                    glm::length(momentum(lattice, last) - first) / glm::length(first), 0, 1e-4, "");
    while (list.undo(*gpu)) {
    }
    checks.equalAbs("undo of every stroke: nodes whose bits are not the first ones",
                    gpu->state().connections.empty() ? 0 : 1, 0, 0, "");
    return {};
}

Status severedBeam(CheckList& checks) {
    const Lattice lattice = beam();
    SolverSetup setup = setupOf(lattice);
    setup.gravity = {0, -9.81, 0};
    for (const glm::ivec3& node : lattice.nodes)
        setup.fixed.push_back(node.x == 0);
    Stroke stroke;
    stroke.from = {lattice.toWorld({0.4, 9, -9}), lattice.toWorld({0.7, 9, 9})};
    stroke.to = {lattice.toWorld({0.3, -9, -9}), lattice.toWorld({0.6, -9, 9})};
    for (const bool onGpu : {false, true}) {
        std::unique_ptr<Solver> solver = onGpu ? nullptr : sim::makeReferenceSolver(setup);
        if (onGpu) {
            SEROSA_ASSIGN(solver, sim::makeFragmentSolver(setup));
        }
        SEROSA_TRY(solver->cut(stroke));
        SEROSA_ASSIGN(const std::vector<std::uint32_t> labels, solver->pieces());
        const int steps = 500;
        solver->advance(steps);
        const LatticeState after = solver->state();
        const double path =
            9.81 * setup.timeStep * setup.timeStep / lattice.spacing * steps * (steps + 1) / 2;
        double worst = 0;
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            if (lattice.restPosition(node).x > 0.5)
                worst = std::max(worst, glm::length(after.positions[node] - lattice.restPosition(node) +
                                                    glm::dvec3(0, path, 0)));
        const std::string which = std::string(", ") + solver->name();
        checks.equalAbs("a beam cut in two: pieces" + which, double(sim::countPieces(labels).pieces), 2, 0,
                        "");
        checks.equalAbs("its free half falls freely, share of the path" + which, worst / path, 0, 1e-5, "");
    }
    return {};
}

} // namespace

Status verifyCuts(const VerifyOptions& options, CheckList& checks) {
    SEROSA_TRY(heartStrokes(options, checks));
    SEROSA_TRY(severedBeam(checks));
    return verifyAgreement(options, checks);
}

} // namespace serosa::app
