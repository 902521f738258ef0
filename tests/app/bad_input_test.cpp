// Bad input through the command: exit code 2, one line on stderr, nothing left behind.

#include "tests/app/child.h"

#include <gtest/gtest.h>

namespace serosa::app {
namespace {

namespace fs = std::filesystem;

const char* const kTetrahedron =
    "OFF\n4 4 0\n0 0 0\n10 0 0\n0 10 0\n0 0 10\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const char* const kScene = "schema = 1\n[[organ]]\nmodel = \"good.off\"\nlength_unit = \"mm\"\nnodes = 100\n";

/// A mesh file that no run may accept.
struct BadMesh {
    const char* name;
    const char* file;
    std::string content;
    std::string says;
};

std::string plyHeader(const std::string& vertices) {
    return "ply\nformat binary_little_endian 1.0\nelement vertex " + vertices +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
           "property list uchar int vertex_indices\nend_header\n";
}

std::vector<BadMesh> badMeshes() {
    const std::string points = "0 0 0\n10 0 0\n0 10 0\n0 0 10\n",
                      faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    const auto off = [](const std::string& p, const std::string& f, int nv, int nf) {
        return "OFF\n" + std::to_string(nv) + " " + std::to_string(nf) + " 0\n" + p + f;
    };
    return {
        {"Empty", "m.off", "", "empty"},
        {"Truncated", "m.off", std::string(kTetrahedron).substr(0, 40), ""},
        {"WrongMagic", "m.ply", "plx\nformat ascii 1.0\n", ""},
        {"Nan", "m.off", off("0 0 0\nnan 0 0\n0 10 0\n0 0 10\n", faces, 4, 4), ""},
        {"Infinite", "m.off", off("0 0 0\ninf 0 0\n0 10 0\n0 0 10\n", faces, 4, 4), ""},
        {"IndexOutOfRange", "m.off", off(points, "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 4\n", 4, 4), ""},
        {"ZeroFaces", "m.off", off(points, "", 4, 0), "face"},
        {"Open", "m.off", off(points, "3 0 2 1\n3 0 1 3\n3 0 3 2\n", 4, 3), "open"},
        {"NonManifold", "m.off", off(points + "5 5 5\n", faces + "3 0 1 4\n3 1 0 4\n", 5, 6), ""},
        {"Inverted", "m.off", off(points, "3 0 1 2\n3 0 3 1\n3 0 2 3\n3 1 3 2\n", 4, 4), ""},
        {"TwoSolids", "m.off",
         off(points + "100 0 0\n110 0 0\n100 10 0\n100 0 10\n",
             faces + "3 4 6 5\n3 4 5 7\n3 4 7 6\n3 5 6 7\n", 8, 8),
         ""},
        {"Huge", "m.off", off("0 0 0\n1e20 0 0\n0 1e20 0\n0 0 1e20\n", faces, 4, 4), ""},
        {"Billions", "m.ply", plyHeader("4000000000") + "abc", ""},
        {"DecimalCommas", "m.off",
         off("0,0 0,0 0,0\n10,0 0,0 0,0\n0,0 10,0 0,0\n0,0 0,0 10,0\n", faces, 4, 4), ""},
    };
}

void PrintTo(const BadMesh& bad, std::ostream* out) {
    *out << bad.name;
}

class BadMeshes : public ::testing::TestWithParam<BadMesh> {};

TEST_P(BadMeshes, AreRefusedByRunAndInspectInOneLine) {
    const BadMesh& bad = GetParam();
    const TestFolder folder;
    folder.write(bad.file, bad.content);
    const auto before = folder.names();
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"run", "--model", bad.file, "--length-unit", "mm", "--nodes", "100",
                                   "--out", "out"},
          std::vector<std::string>{"inspect", bad.file, "--length-unit", "mm"}}) {
        const ChildResult result = runSerosa(folder.path(), arguments);
        EXPECT_EQ(result.exitCode, 2) << result.out << result.err;
        EXPECT_EQ(result.errorLines(), 1u) << result.err;
        EXPECT_EQ(result.err.rfind("serosa: error: ", 0), 0u) << result.err;
        EXPECT_NE(result.err.find(bad.file), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(bad.says), std::string::npos) << result.err;
        EXPECT_EQ(folder.names(), before);
    }
}

INSTANTIATE_TEST_SUITE_P(All, BadMeshes, ::testing::ValuesIn(badMeshes()),
                         [](const ::testing::TestParamInfo<BadMesh>& test) {
                             return std::string(test.param.name);
                         });

/// A command line over a folder that holds good.off and good.toml.
struct BadCommand {
    const char* name;
    std::vector<std::string> arguments;
    std::string scene; // bad.toml, if not empty
    std::string says;
};

std::vector<BadCommand> badCommands() {
    const std::string scene = kScene;
    const auto run = [](std::vector<std::string> more) {
        std::vector<std::string> arguments{"run", "good.toml", "--frames", "1", "--size", "64x64"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    };
    return {
        {"NoCommand", {}, "", "--help"},
        {"UnknownCommand", {"rnu"}, "", "did you mean 'run'"},
        {"UnknownOption", {"run", "--modle", "x"}, "", "run --help"},
        {"NothingToRun", {"run"}, "", "--model"},
        {"SceneAndModel", {"run", "good.toml", "--model", "good.off"}, "", "not both"},
        {"ModelWithoutUnit", {"run", "--model", "good.off"}, "", "--length-unit"},
        {"ModelWrongUnit", {"run", "--model", "good.off", "--length-unit", "MM"}, "", "did you mean 'mm'"},
        {"ModelMissing", {"run", "--model", "gone.off", "--length-unit", "mm"}, "", "gone.off"},
        {"ModelIsFolder", {"run", "--model", ".", "--length-unit", "mm"}, "", ""},
        {"SceneMissing", {"run", "gone.toml"}, "", "no such file"},
        {"UnknownKey", {"run", "bad.toml"}, scene + "nodse = 3\n", "bad.toml:6:1"},
        {"WrongType", {"run", "bad.toml"}, scene + "name = 3\n", "bad.toml:6:8"},
        {"MissingUnit", {"run", "bad.toml"}, scene + "[organ.tissue]\nyoung = 3\n", "bad.toml:7:9"},
        {"NegativeSpacing",
         {"scene", "check", "bad.toml"},
         "schema = 1\n[[organ]]\nmodel = \"good.off\"\nlength_unit = \"mm\"\nspacing = \"-1 mm\"\n",
         "bad.toml:5:11"},
        {"NegativeSpacingOption", run({"--spacing", "-1 mm"}), "", "greater than 0"},
        {"BareSpacingOption", run({"--spacing", "1"}), "", "no unit"},
        {"TooFineSpacing", run({"--spacing", "1e-4 um", "--out", "out"}), "", " GB "},
        {"TooManyNodes", run({"--nodes", "1000000000", "--out", "out"}), "", ""},
        {"TooStiff",
         {"run", "bad.toml", "--out", "out"},
         scene + "[organ.tissue]\nyoung = \"1e12 Pa\"\n",
         "steps"},
        {"FixedNowhere",
         {"run", "bad.toml", "--out", "out"},
         scene + "[[organ.fixed]]\nshape = \"half-space\"\nbelow = \"-4 m\"\n",
         "bad.toml:7:"},
        {"EverythingFixed",
         {"run", "bad.toml", "--out", "out"},
         scene + "[[organ.fixed]]\nshape = \"half-space\"\nbelow = \"4 m\"\n",
         "every node is fixed"},
        {"RegionNowhere",
         {"run", "bad.toml", "--out", "out"},
         scene + "[[organ.material]]\nname = \"a\"\n[[organ.region]]\nmaterial = \"a\"\nshape = "
                 "\"half-space\"\nabove = \"4 m\"\n",
         "bad.toml:10: this region holds no cell"},
        {"PaintWithoutColours",
         {"scene", "check", "bad.toml"},
         scene + "[[organ.material]]\nname = \"a\"\n[[organ.region]]\nmaterial = \"a\"\nshape = "
                 "\"painted\"\ncolour = [1, 2, 3]\n",
         "bad.toml:10: the model has no vertex colours"},
        {"TooStiffMaterial",
         {"scene", "check", "bad.toml"},
         scene + "[[organ.material]]\nname = \"a\"\nyoung = \"1e12 Pa\"\n[[organ.region]]\nmaterial = "
                 "\"a\"\nshape = \"layer\"\ndepth = \"1 mm\"\n",
         "bad.toml:3: the tissue is so stiff"},
        {"Incompressible",
         {"scene", "check", "bad.toml"},
         scene + "[organ.tissue]\npoisson = 0.5\n",
         "at most 0.495"},
        {"BendTooTight",
         {"scene", "check", "bad.toml"},
         scene + "[organ.pose]\nbend_radius = \"1 mm\"\n",
         "bend_radius"},
        {"NoFrames", run({"--frames", "0"}), "", ""},
        {"SizeText", {"run", "good.toml", "--size", "big"}, "", "960x540"},
        {"SizeZero", {"run", "good.toml", "--size", "0x64"}, "", "from 16"},
        {"Mapping", run({"--mapping", "triangel"}), "", "did you mean 'triangle'"},
        {"Solver", run({"--solver", "cuda"}), "", "fragment"},
        {"Gl", run({"--gl", "vulkan"}), "", ""},
        {"Layout", run({"--layout", "cube"}), "", "rows"},
        {"OutBelowFile", run({"--out", "good.off/out"}), "", "below a file"},
        {"OutIsFile", run({"--out", "good.off"}), "", "is a file"},
        {"OutHoldsSomething", run({"--out", "full"}), "", "--force"},
        {"SurfaceAfterEnd",
         {"run", "bad.toml"},
         scene + "[output]\nsurfaces_at = [\"100 s\"]\n",
         "surfaces_at"},
        {"NodesBeyondMemory", run({"--nodes", "900000000"}), "", "good.toml:"},
        {"OutIsEmpty", run({"--out", ""}), "", "--out"},
        {"InspectMissing", {"inspect", "gone.ply"}, "", "gone.ply"},
        {"PhantomName", {"phantom", "haert", "-o", "x.ply"}, "", "heart"},
        {"PhantomNothing", {"phantom", "ball"}, "", "--volume"},
        {"PhantomVolume", {"phantom", "ball", "--volume", "x.nrrd"}, "", "kidney"},
        {"PhantomVoxel", {"phantom", "kidney", "--volume", "x.nrrd", "--voxel", "0.01"}, "", "take larger"},
        {"PhantomVoxelZero", {"phantom", "kidney", "--volume", "x.nrrd", "--voxel", "0"}, "", "above 0"},
        {"PhantomSurfaceExistsBesideVolume",
         {"phantom", "kidney", "--volume", "x.nrrd", "--voxel", "8", "-o", "good.off"},
         "",
         "--force"},
        {"PhantomVolumeExtension", {"phantom", "kidney", "--volume", "x.png", "--voxel", "8"}, "", "png"},
        {"PhantomExists", {"phantom", "ball", "-o", "good.off"}, "", "--force"},
        {"PhantomExtension", {"phantom", "ball", "--faces", "500", "-o", "x.xyz"}, "", "xyz"},
        {"PhantomNoFolder", {"phantom", "ball", "--faces", "500", "-o", "no/such/x.ply"}, "", ""},
        {"VerifyGroup", {"verify", "solvr"}, "", "did you mean 'solver'"},
        {"VerifyInject", {"verify", "--inject", "stiffnes=2"}, "", "did you mean 'stiffness'"},
        {"VerifyInjectNoFactor", {"verify", "--inject", "stiffness"}, "", "stiffness=1.05"},
    };
}

void PrintTo(const BadCommand& bad, std::ostream* out) {
    *out << bad.name;
}

class BadCommands : public ::testing::TestWithParam<BadCommand> {};

TEST_P(BadCommands, AreRefusedInOneLine) {
    const BadCommand& bad = GetParam();
    const TestFolder folder;
    folder.write("good.off", kTetrahedron);
    folder.write("good.toml", kScene);
    fs::create_directory(folder.path() / "full");
    folder.write("full/letter.txt", "keep me");
    if (!bad.scene.empty())
        folder.write("bad.toml", bad.scene);
    const auto before = folder.names();
    const ChildResult result = runSerosa(folder.path(), bad.arguments);
    EXPECT_EQ(result.exitCode, 2) << result.out << result.err;
    EXPECT_EQ(result.errorLines(), 1u) << result.err;
    EXPECT_EQ(result.err.rfind("serosa: error: ", 0), 0u) << result.err;
    EXPECT_NE(result.err.find(bad.says), std::string::npos) << result.err;
    EXPECT_EQ(folder.names(), before);
}

INSTANTIATE_TEST_SUITE_P(All, BadCommands, ::testing::ValuesIn(badCommands()),
                         [](const ::testing::TestParamInfo<BadCommand>& test) {
                             return std::string(test.param.name);
                         });

TEST(NoContext, ExitsWithFiveAndLeavesNothing) {
    const TestFolder folder;
    folder.write("good.off", kTetrahedron);
    folder.write("good.toml", kScene);
    const auto before = folder.names();
    const ChildOptions noGl{{{"SEROSA_GL_DISABLE", "egl,egl-device,osmesa"}}, -1};
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"run", "good.toml", "--out", "out"},
          std::vector<std::string>{"verify", "solver", "--out", "out"}}) {
        const ChildResult result = runSerosa(folder.path(), arguments, noGl);
        EXPECT_EQ(result.exitCode, 5) << result.out << result.err;
        EXPECT_EQ(result.errorLines(), 1u) << result.err;
        EXPECT_EQ(folder.names(), before);
    }
}

} // namespace
} // namespace serosa::app
