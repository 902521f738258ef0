// Materials in scene files: every key of them, what a material inherits, and each error with its line and
// column.

#include "shaders/shared_constants.h"
#include "tests/sim/scene_files.h"

#include <gtest/gtest.h>

namespace serosa::sim {
namespace {

const std::string kMinimal = SceneFiles::minimal();
// Two materials, each with a region: the next line is number 12.
const std::string kRegions =
    "[[organ.region]]\nmaterial = \"tumour\"\nshape = \"sphere\"\ncentre = [\"0 m\", \"0 "
    "m\", \"0 m\"]\nradius = \"1 cm\"\n";

class MaterialScene : public ::testing::Test {
protected:
    Scene mustRead(const std::string& text) {
        const Result<Scene> scene = files_.read(text, &values_);
        EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message);
        return scene.ok() ? *scene : Scene{};
    }
    Organ organOf(const std::string& lines) {
        const Scene scene = mustRead(kMinimal + lines);
        return scene.organs.empty() ? Organ{} : scene.organs.front();
    }
    SceneFiles files_;
    std::vector<SceneValue> values_;
};

TEST_F(MaterialScene, ReadsEveryKey) {
    const Organ organ = organOf(R"([organ.tissue]
curve = [{ strain = 0.1, stress = "0.5 kPa" }, { strain = 0.2, stress = "3 kPa" }, { strain = 0.3, stress = "4 kPa" }]
strain_limit = 0.4
poisson = 0.45
density = "1.05 g/cm3"
damping_time = "1 ms"
fibre = [0, 3, 4]
fibre_young = "20 kPa"
air_drag = "2 1/s"
recovery = true
[[organ.material]]
name = "capsule"
young = "400 kPa"
fibre_young = "400 kPa"
[[organ.material]]
name = "tumour"
curve = [{ strain = 0.5, stress = "5 kPa" }]
[[organ.region]]
material = "capsule"
shape = "layer"
depth = "2 mm"
[[organ.region]]
material = "tumour"
shape = "painted"
colour = [200, 30, 31]
tolerance = 3
depth = "5 mm"
from = "1 mm"
[[organ.region]]
material = "tumour"
shape = "sphere"
centre = ["1 mm", "2 mm", "3 mm"]
radius = "1 cm"
[[organ.region]]
material = "tissue"
shape = "half-space"
axis = "z"
above = "4 mm"
[[organ.region]]
material = "capsule"
shape = "box"
min = ["-1 mm", "-1 mm", "-1 mm"]
max = ["1 mm", "1 mm", "1 mm"]
[[organ.region]]
material = "tumour"
shape = "painted"
colour = [0, 0, 255]
)");
    const Tissue& tissue = organ.tissue;
    ASSERT_EQ(tissue.materialCount(), 3u);
    ASSERT_EQ(tissue.curve.size(), 3u);
    EXPECT_DOUBLE_EQ(tissue.curve[1].strain, 0.2);
    EXPECT_DOUBLE_EQ(tissue.curve[1].stress, 3000);
    EXPECT_DOUBLE_EQ(tissue.young, 5000);
    EXPECT_DOUBLE_EQ(tissue.strainLimit, 0.4);
    EXPECT_DOUBLE_EQ(tissue.density, 1050);
    EXPECT_DOUBLE_EQ(tissue.fibre.y, 0.6);
    EXPECT_DOUBLE_EQ(tissue.fibre.z, 0.8);
    EXPECT_DOUBLE_EQ(tissue.fibreYoung, 20000);
    EXPECT_TRUE(tissue.recovery);
    // 5 kPa, then 25 kPa, 10 kPa, then ten times that.
    const std::vector<CurveBreak> breaks = materialShares(tissue).front().breaks;
    ASSERT_EQ(breaks.size(), 3u);
    EXPECT_NEAR(breaks[0].gain, 4, 1e-12);
    EXPECT_NEAR(breaks[1].gain, -3, 1e-12);
    EXPECT_NEAR(breaks[2].gain, 18, 1e-12);

    const Material& capsule = tissue.material(1);
    EXPECT_EQ(capsule.name, "capsule");
    EXPECT_TRUE(capsule.curve.empty()) << "young replaces the curve";
    EXPECT_DOUBLE_EQ(capsule.young, 400000);
    EXPECT_FALSE(capsule.fibrous()) << "as stiff along the fibres as across";
    for (const double inherited : {capsule.strainLimit - 0.4, capsule.poisson - 0.45, capsule.density - 1050,
                                   capsule.dampingTime - 0.001})
        EXPECT_NEAR(inherited, 0, 1e-12);
    const Material& tumour = tissue.material(2);
    EXPECT_DOUBLE_EQ(tumour.young, 10000);
    EXPECT_TRUE(tumour.fibrous());

    ASSERT_EQ(organ.regions.size(), 6u);
    using Kind = MaterialRegion::Kind;
    EXPECT_EQ(organ.regions[0].kind, Kind::layer);
    EXPECT_EQ(organ.regions[0].material, 1u);
    EXPECT_DOUBLE_EQ(*organ.regions[0].depth, 0.002);
    EXPECT_DOUBLE_EQ(organ.regions[0].from, 0);
    EXPECT_EQ(organ.regions[0].place.line, 24);
    EXPECT_EQ(organ.regions[1].kind, Kind::painted);
    EXPECT_EQ(organ.regions[1].material, 2u);
    EXPECT_EQ(organ.regions[1].colour, glm::u8vec3(200, 30, 31));
    EXPECT_EQ(organ.regions[1].tolerance, 3);
    EXPECT_DOUBLE_EQ(*organ.regions[1].depth, 0.005);
    EXPECT_DOUBLE_EQ(organ.regions[1].from, 0.001);
    EXPECT_EQ(organ.regions[2].place.shape, Region::Shape::sphere);
    EXPECT_DOUBLE_EQ(organ.regions[2].place.radius, 0.01);
    EXPECT_EQ(organ.regions[3].material, 0u);
    EXPECT_EQ(organ.regions[3].place.axis, 2);
    EXPECT_DOUBLE_EQ(*organ.regions[3].place.above, 0.004);
    EXPECT_EQ(organ.regions[4].place.shape, Region::Shape::box);
    EXPECT_EQ(organ.regions[5].tolerance, 8);
    EXPECT_FALSE(organ.regions[5].depth);
}

TEST_F(MaterialScene, SaysWhatIsInherited) {
    mustRead(kMinimal +
             "[organ.tissue]\npoisson = 0.4\n[[organ.material]]\nname = \"tumour\"\nyoung = \"9 kPa\"\n" +
             kRegions);
    const auto value = [&](const std::string& key) -> SceneValue {
        for (const SceneValue& candidate : values_)
            if (candidate.path == "organ[0].material[0]." + key)
                return candidate;
        ADD_FAILURE() << key << " is not explained";
        return {};
    };
    EXPECT_EQ(value("young").line, 9);
    EXPECT_FALSE(value("young").inherited);
    EXPECT_EQ(value("poisson").line, 0);
    EXPECT_TRUE(value("poisson").inherited);
    EXPECT_EQ(value("poisson").value, "0.4");
}

// As many turns as the solvers have room for, and no more.
TEST_F(MaterialScene, TakesAsManyTurnsAsThereAre) {
    const auto curve = [](int points) {
        std::string text = "curve = [";
        for (int i = 1; i <= points; ++i)
            text +=
                "{ strain = " + std::to_string(i) + ", stress = \"" + std::to_string(i * i) + " kPa\" }, ";
        return "[organ.tissue]\n" + text + "]\n";
    };
    EXPECT_EQ(materialShares(organOf(curve(9)).tissue)[0].breaks.size(), std::size_t(SRS_CURVE_BREAKS));
    EXPECT_EQ(materialShares(organOf(curve(8) + "strain_limit = 7.5\n").tissue)[0].breaks.size(),
              std::size_t(SRS_CURVE_BREAKS));
    const Result<Scene> ten = files_.read(kMinimal + curve(10));
    ASSERT_FALSE(ten.ok());
    EXPECT_NE(ten.error().message.find(":6:9: organ[0].tissue.curve: has 10 points, at most 9"),
              std::string::npos)
        << ten.error().message;
    const Result<Scene> nine = files_.read(kMinimal + curve(9) + "strain_limit = 8.5\n");
    ASSERT_FALSE(nine.ok());
    EXPECT_NE(nine.error().message.find("at most 8 are possible beside a strain limit"), std::string::npos)
        << nine.error().message;
}

struct BadMaterial {
    const char* name;
    std::string text;     // after the shortest scene: its first line is number 5
    std::string position; // "line:column"
    std::string says;     // part of the message
};

std::vector<BadMaterial> badMaterials() {
    const auto tissue = [](const std::string& lines) { return "[organ.tissue]\n" + lines + "\n"; };
    const auto curve = [&](const std::string& points) { return tissue("curve = [" + points + "]"); };
    // Its keys begin in line 7.
    const auto material = [](const std::string& lines) {
        return "[[organ.material]]\nname = \"tumour\"\n" + lines + "\n" + kRegions;
    };
    // Its keys begin in line 8.
    const auto region = [](const std::string& lines) {
        return "[[organ.material]]\nname = \"tumour\"\n[[organ.region]]\n" + lines + "\n";
    };
    const auto layer = [&](const std::string& lines) {
        return region("material = \"tumour\"\nshape = \"layer\"\n" + lines);
    };
    const auto painted = [&](const std::string& lines) {
        return region("material = \"tumour\"\nshape = \"painted\"\n" + lines);
    };
    const std::string first = "{ strain = 0.1, stress = \"1 kPa\" }, ";
    std::string sixteen;
    for (int i = 0; i < 16; ++i)
        sixteen += "[[organ.material]]\nname = \"m" + std::to_string(i) + "\"\n";
    return {
        {"CurveIsNumber", tissue("curve = 3"), "6:9", "expected an array of { strain"},
        {"CurveOfNumbers", curve("1, 2"), "6:10", "expected an array of { strain"},
        {"CurveEmpty", curve(""), "6:9", "at least one point"},
        {"CurveAndYoung", tissue("curve = [{ strain = 0.1, stress = \"1 kPa\" }]\nyoung = \"3 kPa\""), "7:9",
         "beside 'curve'"},
        {"CurveUnknownKey", curve("{ strian = 0.1, stress = \"1 kPa\" }"), "6:", "did you mean 'strain'"},
        {"CurveNoStress", curve("{ strain = 0.1 }"), "6:10", "stress' is missing"},
        {"CurveBareStress", curve("{ strain = 0.1, stress = 3 }"), "6:35", "has no unit"},
        {"CurveWrongUnit", curve("{ strain = 0.1, stress = \"3 mm\" }"), "6:35", "is a length"},
        {"CurveStrainZero", curve("{ strain = 0, stress = \"3 kPa\" }"), "6:21", "greater than 0"},
        {"CurveStrainNegative", curve("{ strain = -0.1, stress = \"3 kPa\" }"), "6:21", "greater than 0"},
        {"CurveStrainNan", curve("{ strain = nan, stress = \"3 kPa\" }"), "6:21", "not a finite"},
        {"CurveStrainInfinite", curve("{ strain = inf, stress = \"3 kPa\" }"), "6:21", "not a finite"},
        {"CurveStressNegative", curve("{ strain = 0.1, stress = \"-3 kPa\" }"), "6:35", "greater than 0"},
        {"CurveStressNan", curve("{ strain = 0.1, stress = \"nan kPa\" }"), "6:35", ""},
        {"CurveStrainFalls", curve(first + "{ strain = 0.1, stress = \"2 kPa\" }"), "6:57",
         "strains must rise"},
        {"CurveStressFalls", curve(first + "{ strain = 0.2, stress = \"1 kPa\" }"), "6:71",
         "stresses must rise"},
        {"CurveTooSteep", curve(first + "{ strain = 0.10000000001, stress = \"9 GPa\" }"), "6:81",
         "makes the curve rise"},
        {"LimitNegative", tissue("strain_limit = -0.1"), "6:16", "at least 0"},
        {"LimitNan", tissue("strain_limit = nan"), "6:16", "not a finite"},
        {"LimitInfinite", tissue("strain_limit = inf"), "6:16", "not a finite"},
        {"LimitWithUnit", tissue("strain_limit = \"30 %\""), "6:16", "expected number"},
        {"LimitInsideCurve", curve(first + "{ strain = 0.2, stress = \"3 kPa\" }") + "strain_limit = 0.1\n",
         "7:16", "beyond the curve's last point but one, at 0.1"},
        {"LimitInheritedInsideCurve",
         tissue("strain_limit = 0.1") + "[[organ.material]]\nname = \"tumour\"\ncurve = [" + first +
             "{ strain = 0.2, stress = \"3 kPa\" }]\n" + kRegions,
         "9:9", "strain limit of 0.1"},
        {"FibreAlone", tissue("fibre = [1, 0, 0]"), "6:9", "needs 'fibre_young'"},
        {"FibreYoungAlone", tissue("fibre_young = \"20 kPa\""), "6:15", "needs 'fibre'"},
        {"FibreNoLength", tissue("fibre = [0, 0, 0]\nfibre_young = \"20 kPa\""), "6:9", "no length"},
        {"FibreTwo", tissue("fibre = [1, 0]\nfibre_young = \"20 kPa\""), "6:9", "2 items"},
        {"FibreNan", tissue("fibre = [1, nan, 0]\nfibre_young = \"20 kPa\""), "6:13", "not a finite"},
        {"FibreInfinite", tissue("fibre = [inf, 0, 0]\nfibre_young = \"20 kPa\""), "6:10", "not a finite"},
        {"FibreSofter", tissue("fibre = [1, 0, 0]\nfibre_young = \"4 kPa\""), "7:15",
         "is below the one across"},
        {"FibreNegative", tissue("fibre = [1, 0, 0]\nfibre_young = \"-4 kPa\""), "7:15", "greater than 0"},
        {"MaterialOnce", "[organ.material]\nname = \"tumour\"\n", "5:", "[[organ.material]]"},
        {"MaterialNoName", "[[organ.material]]\nyoung = \"3 kPa\"\n", "5:", "name' is missing"},
        {"MaterialNameNumber", "[[organ.material]]\nname = 3\n", "6:8", "expected text"},
        {"MaterialNameEmpty", "[[organ.material]]\nname = \"\"\n", "6:8", "is empty"},
        {"MaterialNamedTissue", "[[organ.material]]\nname = \"tissue\"\n", "6:8", "take another"},
        {"MaterialTwice", "[[organ.material]]\nname = \"a\"\n[[organ.material]]\nname = \"a\"\n", "8:8",
         "name of another material"},
        {"MaterialUnknownKey", material("yuong = \"3 kPa\""), "7:1", "did you mean 'young'"},
        {"MaterialAirDrag", material("air_drag = \"3 1/s\""), "7:1", "unknown key"},
        {"MaterialNegativeYoung", material("young = \"-3 kPa\""), "7:9", "greater than 0"},
        {"MaterialNanYoung", material("young = nan"), "7:9", ""},
        {"MaterialBareYoung", material("young = 3000"), "7:9", "has no unit"},
        {"MaterialIncompressible", material("poisson = 0.5"), "7:11", "at most 0.495"},
        {"MaterialLowPoisson", material("poisson = -0.2"), "7:11", "at least 0.25"},
        {"MaterialNanPoisson", material("poisson = nan"), "7:11", "not a finite"},
        {"MaterialNoDensity", material("density = \"0 kg/m3\""), "7:11", "greater than 0"},
        {"MaterialNegativeDamping", material("damping_time = \"-1 ms\""), "7:16", "at least 0"},
        {"MaterialStifferThanFibre",
         tissue("fibre = [1, 0, 0]\nfibre_young = \"20 kPa\"") +
             "[[organ.material]]\nname = \"tumour\"\nyoung = \"30 kPa\"\n" + kRegions,
         "10:9", "raise 'fibre_young'"},
        {"SixteenMaterials", sixteen, "5:", "at most 15"},
        {"MaterialUnused", "[[organ.material]]\nname = \"tumour\"\n", "6:8", "no [[organ.region]] gives"},
        {"MaterialBesidePose", material("") + "[organ.pose]\nbend_radius = \"1 m\"\n", "5:", "beside 'pose'"},
        {"RegionWithoutMaterials", "[[organ.region]]\nmaterial = \"tissue\"\nshape = \"layer\"\n",
         "5:", "no [[organ.material]]"},
        {"RegionUnknownMaterial", region("material = \"tumuor\"\nshape = \"layer\"\ndepth = \"2 mm\""),
         "8:12", "did you mean 'tumour'"},
        {"RegionNoMaterial", region("shape = \"layer\"\ndepth = \"2 mm\""), "7:", "material' is missing"},
        {"RegionNoShape", region("material = \"tumour\""), "7:", "shape' is missing"},
        {"RegionUnknownShape", region("material = \"tumour\"\nshape = \"leyer\""), "9:9",
         "did you mean 'layer'"},
        {"RegionLowest", region("material = \"tumour\"\nshape = \"lowest\"\nshare = 0.2"), "10:1",
         "unknown key"},
        {"RegionSphereAsFixed", region("material = \"tumour\"\nshape = \"sphere\"\nradius = \"1 m\""), "9:9",
         "needs 'centre'"},
        {"LayerNoDepth", layer(""), "9:9", "needs 'depth'"},
        {"LayerZeroDepth", layer("depth = \"0 mm\""), "10:9", "greater than 0"},
        {"LayerNegativeDepth", layer("depth = \"-2 mm\""), "10:9", "greater than 0"},
        {"LayerNanDepth", layer("depth = \"nan mm\""), "10:9", ""},
        {"LayerBareDepth", layer("depth = 2"), "10:9", "has no unit"},
        {"LayerNegativeFrom", layer("depth = \"2 mm\"\nfrom = \"-1 mm\""), "11:8", "at least 0"},
        {"LayerFromBelowDepth", layer("depth = \"2 mm\"\nfrom = \"2 mm\""), "11:8", "not less than 'depth'"},
        {"LayerColour", layer("depth = \"2 mm\"\ncolour = [1, 2, 3]"), "11:10", "does not belong"},
        {"PaintedNoColour", painted("depth = \"2 mm\""), "9:9", "needs 'colour'"},
        {"PaintedTwoChannels", painted("colour = [1, 2]"), "10:10", "array of 3 integers"},
        {"PaintedFraction", painted("colour = [0.5, 0.5, 0.5]"), "10:11", "integer"},
        {"PaintedNan", painted("colour = [nan, 0, 0]"), "10:11", "not a finite"},
        {"PaintedTooBright", painted("colour = [0, 0, 256]"), "10:17", "from 0 to 255"},
        {"PaintedNegative", painted("colour = [0, -1, 2]"), "10:14", "from 0 to 255"},
        {"PaintedTolerance", painted("colour = [1, 2, 3]\ntolerance = -1"), "11:13", "from 0 to 255"},
        {"PaintedCentre", painted("colour = [1, 2, 3]\ncentre = [\"0 m\", \"0 m\", \"0 m\"]"), "11:10",
         "does not belong"},
    };
}

void PrintTo(const BadMaterial& bad, std::ostream* out) {
    *out << bad.name;
}

class BadMaterials : public ::testing::TestWithParam<BadMaterial> {};

TEST_P(BadMaterials, IsRefusedWithItsPosition) {
    const BadMaterial& bad = GetParam();
    const SceneFiles files;
    const Result<Scene> scene = files.read(kMinimal + bad.text);
    ASSERT_FALSE(scene.ok());
    const std::string& message = scene.error().message;
    const std::string start = (files.folder() / "scene.toml").string() + ":" + bad.position;
    EXPECT_EQ(message.rfind(start, 0), 0u) << message << "\nexpected at " << bad.position;
    EXPECT_NE(message.find(bad.says), std::string::npos) << message << "\nexpected: " << bad.says;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_EQ(scene.error().exitCode, exitBadInput);
}

INSTANTIATE_TEST_SUITE_P(All, BadMaterials, ::testing::ValuesIn(badMaterials()),
                         [](const ::testing::TestParamInfo<BadMaterial>& test) {
                             return std::string(test.param.name);
                         });

} // namespace
} // namespace serosa::sim
