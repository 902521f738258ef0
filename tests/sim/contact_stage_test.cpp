// Contact, friction and grip against what mechanics says of them: momentum, energy, Coulomb's cone, the
// grip's own force; and nothing passes a sheet one cell thick.
#include "shaders/shared_constants.h"
#include "sim/cpu_solver.h"
#include "sim/distance_field.h"
#include "sim/shape_distance.h"
#include "sim/solver.h"
#include "sim/triangle_tree.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace serosa;
using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;

namespace {

constexpr double kGravity = 9.81;

SolverSetup setupOf(const Lattice& lattice, double dampingTime = 0.002) {
    SolverSetup setup;
    setup.lattice = &lattice;
    setup.tissue.dampingTime = dampingTime;
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1.0 / 60).timeStep;
    return setup;
}

sim::Body floorAt(double height, double friction = 0, const glm::dquat& turn = {1, 0, 0, 0}) {
    sim::Body floor;
    floor.name = "floor";
    floor.shape.kind = sim::ShapeKind::halfSpace;
    floor.shape.radius = 0;
    floor.pose.turn = turn;
    floor.pose.at = turn * glm::dvec3(0, height, 0);
    floor.friction = friction;
    return floor;
}

double massOf(const SolverSetup& setup, std::size_t node) {
    return setup.lattice->massShare(node) * setup.tissue.nodeMass(setup.lattice->spacing);
}

/// Momentum in kg m/s; angular momentum in kg m2/s, about the world's origin.
struct Momenta {
    glm::dvec3 linear{0}, angular{0};
};
Momenta momentaOf(const SolverSetup& setup, const LatticeState& state) {
    Momenta sum;
    for (std::size_t node = 0; node < state.positions.size(); ++node) {
        const glm::dvec3 p =
            massOf(setup, node) * (setup.lattice->spacing / setup.timeStep) * state.increments[node];
        sum.linear += p;
        sum.angular += glm::cross(setup.lattice->toWorld(state.positions[node]), p);
    }
    return sum;
}

glm::dvec3 meanPosition(const SolverSetup& setup, const LatticeState& state) {
    glm::dvec3 sum(0);
    double mass = 0;
    for (std::size_t node = 0; node < state.positions.size(); ++node) {
        sum += massOf(setup, node) * setup.lattice->toWorld(state.positions[node]);
        mass += massOf(setup, node);
    }
    return sum / mass;
}

double lowestNode(const Lattice& lattice) {
    double lowest = 1e9;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        lowest = std::min(lowest, lattice.toWorld(lattice.restPosition(node)).y);
    return lowest;
}

Lattice ballLattice(double radius, double spacing) {
    sim::LatticeRequest request;
    request.spacing = spacing;
    auto lattice = sim::buildLattice(test::ballMesh(radius, 4), request);
    EXPECT_TRUE(lattice.ok());
    return std::move(lattice).value();
}

/// A block on a slope whose axis is askew to the grid: its motion along the slope between 0.1 s, when its
/// first bounce is over, and 0.3 s.
struct Slide {
    double distance = 0;     // m
    double acceleration = 0; // m/s2, of its mean velocity
};
Slide slideOf(double slope, double friction) {
    const Lattice lattice = test::blockLattice(5, 3, 4);
    SolverSetup setup = setupOf(lattice);
    setup.tissue.young = 20e3;
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1.0 / 60).timeStep;
    // The block stands upright, and gravity leans.
    const glm::dquat lean = glm::angleAxis(slope, glm::normalize(glm::dvec3(0.3, 0, 1)));
    setup.gravity = lean * glm::dvec3(0, -kGravity, 0);
    setup.bodies = {floorAt(lowestNode(lattice), friction)};
    const auto solver = sim::makeReferenceSolver(setup);
    solver->setState(sim::startState(setup));
    double mass = 0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        mass += massOf(setup, node);
    const auto look = [&](double time) {
        solver->advance(int(time / setup.timeStep));
        const glm::dvec3 at = meanPosition(setup, solver->state()),
                         velocity = momentaOf(setup, solver->state()).linear / mass;
        return std::pair(glm::dvec3(at.x, 0, at.z), glm::dvec3(velocity.x, 0, velocity.z));
    };
    const auto first = look(0.1), last = look(0.2);
    return {glm::distance(first.first, last.first), glm::distance(first.second, last.second) / 0.2};
}

} // namespace

TEST(ContactStage, blockSlidesWhereTheSlopeIsSteeperThanFriction) {
    const double friction = 0.4;
    EXPECT_LT(slideOf(std::atan(0.95 * friction), friction).distance, 1e-6);
    for (const double share : {1.05, 2.0}) {
        const double slope = std::atan(share * friction);
        const double found = (kGravity * std::sin(slope) - slideOf(slope, friction).acceleration) /
                             (kGravity * std::cos(slope));
        EXPECT_NEAR(found / friction, 1, 0.01) << share;
    }
}

// Without friction a ball slides down a turned half-space and does not roll.
TEST(ContactStage, slopesMayBeBodiesThatAreTurned) {
    const double radius = 0.012;
    const Lattice lattice = ballLattice(radius, 0.004);
    SolverSetup setup = setupOf(lattice);
    const double slope = 0.3;
    setup.gravity = {0, -kGravity, 0};
    setup.bodies = {floorAt(-radius, 0, glm::angleAxis(slope, glm::dvec3(0, 0, 1)))};
    const auto solver = sim::makeReferenceSolver(setup);
    solver->setState(sim::startState(setup));
    const double time = 0.25;
    solver->advance(int(time / setup.timeStep));
    const LatticeState state = solver->state();
    const glm::dvec3 down(-std::cos(slope), -std::sin(slope), 0);
    EXPECT_NEAR(glm::dot(meanPosition(setup, state), down) / (0.5 * kGravity * std::sin(slope) * time * time),
                1, 0.01);
    const sim::RigidPose& pose = setup.bodies[0].pose;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        EXPECT_GE(pose.toOwn(lattice.toWorld(state.positions[node])).y,
                  lattice.restDepth(node) * lattice.spacing - 1e-9);
}

TEST(ContactStage, ballDroppedOnAFloorComesToRestAndGainsNoEnergy) {
    const Lattice lattice = ballLattice(0.015, 0.004);
    SolverSetup setup = setupOf(lattice, 0.004);
    setup.gravity = {0, -kGravity, 0};
    const double drop = 0.02;
    setup.bodies = {floorAt(-0.015 - drop, 0.5)};
    for (const bool onCpu : {false, true}) {
        const auto solver = onCpu ? sim::makeCpuSolver(setup) : sim::makeReferenceSolver(setup);
        solver->setState(sim::startState(setup));
        const auto total = [&] {
            const sim::Energies e = sim::energies(setup, solver->state());
            return e.kinetic + e.elastic + e.gravitational;
        };
        double mass = 0;
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            mass += massOf(setup, node);
        const double scale = mass * kGravity * drop;
        double last = total(), most = last;
        for (int i = 0; i < 120; ++i) {
            solver->advance(int(1.0 / 60 / setup.timeStep + 0.5));
            last = total();
            most = std::max(most, last);
        }
        // Increments lag half a step behind: in free fall the sum swings by m g v dt/2.
        EXPECT_LT(most, 0.03 * scale);
        EXPECT_LT(sim::energies(setup, solver->state()).kinetic, 1e-5 * scale);
        EXPECT_NEAR(meanPosition(setup, solver->state()).y, -drop, 0.15 * 0.015);
        const double weight = solver->takeLoads()[0].impulse.y;
        EXPECT_GT(weight, 0);
        const int steps = 200;
        solver->advance(steps);
        EXPECT_NEAR(solver->takeLoads()[0].impulse.y / (steps * setup.timeStep * mass * kGravity), 1, 0.01);
    }
}

// Loads are all that a free organ gains: by contact with friction, with a tool that turns as it moves, and by
// a grasp that turns.
TEST(ContactStage, loadsAreTheMomentumThatAFreeOrganGains) {
    const Lattice lattice = ballLattice(0.015, 0.004);
    for (int which = 0; which < 3; ++which) {
        SCOPED_TRACE(which);
        SolverSetup setup = setupOf(lattice);
        const double time = 0.1;
        sim::Tool tool;
        tool.name = "tool";
        tool.radius = which == 2 ? 0.005 : 0.003;
        tool.mode = which == 2 ? sim::ToolMode::grasp : sim::ToolMode::push;
        if (which == 1) {
            tool.shape.kind = sim::ShapeKind::box;
            tool.shape.halfSize = {0.012, 0.001, 0.006};
        }
        tool.friction = 0.3;
        tool.gripForce = 0.05;
        const glm::dquat turned = glm::angleAxis(0.8, glm::normalize(glm::dvec3(1, 2, -1)));
        tool.keys = {{0, {0.004, which == 2 ? 0.013 : 0.021, 0.002}}, {time, {0.004, 0.01, 0}, turned}};
        setup.tools = {tool};
        const auto solver = sim::makeReferenceSolver(setup);
        solver->setState(sim::startState(setup));
        sim::ToolLoad sum;
        for (int step = 1; step * setup.timeStep < time; ++step) {
            solver->advance(1);
            const sim::ToolLoad load = solver->takeLoads()[0];
            sum.impulse += load.impulse;
            sum.angular += load.angular + glm::cross(tool.centreAt(step * setup.timeStep), load.impulse);
        }
        const Momenta gained = momentaOf(setup, solver->state());
        EXPECT_GT(glm::length(gained.linear), 1e-5);
        EXPECT_GT(glm::length(gained.angular), 1e-8);
        EXPECT_LT(glm::distance(sum.impulse, gained.linear), 1e-9 * glm::length(gained.linear));
        EXPECT_LT(glm::distance(sum.angular, gained.angular), 1e-9 * glm::length(gained.angular));
    }
}

// A tool of each shape that begins inside comes out slowly: nothing moves faster than the ejection.
TEST(ContactStage, whatAToolBeginsInIsPushedOutSlowly) {
    const Lattice lattice = test::blockLattice(6, 6, 6);
    SolverSetup setup = setupOf(lattice, 0.004);
    sim::Tool tool;
    tool.name = "tool";
    tool.radius = 0.001;
    tool.keys = {{0, lattice.toWorld({0.3, 3.1, 0.2}), glm::angleAxis(1.2, glm::dvec3(1, 0, 0))}};
    for (const sim::ShapeKind kind : {sim::ShapeKind::capsule, sim::ShapeKind::box, sim::ShapeKind::hook}) {
        SCOPED_TRACE(int(kind));
        tool.shape.kind = kind;
        tool.shape.length = 0.01;
        tool.shape.bend = 0.003;
        tool.shape.halfSize = {0.002, 0.002, 0.002};
        setup.tools = {tool};
        const auto solver = sim::makeReferenceSolver(setup);
        const sim::RigidShape shape = sim::scaledShape(tool.wholeShape(), 1 / lattice.spacing);
        const auto deepest = [&] {
            double least = 1e9;
            const LatticeState state = solver->state();
            for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
                const glm::dvec3 own = tool.poseAt(0).toOwn(lattice.toWorld(state.positions[node]));
                least = std::min(least,
                                 sim::shapeDistance(shape, own / lattice.spacing) -
                                     std::max(lattice.restDepth(node), -0.5 * sim::thinnestHalfWidth(shape)));
            }
            return least;
        };
        EXPECT_LT(deepest(), -0.1);
        double fastest = 0;
        for (int i = 0; i < 40; ++i) {
            solver->advance(10);
            for (const glm::dvec3& u : solver->state().increments)
                fastest = std::max(fastest, glm::length(u));
        }
        EXPECT_LT(fastest, 3 * SRS_EJECTION);
        EXPECT_GT(deepest(), -1e-9);
    }
}

/// A sheet one cell thick, held at its rim; probes come at 1 m/s and stop 2 spacings beyond the places of its
/// surface that they aim at. True: the tip's middle stays outside of the face that it came to.
struct Sheet {
    Lattice lattice = test::blockLattice(8, 1, 8);
    SolverSetup setup = setupOf(lattice);
    Sheet() {
        for (const glm::ivec3& node : lattice.nodes)
            setup.fixed.push_back(node.x == 0 || node.z == 0 || node.x == 8 || node.z == 8);
    }
    bool stops(double radius, const glm::dvec3& target, glm::dvec3 towards, bool onCpu) {
        towards = glm::normalize(towards);
        sim::Tool tool;
        tool.name = "probe";
        tool.radius = radius;
        const double lead = 0.003, depth = 0.006; // m: before and behind the place where it touches
        const glm::dvec3 touch = target - towards * (radius / std::abs(towards.y));
        tool.keys = {{0, touch - towards * lead}, {lead + depth, touch + towards * depth}};
        setup.tools = {tool};
        const auto solver = onCpu ? sim::makeCpuSolver(setup) : sim::makeReferenceSolver(setup);
        solver->setState(sim::startState(setup));
        const double end = lead + depth;
        solver->advance(int(end / setup.timeStep));
        const LatticeState state = solver->state();
        const double top = towards.y < 0 ? 1 : -1;
        const glm::dvec3 tip = lattice.toLattice(tool.centreAt(double(state.step) * setup.timeStep));
        bool outside = true;
        double nearest = 1e9;
        for (const glm::uvec3& t : lattice.boundary) {
            const glm::dvec3 n = glm::cross(lattice.restPosition(t.y) - lattice.restPosition(t.x),
                                            lattice.restPosition(t.z) - lattice.restPosition(t.x));
            if (n.y * top < 0.5)
                continue;
            const glm::dvec3 &a = state.positions[t.x], &b = state.positions[t.y], &c = state.positions[t.z];
            const sim::TrianglePoint closest = sim::closestPointOnTriangle(tip, a, b, c);
            const double apart = glm::distance(closest.point, tip);
            if (apart < nearest) {
                nearest = apart;
                outside = glm::dot(tip - closest.point, glm::cross(b - a, c - a)) > 0;
            }
        }
        return outside;
    }
};

TEST(ContactStage, thinProbesDoNotPassASheet) {
    Sheet sheet;
    const double h = sheet.lattice.spacing;
    std::mt19937 random(11);
    const auto one = [&] { return double(random()) / 4294967296.0; };
    int passed = 0, count = 0;
    for (const double radius : {0.0005, 0.001, h, 3 * h})
        for (int i = 0; i < 24; ++i, ++count) {
            const bool above = random() % 2;
            glm::dvec3 at(std::floor(2 + 4 * one()), 0, std::floor(2 + 4 * one())); // a node
            if (i % 3 == 1)
                at[i % 2 ? 0 : 2] += one(); // on an edge
            if (i % 3 == 2)
                at += glm::dvec3(one(), 0, one()); // on a face
            at = glm::dvec3(at.x - 4, above ? 0 : -1, at.z - 4);
            glm::dvec3 towards(one() - 0.5, 0, one() - 0.5);
            towards.y = (above ? -1 : 1) * (0.4 + 0.6 * one());
            const bool stopped = sheet.stops(radius, sheet.lattice.toWorld(at), towards, i % 4 == 0);
            passed += !stopped;
            EXPECT_TRUE(stopped) << "radius " << radius << " approach " << i;
        }
    EXPECT_EQ(passed, 0) << "of " << count;
}

// A ball as a mesh does what a sphere does.
TEST(ContactStage, meshToolBehavesAsItsShape) {
    const Lattice lattice = test::blockLattice(8, 5, 8);
    SolverSetup setup = setupOf(lattice);
    for (const glm::ivec3& node : lattice.nodes)
        setup.fixed.push_back(node.y == 0);
    sim::Tool tool;
    tool.name = "ball";
    tool.radius = 0.008;
    const double end = 0.05;
    const glm::dvec3 top = lattice.toWorld({0.15, 2, 0.3});
    tool.keys = {{0, top + glm::dvec3(0, 0.0081, 0)}, {end, top + glm::dvec3(0, 0.005, 0)}};
    double force[2]{}, lowest[2]{}; // N; lattice units: of the node under it
    for (const bool mesh : {false, true}) {
        if (mesh) {
            tool.shape.kind = sim::ShapeKind::mesh;
            tool.shape.field = std::make_shared<const sim::DistanceField>(test::ballMesh(tool.radius, 5));
            tool.radius = 0;
        }
        setup.tools = {tool};
        const auto solver = sim::makeReferenceSolver(setup);
        solver->setState(sim::startState(setup));
        solver->advance(int(2 * end / setup.timeStep));
        solver->takeLoads();
        solver->advance(100);
        force[mesh] = solver->takeLoads()[0].impulse.y / (100 * setup.timeStep);
        lowest[mesh] = solver->state().positions[std::size_t(lattice.nodeAt({4, 5, 4}))].y;
    }
    EXPECT_LT(force[0], -0.01);
    EXPECT_NEAR(force[1] / force[0], 1, 0.01);
    EXPECT_NEAR(lowest[1], lowest[0], 0.005);
}

// The same bytes whatever the number of threads, and the reference's result.
TEST(ContactStage, onTheCpuIsTheReferencesOnAnyThreads) {
    const Lattice lattice = ballLattice(0.02, 0.0025);
    SolverSetup setup = setupOf(lattice);
    setup.gravity = {0, -kGravity, 0};
    setup.bodies = {floorAt(-0.0202, 0.3)};
    sim::Tool probe, hook;
    probe.name = "probe";
    probe.radius = 0.001;
    probe.friction = 0.2;
    probe.shape.kind = sim::ShapeKind::capsule;
    probe.shape.length = 0.05;
    const glm::dquat up = glm::angleAxis(-std::acos(-1.0) / 2, glm::dvec3(1, 0, 0));
    probe.keys = {{0, {0.003, 0.0215, 0}, up}, {0.03, {0.003, 0.012, 0.002}, up}};
    hook.name = "hook";
    hook.radius = 0.0015;
    hook.shape.kind = sim::ShapeKind::hook;
    hook.shape.bend = 0.006;
    hook.shape.length = 0.03;
    hook.keys = {{0, {-0.022, 0.004, 0.001}}, {0.03, {-0.016, 0.004, 0.001}, up}};
    setup.tools = {probe, hook};
    std::vector<LatticeState> states;
    std::vector<std::vector<sim::ToolLoad>> loads;
    const int steps = int(0.04 / setup.timeStep);
    const auto play = [&](std::unique_ptr<sim::Solver> solver) {
        solver->setState(sim::startState(setup));
        solver->advance(steps);
        states.push_back(solver->state());
        loads.push_back(solver->takeLoads());
    };
    play(sim::makeReferenceSolver(setup));
    for (const int threads : {1, 2, 5}) {
        sim::CpuOptions options;
        options.threads = threads;
        play(sim::makeCpuSolver(setup, options));
        EXPECT_EQ(states.back().hash(), states[1].hash()) << threads;
    }
    double worst = 0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        worst = std::max(worst, glm::distance(states[0].positions[node], states[1].positions[node]));
    EXPECT_LT(worst, 2e-3);
    ASSERT_EQ(loads[0].size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_GT(glm::length(loads[0][i].impulse), 0) << i;
        EXPECT_LT(glm::distance(loads[0][i].impulse, loads[1][i].impulse),
                  1e-3 * glm::length(loads[0][i].impulse))
            << i;
        EXPECT_EQ(loads[2][i].impulse, loads[1][i].impulse);
        EXPECT_EQ(loads[3][i].angular, loads[1][i].angular);
    }
}

TEST(ContactStage, gripSlipsAtItsForce) {
    // A bar held at one end and pulled along: the force grows until the grip slips.
    const Lattice lattice = test::blockLattice(10, 3, 3);
    SolverSetup setup = setupOf(lattice, 0.004);
    for (const glm::ivec3& node : lattice.nodes)
        setup.fixed.push_back(node.x == 0);
    sim::Tool tool;
    tool.name = "forceps";
    tool.mode = sim::ToolMode::grasp;
    tool.radius = 0.0001;
    tool.shape.kind = sim::ShapeKind::box;
    tool.shape.halfSize = {0.004, 0.005, 0.005};
    tool.gripForce = 0.1;
    const double end = 0.4;
    const glm::dvec3 at = lattice.toWorld({4.5, 0, 0});
    tool.keys = {{0, at}, {end, at + glm::dvec3(0.03, 0, 0)}};
    setup.tools = {tool};
    const auto solver = sim::makeReferenceSolver(setup);
    double most = 0, atSlip = 0;
    std::size_t held = 0;
    const int steps = 10;
    for (int step = 0; (step + steps) * setup.timeStep < end; step += steps) {
        solver->advance(steps);
        const double force = solver->takeLoads()[0].impulse.x / (steps * setup.timeStep);
        most = std::max(most, force);
        std::size_t now = 0;
        for (const std::uint32_t holder : solver->state().heldBy)
            now += holder == 1;
        if (now > 0)
            atSlip = force;
        held = std::max(held, now);
    }
    EXPECT_GE(held, 16u);
    EXPECT_NEAR(most / tool.gripForce, 1, 0.1);
    EXPECT_NEAR(atSlip / tool.gripForce, 1, 0.1);
    for (const std::uint32_t holder : solver->state().heldBy)
        EXPECT_EQ(holder, 0u) << "pulled out of the jaws";
}
