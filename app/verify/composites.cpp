// Part of group `materials`: beams of two materials side by side and one behind the other against the closed
// forms (Voigt, Reuss), fibres, and tissue that stiffens under tension against its curve, by real solvers at
// rest.
#include "app/organ_setup.h"
#include "app/verify/elastic_measures.h"
#include "app/verify/lattice_statics.h"
#include "app/verify/material_checks.h"
#include "sim/tissue_field.h"

#include <cmath>

namespace serosa::app {

namespace {

constexpr double kSpacing = 0.003; // m
constexpr double kSecond = 4;      // Young's modulus of the second material over that of the first

/// A beam whose cells with a centre beyond the middle, along `axis` of the beam, are of material 1.
Beam twoMaterials(int axis, double thickness, double length, const glm::dmat3& turn) {
    Beam beam = makeBeam(thickness, length, turn, kSpacing);
    for (sim::LatticeCell& cell : beam.lattice.cells) {
        const glm::dvec3 centre = glm::dvec3(cell.grid - beam.lattice.centre) + 0.5;
        cell.material = (glm::transpose(turn) * (centre - beam.middle))[axis] > 0 ? 1 : 0;
    }
    return beam;
}

/// Share of material 1 in the volume, and the area of the section that the cells have.
struct Content {
    double second = 0, area = 0;
};
Content contentOf(const Beam& beam) {
    double all = 0, second = 0;
    for (const sim::LatticeCell& cell : beam.lattice.cells) {
        all += cell.fill / 255.0;
        second += cell.material == 1 ? cell.fill / 255.0 : 0;
    }
    return {second / all, all / beam.length};
}

/// Young's modulus between the ends over that of material 0. The nodes of the end sections, a spacing and a
/// half deep, are moved along the axis as if strained evenly; between them the stretch is known, the lateral
/// motion free.
double modulusBetweenEnds(const Beam& beam, const sim::Tissue& tissue) {
    const sim::Lattice& lattice = beam.lattice;
    const auto along = [&](std::size_t node) {
        return glm::dot(beam.turn[2], lattice.restPosition(node) - beam.middle);
    };
    const double held = 0.5 * beam.length - 1.5, strain = 1e-3;
    LatticeProblem problem(lattice);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        if (std::abs(along(node)) >= held)
            problem.prescribe(node, beam.turn[2], strain * along(node));
    const Eigen::VectorXd moved = problem.solve(tissue), inner = latticeStiffness(lattice, tissue) * moved;
    double force = 0; // on the half beyond the middle
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        if (along(node) > 0)
            force += glm::dot(beam.turn[2], nodeVector(inner, node));
    return force / (contentOf(beam).area * strain) / (2 * (1 + tissue.poisson));
}

void composites(const VerifyOptions& options, CheckList& checks) {
    for (const std::uint32_t turn : {0u, 1u, 2u}) {
        if (turn > 1 && !options.full)
            continue;
        const glm::dmat3 rotation = turn == 0 ? glm::dmat3(1) : randomRotation(turn);
        const std::string name = turn == 0 ? "aligned" : "turn " + std::to_string(turn);
        for (const double poisson : {0.25, 0.45}) {
            sim::Tissue tissue = tissueOf(options, poisson);
            sim::Material second = tissue;
            second.young = kSecond * tissueOf({}, poisson).young; // the second one is not injected
            tissue.others = {second};
            const double ratio = kSecond;
            // Side by side: both are strained alike (Voigt). One behind the other: both carry the same stress
            // (Reuss), as far from their interface as the beam is thick.
            const double thickness = 10;
            for (const int axis : {0, 2}) {
                const Beam beam = twoMaterials(axis, thickness, axis == 0 ? 30 : 60, rotation);
                const double v = contentOf(beam).second;
                const double expected = axis == 0 ? 1 - v + v * ratio : 1 / (1 - v + v / ratio);
                checks.equalRel("two materials, " + std::string(axis == 0 ? "in parallel" : "in series") +
                                    ", " + name + ", " + nameOf(poisson) + ": modulus / closed form",
                                modulusBetweenEnds(beam, tissue) * tissue.young /
                                    (tissueOf({}, poisson).young * expected),
                                1, 0.03, "1");
            }
        }
    }
}

/// Tension of bars whose fibres run along them: the modulus that was asked for.
void fibres(const VerifyOptions& options, CheckList& checks) {
    for (const std::uint32_t turn : {0u, 1u, 2u, 3u}) {
        if (turn > 1 && !options.full)
            continue;
        const glm::dmat3 rotation = turn == 0 ? glm::dmat3(1) : randomRotation(turn);
        const Beam beam = makeBeam(10, 30, rotation, kSpacing);
        sim::Tissue tissue = tissueOf(options, 0.45);
        const double given = tissueOf({}, 0.45).young;
        tissue.fibre = rotation[2];
        tissue.fibreYoung = 3 * tissue.young;
        checks.equalRel("fibres along a beam, " + (turn == 0 ? "aligned" : "turn " + std::to_string(turn)) +
                            ": Young's modulus / given",
                        modulusBetweenEnds(beam, tissue) * tissue.young / (3 * given), 1, 0.03, "1");
    }
}

/// A bar of stiffening tissue is held at one end and pulled at the other, to rest, by forceps that hold its
/// last cells: nominal stress (force over the area at rest) against nominal strain of the middle third.
Status tension(const VerifyOptions& options, CheckList& checks, double poisson) {
    const Beam beam = makeBeam(5, 25, glm::dmat3(1), kSpacing);
    const sim::Lattice& lattice = beam.lattice;
    const double given = 3000; // Pa
    sim::SolverSetup setup;
    setup.lattice = &lattice;
    setup.tissue = tissueOf(options, poisson);
    setup.tissue.young = given * setup.tissue.young / tissueOf({}, poisson).young;
    const sim::Tissue expected = [&] {
        sim::Tissue tissue;
        tissue.young = given;
        tissue.poisson = poisson;
        tissue.curve = {{0.05, 150}, {0.1, 500}, {0.2, 2500}};
        return tissue;
    }();
    setup.tissue.curve = expected.curve;
    for (sim::CurvePoint& point : setup.tissue.curve)
        point.stress *= setup.tissue.young / given;
    setup.tissue.dampingTime = 0.002;
    setup.tissue.airDrag = 40; // the bar's slowest swing is over in a fraction of a second
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1).timeStep;
    const auto along = [&](std::size_t node) { return (lattice.restPosition(node) - beam.middle).z; };
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        setup.fixed.push_back(along(node) < -0.5 * beam.length + 1.5);
    const glm::dvec3 end = lattice.toWorld(beam.middle + glm::dvec3(0, 0, 0.5 * beam.length + 5.5));
    const double pause = 0.6, radius = 7.2 * kSpacing; // reaches the last sections of nodes
    sim::Tool forceps;
    forceps.name = "forceps";
    forceps.mode = sim::ToolMode::grasp;
    forceps.radius = radius;
    forceps.keys = {{0, end}};
    const std::vector<double> stretches = {0.035, 0.08, 0.125, 0.17}; // of the whole length
    for (std::size_t i = 0; i < stretches.size(); ++i) {
        const glm::dvec3 at = end + glm::dvec3(0, 0, stretches[i] * beam.length * kSpacing);
        forceps.keys.push_back({0.3 + double(i) * (0.3 + pause), at});
        forceps.keys.push_back({0.3 + double(i) * (0.3 + pause) + pause, at});
    }
    forceps.keys.push_back({100, forceps.keys.back().at});
    setup.tools = {forceps};
    SEROSA_ASSIGN(const std::unique_ptr<sim::Solver> solver, sim::makeFragmentSolver(setup));
    const double area = contentOf(beam).area * kSpacing * kSpacing;
    std::int64_t step = 0;
    for (std::size_t i = 0; i < stretches.size(); ++i) {
        if (!options.full && i % 2 == 0)
            continue; // on the way it is stretched all the same
        const auto restAt = std::int64_t(forceps.keys[2 * i + 2].time / setup.timeStep);
        const std::int64_t measured = 100;
        solver->advance(int(restAt - step - measured));
        solver->takeToolImpulses();
        solver->advance(int(measured));
        step = restAt;
        const double force = solver->takeToolImpulses().front().z / (double(measured) * setup.timeStep);
        const sim::LatticeState state = solver->state();
        double sums[2] = {0, 0}, masses[2] = {0, 0};
        const double third = std::floor(beam.length / 6) + 0.5; // sections of nodes
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            for (const int side : {0, 1})
                if (std::abs(along(node) - (side ? third : -third)) < 0.1) {
                    sums[side] += lattice.massShare(node) * state.positions[node].z;
                    masses[side] += lattice.massShare(node);
                }
        const double strain = (sums[1] / masses[1] - sums[0] / masses[0]) / (2 * third) - 1;
        double curve = 0; // Pa: straight between the points
        sim::CurvePoint before;
        for (const sim::CurvePoint& point : expected.curve) {
            if (strain > before.strain)
                curve = before.stress + (point.stress - before.stress) * (strain - before.strain) /
                                            (point.strain - before.strain);
            before = point;
        }
        checks.equalRel("bar of stiffening tissue, " + nameOf(poisson) + ", strain " + shortNumber(strain) +
                            ": stress / curve",
                        force / area / curve, 1, 0.05, "1");
    }
    return {};
}

} // namespace

Status verifyComposites(const VerifyOptions& options, CheckList& checks) {
    composites(options, checks);
    fibres(options, checks);
    for (const double poisson : {0.25, 0.45})
        if (poisson == 0.45 || options.full)
            SEROSA_TRY(tension(options, checks, poisson));
    return {};
}

} // namespace serosa::app
