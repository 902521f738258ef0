// Threads and clips: the length that they keep, the force that they carry and break at, momentum, and going
// on from a state.
#include "sim/thread_hold.h"
#include "tests/sim/coupled_organs.h"

#include <cmath>

using namespace serosa;
using test::Kind;
using test::TestOrgan;

namespace {

constexpr double kSide = 0.009; // m, of the blocks

/// Two blocks one above the other, with a gap, and a thread from the top of the low one to the bottom of the
/// high one.
struct Tied {
    TestOrgan low{test::boxLattice({0, 0, 0}, {kSide, kSide, kSide}, 0.003)};
    TestOrgan high{test::boxLattice({0, 2 * kSide, 0}, {kSide, 3 * kSide, kSide}, 0.00225)};
    std::vector<sim::TiedThread> threads;
    std::unique_ptr<sim::OrganGroup> group;
    sim::Thread thread;

    Tied() {
        thread.name = "suture";
        thread.ends[0].at = {0.4 * kSide, 0.95 * kSide, 0.5 * kSide};
        thread.ends[1].at = {0.55 * kSide, 2.05 * kSide, 0.45 * kSide};
    }
    double distanceAtRest() const { return glm::distance(thread.ends[0].at, thread.ends[1].at); }
    void make(Kind kind) {
        test::stepTogether({&low, &high});
        test::makeSolvers({&low, &high}, kind);
        low.start(glm::dvec3(0));
        high.start(glm::dvec3(0));
        tie();
    }
    void tie() {
        sim::TiedThread tied;
        tied.thread = thread;
        tied.organs[1] = 1;
        double far = -1;
        tied.anchors[0] = sim::anchorAt(low.lattice, thread.ends[0].at, far);
        EXPECT_EQ(far, 0);
        tied.anchors[1] = sim::anchorAt(high.lattice, thread.ends[1].at, far);
        EXPECT_EQ(far, 0);
        threads.assign(1, tied);
        group = test::groupOf({&low, &high}, 0, threads, false);
    }
    glm::dvec3 end(std::size_t i) const { // m, now
        const TestOrgan& organ = i == 0 ? low : high;
        const sim::LatticeState state = organ.solver->state();
        glm::dvec3 sum(0);
        for (std::size_t k = 0; k < 8; ++k)
            sum += threads[0].anchors[i].weights[k] * state.positions[threads[0].anchors[i].nodes[k]];
        return organ.lattice.toWorld(sum);
    }
    double distance() const { return glm::distance(end(0), end(1)); }
    void advance(double seconds) const { group->advance(int(seconds / low.setup.timeStep + 0.5)); }
    sim::ThreadState state() const { return group->threads()[0]; }
};

glm::dvec3 angularMomentum(const TestOrgan& organ) {
    const sim::LatticeState state = organ.solver->state();
    glm::dvec3 sum(0);
    for (std::size_t node = 0; node < organ.lattice.nodeCount(); ++node)
        sum += organ.mass(node) *
               glm::cross(organ.lattice.toWorld(state.positions[node]), state.increments[node]);
    return sum * (organ.lattice.spacing / organ.setup.timeStep);
}

} // namespace

TEST(Thread, endsAreMaterialPoints) {
    const sim::Lattice lattice = test::ballLattice(0.02, 0.003, {0.1, 0, 0});
    for (const glm::dvec3 at : {glm::dvec3(0.1, 0.019, 0.001), glm::dvec3(0.1111, -0.004, 0.0123)}) {
        double far = -1;
        const sim::ThreadAnchor anchor = sim::anchorAt(lattice, at, far);
        EXPECT_EQ(far, 0);
        glm::dvec3 sum(0);
        double weights = 0;
        for (std::size_t i = 0; i < 8; ++i) {
            sum += anchor.weights[i] * lattice.toWorld(lattice.restPosition(anchor.nodes[i]));
            weights += anchor.weights[i];
            EXPECT_GE(anchor.weights[i], 0);
        }
        EXPECT_NEAR(weights, 1, 1e-12);
        EXPECT_LT(glm::distance(sum, at), 1e-12);
    }
    // Outside: the nearest point of the cells, and how far it is.
    double far = 0;
    sim::anchorAt(lattice, {0.1, 0.05, 0}, far);
    EXPECT_NEAR(far, 0.03, 0.003);
}

TEST(Thread, keepsLengthMomentumAndAngularMomentum) {
    for (const Kind kind : {Kind::reference, Kind::cpu})
        for (const bool clip : {false, true}) {
            Tied tied;
            tied.thread.length = tied.distanceAtRest();
            tied.thread.clip = clip;
            tied.make(kind);
            tied.low.start({0.02, -0.1, 0.01}); // apart, and turning
            tied.high.start({-0.03, 0.1, 0.02});
            const glm::dvec3 momentum = tied.low.momentum() + tied.high.momentum(),
                             angular = angularMomentum(tied.low) + angularMomentum(tied.high);
            const double size = glm::length(tied.low.momentum()),
                         energy = tied.low.energy() + tied.high.energy();
            const double bound = kind == Kind::cpu ? 1e-6 : 1e-12;
            double shortest = 1;
            for (int i = 0; i < 60; ++i) {
                tied.group->advance(5);
                const double stretch = tied.distance() / tied.thread.length - 1;
                shortest = std::min(shortest, stretch);
                EXPECT_LT(clip ? std::abs(stretch) : stretch, kind == Kind::cpu ? 1e-5 : 1e-9);
                EXPECT_LT(glm::length(tied.low.momentum() + tied.high.momentum() - momentum), bound * size);
            }
            EXPECT_LT(glm::length(angularMomentum(tied.low) + angularMomentum(tied.high) - angular),
                      10 * bound * size * kSide);
            EXPECT_LT(tied.low.energy() + tied.high.energy(), energy * (1 + 1e-6));
            EXPECT_GT(tied.state().impulse, 0);
            if (!clip) {
                EXPECT_LT(shortest, -0.01) << "a thread goes slack, a clip does not";
            }
        }
}

TEST(Thread, isDrawnInWithinItsTime) {
    for (const bool clip : {false, true}) {
        Tied tied;
        const double start = tied.distanceAtRest(),
                     end = clip ? 1.2 * start : 0.5 * start; // a clip pushes too
        tied.thread.length = end;
        tied.thread.tightening = 0.1;
        tied.thread.time = 0.02;
        tied.thread.clip = clip;
        tied.low.fix([](const glm::dvec3& p) { return p.y < 0.001; });
        tied.high.fix([](const glm::dvec3& p) { return p.y > 3 * kSide - 0.001; });
        tied.make(Kind::reference);
        tied.advance(0.01);
        EXPECT_LT(tied.state().startLength, 0) << "not tied yet";
        EXPECT_NEAR(tied.distance(), start, 1e-12);
        tied.advance(0.06);
        EXPECT_NEAR(tied.distance(), 0.5 * (start + end), 0.01 * start);
        tied.advance(0.06);
        EXPECT_NEAR(tied.distance(), end, 1e-9);
        EXPECT_NEAR(tied.state().startLength, start, 1e-9);
        EXPECT_GT(tied.state().work, 0);
    }
}

TEST(Thread, nothingIsTornTogetherInOneStep) {
    Tied tied;
    tied.thread.length = 0.1 * tied.distanceAtRest(); // tightening 0
    tied.make(Kind::reference);
    const double before = tied.distance();
    tied.group->advance(1);
    EXPECT_NEAR(before - tied.distance(), SRS_THREAD_PULL * tied.high.lattice.spacing, 1e-9);
}

// The high block is pulled away by forceps, ever further: the thread holds until the forceps' force is its
// strength, and is broken for good.
TEST(Thread, breaksAtItsStrength) {
    for (const Kind kind : {Kind::reference, Kind::cpu}) {
        Tied tied;
        const double strength = 0.02; // N
        tied.thread.length = tied.distanceAtRest();
        tied.thread.strength = strength;
        tied.low.fix([](const glm::dvec3& p) { return p.y < 0.001; });
        const glm::dvec3 grip(0.5 * kSide, 3 * kSide, 0.5 * kSide);
        tied.high.setup.tools = {
            {"forceps", sim::ToolMode::grasp, 0.006, {{0, grip}, {2, grip + glm::dvec3(0, 0.02, 0)}}}};
        tied.high.setup.tissue.airDrag = tied.low.setup.tissue.airDrag = 20;
        tied.make(kind);
        double held = 0, pulled = 0;
        for (int i = 0; i < 300 && !tied.state().broken; ++i) {
            held = pulled;
            tied.high.solver->takeLoads();
            tied.advance(0.005);
            pulled = tied.high.solver->takeLoads()[0].impulse.y / 0.005;
        }
        ASSERT_TRUE(tied.state().broken);
        EXPECT_NEAR(held / strength, 1, 0.1);
        tied.group->takeThreads();
        const double before = tied.distance();
        tied.advance(0.1);
        EXPECT_GT(tied.distance(), 1.02 * before) << "it no longer holds";
        EXPECT_EQ(tied.group->takeThreads()[0].impulse, 0);
    }
}

TEST(Thread, carriesAWeightBelowItsStrength) {
    for (const double share : {0.9, 1.1}) {
        Tied tied; // upside down: the low block hangs on the high one
        tied.thread.length = tied.distanceAtRest();
        tied.high.fix([](const glm::dvec3& p) { return p.y > 3 * kSide - 0.001; });
        double weight = 0;
        for (std::size_t node = 0; node < tied.low.lattice.nodeCount(); ++node)
            weight += 9.81 * tied.low.mass(node);
        tied.thread.strength = weight / share;
        tied.low.setup.tissue.airDrag = tied.high.setup.tissue.airDrag = 60; // no swing beyond its weight
        tied.make(Kind::cpu);
        // Gravity comes slowly, or the weight would swing.
        for (int i = 1; i <= 20; ++i) {
            const sim::LatticeState low = tied.low.solver->state(), high = tied.high.solver->state();
            const std::vector<sim::ThreadState> threads = tied.group->threads();
            tied.low.setup.gravity = {0, -9.81 * std::min(1.0, i / 16.0), 0};
            test::makeSolvers({&tied.low, &tied.high}, Kind::cpu);
            tied.low.solver->setState(low);
            tied.high.solver->setState(high);
            tied.tie();
            tied.group->restart(low.step, threads);
            tied.advance(0.05);
        }
        EXPECT_EQ(tied.state().broken, share > 1) << share;
        if (share < 1) {
            EXPECT_NEAR(tied.state().force / weight, 1, 0.01);
        }
    }
}

TEST(Thread, bothEndsMayLieInOneOrgan) {
    TestOrgan block(test::boxLattice({0, 0, 0}, {0.03, 0.009, 0.009}, 0.003));
    block.setup.tissue.airDrag = 50;
    test::stepTogether({&block});
    test::makeSolvers({&block}, Kind::reference);
    block.start(glm::dvec3(0));
    sim::TiedThread tied;
    tied.thread.length = 0.015;
    tied.thread.tightening = 0.2;
    double far = 0;
    tied.anchors[0] = sim::anchorAt(block.lattice, {0.002, 0.0085, 0.004}, far);
    tied.anchors[1] = sim::anchorAt(block.lattice, {0.028, 0.0085, 0.005}, far);
    sim::TiedThread inACell = tied; // its ends share their nodes
    inACell.anchors[0] = sim::anchorAt(block.lattice, {0.0101, 0.001, 0.001}, far);
    inACell.anchors[1] = sim::anchorAt(block.lattice, {0.0117, 0.002, 0.002}, far);
    inACell.thread.length = 0.0017;
    const auto group = test::groupOf({&block}, 0, {tied, inACell}, false);
    group->advance(int(0.4 / block.setup.timeStep));
    const sim::LatticeState state = block.solver->state();
    for (const sim::TiedThread* thread : {&tied, &inACell}) {
        glm::dvec3 apart(0);
        for (std::size_t i = 0; i < 8; ++i)
            apart += thread->anchors[0].weights[i] * state.positions[thread->anchors[0].nodes[i]] -
                     thread->anchors[1].weights[i] * state.positions[thread->anchors[1].nodes[i]];
        EXPECT_NEAR(glm::length(apart) * block.lattice.spacing, thread->thread.length,
                    1e-6 * thread->thread.length);
    }
    EXPECT_LT(glm::length(block.momentum()), 1e-12);
}

TEST(Thread, goesOnFromAStateWithTheSameBytes) {
    for (const Kind kind : {Kind::reference, Kind::cpu}) {
        std::string hashes[2];
        for (const bool interrupted : {false, true}) {
            Tied tied;
            tied.thread.length = 0.6 * tied.distanceAtRest();
            tied.thread.tightening = 0.05;
            tied.thread.strength = 0.03;
            tied.low.fix([](const glm::dvec3& p) { return p.y < 0.001; });
            tied.make(kind);
            tied.high.start({0, 0.2, 0});
            tied.group->advance(40);
            if (interrupted) {
                const sim::LatticeState low = tied.low.solver->state(), high = tied.high.solver->state();
                const std::vector<sim::ThreadState> threads = tied.group->threads();
                test::makeSolvers({&tied.low, &tied.high}, kind);
                tied.tie();
                tied.low.solver->setState(low);
                tied.high.solver->setState(high);
                tied.group->restart(40, threads);
            }
            tied.group->advance(200);
            hashes[interrupted] = tied.low.solver->state().hash() + tied.high.solver->state().hash();
        }
        EXPECT_EQ(hashes[0], hashes[1]);
    }
}
