// What is said of tools and bodies before a run: who begins inside of an organ, and grasps on the same nodes.

#include "app/contact_notes.h"
#include "app/tool_entry.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

namespace serosa::app {
namespace {

class ContactNotes : public ::testing::Test {
protected:
    ContactNotes() : organ_{} {
        sim::LatticeRequest request;
        request.spacing = 0.01;
        Result<sim::Lattice> lattice =
            sim::buildLattice(test::boxMesh({0, 0, 0}, {0.06, 0.06, 0.06}), request);
        EXPECT_TRUE(lattice.ok());
        lattice_ = std::move(*lattice);
        organ_.name = "cube";
        fixed_.assign(lattice_.nodeCount(), false);
        fixed_[0] = true;
        scene_.file = "scene.toml";
    }
    std::vector<PlacedOrgan> placed() const { return {{&organ_, &lattice_, &fixed_}}; }
    std::vector<std::string> notes() const { return contactNotes(scene_, placed()); }
    static sim::Tool grasp(const std::string& name, double from, double to, const glm::dvec3& at,
                           double radius) {
        sim::Tool tool;
        tool.name = name;
        tool.mode = sim::ToolMode::grasp;
        tool.radius = radius;
        tool.keys = {{from, at}, {to, at}};
        tool.line = 17;
        return tool;
    }
    sim::Organ organ_;
    sim::Lattice lattice_;
    std::vector<bool> fixed_;
    sim::Scene scene_;
};

TEST_F(ContactNotes, NameToolsAndBodiesThatBeginInside) {
    EXPECT_TRUE(notes().empty());
    sim::Tool probe;
    probe.name = "probe";
    probe.radius = 0.01;
    probe.keys = {{0, {0.03, 0.07, 0.03}}}; // touches
    scene_.tools = {probe};
    EXPECT_TRUE(notes().empty());
    scene_.tools[0].keys[0].at.y = 0.065; // 5 mm deep
    ASSERT_EQ(notes().size(), 1u);
    EXPECT_EQ(notes()[0].rfind("probe begins inside of cube, ", 0), 0u) << notes()[0];
    const double deep = std::stod(notes()[0].substr(notes()[0].find("cube, ") + 6));
    EXPECT_NEAR(deep, 5, 1);
    EXPECT_NE(notes()[0].find("comes in from outside"), std::string::npos);
    scene_.tools[0].mode = sim::ToolMode::grasp;
    EXPECT_TRUE(notes().empty()) << "grasps are there to be inside";
    scene_.tools[0].keys[0].at = {0.2, 0.2, 0.2};
    ASSERT_EQ(notes().size(), 1u);
    EXPECT_NE(notes()[0].find("where no node rests"), std::string::npos) << notes()[0];
    scene_.tools[0].keys[0].at = {0, 0, 0};
    scene_.tools[0].radius = 0.001; // node 0
    ASSERT_EQ(notes().size(), 1u);
    EXPECT_NE(notes()[0].find("on fixed nodes alone"), std::string::npos) << notes()[0];

    scene_.tools.clear();
    sim::Body table;
    table.name = "table";
    table.shape.kind = sim::ShapeKind::halfSpace;
    table.shape.radius = 0;
    scene_.bodies = {table}; // at y = 0: the cube stands on it
    EXPECT_TRUE(notes().empty());
    scene_.bodies[0].pose.at.y = 0.004;
    ASSERT_EQ(notes().size(), 1u);
    EXPECT_NE(notes()[0].find("table begins inside of cube, 4 mm deep"), std::string::npos) << notes()[0];
    // A thin wire deep in the organ, between its nodes.
    scene_.bodies.clear();
    sim::Tool wire;
    wire.name = "wire";
    wire.radius = 0.0005;
    wire.shape.kind = sim::ShapeKind::capsule;
    wire.shape.length = 0.02;
    wire.keys = {{0, {0.035, 0.035, 0.02}}};
    scene_.tools = {wire};
    EXPECT_EQ(notes().size(), 1u);
}

TEST_F(ContactNotes, SayThatAnOrganFalls) {
    fixed_.assign(fixed_.size(), false);
    ASSERT_EQ(notes().size(), 1u);
    EXPECT_NE(notes()[0].find("it falls"), std::string::npos);
    scene_.gravity = glm::dvec3(0);
    EXPECT_TRUE(notes().empty());
}

TEST_F(ContactNotes, TwoGraspsOnTheSameNodesAreRefused) {
    const glm::dvec3 corner(0.06, 0.06, 0.06), other(0, 0.06, 0.06);
    const auto refused = [&] { return !checkGrasps(scene_, placed()).ok(); };
    scene_.tools = {grasp("left", 0, 1, corner, 0.015), grasp("right", 0.5, 2, corner, 0.012)};
    ASSERT_TRUE(refused());
    const std::string message = checkGrasps(scene_, placed()).error().message;
    EXPECT_EQ(message.rfind("scene.toml:17: right closes at 0.5 s on ", 0), 0u) << message;
    EXPECT_NE(message.find("of cube that left holds"), std::string::npos) << message;
    scene_.tools[1].keys[0].time = 1; // as the first lets go
    EXPECT_FALSE(refused());
    scene_.tools[1].keys[0].time = 0; // together: the first in the scene holds
    EXPECT_TRUE(refused());
    scene_.tools[1].keys[0].at = other;
    EXPECT_FALSE(refused());
    // The first has carried its nodes away by then, and to where the other one closes.
    scene_.tools = {grasp("left", 0, 1, corner, 0.015), grasp("right", 0.5, 2, corner, 0.012)};
    scene_.tools[0].keys[1].at += glm::dvec3(0.1, 0, 0);
    EXPECT_FALSE(refused());
    scene_.tools[1].keys[0].at = corner + glm::dvec3(0.05, 0, 0);
    EXPECT_TRUE(refused());
    // Fixed nodes are nobody's.
    fixed_.assign(fixed_.size(), true);
    EXPECT_FALSE(refused());
}

// It begins clear of the organ, comes to its place evenly, and is where its keys say from then on.
TEST_F(ContactNotes, AToolThatWouldBeginInsideComesInFromOutside) {
    sim::Tool probe;
    probe.name = "probe";
    probe.radius = 0.01;
    probe.keys = {{0, {0.03, 0.05, 0.03}}, {0.1, {0.03, 0.06, 0.03}}, {2, {0.03, 0.04, 0.03}}};
    sim::Tool beside = probe;
    beside.keys = {{0, {0.03, 0.09, 0.03}}};
    scene_.tools = {probe, beside};
    const auto entry = toolEntry(probe, placed());
    ASSERT_TRUE(entry);
    EXPECT_NEAR(entry->deep, 0.02, 0.003) << "as the nodes have it";
    EXPECT_NEAR(entry->offset.y, 0.025, 0.006) << "the shortest way: up";
    EXPECT_NEAR(glm::length(entry->offset), entry->offset.y, 1e-12);
    EXPECT_NEAR(entry->time, glm::length(entry->offset) / (6 * 0.01), 1e-12);
    const std::vector<std::string> said = bringToolsIn(scene_, placed());
    ASSERT_EQ(said.size(), 1u);
    const sim::Tool& now = scene_.tools[0];
    EXPECT_LT(depthInside(now.wholeShape(), now.poseAt(0), lattice_), 0);
    for (const double time : {0.0, 0.05, 0.1, 0.2, 0.3, 1.0, 3.0}) {
        const glm::dvec3 by = entry->offset * std::max(0.0, 1 - time / entry->time);
        EXPECT_LT(glm::distance(now.poseAt(time).at, probe.poseAt(time).at + by), 1e-12) << time;
    }
    EXPECT_EQ(scene_.tools[1].keys.size(), 1u) << "the other one is as it was";
    EXPECT_TRUE(bringToolsIn(scene_, placed()).empty()) << "once";
}

} // namespace
} // namespace serosa::app
