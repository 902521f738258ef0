// Tissue of the CPU solver beyond plain springs, against the reference: the volumetric term, recovery,
// several materials, curves, strain limits, fibres, each alone and all at once.
#include "shaders/shared_constants.h"
#include "sim/cell_volumes.h"
#include "sim/cpu_solver.h"
#include "sim/tissue_field.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

using namespace serosa;
using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;
using sim::Tissue;

namespace {

struct Case {
    const char* name;
    std::function<void(Tissue&)> change;
};

void addMaterials(Tissue& tissue) {
    sim::Material stiff, soft;
    stiff.young = 3 * tissue.young;
    stiff.density = 1900;
    stiff.dampingTime = 0.0002;
    soft.young = 0.5 * tissue.young;
    soft.density = 800;
    soft.dampingTime = 0;
    tissue.others = {stiff, soft};
}

void addCurve(sim::Material& material) {
    material.curve = {
        {0.01, 0.01 * material.young}, {0.03, 0.07 * material.young}, {0.1, 0.5 * material.young}};
}

void addFibres(sim::Material& material) {
    material.fibre = {1, 0.4, 0.2};
    material.fibreYoung = 4 * material.young;
}

const std::vector<Case>& cases() {
    static const std::vector<Case> all = {
        {"nu 0.45", [](Tissue& t) { t.poisson = 0.45; }},
        {"nu 0.49", [](Tissue& t) { t.poisson = 0.49; }},
        {"recovery", [](Tissue& t) { t.recovery = true; }},
        {"three materials", addMaterials},
        {"three materials, two with a volumetric term",
         [](Tissue& t) {
             addMaterials(t);
             t.others[0].poisson = 0.45;
             t.others[1].poisson = 0.35;
         }},
        {"curve", [](Tissue& t) { addCurve(t); }},
        {"strain limit", [](Tissue& t) { t.strainLimit = 0.02; }},
        {"curve of one material among three",
         [](Tissue& t) {
             addMaterials(t);
             addCurve(t.others[1]);
         }},
        {"fibres", [](Tissue& t) { addFibres(t); }},
        {"everything",
         [](Tissue& t) {
             t.poisson = 0.4;
             t.recovery = true;
             addMaterials(t);
             t.others[0].poisson = 0.45;
             addCurve(t);
             addFibres(t.others[0]);
             t.others[1].strainLimit = 0.02;
             t.others[1].poisson = 0.48;
         }},
    };
    return all;
}

/// A bent body with random fills and holes, three materials in layers and spots, longer than a vector.
const Lattice& raggedOrgan() {
    static const Lattice organ = [] {
        std::vector<sim::LatticeCell> cells;
        std::mt19937 random(5);
        for (int z = 0; z < 9; ++z)
            for (int y = 0; y < 12; ++y)
                for (int x = 0; x < 40; ++x) {
                    const double bend = 2 * std::sin(0.16 * x);
                    const double r = glm::length((glm::dvec3(x, y - bend, z) - glm::dvec3(19.5, 5, 4)) /
                                                 glm::dvec3(20, 4, 4.5));
                    const bool hole = random() % 11 == 0;
                    const auto material = std::uint8_t(random() % 7 == 0 ? 1 : z > 4 ? 2 : 0);
                    if (r < 1 && !hole)
                        cells.push_back({{x, y, z}, std::uint8_t(60 + random() % 196), material});
                }
        return sim::latticeFromCells(cells, 0.003, {0.1, 1.6, -0.2});
    }();
    return organ;
}

/// The same where the tissue has one material.
const Lattice& oneMaterial() {
    static const Lattice organ = [] {
        std::vector<sim::LatticeCell> cells = raggedOrgan().cells;
        for (sim::LatticeCell& cell : cells)
            cell.material = 0;
        return sim::latticeFromCells(cells, 0.003, {0.1, 1.6, -0.2});
    }();
    return organ;
}

SolverSetup freeBody(const Case& tissue) {
    SolverSetup setup;
    setup.tissue.dampingTime = 0.0005;
    tissue.change(setup.tissue);
    setup.lattice = setup.tissue.materialCount() > 1 ? &raggedOrgan() : &oneMaterial();
    setup.timeStep = sim::stableStep(*setup.lattice, setup.tissue, 1.0 / 60).timeStep;
    return setup;
}

/// Held at one end, under gravity, with a probe that comes from above within 300 steps.
SolverSetup pressedBody(const Case& tissue) {
    SolverSetup setup = freeBody(tissue);
    const Lattice& lattice = *setup.lattice;
    setup.gravity = {0, -9.81, 0};
    setup.tissue.airDrag = 2;
    glm::dvec3 top(-1e9);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        setup.fixed.push_back(lattice.nodes[node].x < 3);
        if (lattice.nodes[node].x > 6 && lattice.nodes[node].x < 12 && lattice.restPosition(node).y > top.y)
            top = lattice.restPosition(node);
    }
    top = lattice.toWorld(top);
    const double end = 300 * setup.timeStep;
    setup.tools = {
        {"probe",
         sim::ToolMode::push,
         0.009,
         {{0, top + glm::dvec3(0, 0.009, 0)}, {0.2 * end, top}, {end, top - glm::dvec3(0, 0.006, 0)}}}};
    return setup;
}

/// A blade down through the upper half of the body, in its middle, aslant.
sim::Stroke bladeThrough(const Lattice& lattice) {
    const glm::dvec3 low = lattice.toWorld(-glm::dvec3(lattice.centre)),
                     high = lattice.toWorld(glm::dvec3(lattice.nodeDims - 1 - lattice.centre));
    const glm::dvec3 middle = 0.5 * (low + high);
    sim::Stroke stroke;
    stroke.from = {glm::dvec3(middle.x - 0.004, high.y + 0.01, low.z - 0.01),
                   glm::dvec3(middle.x + 0.005, high.y + 0.01, high.z + 0.01)};
    stroke.to = {glm::dvec3(middle.x - 0.004, middle.y + 0.001, low.z - 0.01),
                 glm::dvec3(middle.x + 0.005, middle.y - 0.002, high.z + 0.01)};
    return stroke;
}

/// Infinity where a number is none.
double largestDifference(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double apart = glm::length(a[i] - b[i]);
        worst = std::isfinite(apart) ? std::max(worst, apart) : HUGE_VAL;
    }
    return worst;
}

glm::dvec3 randomVector(std::mt19937& random) {
    const auto one = [&random] { return double(random()) / 2147483648.0 - 1; };
    const double x = one(), y = one(), z = one();
    return {x, y, z};
}

/// Positions and increments off rest.
LatticeState disturbed(const Lattice& lattice, double size, double speed) {
    LatticeState state = sim::restState(lattice);
    std::mt19937 random(8);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        state.positions[node] = glm::vec3(state.positions[node] + size * randomVector(random));
        state.increments[node] = glm::vec3(speed * randomVector(random));
    }
    return state;
}

/// Runs `test` once for every instruction set that this processor has and the kernel was built for.
template <class Test>
void forEveryTarget(const Test& test) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        SCOPED_TRACE(hwy::TargetName(target));
        test();
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

class CpuMaterials : public testing::TestWithParam<std::size_t> {
protected:
    const Case& tissue() const { return cases()[GetParam()]; }
};

INSTANTIATE_TEST_SUITE_P(Tissues, CpuMaterials, testing::Range(std::size_t(0), cases().size()),
                         [](const testing::TestParamInfo<std::size_t>& tissue) {
                             std::string name = cases()[tissue.param].name;
                             for (char& letter : name)
                                 letter = std::isalnum(static_cast<unsigned char>(letter)) ? letter : '_';
                             return name;
                         });

} // namespace

// In parts of 20 steps from the reference's own state: which triangle a tool pushes can turn on the last bit,
// and whole runs part from there.
TEST_P(CpuMaterials, followTheReferenceUnderAProbeAndACut) {
    const SolverSetup setup = pressedBody(tissue());
    const sim::Stroke stroke = bladeThrough(*setup.lattice);
    constexpr int kParts = 15, kSteps = 20, kCutBefore = 5;
    const auto takePart = [&](sim::Solver& solver, int part) {
        if (part == kCutBefore) {
            EXPECT_TRUE(solver.cut(stroke).ok());
        }
        solver.advance(kSteps);
        return solver.state();
    };
    const auto reference = sim::makeReferenceSolver(setup);
    std::vector<LatticeState> expected{reference->state()};
    std::vector<glm::dvec3> impulses;
    glm::dvec3 impulse(0);
    for (int part = 0; part < kParts; ++part) {
        expected.push_back(takePart(*reference, part));
        impulses.push_back(reference->takeToolImpulses()[0]);
        impulse += impulses.back();
    }
    EXPECT_NE(expected.back().connections, setup.lattice->connections);
    EXPECT_GT(glm::length(impulse), 0);
    EXPECT_GT(largestDifference(expected.back().positions, sim::restState(*setup.lattice).positions), 0.3);
    forEveryTarget([&] {
        const auto solver = sim::makeCpuSolver(setup);
        int turned = 0;
        for (int part = 0; part < kParts; ++part) {
            const LatticeState& after = expected[std::size_t(part) + 1];
            solver->setState(expected[std::size_t(part)]);
            const LatticeState got = takePart(*solver, part);
            EXPECT_EQ(got.connections, after.connections);
            const double apart = largestDifference(got.positions, after.positions);
            turned += apart > 3e-4;
            EXPECT_LT(apart, 5e-3) << part;
            EXPECT_LT(glm::length(solver->takeToolImpulses()[0] - impulses[std::size_t(part)]),
                      1e-3 * glm::length(impulse));
        }
        EXPECT_LE(turned, 3) << "of " << kParts;
    });
}

TEST_P(CpuMaterials, oneStepFromADisturbedAndCutStateIsTheReferences) {
    const SolverSetup setup = freeBody(tissue());
    const Lattice& lattice = *setup.lattice;
    LatticeState state = disturbed(lattice, 0.5, 0.05);
    const std::vector<double> volumes = sim::cellVolumeRatios(lattice, state);
    EXPECT_LT(*std::min_element(volumes.begin(), volumes.end()), 0.2) << "cells that recovery acts on";
    state.connections = lattice.connections;
    std::mt19937 random(31);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < SRS_NEIGHBOURS; d += 2)
            if (const std::int64_t other = lattice.neighbour(node, d); other >= 0 && random() % 60 == 0) {
                state.connections[node] &= ~(1u << d);
                state.connections[std::size_t(other)] &= ~(2u << d);
            }
    const auto changeOf = [&state](sim::Solver& solver) {
        solver.setState(state);
        solver.advance(1);
        std::vector<glm::dvec3> change = solver.state().increments;
        for (std::size_t node = 0; node < change.size(); ++node)
            change[node] -= state.increments[node];
        return change;
    };
    const auto reference = sim::makeReferenceSolver(setup);
    const std::vector<glm::dvec3> expected = changeOf(*reference);
    double size = 0;
    for (const glm::dvec3& change : expected)
        size += glm::length(change) / double(expected.size());
    EXPECT_GT(size, 1e-3);
    forEveryTarget([&] {
        const auto solver = sim::makeCpuSolver(setup);
        EXPECT_LT(largestDifference(changeOf(*solver), expected), 2e-5 * size);
    });
}

TEST_P(CpuMaterials, keepBothMomenta) {
    const SolverSetup setup = freeBody(tissue());
    const sim::TissueField field(*setup.lattice, setup.tissue);
    struct Sums {
        glm::dvec3 linear{0}, angular{0};
        double linearSize = 0, angularSize = 0;
    };
    const auto sumsOf = [&](const LatticeState& state) {
        Sums sums;
        for (std::size_t node = 0; node < state.positions.size(); ++node) {
            const glm::dvec3 p = field.massShare(node) * state.increments[node];
            // x_n cross (x_n - x_(n-1)), which central forces keep in Verlet's steps.
            sums.linear += p;
            sums.angular += glm::cross(state.positions[node], p);
            sums.linearSize += glm::length(p);
            sums.angularSize += glm::length(state.positions[node]) * glm::length(p);
        }
        return sums;
    };
    const auto solver = sim::makeCpuSolver(setup);
    solver->setState(disturbed(*setup.lattice, 0.02, 0.005));
    const Sums before = sumsOf(solver->state());
    solver->advance(1000);
    const Sums after = sumsOf(solver->state());
    EXPECT_LT(glm::length(after.linear - before.linear), 1e-7 * before.linearSize);
    EXPECT_LT(glm::length(after.angular - before.angular), 1e-7 * before.angularSize);
    EXPECT_GT(largestDifference(solver->state().positions, sim::restState(*setup.lattice).positions), 0.01);
}

TEST_P(CpuMaterials, restExactlyWithoutForce) {
    const SolverSetup setup = freeBody(tissue());
    const LatticeState rest = sim::restState(*setup.lattice);
    forEveryTarget([&] {
        const auto solver = sim::makeCpuSolver(setup);
        solver->advance(1000);
        EXPECT_EQ(solver->state().positions, rest.positions);
        EXPECT_EQ(solver->state().increments, rest.increments);
    });
}

TEST_P(CpuMaterials, giveTheSameBytesWithAnyNumberOfThreadsAndAfterAStateWasSet) {
    const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 3);
    const SolverSetup setup = pressedBody(tissue());
    const sim::Stroke stroke = bladeThrough(*setup.lattice);
    std::string one;
    for (const int threads : {1, 2, 3, 0}) {
        const auto solver = sim::makeCpuSolver(setup, {threads, false});
        solver->advance(60);
        EXPECT_TRUE(solver->cut(stroke).ok());
        solver->advance(20);
        const LatticeState halfWay = solver->state();
        solver->advance(40);
        const std::string hash = solver->state().hash();
        one = one.empty() ? hash : one;
        EXPECT_EQ(hash, one) << threads;
        const auto other = sim::makeCpuSolver(setup, {threads, false});
        other->setState(halfWay);
        other->advance(40);
        EXPECT_EQ(other->state().hash(), one) << threads;
    }
}

TEST_P(CpuMaterials, areWholeAgainWhenACutIsUndone) {
    const SolverSetup setup = pressedBody(tissue());
    const auto cut = sim::makeCpuSolver(setup), whole = sim::makeCpuSolver(setup);
    EXPECT_TRUE(cut->cut(bladeThrough(*setup.lattice)).ok());
    cut->advance(20);
    EXPECT_TRUE(cut->undoCut());
    cut->setState(sim::restState(*setup.lattice));
    cut->advance(50);
    whole->advance(50);
    EXPECT_EQ(cut->state().hash(), whole->state().hash());
}

TEST(CpuMaterial, everyCaseDiffersFromPlainSprings) {
    // Else agreement with the reference would show nothing.
    const Case plain{"plain", [](Tissue&) {}};
    for (const Case& tissue : cases()) {
        if (std::string(tissue.name) == "recovery")
            continue; // no cell collapses under the probe: see below
        SolverSetup setup = pressedBody(tissue);
        SolverSetup other = pressedBody(plain);
        setup.timeStep = other.timeStep = std::min(setup.timeStep, other.timeStep);
        const auto with = sim::makeReferenceSolver(setup), without = sim::makeReferenceSolver(other);
        with->advance(200);
        without->advance(200);
        EXPECT_GT(largestDifference(with->state().positions, without->state().positions), 0.01)
            << tissue.name;
    }
}

TEST(CpuMaterial, recoveryTurnsCollapsedCellsRightAsTheReferenceDoes) {
    // Lone cells in a row, from the mirror image, in which springs have no energy, to nearly whole.
    std::vector<sim::LatticeCell> cells;
    for (int i = 0; i < 20; ++i)
        cells.push_back({{2 * i, 0, 0}, std::uint8_t(255 - 5 * i)});
    const Lattice lattice = sim::latticeFromCells(cells, 0.003, glm::dvec3(0));
    SolverSetup setup;
    setup.lattice = &lattice;
    setup.tissue.recovery = true;
    setup.tissue.dampingTime = 0.0005;
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1).timeStep;
    LatticeState state = sim::restState(lattice);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        glm::dvec3& x = state.positions[node];
        x.y *= -1 + 0.09 * double(lattice.nodes[node].x / 2);
        x.z += 0.1 * x.y;
    }
    EXPECT_GT(sim::invertedCells(lattice, state), 8u);
    const auto run = [&](sim::Solver& solver) {
        solver.setState(state);
        solver.advance(300);
        return solver.state();
    };
    const LatticeState expected = run(*sim::makeReferenceSolver(setup));
    EXPECT_EQ(sim::invertedCells(lattice, expected), 0u);
    SolverSetup without = setup;
    without.tissue.recovery = false;
    EXPECT_GT(sim::invertedCells(lattice, run(*sim::makeReferenceSolver(without))), 0u);
    forEveryTarget([&] {
        EXPECT_LT(largestDifference(run(*sim::makeCpuSolver(setup)).positions, expected.positions), 1e-3);
    });
}

TEST(CpuMaterial, equalMaterialsAreOneMaterialByTheByte) {
    SolverSetup one = pressedBody({"", [](Tissue&) {}});
    SolverSetup three = one;
    three.lattice = &raggedOrgan();
    three.tissue.others = {one.tissue, one.tissue};
    const auto a = sim::makeCpuSolver(one), b = sim::makeCpuSolver(three);
    a->advance(150);
    b->advance(150);
    EXPECT_EQ(a->state().hash(), b->state().hash());
}
