// An organ that folds touches itself: the two limbs of a strip meet and do not pass; its neighbourhood, a
// bend and a squeeze are no contact.
#include "sim/pair_contact.h"
#include "tests/sim/coupled_organs.h"

#include <algorithm>
#include <cmath>

using namespace serosa;
using test::Kind;
using test::TestOrgan;

namespace {

/// A strip like a U: two limbs of `thickness` x `length` x 3 cells, `gap` cells apart, and a base.
sim::Lattice forkLattice(int thickness, int length, int gap, std::uint8_t fill) {
    std::vector<sim::LatticeCell> cells;
    for (int z = 0; z < 3; ++z)
        for (int x = 0; x < 2 * thickness + gap; ++x)
            for (int y = 0; y < length; ++y)
                if (y < 2 || x < thickness || x >= thickness + gap)
                    cells.push_back({{x, y, z}, fill});
    return sim::latticeFromCells(cells, 0.003, glm::dvec3(0));
}

/// The limbs fly at each other. \param least how near the inner faces came (spacings, below 0: passed)
std::unique_ptr<TestOrgan> clap(Kind kind, bool contact, double& least, double& gained) {
    const int thickness = 2, length = 12, gap = 4;
    auto fork = std::make_unique<TestOrgan>(forkLattice(thickness, length, gap, 255));
    const sim::Lattice& lattice = fork->lattice;
    const auto gridOf = [&](std::size_t node) { return lattice.nodes[node]; };
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        fork->setup.fixed.push_back(gridOf(node).y == 0);
    test::stepTogether({fork.get()});
    test::makeSolvers({fork.get()}, kind);
    sim::LatticeState state = sim::restState(lattice);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        if (gridOf(node).y > 2) {
            const double speed = 0.9 * (gridOf(node).y - 2) / double(length - 2); // m/s at the tip
            state.increments[node].x =
                (gridOf(node).x <= thickness ? 1 : -1) * speed * fork->setup.timeStep / lattice.spacing;
        }
    fork->solver->setState(state);
    auto group = std::move(sim::OrganGroup::create({{fork->solver.get(), false, contact}}, {})).value();
    const double before = fork->energy();
    const glm::dvec3 momentum = fork->momentum();
    least = gap;
    gained = 0;
    for (int i = 0; i < 60; ++i) {
        group->advance(int(0.001 / fork->setup.timeStep));
        const sim::LatticeState now = fork->solver->state();
        for (int y = 3; y < length; ++y)
            for (int z = 1; z < 3; ++z)
                least =
                    std::min(least, now.positions[std::size_t(lattice.nodeAt({thickness + gap, y, z}))].x -
                                        now.positions[std::size_t(lattice.nodeAt({thickness, y, z}))].x);
        gained = std::max(gained, fork->energy() / before - 1);
    }
    EXPECT_LT(glm::length(momentum), 1e-12) << "the limbs are mirror images";
    return fork;
}

} // namespace

TEST(SelfContact, limbsOfAForkMeetAndDoNotPass) {
    double least = 0, gained = 0;
    clap(Kind::cpu, false, least, gained);
    EXPECT_LT(least, -1) << "without contact they pass";
    for (const Kind kind : {Kind::reference, Kind::cpu}) {
        clap(kind, true, least, gained);
        EXPECT_GT(least, -0.15) << "spacings";
        EXPECT_LT(least, 0.2) << "they meet";
        EXPECT_LT(gained, 1e-3);
    }
}

TEST(SelfContact, nothingTouchesInASqueezedOrBentOrgan) {
    // A thin sheet and a thick block, squeezed to 70% and bent: no part of it meets another.
    const double h = 0.003;
    for (const double thickness : {0.3, 1.0, 1.6, 3.0}) {
        TestOrgan sheet(test::boxLattice({0, 0, 0}, {16 * h, thickness * h, 5 * h}, h));
        sim::CoupledMember member;
        member.setup = &sheet.setup;
        member.touchesItself = true;
        const sim::CoupledGroup group = sim::coupleOrgans({member});
        sim::CoupledMotion motion;
        motion.inverseMass = group.inverseMass;
        const double radius = 5; // spacings, of the bend: a half circle
        for (std::size_t i = 0; i < group.nodeCount(); ++i) {
            const glm::dvec3 q = 0.7 * sheet.lattice.restPosition(group.latticeNode[i]);
            motion.positions.emplace_back((radius + q.y) * std::sin(q.x / radius),
                                          (radius + q.y) * std::cos(q.x / radius), q.z);
            motion.increments.emplace_back(-0.02 * q); // squeezed further
        }
        sim::PairContacts contacts(group, 0);
        contacts.solve(motion);
        EXPECT_EQ(contacts.contacts().size(), 0u) << thickness;
    }
}
