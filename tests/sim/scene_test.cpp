// Scene files: every value in SI units, the defaults that the reference states, regions, the default scene.

#include "sim/scene.h"
#include "sim/scene_keys.h"
#include "tests/sim/scene_files.h"

#include <gtest/gtest.h>

namespace serosa::sim {
namespace {

class SceneTest : public ::testing::Test {
protected:
    Scene mustRead(const std::string& text) {
        const Result<Scene> scene = files_.read(text, &values_);
        EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message);
        return scene.ok() ? *scene : Scene{};
    }
    SceneFiles files_;
    std::vector<SceneValue> values_;
};

TEST_F(SceneTest, ReadsTheSceneOfTheDesign) {
    const Scene scene = mustRead(R"(schema = 1
frame_rate = "50 Hz"
duration = "1.5 s"
gravity = ["0 m/s2", "-1.62 m/s2", "1 cm/s2"]
[[organ]]
name = "heart"
model = "ball.ply"
length_unit = "mm"
nodes = 12000
[organ.tissue]
young = "3 kPa"
poisson = 0.25
density = "1060 kg/m3"
damping_time = "2 ms"
air_drag = "0.5 1/s"
[[organ.fixed]]
shape = "half-space"
below = "-40 mm"
[[organ.fixed]]
shape = "sphere"
centre = ["1 mm", "2 mm", "3 mm"]
radius = "1 cm"
[[organ.fixed]]
shape = "box"
min = ["-1 mm", "-1 mm", "-1 mm"]
max = ["1 mm", "1 mm", "1 mm"]
[[organ.fixed]]
shape = "lowest"
share = 0.1
[[tool]]
kind = "sphere"
radius = "6 mm"
mode = "grasp"
keys = [{ t = "0 s", at = ["0 mm", "80 mm", "0 mm"] }, { t = "1 s", at = ["0 mm", "45 mm", "0 mm"] }]
[camera]
projection = "orthographic"
height = "10 cm"
[light]
intensity = 2
[look]
mapping = "one-to-one"
colour = "dynamic-normal"
lattice = true
[output]
size = [320, 200]
surfaces_at = ["1 s", "0.5 s"]
frame_every = 2
)");
    EXPECT_EQ(scene.frames(), 75);
    EXPECT_DOUBLE_EQ(scene.gravity.z, 0.01);
    ASSERT_EQ(scene.organs.size(), 1u);
    const Organ& organ = scene.organs[0];
    EXPECT_EQ(organ.name, "heart");
    EXPECT_EQ(organ.model, files_.folder() / "ball.ply");
    EXPECT_DOUBLE_EQ(organ.lengthUnit, 0.001);
    EXPECT_EQ(organ.nodes, 12000u);
    EXPECT_DOUBLE_EQ(organ.tissue.young, 3000);
    EXPECT_DOUBLE_EQ(organ.tissue.dampingTime, 0.002);
    EXPECT_DOUBLE_EQ(organ.tissue.airDrag, 0.5);
    ASSERT_EQ(organ.fixed.size(), 3u);
    EXPECT_DOUBLE_EQ(*organ.fixed[0].below, -0.04);
    EXPECT_EQ(organ.fixed[0].line, 17);
    EXPECT_DOUBLE_EQ(organ.fixed[1].centre.y, 0.002);
    EXPECT_DOUBLE_EQ(organ.fixedLowestShare, 0.1);
    ASSERT_EQ(scene.tools.size(), 1u);
    EXPECT_EQ(scene.tools[0].mode, ToolMode::grasp);
    EXPECT_DOUBLE_EQ(scene.tools[0].centreAt(0.5).y, 0.0625);
    EXPECT_EQ(scene.camera.projection, Projection::orthographic);
    EXPECT_DOUBLE_EQ(*scene.camera.height, 0.1);
    EXPECT_EQ(scene.look.mapping, Mapping::oneToOne);
    EXPECT_EQ(scene.look.colour, SurfaceColour::dynamicNormal);
    EXPECT_TRUE(scene.look.lattice);
    EXPECT_EQ(scene.output.width, 320);
    EXPECT_EQ(scene.output.surfacesAt, (std::vector<double>{1, 0.5}));
}

// The reference states defaults as text, sim/scene.h as values: a scene that writes every default down is the
// scene that writes none.
TEST_F(SceneTest, DefaultsOfTheReferenceAreTheOnesInForce) {
    mustRead(files_.minimal());
    const std::vector<SceneValue> unwritten = values_;
    std::string text, organ, later;
    for (const SceneKey& key : sceneKeys()) {
        const std::string table = key.table;
        if (key.required() || *key.fallback == '\0' || table == "tool" || table == "body" ||
            table == "thread" || table == "cut" || table.rfind("deformation", 0) == 0 ||
            table.rfind("look.cut_volume", 0) == 0)
            continue;
        const std::string line = std::string(key.name) + " = " + key.fallback + "\n";
        if (table.empty())
            text += line;
        else if (table == "organ")
            organ += line;
        else if (table != "organ.fixed" && table != "organ.region") {
            if (later.find("[" + table + "]") == std::string::npos)
                later += "[" + table + "]\n";
            later += line;
        }
    }
    values_.clear();
    mustRead("schema = 1\n" + text + "[[organ]]\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\n" + organ +
             later);
    ASSERT_EQ(values_.size(), unwritten.size());
    for (std::size_t i = 0; i < values_.size(); ++i) {
        EXPECT_EQ(values_[i].path, unwritten[i].path);
        EXPECT_EQ(values_[i].value, unwritten[i].value) << values_[i].path;
        EXPECT_GT(values_[i].line, 0) << values_[i].path;
    }
}

TEST_F(SceneTest, ExplainsWhereValuesComeFrom) {
    mustRead(files_.minimal() + "[organ.tissue]\nyoung = \"3 kPa\"\n");
    const auto value = [&](const std::string& path) -> SceneValue {
        for (const SceneValue& candidate : values_)
            if (candidate.path == path)
                return candidate;
        ADD_FAILURE() << path << " is not explained";
        return {};
    };
    EXPECT_EQ(value("organ[0].tissue.young").value, "3000 Pa");
    EXPECT_EQ(value("organ[0].tissue.young").line, 6);
    EXPECT_NE(value("organ[0].tissue.young").written.find("3 kPa"), std::string::npos);
    EXPECT_EQ(value("organ[0].tissue.density").line, 0);
    EXPECT_EQ(value("organ[0].tissue.density").value, "1000 kg/m3");
}

TEST(Region, HoldsWhatItsShapeSays) {
    Region half;
    half.axis = 2;
    half.above = 1.0;
    EXPECT_TRUE(half.contains({0, 0, 1.1}));
    EXPECT_FALSE(half.contains({5, 5, 1.0}));
    Region box;
    box.shape = Region::Shape::box;
    box.lowest = glm::dvec3(-1);
    box.highest = glm::dvec3(1, 2, 3);
    EXPECT_TRUE(box.contains({1, 2, 3}));
    EXPECT_FALSE(box.contains({1, 2, 3.001}));
    Region sphere;
    sphere.shape = Region::Shape::sphere;
    sphere.centre = {1, 0, 0};
    sphere.radius = 2;
    EXPECT_TRUE(sphere.contains({3, 0, 0}));
    EXPECT_FALSE(sphere.contains({3, 0.1, 0}));
}

TEST(Tool, FollowsItsKeys) {
    Tool tool;
    tool.mode = ToolMode::grasp;
    tool.keys = {{1, {0, 0, 0}}, {2, {4, 0, 0}}, {4, {4, 8, 0}}};
    EXPECT_EQ(tool.centreAt(0), glm::dvec3(0, 0, 0));
    EXPECT_EQ(tool.centreAt(1.25), glm::dvec3(1, 0, 0));
    EXPECT_EQ(tool.centreAt(2), glm::dvec3(4, 0, 0));
    EXPECT_EQ(tool.centreAt(3), glm::dvec3(4, 4, 0));
    EXPECT_EQ(tool.centreAt(9), glm::dvec3(4, 8, 0));
    EXPECT_FALSE(tool.activeAt(0.999));
    EXPECT_TRUE(tool.activeAt(1));
    EXPECT_FALSE(tool.activeAt(4));
    tool.mode = ToolMode::push;
    EXPECT_TRUE(tool.activeAt(0));
}

// A probe over the top: it presses 5% of the largest extent deep, and ends clear of the organ.
TEST(DefaultScene, PressesTheTopAndLeaves) {
    TriangleMesh box;
    for (int i = 0; i < 8; ++i)
        box.positions.emplace_back((i & 1) * 0.1, (i & 2) / 2 * 0.2, (i & 4) / 4 * 0.05);
    box.positions.emplace_back(0.05, 0.199, 0.025); // the middle of the top, hardly lower
    const Scene scene = defaultScene("liver.stl", 0.001, box);
    EXPECT_EQ(scene.frames(), 120);
    ASSERT_EQ(scene.tools.size(), 1u);
    const Tool& probe = scene.tools[0];
    double lowest = 1;
    for (double t = 0; t <= 2; t += 0.01)
        lowest = std::min(lowest, probe.centreAt(t).y - probe.radius);
    EXPECT_NEAR(lowest, 0.199 - 0.05 * 0.2, 1e-12);
    EXPECT_DOUBLE_EQ(probe.centreAt(1).x, 0.05);
    EXPECT_GT(probe.centreAt(0).y - probe.radius, 0.2);
    EXPECT_GT(probe.centreAt(2).y - probe.radius, 0.2);
    EXPECT_DOUBLE_EQ(scene.organs[0].fixedLowestShare, 0.05);
}

TEST(SceneReference, DocumentHoldsEveryKeyAsTheParserHasIt) {
    const std::string document =
        readWholeFile(std::filesystem::path(SEROSA_SOURCE_DIR) / "docs" / "scene.md");
    ASSERT_FALSE(document.empty()) << "docs/scene.md is missing";
    EXPECT_NE(document.find(sceneReference()), std::string::npos)
        << "docs/scene.md does not hold the tables of sim/scene_keys.cpp: replace them with the output of "
           "'serosa scene keys'";
}

} // namespace
} // namespace serosa::sim
