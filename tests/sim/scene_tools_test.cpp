// Tools and bodies of a scene file: their shapes in the frames of sim/rigid_shape.h, their turns, meshes; and
// what is refused.

#include "sim/distance_field.h"
#include "sim/shape_distance.h"
#include "tests/sim/scene_files.h"

#include <gtest/gtest.h>

namespace serosa::sim {
namespace {

const std::string kKeys = "keys = [{ t = \"0 s\", at = [\"0 m\", \"0 m\", \"0 m\"] }, "
                          "{ t = \"1 s\", at = [\"0 m\", \"0 m\", \"0 m\"] }]\n";

/// A cube from the origin, of this many units along each side; open: without its last face.
std::string cubeOff(double side, bool open = false) {
    std::string text = open ? "OFF\n8 11 0\n" : "OFF\n8 12 0\n";
    for (int i = 0; i < 8; ++i)
        text += std::to_string(i & 1 ? side : 0) + " " + std::to_string(i & 2 ? side : 0) + " " +
                std::to_string(i & 4 ? side : 0) + "\n";
    const char* faces[] = {"0 2 3", "0 3 1", "4 5 7", "4 7 6", "0 1 5", "0 5 4",
                           "2 6 7", "2 7 3", "0 4 6", "0 6 2", "1 3 7", "1 7 5"};
    for (int i = 0; i < (open ? 11 : 12); ++i)
        text += std::string("3 ") + faces[i] + "\n";
    return text;
}

class SceneTools : public ::testing::Test {
protected:
    Scene mustRead(const std::string& more) {
        const Result<Scene> scene = files_.read(SceneFiles::minimal() + more);
        EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message);
        return scene.ok() ? *scene : Scene{};
    }
    Tool tool(const std::string& lines) {
        const Scene scene =
            mustRead("[[tool]]\n" + lines + (lines.find("keys") == std::string::npos ? kKeys : ""));
        return scene.tools.empty() ? Tool{} : scene.tools[0];
    }
    Body body(const std::string& lines) {
        const Scene scene = mustRead("[[body]]\n" + lines);
        return scene.bodies.empty() ? Body{} : scene.bodies[0];
    }
    void mesh(const std::string& name, const std::string& text) const {
        std::ofstream(files_.folder() / name) << text;
    }
    SceneFiles files_;
};

/// Distance of a tool's or body's surface, own frame.
double distance(const Tool& tool, const glm::dvec3& p) {
    return shapeDistance(tool.wholeShape(), p);
}

TEST_F(SceneTools, CapsulesBoxesAndHooks) {
    const Tool rod = tool("kind = \"capsule\"\nradius = \"2 mm\"\nlength = \"80 mm\"\nfriction = 0.4\n");
    EXPECT_NEAR(distance(rod, {0, 0, -0.002}), 0, 1e-12);
    EXPECT_NEAR(distance(rod, {0, 0, 0.082}), 0, 1e-12);
    EXPECT_NEAR(distance(rod, {0, 0.003, 0.04}), 0.001, 1e-12);
    EXPECT_DOUBLE_EQ(rod.friction, 0.4);
    EXPECT_EQ(rod.mode, ToolMode::push);
    const Tool box = tool("kind = \"box\"\nsize = [\"20 mm\", \"10 mm\", \"40 mm\"]\n");
    EXPECT_DOUBLE_EQ(box.radius, 0.001) << "a tenth of the least side";
    for (const glm::dvec3& face : {glm::dvec3(0.01, 0, 0), glm::dvec3(0, -0.005, 0), glm::dvec3(0, 0, 0.02)})
        EXPECT_NEAR(distance(box, face), 0, 1e-12);
    const Tool ball = tool("kind = \"box\"\nsize = [\"10 mm\", \"10 mm\", \"10 mm\"]\nradius = \"5 mm\"\n");
    EXPECT_NEAR(distance(ball, glm::normalize(glm::dvec3(1, 2, 3)) * 0.007), 0.002, 1e-12);
    const Tool hook = tool("kind = \"hook\"\nradius = \"1.5 mm\"\nbend = \"8 mm\"\n");
    EXPECT_DOUBLE_EQ(hook.shape.length, 0.032) << "four bends";
    EXPECT_NEAR(distance(hook, {0, 0, -0.0095}), 0, 1e-12) << "the bottom of the bend";
    EXPECT_NEAR(distance(hook, {0, 0.008, 0.0015}), 0, 1e-12) << "the tip";
    EXPECT_NEAR(distance(hook, {0, -0.008, 0.0335}), 0, 1e-12) << "the end of the shank";
}

TEST_F(SceneTools, BladesAndJawsBeginAtTheirTip) {
    const Tool blade =
        tool("kind = \"blade\"\nlength = \"60 mm\"\nwidth = \"20 mm\"\nthickness = \"2 mm\"\n");
    for (const glm::dvec3& p : {glm::dvec3(0, 0, 0), glm::dvec3(0, 0, 0.06), glm::dvec3(0.01, 0, 0.03),
                                glm::dvec3(0, 0.001, 0.03), glm::dvec3(0.009, -0.001, 0.059)})
        EXPECT_NEAR(distance(blade, p), 0, 1e-12);
    const Tool jaws = tool("kind = \"jaws\"\nlength = \"12 mm\"\nwidth = \"5 mm\"\nopening = \"6 mm\"\n"
                           "grip_force = \"500 mN\"\n");
    EXPECT_EQ(jaws.mode, ToolMode::grasp);
    EXPECT_TRUE(jaws.jaws);
    EXPECT_DOUBLE_EQ(jaws.gripForce, 0.5);
    EXPECT_LT(distance(jaws, {0.0024, 0.0029, 0.0001}), 0);
    for (const glm::dvec3& p : {glm::dvec3(0, 0, 0), glm::dvec3(0, 0, 0.012), glm::dvec3(0.0025, 0, 0.006),
                                glm::dvec3(0, 0.003, 0.006)})
        EXPECT_NEAR(distance(jaws, p), 0, 1e-12);
    EXPECT_TRUE(std::isinf(tool("mode = \"grasp\"\n").gripForce));
}

// The turn that keys say, as what it does to the tool's own axes.
TEST_F(SceneTools, TurnsAlongAndAboutAxesAndKeepsThem) {
    const Tool rod = tool(
        "kind = \"capsule\"\nlength = \"1 cm\"\nkeys = [{ t = \"0 s\", at = [\"0 m\", \"0 m\", \"0 m\"] },\n"
        "{ t = \"1 s\", at = [\"1 m\", \"2 m\", \"3 m\"], along = [0, 2, 0] },\n"
        "{ t = \"2 s\", at = [\"0 m\", \"0 m\", \"0 m\"] },\n"
        "{ t = \"3 s\", at = [\"0 m\", \"0 m\", \"0 m\"], along = [1, 0, 0], axis = [3, 0, 0], angle = \"90 "
        "deg\" },\n"
        "{ t = \"4 s\", at = [\"0 m\", \"0 m\", \"0 m\"], axis = [0, 1, 0], angle = \"-90 deg\" },\n"
        "{ t = \"5 s\", at = [\"0 m\", \"0 m\", \"0 m\"], along = [0, 0, -1] }]\n");
    ASSERT_EQ(rod.keys.size(), 6u);
    const auto axes = [&](int key, const glm::dvec3& x, const glm::dvec3& z) {
        EXPECT_LT(glm::distance(rod.keys[std::size_t(key)].turn * glm::dvec3(1, 0, 0), x), 1e-12) << key;
        EXPECT_LT(glm::distance(rod.keys[std::size_t(key)].turn * glm::dvec3(0, 0, 1), z), 1e-12) << key;
    };
    axes(0, {1, 0, 0}, {0, 0, 1});
    axes(1, {1, 0, 0}, {0, 1, 0});
    axes(2, {1, 0, 0}, {0, 1, 0}); // as before
    axes(3, {0, 1, 0}, {1, 0, 0}); // x goes to -z with z to x, then on about x
    axes(4, {0, 0, 1}, {-1, 0, 0});
    axes(5, {1, 0, 0}, {0, 0, -1});
    const RigidPose pose = rod.poseAt(1);
    EXPECT_LT(glm::distance(pose.toWorld({0, 0, 0.01}), glm::dvec3(1, 2.01, 3)), 1e-12);
}

TEST_F(SceneTools, BodiesStandWhereTheySay) {
    const auto own = [](const Body& body, const glm::dvec3& world) {
        return shapeDistance(body.shape, body.pose.toOwn(world));
    };
    const Body table = body("kind = \"floor\"\nheight = \"-20 mm\"\nfriction = 0.5\n");
    EXPECT_NEAR(own(table, {3, 0.01, 5}), 0.03, 1e-12);
    EXPECT_DOUBLE_EQ(table.friction, 0.5);
    // A slope, in two ways: 30 degrees about z leans the normal towards -x.
    const double sine = 0.5, cosine = std::sqrt(0.75);
    for (const char* lines :
         {"normal = [-0.5, 0.8660254037844386, 0]\n", "axis = [0, 0, 1]\nangle = \"30 deg\"\n"}) {
        const Body slope = body(std::string("kind = \"floor\"\nat = [\"1 m\", \"0 m\", \"0 m\"]\n") + lines);
        EXPECT_NEAR(own(slope, {1 - 0.1 * sine, 0.1 * cosine, 7}), 0.1, 1e-12) << lines;
        EXPECT_NEAR(own(slope, {1 + cosine, sine, 0}), 0, 1e-12) << lines;
    }
    const Body rod = body("kind = \"capsule\"\nat = [\"0 m\", \"1 m\", \"0 m\"]\nradius = \"1 cm\"\nlength = "
                          "\"10 cm\"\nalong = [1, 0, 0]\n");
    EXPECT_NEAR(own(rod, {0.11, 1, 0}), 0, 1e-12);
    const Body box = body("kind = \"box\"\nat = [\"0 m\", \"0 m\", \"0 m\"]\nsize = [\"2 cm\", \"2 cm\", \"4 "
                          "cm\"]\naxis = [0, 1, 0]\nangle = \"90 deg\"\n");
    EXPECT_NEAR(own(box, {0.02, 0, 0}), 0, 1e-12) << "its long side lies along x now";
    const Body ball = body("kind = \"sphere\"\nat = [\"0 m\", \"1 m\", \"0 m\"]\nradius = \"1 cm\"\n");
    EXPECT_NEAR(own(ball, {0, 1.02, 0}), 0.01, 1e-12);
}

TEST_F(SceneTools, MeshesAreClosedSmallAndInTheirUnit) {
    mesh("cube.off", cubeOff(20));
    const std::string lines = "kind = \"mesh\"\nmodel = \"cube.off\"\nlength_unit = \"mm\"\n";
    const Tool cube = tool(lines);
    ASSERT_TRUE(cube.shape.field);
    ASSERT_TRUE(cube.shape.surface);
    EXPECT_NEAR(cube.shape.surface->highest().x, 0.02, 1e-12);
    EXPECT_NEAR(distance(cube, {0.01, 0.03, 0.01}), 0.01, 5e-4);
    EXPECT_NEAR(distance(cube, {0.01, 0.01, 0.01}), -0.01, 5e-4);
    const Body fixed = body(lines + "at = [\"1 m\", \"0 m\", \"0 m\"]\n");
    EXPECT_NEAR(shapeDistance(fixed.shape, fixed.pose.toOwn({1.03, 0.01, 0.01})), 0.01, 5e-4);
}

struct BadTool {
    const char* name;
    std::string text;     // from line 5 on
    std::string position; // "line:column"
    std::string says;
};

std::vector<BadTool> badTools() {
    const auto tool = [](const std::string& lines) { return "[[tool]]\n" + lines + kKeys; };
    const auto body = [](const std::string& lines) { return "[[body]]\n" + lines; };
    const auto keyed = [](const std::string& shape, const std::string& key) {
        return "[[tool]]\n" + shape + "keys = [{ t = \"0 s\", at = [\"0 m\", \"0 m\", \"0 m\"], " + key +
               " }]\n";
    };
    const std::string mesh = "kind = \"mesh\"\nlength_unit = \"mm\"\nmodel = ";
    const std::string at = "at = [\"0 m\", \"0 m\", \"0 m\"]\n",
                      rod = "kind = \"capsule\"\nlength = \"1 cm\"\n";
    std::string crowd;
    for (int i = 0; i < 12; ++i)
        crowd += "[[body]]\nkind = \"floor\"\nheight = \"0 m\"\n";
    return {
        {"ZeroRadius", tool("radius = \"0 mm\"\n"), "6:10", "greater than 0"},
        {"NegativeRadius", tool("radius = \"-3 mm\"\n"), "6:10", "greater than 0"},
        {"NegativeFriction", tool("friction = -0.1\n"), "6:12", "at least 0"},
        {"FrictionOfAGrasp", tool("friction = 0.1\nmode = \"grasp\"\n"), "6:12", "no effect on a grasp"},
        {"GripOfAPush", tool("grip_force = \"1 N\"\n"), "6:14", "no effect on a push"},
        {"ZeroGrip", tool("mode = \"grasp\"\ngrip_force = \"0 N\"\n"), "7:14", "greater than 0"},
        {"GripUnit", tool("mode = \"grasp\"\ngrip_force = \"1 kPa\"\n"), "7:14", "is a pressure"},
        {"UnknownKind", tool("kind = \"sphare\"\n"), "6:8", "did you mean 'sphere'"},
        {"LengthOfASphere", tool("length = \"1 cm\"\n"), "6:10", "no effect on a sphere"},
        {"SizeOfABlade",
         tool("kind = \"blade\"\nlength = \"1 cm\"\nwidth = \"1 cm\"\nsize = [\"1 m\", \"1 m\", \"1 m\"]\n"),
         "9:8", "no effect on a blade"},
        {"CapsuleWithoutLength", tool("kind = \"capsule\"\n"), "6:8", "a capsule needs 'length'"},
        {"JawsWithoutOpening", tool("kind = \"jaws\"\nlength = \"1 cm\"\nwidth = \"1 cm\"\n"), "6:8",
         "jaws need 'opening'"},
        {"JawsPush",
         tool("kind = \"jaws\"\nlength = \"1 cm\"\nwidth = \"1 cm\"\nopening = \"1 cm\"\nmode = \"push\"\n"),
         "10:8", "jaws only grasp"},
        {"BoxTooRound", tool("kind = \"box\"\nsize = [\"1 cm\", \"2 cm\", \"2 cm\"]\nradius = \"6 mm\"\n"),
         "8:10", "least side"},
        {"BoxWithoutSide", tool("kind = \"box\"\nsize = [\"1 cm\", \"0 cm\", \"2 cm\"]\n"), "7:17",
         "greater than 0"},
        {"BladeTooThick",
         tool("kind = \"blade\"\nlength = \"1 cm\"\nwidth = \"1 mm\"\nthickness = \"2 mm\"\n"), "8:9",
         "less than the blade's thickness"},
        {"HookTooTight", tool("kind = \"hook\"\nbend = \"4 mm\"\n"), "7:8", "not greater than 'radius'"},
        {"TurnOfASmoothSphere", keyed("", "along = [0, 1, 0]"), "6:", "no effect on a sphere"},
        {"AlongNothing", keyed(rod, "along = [0, 0, 0]"), "8:", "no length"},
        {"AxisAlone", keyed(rod, "axis = [0, 0, 1]"), "8:", "takes 'axis' and 'angle'"},
        {"AngleAlone", keyed(rod, "angle = \"3 deg\""), "8:", "takes 'axis' and 'angle'"},
        {"AngleBare", keyed(rod, "axis = [0, 0, 1], angle = 3"), "8:", "has no unit"},
        {"MeshOpen", tool(mesh + "\"open.off\"\n"), "8:9", "need a closed surface"},
        {"MeshGone", tool(mesh + "\"gone.off\"\n"), "8:9", "gone.off"},
        {"MeshOfMetres", tool("kind = \"mesh\"\nlength_unit = \"m\"\nmodel = \"cube.off\"\n"), "8:9",
         "look at 'length_unit'"},
        {"MeshTooFine", tool(mesh + "\"fine.off\"\n"), "8:9", "at most 50000"},
        {"MeshTooThin", tool(mesh + "\"thin.off\"\n"), "8:9", "thinner than its distance field"},
        {"MeshRadius", tool("radius = \"1 mm\"\n" + mesh + "\"cube.off\"\n"), "6:10", "no effect on a mesh"},
        {"BodyWithoutKind", body("height = \"0 m\"\n"), "5:", "kind' is missing"},
        {"FloorNowhere", body("kind = \"floor\"\n"), "6:8", "needs 'height'"},
        {"FloorTwice", body("kind = \"floor\"\nheight = \"0 m\"\n" + at), "8:6", "keep one of the two"},
        {"FloorAlong", body("kind = \"floor\"\nheight = \"0 m\"\nalong = [1, 0, 0]\n"), "8:9",
         "no effect on a floor"},
        {"FloorNoNormal", body("kind = \"floor\"\n" + at + "normal = [0, 0, 0]\n"), "8:10", "no length"},
        {"BodyFriction", body("kind = \"floor\"\nheight = \"0 m\"\nfriction = -1\n"), "8:12", "at least 0"},
        {"SphereWithoutPlace", body("kind = \"sphere\"\nradius = \"1 cm\"\n"), "6:8", "needs 'at'"},
        {"SphereTurned", body("kind = \"sphere\"\nradius = \"1 cm\"\nalong = [1, 0, 0]\n" + at), "8:9",
         "no effect"},
        {"HookIsNoBody", body("kind = \"hook\"\n"), "6:8", "unknown value"},
        {"TooManyColliders", crowd + "[[tool]]\n" + kKeys, "", "1 tools and 12 bodies, together at most 12"},
    };
}

void PrintTo(const BadTool& bad, std::ostream* out) {
    *out << bad.name;
}

class SceneToolErrors : public ::testing::TestWithParam<BadTool> {};

TEST_P(SceneToolErrors, AreRefusedWhereTheyStand) {
    const BadTool& bad = GetParam();
    const SceneFiles files;
    std::ofstream(files.folder() / "cube.off") << cubeOff(20);
    std::ofstream(files.folder() / "open.off") << cubeOff(20, true);
    std::string fine = "OFF\n3 50001 0\n0 0 0\n1 0 0\n0 1 0\n"; // refused by its count before its faults
    if (std::string(bad.name) == "MeshTooFine")
        for (int i = 0; i < 50001; ++i)
            fine += "3 0 1 2\n";
    std::ofstream(files.folder() / "fine.off") << fine;
    std::string thin = cubeOff(100);
    for (std::size_t at = thin.find("100.000000\n"); at != std::string::npos; at = thin.find("100.000000\n"))
        thin.replace(at, 10, "0.200000"); // along z
    std::ofstream(files.folder() / "thin.off") << thin;

    const Result<Scene> scene = files.read(SceneFiles::minimal() + bad.text);
    ASSERT_FALSE(scene.ok()) << "accepted:\n" << bad.text;
    const std::string message = scene.error().message, file = (files.folder() / "scene.toml").string();
    EXPECT_EQ(message.rfind(file + ":" + bad.position, 0), 0u) << message << "\nexpected at " << bad.position;
    EXPECT_NE(message.find(bad.says), std::string::npos) << message << "\nexpected: " << bad.says;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(All, SceneToolErrors, ::testing::ValuesIn(badTools()),
                         [](const ::testing::TestParamInfo<BadTool>& test) {
                             return std::string(test.param.name);
                         });

} // namespace
} // namespace serosa::sim
