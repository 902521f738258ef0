// Organs that touch: momentum, energy, equal and opposite forces, closed forms, nothing passes through.
#include "sim/pair_contact.h"
#include "tests/sim/coupled_organs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

using namespace serosa;
using test::Kind;
using test::TestOrgan;

namespace {

constexpr double kRadius = 0.02; // m, of balls

/// Two balls of different spacing that fly at each other, not quite head on.
struct Balls {
    TestOrgan left{test::ballLattice(kRadius, 0.003, {-0.022, 0, 0})};
    TestOrgan right{test::ballLattice(kRadius, 0.0042, {0.022, 0.006, 0.003})};
    std::unique_ptr<sim::OrganGroup> group;
    Balls(Kind kind, double friction, double speed) {
        test::stepTogether({&left, &right});
        test::makeSolvers({&left, &right}, kind);
        left.start({speed, 0, 0});
        right.start({-speed, 0, 0});
        group = test::groupOf({&left, &right}, friction);
    }
    int stepsIn(double seconds) const { return int(seconds / left.setup.timeStep); }
};

} // namespace

TEST(PairContact, skinOfABallIsOnTheSphereWhateverTheSpacing) {
    for (const double spacing : {0.005, 0.003, 0.0021}) {
        SCOPED_TRACE(spacing);
        const glm::dvec3 centre(0.3, -0.2, 1.1);
        TestOrgan ball(test::ballLattice(kRadius, spacing, centre));
        sim::CoupledMember member;
        member.setup = &ball.setup;
        member.touches = true;
        const sim::CoupledGroup group = sim::coupleOrgans({member});
        std::vector<glm::dvec3> positions, offsets, normals;
        // Turned and moved: the skin follows.
        const glm::dquat turn = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3)));
        const glm::dvec3 by(3, 1, -2), middle = (centre - ball.lattice.origin) / group.length;
        for (std::size_t i = 0; i < group.nodeCount(); ++i)
            positions.push_back(
                by + turn * group.organs[0].toGroup(ball.lattice.restPosition(group.latticeNode[i])));
        sim::placeSkin(group, positions, offsets, normals);
        ASSERT_GT(group.organs[0].skinNodes, 100u);
        for (std::size_t i = 0; i < group.organs[0].skinNodes; ++i) {
            const glm::dvec3 out = positions[i] + offsets[i] - by - turn * middle;
            EXPECT_NEAR(glm::length(out), kRadius / spacing, 0.02);
            EXPECT_GT(glm::dot(glm::normalize(out), normals[i]), std::cos(0.12));
            EXPECT_NEAR(group.thickness[i], 4, 1e-9);
        }
        // The triangles are the sphere's area.
        double area = 0;
        for (const glm::uvec3& t : group.triangles) {
            const auto p = [&](std::uint32_t i) { return positions[i] + offsets[i]; };
            area += 0.5 * glm::length(glm::cross(p(t.y) - p(t.x), p(t.z) - p(t.x)));
        }
        EXPECT_NEAR(area * spacing * spacing / (4 * M_PI * kRadius * kRadius), 1, 0.03);
    }
}

TEST(PairContact, skinKnowsHowThinAnOrganIs) {
    const double h = 0.003;
    TestOrgan sheet(test::boxLattice({0, 0, 0}, {0.03, 0.0012, 0.03}, h));
    sim::CoupledMember member;
    member.setup = &sheet.setup;
    member.touches = true;
    const sim::CoupledGroup group = sim::coupleOrgans({member});
    int inside = 0;
    for (std::size_t i = 0; i < group.organs[0].skinNodes; ++i) {
        const glm::dvec3 at = sheet.lattice.toWorld(sheet.lattice.restPosition(group.latticeNode[i]));
        if (std::min({at.x, at.z, 0.03 - at.x, 0.03 - at.z}) < 2 * h)
            continue;
        EXPECT_NEAR(group.thickness[i], 0.4, 0.02);
        ++inside;
    }
    EXPECT_GT(inside, 20);
}

TEST(PairContact, keepsMomentumOfFreeOrgans) {
    for (const Kind kind : {Kind::reference, Kind::cpu})
        for (const double friction : {0.0, 0.4}) {
            Balls balls(kind, friction, 0.3);
            const glm::dvec3 before = balls.left.momentum() + balls.right.momentum();
            const double size = glm::length(balls.left.momentum());
            double worst = 0;
            glm::dvec3 got(0);
            const glm::dvec3 leftBefore = balls.left.momentum();
            for (int frame = 0; frame < 12; ++frame) {
                balls.group->advance(balls.stepsIn(0.01));
                worst = std::max(worst, glm::length(balls.left.momentum() + balls.right.momentum() - before));
                const sim::PairLoads loads = balls.group->takeLoads();
                EXPECT_LE(glm::length(loads[0][1].impulse + loads[1][0].impulse),
                          1e-13 * loads[0][1].pressed);
                got += loads[0][1].impulse;
            }
            EXPECT_LT(worst, (kind == Kind::cpu ? 1e-6 : 1e-12) * size);
            EXPECT_LT(balls.left.momentum().x, -0.5 * size) << "they met";
            // What the loads say is what the organ's own nodes got.
            EXPECT_LT(glm::length(balls.left.momentum() - leftBefore - got),
                      (kind == Kind::cpu ? 1e-6 : 1e-12) * size);
        }
}

TEST(PairContact, ballsThatCollideSeparateAndGainNoEnergy) {
    for (const double speed : {0.05, 0.3}) {
        Balls balls(Kind::reference, 0, speed);
        const double before = balls.left.energy() + balls.right.energy();
        double most = 0;
        for (int frame = 0; frame < 40; ++frame) {
            balls.group->advance(balls.stepsIn(0.1 / 40 * 0.3 / speed));
            most = std::max(most, balls.left.energy() + balls.right.energy());
        }
        const double after = balls.left.energy() + balls.right.energy();
        EXPECT_LT(most, before * (1 + 1e-3));
        EXPECT_GT(after, 0.7 * before) << "soft balls bounce";
        EXPECT_GT(glm::length(balls.right.centre() - balls.left.centre()), 2.2 * kRadius);
        EXPECT_EQ(balls.group->takeLoads()[0][1].impulse == glm::dvec3(0), false);
        balls.group->advance(10);
        EXPECT_EQ(balls.group->takeLoads()[0][1].impulse, glm::dvec3(0));
    }
}

// Two columns of one cross-section and different spacing, one on the other, pressed by a given distance: a
// column of the sum of lengths, F = E A d / L.
TEST(PairContact, columnsOfDifferentSpacingCarryTheForceOfOneColumn) {
    for (const Kind kind : {Kind::reference, Kind::cpu})
        for (const double spacing : {0.003, 0.00225}) {
            const double side = 0.018, height = 0.018, press = 0.0018;
            TestOrgan low(test::boxLattice({0, 0, 0}, {side, height, side}, 0.003));
            TestOrgan high(test::boxLattice({0, height, 0}, {side, 2 * height, side}, spacing));
            low.fix([](const glm::dvec3& p) { return p.y < 1e-6; });
            high.fix([&](const glm::dvec3& p) { return p.y > 2 * height - 1e-6; });
            for (TestOrgan* organ : {&low, &high}) {
                organ->setup.tissue.airDrag = 150;
                organ->setup.tissue.poisson = 0.25;
            }
            test::stepTogether({&low, &high});
            test::makeSolvers({&low, &high}, kind);
            low.start(glm::dvec3(0));
            // Squeezed evenly, so that it begins without a gap or an overlap.
            for (TestOrgan* organ : {&low, &high}) {
                sim::LatticeState state = sim::restState(organ->lattice);
                for (glm::dvec3& q : state.positions) {
                    glm::dvec3 p = organ->lattice.toWorld(q);
                    p.y *= 1 - press / (2 * height);
                    q = organ->lattice.toLattice(p);
                }
                organ->solver->setState(state);
            }
            const auto group = test::groupOf({&low, &high});
            const double dt = low.setup.timeStep;
            group->advance(int(0.4 / dt));
            group->takeLoads();
            const int steps = int(0.05 / dt);
            group->advance(steps);
            const sim::PairLoads loads = group->takeLoads();
            const double force = loads[1][0].impulse.y / (steps * dt);
            const double expected = low.setup.tissue.young * side * side * press / (2 * height);
            // Springs soften under pressure: a column of one lattice has 0.985 as well.
            EXPECT_NEAR(force / expected, 0.985, 0.02) << spacing;
            EXPECT_LT(std::hypot(loads[1][0].impulse.x, loads[1][0].impulse.z),
                      0.02 * std::abs(loads[1][0].impulse.y));
        }
}

TEST(PairContact, pressedOrgansCarryEqualAndOppositeForces) {
    TestOrgan low(test::ballLattice(kRadius, 0.003, {0, 0, 0}));
    TestOrgan high(test::ballLattice(kRadius, 0.0042, {0.001, 2 * kRadius + 0.0002, 0.002}));
    low.fix([](const glm::dvec3& p) { return p.y < -0.01; });
    const double top = 3 * kRadius + 0.0002, probe = 0.03;
    high.setup.tools = {
        {"probe",
         sim::ToolMode::push,
         probe,
         {{0, {0.001, top + probe + 0.001, 0.002}}, {0.3, {0.001, top + probe - 0.006, 0.002}}}}};
    for (TestOrgan* organ : {&low, &high})
        organ->setup.tissue.airDrag = 100;
    test::stepTogether({&low, &high});
    test::makeSolvers({&low, &high}, Kind::cpu);
    low.start(glm::dvec3(0));
    high.start(glm::dvec3(0));
    // Some friction: a ball between two balls is no stable place.
    const auto group = test::groupOf({&low, &high}, 0.5);
    const double dt = low.setup.timeStep;
    group->advance(int(0.7 / dt));
    group->takeLoads();
    high.solver->takeLoads();
    const glm::dvec3 before = high.momentum();
    group->advance(int(0.1 / dt));
    const sim::PairLoads loads = group->takeLoads();
    const glm::dvec3 tool = high.solver->takeLoads()[0].impulse, got = loads[0][1].impulse,
                     gave = loads[1][0].impulse;
    EXPECT_LT(glm::length(got + gave), 1e-12 * glm::length(got));
    EXPECT_LT(got.y, 0) << "the lower one is pressed down";
    EXPECT_GT(gave.y, 0);
    // At rest what the tool gives, the other organ takes.
    EXPECT_NEAR(-tool.y / gave.y, 1, 0.005);
    EXPECT_LT(glm::length(high.momentum() - before), 0.02 * glm::length(gave));
}

// Steps of up to eight spacings, from both sides, against sheets from a tenth of a cell to a cell thick: what
// was on one side stays there.
TEST(PairContact, nothingPassesAThinSheetInOneStep) {
    std::mt19937 random(11);
    const auto number = [&random](double low, double high) {
        return low + (high - low) * (double(random()) / 4294967296.0);
    };
    const double h = 0.003;
    int stopped = 0;
    for (const double thickness : {0.0003, 0.001, 0.003})
        for (int i = 0; i < 60; ++i) {
            TestOrgan sheet(test::boxLattice({-0.05, -thickness, -0.05}, {0.05, 0, 0.05}, h));
            sheet.fix([](const glm::dvec3&) { return true; });
            TestOrgan ball(test::ballLattice(0.007, i % 2 ? 0.0035 : 0.002, {0, 0.0073, 0}));
            sim::CoupledMember low, high;
            low.setup = &sheet.setup;
            high.setup = &ball.setup;
            low.touches = high.touches = true;
            const sim::CoupledGroup group = sim::coupleOrgans({low, high});
            sim::CoupledMotion motion;
            motion.inverseMass = group.inverseMass;
            // From above or, turned over, from below.
            const bool below = i % 3 == 0;
            const double side = below ? -1 : 1, way = number(0.2, 8);
            const glm::dvec3 move(number(-0.5, 0.5) * way, -side * way, number(-0.5, 0.5) * way),
                place(number(-3, 3), number(0, 0.9) * way, number(-3, 3));
            for (std::size_t o = 0; o < 2; ++o)
                for (std::size_t k = 0; k < group.organs[o].nodes; ++k) {
                    const std::size_t node = group.organs[o].firstNode + k;
                    glm::dvec3 p = group.organs[o].toGroup(
                        group.organs[o].lattice->restPosition(group.latticeNode[node]));
                    if (o == 1) {
                        p += place;
                        if (below) {
                            const double middle = (-0.5 * thickness - sheet.lattice.origin.y) / group.length;
                            p.y -= 2 * (p.y - middle);
                            p.z = -p.z;
                        }
                    }
                    motion.positions.push_back(p);
                    motion.increments.push_back(o == 1 ? move : glm::dvec3(0));
                }
            std::vector<glm::dvec3> offsets, normals;
            sim::placeSkin(group, motion.positions, offsets, normals);
            sim::PairContacts contacts(group, 0);
            contacts.solve(motion);
            stopped += !contacts.contacts().empty();
            const double surface = ((below ? -thickness : 0) - sheet.lattice.origin.y) / group.length;
            for (std::size_t k = 0; k < group.organs[1].skinNodes; ++k) {
                const std::size_t node = group.organs[1].firstNode + k;
                const glm::dvec3 end = motion.positions[node] + offsets[node] + motion.increments[node];
                // What looks at the sheet is stopped, but for what the iteration leaves; the rest hangs on
                // to it.
                if (side * normals[node].y < -0.3) {
                    EXPECT_GT(side * (end.y - surface), -0.15 * way)
                        << "case " << i << ", " << thickness << ", " << way;
                }
            }
        }
    EXPECT_GT(stopped, 80);
}

TEST(PairContact, aBallIsStoppedByASheetOneCellThick) {
    for (const double thickness : {0.001, 0.003})
        for (const double side : {1.0, -1.0}) {
            SCOPED_TRACE(thickness);
            TestOrgan sheet(test::boxLattice({-0.03, -thickness, -0.03}, {0.03, 0, 0.03}, 0.003));
            sheet.fix([](const glm::dvec3& p) { return std::max(std::abs(p.x), std::abs(p.z)) > 0.0269; });
            const double start = side > 0 ? 0.0085 : -thickness - 0.0085;
            TestOrgan ball(test::ballLattice(0.008, 0.0024, {0.001, start, 0.002}));
            test::stepTogether({&sheet, &ball});
            test::makeSolvers({&sheet, &ball}, Kind::cpu);
            sheet.start(glm::dvec3(0));
            ball.start({0, -side, 0}); // 1 m/s
            const auto group = test::groupOf({&sheet, &ball});
            double least = 1;
            for (int i = 0; i < 40; ++i) {
                group->advance(int(0.002 / sheet.setup.timeStep));
                const sim::LatticeState a = sheet.solver->state();
                const glm::dvec3 centre = ball.centre();
                double nearest = 1, surface = 0; // of the sheet below the ball
                for (std::size_t node = 0; node < a.positions.size(); ++node) {
                    const glm::dvec3 p = sheet.lattice.toWorld(a.positions[node]);
                    if (const double aside = std::hypot(p.x - centre.x, p.z - centre.z); aside < nearest) {
                        nearest = aside;
                        surface = p.y;
                    }
                }
                least = std::min(least, side * (centre.y - surface));
            }
            EXPECT_GT(least, 0.003) << "the ball's middle stays on its side";
            EXPECT_GT(side * ball.momentum().y, 0) << "and it is thrown back";
        }
}

// A block on a slab that is tilted: it slides where tan(angle) > mu, and is then held back by mu times what
// presses it on.
TEST(PairContact, aBlockSlidesWhereTheSlopeIsSteeperThanFriction) {
    const double mu = 0.5;
    for (const double tangent : {0.475, 0.525, 0.7}) {
        SCOPED_TRACE(tangent);
        const double angle = std::atan(tangent);
        TestOrgan slab(test::boxLattice({-0.015, -0.006, -0.009}, {0.03, 0, 0.009}, 0.003));
        slab.fix([](const glm::dvec3& p) { return p.y < -0.0059; });
        TestOrgan block(test::boxLattice({-0.0105, 0, -0.006}, {0.0015, 0.006, 0.006}, 0.0024));
        for (TestOrgan* organ : {&slab, &block}) {
            organ->setup.gravity = 9.81 * glm::dvec3(std::sin(angle), -std::cos(angle), 0);
            organ->setup.tissue.young = 3e4;
        }
        test::stepTogether({&slab, &block});
        test::makeSolvers({&slab, &block}, Kind::cpu);
        slab.start(glm::dvec3(0));
        block.start(glm::dvec3(0));
        const auto group = test::groupOf({&slab, &block}, mu);
        const double dt = slab.setup.timeStep;
        double mass = 0;
        for (std::size_t node = 0; node < block.lattice.nodeCount(); ++node)
            mass += block.mass(node);
        group->advance(int((tangent < mu ? 0.25 : 0.05) / dt)); // it drops onto the slab, and slides at first
        const double speed = block.momentum().x / mass;
        group->takeLoads();
        const int steps = int(0.05 / dt);
        group->advance(steps);
        const double gained = block.momentum().x / mass - speed;
        const glm::dvec3 got = group->takeLoads()[1][0].impulse;
        EXPECT_NEAR(got.y / (mass * 9.81 * std::cos(angle) * steps * dt), 1, 0.02);
        if (tangent < mu) {
            EXPECT_NEAR(-got.x / got.y, tangent, 0.01);
            EXPECT_LT(std::abs(block.momentum().x / mass), 1e-4) << "it stays";
        } else {
            EXPECT_NEAR(-got.x / got.y, mu, 0.02 * mu);
            EXPECT_NEAR(gained, 9.81 * (std::sin(angle) - mu * std::cos(angle)) * steps * dt,
                        0.02 * mu * 9.81 * steps * dt);
            EXPECT_GT(gained, 0);
        }
    }
}
