// Bad scenes: each is refused with the line and column that a person would point at, and says what to do.

#include "tests/sim/scene_files.h"

#include <gtest/gtest.h>

namespace serosa::sim {
namespace {

struct BadScene {
    const char* name;
    std::string text;
    std::string position; // "line:column", or "" where the whole file is meant
    std::string says;     // part of the message
};

const std::string kMinimal = SceneFiles::minimal();
const std::string kOrgan = "[[organ]]\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\n";
const std::string kKeys = "keys = [{ t = \"0 s\", at = [\"0 m\", \"0 m\", \"0 m\"] }]\n";

std::vector<BadScene> badScenes() {
    const auto tissue = [](const std::string& line) { return kMinimal + "[organ.tissue]\n" + line + "\n"; };
    const auto top = [](const std::string& line) { return "schema = 1\n" + line + "\n" + kOrgan; };
    const auto fixed = [](const std::string& lines) { return kMinimal + "[[organ.fixed]]\n" + lines + "\n"; };
    const auto tool = [](const std::string& lines) { return kMinimal + "[[tool]]\n" + lines + "\n"; };
    const auto camera = [](const std::string& lines) { return kMinimal + "[camera]\n" + lines + "\n"; };
    const auto output = [](const std::string& line) { return kMinimal + "[output]\n" + line + "\n"; };
    const auto cutVolume = [](const std::string& lines) {
        return kMinimal + "[look]\nshow = \"implicit\"\n[look.cut_volume]\n" + lines + "\n";
    };
    const std::string label = "[[look.cut_volume.label]]\nvalue = 1\ncolour = [200, 30, 20]\n";
    const auto ofOrgans = [](const std::string& names) {
        return "schema = 1\n" + kOrgan + "name = \"liver\"\n" + kOrgan +
               "name = \"gall\"\n[look]\nshow = \"implicit\"\n[deformation]\nkind = \"sphere\"\norgans = " +
               names + "\nat = [\"0 m\", \"0 m\", \"0 m\"]\n";
    };
    const auto byVertices = [](const std::string& lines, const std::string& more = "") {
        return kMinimal + "[look]\nshow = \"implicit\"\n[[deformation]]\nat = [\"0 m\", \"0 m\", \"0 m\"]\n" +
               "size = [\"1 m\", \"1 m\", \"1 m\"]\nby = \"vertices\"\n" + lines + "\n" + more;
    };
    const std::string twist = "kind = \"twist\"\nangle = \"30 deg\"";
    std::string nineOrgans;
    for (int i = 0; i < 9; ++i)
        nineOrgans += kOrgan + "name = \"" + std::to_string(i) + "\"\n";
    std::string tooManyTools = kMinimal;
    for (int i = 0; i < 8; ++i)
        tooManyTools += "[[tool]]\n" + kKeys;
    return {
        {"Empty", "", "1:1", "'schema' is missing"},
        {"SchemaTwo", "schema = 2\nnew_key = 1\n", "1:10", "expected 1"},
        {"SchemaText", "schema = \"1\"\n", "1:10", "expected integer"},
        {"Syntax", "schema = 1\nfoo = = 3\n", "2:7", ""},
        {"NoValue", "schema = \n", "1:", ""},
        {"KeyTwice", "schema = 1\nschema = 1\n", "2:", ""},
        {"Binary", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), "1:1", ""},
        {"InvalidUtf8", "schema = 1\n# \xff\xfe\n", "2:", ""},
        {"DeepNesting", "schema = 1\nx = " + std::string(100000, '[') + "\n", "2:", ""},
        {"UnknownTopKey", top("framerate = \"60 Hz\""), "2:1", "did you mean 'frame_rate'"},
        {"UnknownTable", kMinimal + "[lights]\nintensity = 1\n", "5:", "did you mean 'light'"},
        {"UnknownOrganKey", "schema = 1\n[[organ]]\nmodle = \"ball.ply\"\n", "3:1", "did you mean 'model'"},
        {"UnknownTissueKey", tissue("yuong = \"3 kPa\""), "6:1", "did you mean 'young'"},
        {"UnknownKeyOfKey", tool("keys = [{ time = \"0 s\" }]"), "6:", "unknown key \"time\""},
        {"UnknownFarKey", top("zzzzzzzz = 1"), "2:1", "known: schema"},
        {"NoOrgan", "schema = 1\n", "", "'organ' is missing"},
        {"OrganOnce", "schema = 1\n[organ]\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\n", "2:", "[[organ]]"},
        {"NoOrgans", "schema = 1\norgan = []\n", "2:", "0 organs, one to 8"},
        {"NineOrgans", "schema = 1\n" + nineOrgans, "", "9 organs, one to 8"},
        {"NamesOneFile", "schema = 1\n" + kOrgan + "name = \"a b\"\n" + kOrgan + "name = \"a_b\"\n",
         "9:", "name of another"},
        {"NameNoFile", "schema = 1\n" + kOrgan + "name = \"a/b\"\n" + kOrgan, "5:", "letters, digits"},
        {"TextureIsNoWord", kMinimal + "[organ.look]\ntexture = \"muscle\"\n", "6:11", "heart-muscle"},
        {"PictureMissing", kMinimal + "[organ.look]\nalbedo = \"gone.png\"\n", "6:10", "no such file"},
        {"PictureIsFolder", kMinimal + "[organ.look]\nnormal = \".\"\n", "6:10", "is not a file"},
        {"PictureBesideTexture", kMinimal + "[organ.look]\ntexture = \"fat\"\nheight = \"ball.ply\"\n",
         "7:10", "beside 'texture'"},
        {"TileOfNothing", kMinimal + "[organ.look]\ntile = \"3 mm\"\n", "6:8", "no effect without a texture"},
        {"TileIsNothing", kMinimal + "[organ.look]\ntexture = \"fat\"\ntile = \"0 mm\"\n", "7:8",
         "greater than 0"},
        {"CutVolumeGone", cutVolume("file = \"gone.mha\""), "8:8", "no such file"},
        {"CutVolumeOfNoFile", cutVolume("level = 3"), "7:", "file' is missing"},
        {"CutVolumeNoWidth", cutVolume("file = \"ball.ply\"\nwidth = 0"), "9:9", "greater than 0"},
        {"CutVolumeNegativeWidth", cutVolume("file = \"ball.ply\"\nwidth = -4"), "9:9", "greater than 0"},
        {"CutVolumeUnknownKey", cutVolume("file = \"ball.ply\"\nwindow = 4"), "9:1", "unknown key"},
        {"CutVolumeLabelTwice", cutVolume("file = \"ball.ply\"\n" + label + label), "13:9",
         "a colour already"},
        {"CutVolumeWidthOfLabels", cutVolume("file = \"ball.ply\"\nwidth = 4\n" + label), "9:9",
         "beside labels"},
        {"CutVolumeOfSurfaces", kMinimal + "[look.cut_volume]\nfile = \"ball.ply\"\n", "6:8",
         "surfaces are drawn"},
        {"CutVolumeOfHollow",
         kMinimal + "[look]\nshow = \"implicit\"\ninterior = \"hollow\"\n[look.cut_volume]\nfile = "
                    "\"ball.ply\"\n",
         "9:8", "hollow"},
        {"SectionOfRayCast",
         kMinimal + "[look]\nshow = \"implicit\"\nsection_at = [\"0 m\", \"0 m\", \"0 m\"]\n", "7:14",
         "no effect on what is ray-cast"},
        {"VerticesCannotCut", byVertices("kind = \"sphere\"\nradius = \"1 cm\""), "10:6", "leave this kind"},
        {"VerticesCannotBeWound", byVertices(twist + "\nwound = \"1 cm\""), "13:9", "has no effect"},
        {"VerticesHaveNoTexels", byVertices(twist + "\ntexels = [8, 8, 8]"), "13:10", "has no effect"},
        {"VerticesBeforePixels",
         byVertices(twist, "[[deformation]]\nat = [\"0 m\", \"0 m\", \"0 m\"]\nkind = \"sphere\"\nradius = "
                           "\"1 cm\"\nsize = [\"1 m\", \"1 m\", \"1 m\"]\n"),
         "15:8", "put it before"},
        {"VerticesInStages",
         kMinimal + "[look]\nshow = \"implicit\"\nstage = \"box\"\n" +
             byVertices(twist).substr((kMinimal + "[look]\nshow = \"implicit\"\n").size()),
         "7:9", "leaves its box"},
        {"UnknownBy", byVertices(twist + "\nby = \"cells\""), "13:", ""},
        {"ProxyOfNothing", kMinimal + "[look]\nshow = \"implicit\"\nproxy_cells = 8\n", "7:15",
         "has no effect"},
        {"ProxyOfOneCell", kMinimal + "[look]\nshow = \"implicit\"\nproxy_cells = 1\n", "7:15", ""},
        {"DeformationOfNoOrgan", ofOrgans("[\"livr\"]"), "14:10", "did you mean 'liver'"},
        {"DeformationOfOneTwice", ofOrgans("[\"liver\", \"liver\"]"), "14:10", "twice"},
        {"DeformationOfNone", ofOrgans("[]"), "14:10", "is empty"},
        {"DeformationOfText", ofOrgans("\"liver\""), "14:10", "array of texts"},
        {"UnknownMethod", kMinimal + "method = \"implict\"\n", "5:10", "did you mean 'implicit'"},
        {"MethodIsNoNumber", kMinimal + "method = 1\n", "5:10", "method"},
        {"MethodAtTheTop", top("method = \"implicit\""), "2:1", "unknown key"},
        {"MethodOfAPose", kMinimal + "method = \"implicit\"\n[organ.pose]\nbend_radius = \"1 m\"\n", "5:10",
         "no effect beside 'pose'"},
        {"ImplicitLevels", kMinimal + "levels = 2\nmethod = \"implicit\"\n", "6:10", "levels of detail"},
        {"UnknownAxis", kMinimal + "up_axis = \"w\"\n", "5:", "up_axis"},
        {"RepairIsNoFlag", kMinimal + "repair = \"yes\"\n", "5:", "true or false"},
        {"TwoOrgansOneName", "schema = 1\n" + kOrgan + kOrgan, "5:", "name of another"},
        {"NoModel", "schema = 1\n[[organ]]\nlength_unit = \"mm\"\n", "2:", "model' is missing"},
        {"NoUnit", "schema = 1\n[[organ]]\nmodel = \"ball.ply\"\n", "2:", "length_unit' is missing"},
        {"ModelMissing", "schema = 1\n[[organ]]\nmodel = \"gone.ply\"\nlength_unit = \"mm\"\n", "3:9",
         "no such file"},
        {"ModelIsFolder", "schema = 1\n[[organ]]\nmodel = \".\"\nlength_unit = \"mm\"\n", "3:9",
         "not a file"},
        {"WrongLengthUnit", "schema = 1\n[[organ]]\nmodel = \"ball.ply\"\nlength_unit = \"mmm\"\n", "4:15",
         "did you mean 'mm'"},
        {"BareNumber", tissue("young = 3000"), "6:9", "has no unit"},
        {"MissingUnit", tissue("young = \"3000\""), "6:9", "has no unit"},
        {"WrongDimension", tissue("young = \"3 mm\""), "6:9", "is a length"},
        {"UnknownUnit", tissue("density = \"1 kg/m2\""), "6:11", "did you mean 'kg/m3'"},
        {"DecimalComma", tissue("young = \"2,5 kPa\""), "6:9", "write a point"},
        {"WrongType", tissue("young = true"), "6:9", "expected pressure"},
        {"NegativeYoung", tissue("young = \"-3 kPa\""), "6:9", "greater than 0"},
        {"ZeroDensity", tissue("density = \"0 kg/m3\""), "6:11", "greater than 0"},
        {"InfiniteYoung", tissue("young = \"1e400 kPa\""), "6:9", "not a finite"},
        {"NanPoisson", tissue("poisson = nan"), "6:11", "not a finite"},
        {"LowPoisson", tissue("poisson = 0.2"), "6:11", "volumetric"},
        {"Incompressible", tissue("poisson = 0.5"), "6:11", "at most 0.495"},
        {"HalfPoisson", tissue("poisson = 0.6"), "6:11", "expected"},
        {"NegativeSpacing", kMinimal + "spacing = \"-2 mm\"\n", "5:11", "greater than 0"},
        {"ZeroSpacing", kMinimal + "spacing = \"0 mm\"\n", "5:11", "greater than 0"},
        {"SpacingAndNodes", kMinimal + "nodes = 100\nspacing = \"2 mm\"\n", "6:11", "keep one"},
        {"FewNodes", kMinimal + "nodes = 7\n", "5:9", "from 8"},
        {"NodesNotWhole", kMinimal + "nodes = 100.5\n", "5:9", "expected integer"},
        {"HugeNodes", kMinimal + "nodes = 99999999999999\n", "5:9", "from 8"},
        {"GravityTwo", top("gravity = [\"0 m/s2\", \"0 m/s2\"]"), "2:11", "2 items"},
        {"GravityBare", top("gravity = [0, -9.81, 0]"), "2:12", "has no unit"},
        {"ZeroDuration", top("duration = \"0 s\""), "2:12", "greater than 0"},
        {"TooManyFrames", top("duration = \"1e9 s\""), "2:12", "frames"},
        {"FixedUnknownShape", fixed("shape = \"spehre\""), "6:9", "did you mean 'sphere'"},
        {"FixedNoShape", fixed("below = \"1 mm\""), "5:", "shape' is missing"},
        {"HalfSpaceNeither", fixed("shape = \"half-space\""), "6:9", "neither"},
        {"HalfSpaceBoth", fixed("shape = \"half-space\"\nbelow = \"1 m\"\nabove = \"2 m\""), "6:9", "both"},
        {"BoxWithoutMax", fixed("shape = \"box\"\nmin = [\"0 m\", \"0 m\", \"0 m\"]"), "6:9", "needs 'max'"},
        {"BoxInsideOut",
         fixed("shape = \"box\"\nmin = [\"0 m\", \"0 m\", \"0 m\"]\nmax = [\"1 m\", \"-1 m\", \"1 m\"]"),
         "8:7", "greater than 'min'"},
        {"SphereBelow",
         fixed("shape = \"sphere\"\ncentre = [\"0 m\", \"0 m\", \"0 m\"]\nradius = \"1 m\"\nbelow = \"1 m\""),
         "9:9", "does not belong"},
        {"ShareAboveOne", fixed("shape = \"lowest\"\nshare = 5"), "7:9", "at most 1"},
        {"LowestTwice",
         fixed("shape = \"lowest\"\nshare = 0.1\n[[organ.fixed]]\nshape = \"lowest\"\nshare = 0.2"), "9:9",
         "second region"},
        {"PoseWithoutRadius", kMinimal + "[organ.pose]\n", "5:", "bend_radius' is missing"},
        {"EightTools", tooManyTools, "", "at most 7"},
        {"ToolWithoutKeys", tool("radius = \"1 mm\""), "5:", "keys' is missing"},
        {"ToolEmptyKeys", tool("keys = []"), "6:8", "at least one"},
        {"ToolKind", tool("kind = \"cube\"\n" + kKeys), "6:8", "unknown value \"cube\""},
        {"GraspOneKey", tool("mode = \"grasp\"\n" + kKeys), "7:8", "two"},
        {"KeysNotIncreasing",
         tool("keys = [{ t = \"1 s\", at = [\"0 m\", \"0 m\", \"0 m\"] },\n { t = \"1 s\", at = [\"0 m\", "
              "\"0 m\", \"0 m\"] }]"),
         "7:8", "times must increase"},
        {"KeysBackwards",
         tool("keys = [{ t = \"1 s\", at = [\"0 m\", \"0 m\", \"0 m\"] },\n { t = \"0.5 s\", at = [\"0 m\", "
              "\"0 m\", \"0 m\"] }]"),
         "7:8", "times must increase"},
        {"KeysOfNumbers", tool("keys = [1, 2]"), "6:9", "expected an array of { t"},
        {"CameraHeightPerspective", camera("height = \"1 m\""), "6:10", "orthographic"},
        {"CameraFovOrthographic", camera("projection = \"orthographic\"\nfov = \"30 deg\""), "7:7",
         "'height'"},
        {"CameraFovRange", camera("fov = \"179 deg\""), "6:7", "from 1 to 170 deg"},
        {"CameraNoDirection", camera("direction = [0, 0, 0]"), "6:13", "no length"},
        {"CameraUpAlongView", camera("direction = [0, -2, 0]"), "", "view direction"},
        {"CameraEyeAtTarget",
         camera("eye = [\"1 m\", \"0 m\", \"0 m\"]\ntarget = [\"1 m\", \"0 m\", \"0 m\"]"), "7:10",
         "where 'eye' is"},
        {"LightNoDirection", kMinimal + "[light]\ndirection = [0, 0, 0]\n", "6:13", "no length"},
        {"LightInfinite", kMinimal + "[light]\nintensity = inf\n", "6:13", "not a finite"},
        {"LookNumber", kMinimal + "[look]\nsurface = 1\n", "6:11", "expected true or false"},
        {"LookField", kMinimal + "[look]\nfield = \"dept\"\n", "6:9", "did you mean 'depth'"},
        {"DepthAxisOfNone", kMinimal + "[look]\ndepth_axis = \"y\"\n", "6:14", "no effect"},
        {"DepthsBesideTheSurface", kMinimal + "[look]\nshow = \"both\"\nfield = \"depth-cube\"\n", "7:9",
         "fill hollows"},
        {"DepthsByThreshold", kMinimal + "[look]\nfield = \"depth\"\nsearch = \"threshold\"\n", "7:10",
         "depth maps do not know"},
        {"LookMapping", kMinimal + "[look]\nmapping = \"curved\"\n", "6:11", "known: one-to-one"},
        {"SizeOne", output("size = [960]"), "6:8", "1 items"},
        {"SizeHuge", output("size = [960, 100000]"), "6:14", "from 16 to 16384"},
        {"SizeFractions", output("size = [960.5, 960]"), "6:9", "expected array of 2 integers"},
        {"SurfacesAfterEnd", output("surfaces_at = [\"3 s\"]"), "6:15", "after the end"},
        {"SnapshotsAfterEnd", output("snapshots_at = [\"3 s\"]"), "6:16", "after the end"},
        {"DisplacementsAfterEnd", output("displacements_at = [\"3 s\"]"), "6:20", "after the end"},
        {"DisplacementFormatWithoutTimes", output("displacement_format = \"mha\""), "6:23", "no effect"},
        {"DisplacementFormatUnknown", output("displacement_format = \"nii\""), "6:23", "known: nrrd"},
        {"SurfacesNotAList", output("surfaces_at = \"1 s\""), "6:15", "expected array"},
        {"SheetTooMany", output("sheet_columns = 1\nsheet_rows = 1\nsheet_at = [\"0 s\", \"1 s\"]"), "8:12",
         "places"},
    };
}

void PrintTo(const BadScene& bad, std::ostream* out) {
    *out << bad.name;
}

class SceneErrors : public ::testing::TestWithParam<BadScene> {};

TEST_P(SceneErrors, AreRefusedWhereTheyStand) {
    const BadScene& bad = GetParam();
    const SceneFiles files;
    const Result<Scene> scene = files.read(bad.text);
    ASSERT_FALSE(scene.ok()) << "accepted:\n" << bad.text;
    const std::string message = scene.error().message, file = (files.folder() / "scene.toml").string();
    EXPECT_EQ(message.rfind(file + ":" + bad.position, 0), 0u) << message << "\nexpected at " << bad.position;
    EXPECT_NE(message.find(bad.says), std::string::npos) << message << "\nexpected: " << bad.says;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_LT(message.size(), file.size() + 400) << message;
    EXPECT_EQ(scene.error().exitCode, exitBadInput);
}

INSTANTIATE_TEST_SUITE_P(All, SceneErrors, ::testing::ValuesIn(badScenes()),
                         [](const ::testing::TestParamInfo<BadScene>& test) {
                             return std::string(test.param.name);
                         });

TEST(SceneFileErrors, MissingFolderAndHuge) {
    const SceneFiles files;
    EXPECT_NE(readScene(files.folder() / "gone.toml").error().message.find("no such file"),
              std::string::npos);
    EXPECT_NE(readScene(files.folder()).error().message.find("not a file"), std::string::npos);
    const std::string huge = SceneFiles::minimal() + "#" + std::string(2 << 20, 'x');
    EXPECT_NE(files.read(huge).error().message.find("1 MiB"), std::string::npos);
}

} // namespace
} // namespace serosa::sim
