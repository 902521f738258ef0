// What is said of tools and bodies before a run: who begins inside of an organ, and grasps on the same nodes.

#include "app/contact_notes.h"
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
    scene_.tools[0].mode = sim::ToolMode::grasp;
    EXPECT_TRUE(notes().empty()) << "grasps are there to be inside";

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

} // namespace
} // namespace serosa::app
