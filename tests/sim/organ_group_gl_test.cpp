// Coupled organs on the GPU: the passes against the reference and the CPU solver, momentum, the same bytes.
#include "gpu/context.h"
#include "tests/gl_fixture.h"
#include "tests/sim/coupled_organs.h"

#include <cmath>

using namespace serosa;
using test::Kind;
using test::TestOrgan;

namespace {

class GlOrganGroup : public test::GlTest {};

/// Two balls of different spacing that fly at each other, not quite head on.
struct Balls {
    TestOrgan left{test::ballLattice(0.02, 0.004, {-0.0215, 0, 0})};
    TestOrgan right{test::ballLattice(0.02, 0.0053, {0.0215, 0.006, 0.003})};
    std::unique_ptr<sim::OrganGroup> group;
    Balls(Kind kind, double friction, double speed = 0.3) {
        test::stepTogether({&left, &right});
        test::makeSolvers({&left, &right}, kind);
        left.start({speed, 0, 0});
        right.start({-speed, 0, 0});
        group = test::groupOf({&left, &right}, friction);
    }
};

double largestDifference(const TestOrgan& a, const TestOrgan& b) {
    const sim::LatticeState x = a.solver->state(), y = b.solver->state();
    double worst = 0;
    for (std::size_t node = 0; node < x.positions.size(); ++node)
        worst = std::max(worst, glm::length(x.positions[node] - y.positions[node]));
    return worst;
}

} // namespace

TEST_F(GlOrganGroup, agreesWithTheReferenceAndKeepsMomentum) {
    for (const double friction : {0.0, 0.4}) {
        Balls reference(Kind::reference, friction);
        const int steps = int(0.03 / reference.left.setup.timeStep);
        reference.group->advance(steps);
        const sim::PairLoads expected = reference.group->takeLoads();
        EXPECT_GT(expected[0][1].pressed, 1e-3);
        std::string hashes[2];
        for (const Kind kind : {Kind::fragment, Kind::compute}) {
            Balls balls(kind, friction);
            const glm::dvec3 before = balls.left.momentum() + balls.right.momentum();
            const double size = glm::length(balls.left.momentum());
            balls.group->advance(steps);
            EXPECT_LT(largestDifference(balls.left, reference.left), 2e-3);
            EXPECT_LT(largestDifference(balls.right, reference.right), 2e-3);
            EXPECT_LT(glm::length(balls.left.momentum() + balls.right.momentum() - before), 1e-6 * size);
            const sim::PairLoads loads = balls.group->takeLoads();
            EXPECT_EQ(loads[0][1].impulse, -loads[1][0].impulse) << "to the last bit";
            EXPECT_LT(glm::length(loads[0][1].impulse - expected[0][1].impulse),
                      1e-3 * glm::length(expected[0][1].impulse));
            EXPECT_NEAR(loads[0][1].pressed / expected[0][1].pressed, 1, 1e-3);
            EXPECT_EQ(balls.group->takeLoads()[0][1].impulse, glm::dvec3(0)) << "taken once";
            hashes[kind == Kind::compute] =
                balls.left.solver->state().hash() + balls.right.solver->state().hash();
            // Once more: the same bytes.
            Balls again(kind, friction);
            again.group->advance(steps);
            EXPECT_EQ(again.left.solver->state().hash() + again.right.solver->state().hash(),
                      hashes[kind == Kind::compute]);
        }
        if (test::sharedTestContext()->info().software) {
            EXPECT_EQ(hashes[0], hashes[1]);
        }
    }
}

// A thread between two blocks that fly apart, drawn in; and one that breaks.
TEST_F(GlOrganGroup, threadsAgreeWithTheReferenceAndBreakAsItsDo) {
    const double side = 0.009;
    const auto play = [&](Kind kind, std::vector<sim::ThreadState>& states, glm::dvec3& momentum) {
        auto organs = std::make_unique<std::pair<std::unique_ptr<TestOrgan>, std::unique_ptr<TestOrgan>>>();
        organs->first = std::make_unique<TestOrgan>(test::boxLattice({0, 0, 0}, {side, side, side}, 0.003));
        organs->second =
            std::make_unique<TestOrgan>(test::boxLattice({0, 2 * side, 0}, {side, 3 * side, side}, 0.00225));
        TestOrgan &low = *organs->first, &high = *organs->second;
        test::stepTogether({&low, &high});
        test::makeSolvers({&low, &high}, kind);
        low.start({0.02, -0.1, 0.01});
        high.start({-0.03, 0.1, 0.02});
        std::vector<sim::TiedThread> threads(2);
        for (std::size_t i = 0; i < 2; ++i) {
            sim::TiedThread& tied = threads[i];
            tied.organs[1] = 1;
            double far = 0;
            tied.anchors[0] =
                sim::anchorAt(low.lattice, {(0.3 + 0.3 * double(i)) * side, 0.95 * side, 0.5 * side}, far);
            tied.anchors[1] = sim::anchorAt(high.lattice, {0.5 * side, 2.05 * side, 0.4 * side}, far);
            tied.thread.length = 0.5 * side;
            tied.thread.tightening = 0.05;
            tied.thread.time = 0.005;
            tied.thread.clip = i == 0;
            tied.thread.strength = i == 0 ? INFINITY : 0.004;
        }
        const auto group = test::groupOf({&low, &high}, 0, threads, false);
        group->advance(int(0.08 / low.setup.timeStep));
        states = group->threads();
        momentum = low.momentum() + high.momentum();
        return organs;
    };
    std::vector<sim::ThreadState> expected, got;
    glm::dvec3 before, momentum;
    const auto reference = play(Kind::reference, expected, before);
    EXPECT_FALSE(expected[0].broken);
    EXPECT_TRUE(expected[1].broken);
    for (const Kind kind : {Kind::cpu, Kind::fragment, Kind::compute}) {
        const auto organs = play(kind, got, momentum);
        EXPECT_LT(largestDifference(*organs->first, *reference->first), 2e-3);
        EXPECT_LT(largestDifference(*organs->second, *reference->second), 2e-3);
        EXPECT_LT(glm::length(momentum - before), 1e-6 * 0.1 * 0.002);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(got[i].broken, expected[i].broken);
            EXPECT_NEAR(got[i].startLength / expected[i].startLength, 1, 1e-4);
            EXPECT_NEAR(got[i].impulse / expected[i].impulse, 1, 5e-3);
            EXPECT_NEAR(got[i].work / expected[i].work, 1, 1e-2);
        }
        EXPECT_NEAR(got[0].force / expected[0].force, 1, 2e-2);
    }
}

TEST_F(GlOrganGroup, foldsAgreeWithTheReference) {
    // A fork whose limbs fly at each other, beside a ball that comes down on it.
    const auto play = [&](Kind kind, std::array<double, 2>& pressed) {
        std::vector<sim::LatticeCell> cells;
        for (int z = 0; z < 3; ++z)
            for (int x = 0; x < 8; ++x)
                for (int y = 0; y < 10; ++y)
                    if (y < 2 || x < 2 || x >= 6)
                        cells.push_back({{x, y, z}, 255});
        auto organs = std::make_unique<std::pair<std::unique_ptr<TestOrgan>, std::unique_ptr<TestOrgan>>>();
        organs->first = std::make_unique<TestOrgan>(sim::latticeFromCells(cells, 0.003, glm::dvec3(0)));
        organs->second = std::make_unique<TestOrgan>(test::ballLattice(0.008, 0.0026, {0.009, 0.017, 0.004}));
        TestOrgan &fork = *organs->first, &ball = *organs->second;
        test::stepTogether({&fork, &ball});
        test::makeSolvers({&fork, &ball}, kind);
        sim::LatticeState state = sim::restState(fork.lattice);
        for (std::size_t node = 0; node < fork.lattice.nodeCount(); ++node)
            if (const glm::ivec3 at = fork.lattice.nodes[node]; at.y > 2)
                state.increments[node].x =
                    (at.x <= 2 ? 0.1 : -0.1) * (at.y - 2) * fork.setup.timeStep / fork.lattice.spacing;
        fork.solver->setState(state);
        ball.start({0, -0.3, 0});
        auto group = std::move(sim::OrganGroup::create(
                                   {{fork.solver.get(), true, true}, {ball.solver.get(), true, false}}, {}))
                         .value();
        group->advance(int(0.02 / fork.setup.timeStep));
        const sim::PairLoads loads = group->takeLoads();
        pressed = {loads[0][0].pressed, loads[1][0].pressed};
        return organs;
    };
    std::array<double, 2> expected{}, pressed{};
    const auto reference = play(Kind::reference, expected);
    EXPECT_GT(expected[0], 0) << "the limbs met";
    EXPECT_GT(expected[1], 0) << "the ball came down on them";
    for (const Kind kind : {Kind::cpu, Kind::fragment, Kind::compute}) {
        const auto organs = play(kind, pressed);
        EXPECT_LT(largestDifference(*organs->first, *reference->first), 5e-3);
        EXPECT_LT(largestDifference(*organs->second, *reference->second), 5e-3);
        EXPECT_NEAR(pressed[0] / expected[0], 1, 5e-3);
        EXPECT_NEAR(pressed[1] / expected[1], 1, 5e-3);
    }
}

TEST_F(GlOrganGroup, aCutIsNoBridgeForContact) {
    // Cuts change the skin: both kinds of solver remake it, keep what they had counted, and agree.
    for (const Kind kind : {Kind::cpu, Kind::compute}) {
        Balls reference(Kind::reference, 0), balls(kind, 0);
        for (Balls* b : {&reference, &balls}) {
            b->group->advance(40);
            sim::Stroke stroke;
            stroke.from = {glm::dvec3(-0.05, 0.001, -0.03), glm::dvec3(-0.05, 0.001, 0.03)};
            stroke.to = {glm::dvec3(0.003, 0.001, -0.03), glm::dvec3(0.003, 0.001, 0.03)};
            ASSERT_TRUE(b->left.solver->cut(stroke).ok());
            b->group->reconnect(0);
            b->group->advance(30);
        }
        EXPECT_FALSE(balls.left.solver->state().connections.empty());
        EXPECT_LT(largestDifference(balls.left, reference.left), 5e-3);
        const sim::PairLoads got = balls.group->takeLoads(), expected = reference.group->takeLoads();
        EXPECT_NEAR(got[0][1].pressed / expected[0][1].pressed, 1, 5e-3);
    }
}
