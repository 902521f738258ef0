// `serosa run` on a small solid: what it writes, the same bytes twice, the same with both solvers, a full
// disk.

#include "app/html_page.h"
#include "sim/mesh_reader.h"
#include "sim/mesh_writer.h"
#include "sim/up_axis.h"
#include "tests/app/child.h"
#include "tests/app/page_reader.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <functional>

namespace serosa::app {
namespace {

namespace fs = std::filesystem;

/// The backend that this run of the tests is for.
std::string glChoice() {
    const char* gl = std::getenv("SEROSA_TEST_GL");
    return gl ? gl : "auto";
}

class GlRun : public ::testing::Test {
protected:
    void SetUp() override {
        folder_.write(
            "ball.toml",
            "schema = 1\n[[organ]]\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\nnodes = 200\n"
            "[[organ.fixed]]\nshape = \"lowest\"\nshare = 0.3\n"
            "[[tool]]\nradius = \"30 mm\"\nkeys = [{ t = \"0 s\", at = [\"0 mm\", \"72 mm\", \"0 mm\"] },"
            " { t = \"100 ms\", at = [\"0 mm\", \"55 mm\", \"0 mm\"] }]\n"
            "[output]\nsize = [64, 48]\nsurfaces_at = [\"0 s\", \"100 ms\"]\nframe_every = 3\n");
        const ChildResult made = serosa({"phantom", "ball", "--faces", "500", "-o", "ball.ply"});
        ASSERT_EQ(made.exitCode, 0) << made.err;
    }
    ChildResult serosa(const std::vector<std::string>& arguments, const ChildOptions& options = {}) const {
        return runSerosa(folder_.path(), arguments, options);
    }
    ChildResult run(const std::string& out, std::vector<std::string> more = {},
                    const ChildOptions& options = {}) const {
        std::vector<std::string> arguments{"run",  "ball.toml", "--frames", "6",
                                           "--gl", glChoice(),  "--out",    out};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return serosa(arguments, options);
    }
    nlohmann::json summary(const std::string& out) const {
        return nlohmann::json::parse(readWhole(folder_.path() / out / "summary.json"), nullptr, false);
    }
    std::set<std::string> written(const std::string& out) const {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_.path() / out))
            names.insert(entry.path().filename().string());
        return names;
    }
    TestFolder folder_;
};

TEST_F(GlRun, WritesWhatTheReferenceSays) {
    const ChildResult result = run("a");
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(written("a"), (std::set<std::string>{"frame_000003.png", "frame_000006.png",
                                                   "contact_sheet.png", "surface_000000.ply",
                                                   "surface_000006.ply", "summary.json", "report.html"}));
    const nlohmann::json json = summary("a");
    ASSERT_FALSE(json.is_discarded());
    EXPECT_EQ(json["solver"], "fragment");
    EXPECT_EQ(json["frames"], 6);
    EXPECT_EQ(json["end"], "complete");
    EXPECT_EQ(json["pictures"], 2);
    EXPECT_GT(json["largest_displacement_m"].get<double>(), 1e-3);
    EXPECT_GT(json["tools"][0]["largest_force_N"].get<double>(), 0);
    EXPECT_EQ(json["tools"][0]["force"].size(), 6u);
    EXPECT_NEAR(json["lattice"]["nodes"].get<double>(), 200, 40);
    EXPECT_EQ(json["state_hash"].get<std::string>().size(), 32u);
    EXPECT_NEAR(json["step"]["time_step_s"].get<double>() * json["step"]["steps_per_frame"].get<int>(),
                1.0 / 60, 1e-12);
}

TEST_F(GlRun, DocumentsEverySummaryKey) {
    ASSERT_EQ(run("a").exitCode, 0);
    const std::string document = readWhole(fs::path(SEROSA_SOURCE_DIR) / "docs" / "cli.md");
    const std::function<void(const nlohmann::json&)> check = [&](const nlohmann::json& json) {
        if (json.is_array() && !json.empty())
            check(json.front());
        if (!json.is_object())
            return;
        for (const auto& [key, value] : json.items()) {
            EXPECT_NE(document.find("`" + key + "`"), std::string::npos)
                << "docs/cli.md does not explain " << key;
            check(value);
        }
    };
    check(summary("a"));
    for (const char* key :
         {"curve", "strain", "stress_Pa", "strain_limit", "fibre", "fibre_young_Pa"}) // of some
        EXPECT_NE(document.find("`" + std::string(key) + "`"), std::string::npos) << key;
}

// Nothing is fixed, under gravity, without a floor: allowed, and said once. Its materials add up to the ball.
TEST_F(GlRun, SaysWhatTheLatticeMadeOfItsMaterials) {
    folder_.write("ball.toml",
                  "schema = 1\n[[organ]]\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\nnodes = 200\n"
                  "[organ.tissue]\ndensity = \"1000 kg/m3\"\n"
                  "[[organ.material]]\nname = \"shell\"\ndensity = \"1100 kg/m3\"\n"
                  "curve = [{ strain = 0.1, stress = \"1 kPa\" }, { strain = 0.2, stress = \"3 kPa\" }]\n"
                  "[[organ.region]]\nmaterial = \"shell\"\nshape = \"layer\"\ndepth = \"1 mm\"\n"
                  "[look]\ncolour = \"material\"\n[output]\nsize = [64, 48]\n");
    const ChildResult result = run("a", {"--solver", "reference"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const auto times = [&result](const std::string& text) {
        std::size_t count = 0;
        for (std::size_t at = result.out.find(text); at != std::string::npos;
             at = result.out.find(text, at + 1))
            ++count;
        return count;
    };
    EXPECT_EQ(times("is fixed, and there is no floor: it falls"), 1u) << result.out;
    EXPECT_EQ(times("material tissue: young 5 kPa"), 1u) << result.out;
    EXPECT_EQ(times("material shell: young 10 kPa"), 1u) << result.out;
    EXPECT_EQ(times("curve of 2 points"), 1u) << result.out;
    EXPECT_EQ(times("is thinner than the lattice's spacing"), 1u) << result.out;

    const nlohmann::json json = summary("a"), materials = json["organ"]["materials"];
    ASSERT_EQ(materials.size(), 2u);
    EXPECT_EQ(materials[0]["name"], "tissue");
    EXPECT_EQ(materials[1]["curve"][1]["stress_Pa"], 3000.0);
    const double inner = materials[0]["volume_m3"], shell = materials[1]["volume_m3"];
    EXPECT_NEAR(inner + shell, json["lattice"]["filled_volume_m3"].get<double>(), 1e-12);
    EXPECT_NEAR(materials[1]["mass_kg"].get<double>(), 1100 * shell, 1e-12);
    EXPECT_EQ(materials[0]["cells"].get<int>() + materials[1]["cells"].get<int>(),
              json["lattice"]["cells"].get<int>());
    const std::string page = readWhole(folder_.path() / "a" / "report.html");
    EXPECT_NE(page.find(">shell<"), std::string::npos);
    EXPECT_NE(page.find("tension 1\u00A0kPa at 10\u00A0%, 3\u00A0kPa at 20\u00A0%"), std::string::npos);
}

TEST_F(GlRun, GivesTheSameBytesTwice) {
    ASSERT_EQ(run("a").exitCode, 0);
    ASSERT_EQ(run("b").exitCode, 0);
    nlohmann::json first = summary("a"), second = summary("b");
    first.erase("timing");
    second.erase("timing");
    EXPECT_EQ(first, second);
    for (const std::string& name : written("a"))
        if (name != "summary.json" && name != "report.html") {
            EXPECT_EQ(readWhole(folder_.path() / "a" / name), readWhole(folder_.path() / "b" / name)) << name;
        }
}

TEST_F(GlRun, ReportIsCompleteAndTheSameTwice) {
    std::vector<std::string> pages;
    for (const char* out : {"a", "b"}) {
        ASSERT_EQ(run(out).exitCode, 0);
        pages.push_back(readWhole(folder_.path() / out / "report.html"));
        const PageReader page(pages.back());
        ASSERT_EQ(page.error(), "");
        std::vector<std::string> sources;
        for (const Element* image : page.all("img"))
            sources.push_back(image->attribute("src"));
        // Rest, frame 6: pictures 3 and 6; the largest displacement is that of the last.
        const auto embedded = [&](const char* name) {
            return "data:image/png;base64," + base64(readWhole(folder_.path() / out / name));
        };
        EXPECT_EQ(sources,
                  (std::vector<std::string>{embedded("contact_sheet.png"), embedded("frame_000006.png")}));
        EXPECT_NE(page.byId("plot-force"), nullptr);
        const Element* timing = page.byId("timing");
        ASSERT_NE(timing, nullptr);
        pages.back().erase(timing->begin, timing->end - timing->begin);
    }
    EXPECT_EQ(pages[0], pages[1]);
}

// JSON and HTML are UTF-8, names of files are bytes.
TEST_F(GlRun, TakesAFileNameThatIsNoUtf8) {
    const std::string name = "b\xFFll.ply";
    fs::copy_file(folder_.path() / "ball.ply", folder_.path() / name);
    const ChildResult result =
        serosa({"run", "--model", name, "--length-unit", "mm", "--frames", "2", "--nodes", "200", "--size",
                "64x48", "--gl", glChoice(), "--out", "b"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(summary("b")["organ"]["model"], "b\uFFFDll.ply");
    EXPECT_EQ(PageReader(readWhole(folder_.path() / "b" / "report.html")).error(), "");
}

TEST_F(GlRun, SurfacesComeBackInUnitFrameAndOrderOfTheInput) {
    ASSERT_EQ(run("a").exitCode, 0);
    const auto input = sim::readMesh(folder_.path() / "ball.ply");
    const auto rest = sim::readMesh(folder_.path() / "a" / "surface_000000.ply");
    const auto pressed = sim::readMesh(folder_.path() / "a" / "surface_000006.ply");
    ASSERT_TRUE(input.ok() && rest.ok() && pressed.ok());
    EXPECT_EQ(rest->positions, input->positions); // to the last bit
    EXPECT_EQ(pressed->faces, input->faces);
    ASSERT_EQ(pressed->positions.size(), input->positions.size());
    double largest = 0;
    for (std::size_t i = 0; i < input->positions.size(); ++i)
        largest = std::max(largest, glm::distance(pressed->positions[i], input->positions[i]));
    EXPECT_GT(largest, 1);  // mm: the tool presses by 15 mm at most
    EXPECT_LT(largest, 30); // mm
}

TEST_F(GlRun, ReferenceAndFragmentAgree) {
    ASSERT_EQ(run("a").exitCode, 0);
    const ChildResult reference = run("b", {"--solver", "reference"});
    ASSERT_EQ(reference.exitCode, 0) << reference.err;
    const nlohmann::json a = summary("a"), b = summary("b");
    EXPECT_EQ(b["solver"], "reference");
    const double spacing = a["lattice"]["spacing_m"];
    EXPECT_NEAR(a["largest_displacement_m"].get<double>(), b["largest_displacement_m"].get<double>(),
                1e-3 * spacing);
}

TEST_F(GlRun, ForceReplacesOwnResultsAndKeepsTheRest) {
    ASSERT_EQ(run("a").exitCode, 0);
    folder_.write("a/notes.txt", "mine");
    folder_.write("a/frame_000099.png", "of a longer run");
    EXPECT_EQ(run("a").exitCode, 2);
    EXPECT_TRUE(fs::exists(folder_.path() / "a" / "frame_000099.png"));
    ASSERT_EQ(run("a", {"--force"}).exitCode, 0);
    EXPECT_TRUE(fs::exists(folder_.path() / "a" / "notes.txt"));
    EXPECT_FALSE(fs::exists(folder_.path() / "a" / "frame_000099.png"));
}

TEST_F(GlRun, FullDiskLeavesNothing) {
    const auto before = folder_.names();
    const ChildOptions full{{{"MESA_SHADER_CACHE_DISABLE", "true"}}, 700};
    const ChildResult result = run("a", {}, full);
    EXPECT_EQ(result.exitCode, 2) << result.err;
    EXPECT_EQ(folder_.names(), before);
    const ChildResult phantom = serosa({"phantom", "ball", "--faces", "500", "-o", "new.ply"}, full);
    EXPECT_EQ(phantom.exitCode, 2) << phantom.err;
    EXPECT_EQ(phantom.errorLines(), 1u) << phantom.err;
    EXPECT_EQ(folder_.names(), before);
}

TEST_F(GlRun, AnInterruptedRunKeepsItsFramesAndSaysSo) {
    for (const int signal : {SIGINT, SIGTERM}) {
        const std::string out = "by" + std::to_string(signal);
        ChildOptions options;
        options.interruptAfter = out + "/frame_000003.png";
        options.interruptBy = signal;
        const ChildResult result =
            serosa({"run", "ball.toml", "--frames", "1000000", "--gl", glChoice(), "--out", out}, options);
        EXPECT_EQ(result.exitCode, 130) << result.err;
        EXPECT_NE(result.out.find("interrupted after frame"), std::string::npos) << result.out;
        const nlohmann::json json = summary(out);
        ASSERT_FALSE(json.is_discarded()) << result.err;
        EXPECT_EQ(json["end"], "interrupted");
        EXPECT_EQ(json["frames_asked"], 1000000);
        const int frames = json["frames"];
        EXPECT_GE(frames, 3);
        EXPECT_TRUE(written(out).contains("frame_000003.png"));
        // The state is that of a run that was asked for just so many frames.
        const std::string whole = out + "-whole";
        ASSERT_EQ(serosa({"run", "ball.toml", "--frames", std::to_string(frames), "--gl", glChoice(), "--out",
                          whole})
                      .exitCode,
                  0);
        EXPECT_EQ(json["state_hash"], summary(whole)["state_hash"]);
    }
}

TEST_F(GlRun, FewerFramesLeaveOutLaterTimesAndSaySo) {
    const ChildResult result =
        serosa({"run", "ball.toml", "--frames", "3", "--gl", glChoice(), "--out", "short"});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_NE(result.out.find("note: 1 of the times"), std::string::npos) << result.out;
    EXPECT_EQ(summary("short")["surfaces"], 1);
}

TEST_F(GlRun, AFullStandardOutputIsNoticed) {
    const ChildResult result = serosa({"scene", "check", "ball.toml"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    ChildOptions full;
    full.standardOutput = "/dev/full";
    const ChildResult failed = serosa({"scene", "check", "ball.toml"}, full);
    EXPECT_EQ(failed.exitCode, 2);
    EXPECT_EQ(failed.errorLines(), 1U) << failed.err;
    EXPECT_NE(failed.err.find("standard output"), std::string::npos) << failed.err;
}

TEST_F(GlRun, AnOrganThatRunsAwayIsStoppedAndTheRunGoesOn) {
    // Gravity beyond the range of the state's float32: infinite after one step.
    std::string scene = readWhole(folder_.path() / "ball.toml");
    scene.insert(scene.find("[[organ]]"), "gravity = [\"0 m/s2\", \"-1e45 m/s2\", \"0 m/s2\"]\n");
    folder_.write("away.toml", scene);
    const ChildResult result =
        serosa({"run", "away.toml", "--frames", "30", "--gl", glChoice(), "--out", "away"});
    EXPECT_EQ(result.exitCode, 1) << result.out;
    EXPECT_EQ(result.errorLines(), 1U) << result.err;
    EXPECT_NE(result.err.find("is not finite"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("node "), std::string::npos) << result.err;
    const nlohmann::json json = summary("away");
    ASSERT_FALSE(json.is_discarded()) << "what led to it is kept";
    EXPECT_EQ(json["end"], "organ stopped");
    EXPECT_EQ(json["frames"], 30) << "the others live on";
    EXPECT_EQ(json["surfaces"], 2) << "of the last good state";
    EXPECT_EQ(json["stopped"]["reason"], "not finite");
    EXPECT_TRUE(json["stopped"]["position_m"][1].is_number());
    EXPECT_EQ(json["largest_displacement_m"], 0);
    EXPECT_NE(result.out.find("stopped: "), std::string::npos) << result.out;
    const std::string page = readWhole(folder_.path() / "away" / "report.html");
    EXPECT_NE(page.find("An organ was stopped"), std::string::npos);
    EXPECT_NE(page.find("is not finite"), std::string::npos);
}

// An organ among others moves as it does alone: no contact between organs yet, one tool acts on all.
TEST_F(GlRun, SeveralOrgansMoveInLockstep) {
    const std::string organ = "model = \"ball.ply\"\nlength_unit = \"mm\"\nnodes = 200\n"
                              "[[organ.fixed]]\nshape = \"lowest\"\nshare = 0.3\n";
    const std::string scene = readWhole(folder_.path() / "ball.toml");
    const std::string rest = scene.substr(scene.find("[[tool]]"));
    folder_.write("two.toml", "schema = 1\n[[organ]]\nname = \"left one\"\n" + organ +
                                  "[[organ]]\nname = \"stiff\"\n" + organ +
                                  "[organ.tissue]\nyoung = \"20 kPa\"\n" + rest);
    folder_.write("stiff.toml",
                  "schema = 1\n[[organ]]\n" + organ + "[organ.tissue]\nyoung = \"20 kPa\"\n" + rest);
    const auto runScene = [&](const std::string& name) {
        return serosa({"run", name + ".toml", "--frames", "6", "--gl", glChoice(), "--out", name});
    };
    for (const char* name : {"two", "stiff"}) {
        const ChildResult result = runScene(name);
        ASSERT_EQ(result.exitCode, 0) << result.err;
    }
    ASSERT_EQ(run("soft").exitCode, 0);
    const nlohmann::json two = summary("two"), soft = summary("soft"), stiff = summary("stiff");
    ASSERT_EQ(two["organs"].size(), 2u);
    EXPECT_EQ(two["organs"][0]["state_hash"], soft["state_hash"]);
    EXPECT_EQ(two["organs"][1]["state_hash"], stiff["state_hash"]);
    EXPECT_EQ(two["organs"][0]["step"], soft["step"]);
    EXPECT_EQ(two["organs"][1]["step"], stiff["step"]);
    EXPECT_NE(soft["step"]["steps_per_frame"], stiff["step"]["steps_per_frame"]);
    EXPECT_FALSE(two.contains("organ"));
    const auto sum = [](const nlohmann::json& json) {
        return json["energies"].back()["elastic_J"].get<double>();
    };
    EXPECT_NEAR(sum(two), sum(soft) + sum(stiff), 1e-12);
    const auto force = [](const nlohmann::json& json) {
        return json["tools"][0]["force"][5]["N"][1].get<double>();
    };
    EXPECT_NEAR(force(two), force(soft) + force(stiff), 1e-9);
    EXPECT_EQ(written("two"),
              (std::set<std::string>{"frame_000003.png", "frame_000006.png", "contact_sheet.png",
                                     "surface_left_one_000000.ply", "surface_left_one_000006.ply",
                                     "surface_stiff_000000.ply", "surface_stiff_000006.ply", "summary.json",
                                     "report.html"}));
    EXPECT_EQ(readWhole(folder_.path() / "two" / "surface_left_one_000006.ply"),
              readWhole(folder_.path() / "soft" / "surface_000006.ply"));
    EXPECT_EQ(readWhole(folder_.path() / "two" / "surface_stiff_000006.ply"),
              readWhole(folder_.path() / "stiff" / "surface_000006.ply"));
}

// The same body in a file whose z points up: the same states and pictures, and surfaces in the file's axes.
TEST_F(GlRun, TurnsAModelWhoseZIsUp) {
    ASSERT_EQ(run("a").exitCode, 0);
    auto turned = sim::readMesh(folder_.path() / "ball.ply");
    ASSERT_TRUE(turned.ok());
    for (glm::dvec3& position : turned->positions)
        position = sim::fileFromWorld(sim::UpAxis::z, position);
    ASSERT_TRUE(sim::writeMesh(*turned, folder_.path() / "turned.ply").ok());
    std::string scene = readWhole(folder_.path() / "ball.toml");
    scene.replace(scene.find("ball.ply"), 8, "turned.ply");
    scene.insert(scene.find("nodes ="), "up_axis = \"z\"\n");
    folder_.write("turned.toml", scene);
    const ChildResult result =
        serosa({"run", "turned.toml", "--frames", "6", "--gl", glChoice(), "--out", "b"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(summary("b")["state_hash"], summary("a")["state_hash"]);
    EXPECT_EQ(summary("b")["organ"]["up_axis"], "z");
    EXPECT_EQ(readWhole(folder_.path() / "b" / "frame_000006.png"),
              readWhole(folder_.path() / "a" / "frame_000006.png"));
    const auto rest = sim::readMesh(folder_.path() / "b" / "surface_000000.ply");
    const auto pressed = sim::readMesh(folder_.path() / "b" / "surface_000006.ply");
    const auto expected = sim::readMesh(folder_.path() / "a" / "surface_000006.ply");
    ASSERT_TRUE(rest.ok() && pressed.ok() && expected.ok());
    EXPECT_EQ(rest->positions, turned->positions);
    for (std::size_t i = 0; i < expected->positions.size(); ++i)
        ASSERT_EQ(sim::worldFromFile(sim::UpAxis::z, pressed->positions[i]), expected->positions[i]);
}

TEST_F(GlRun, RepairsOnlyWhenAsked) {
    auto broken = sim::readMesh(folder_.path() / "ball.ply");
    ASSERT_TRUE(broken.ok());
    broken->faces.erase(broken->faces.begin() + 9);
    std::swap(broken->faces[3].x, broken->faces[3].y);
    ASSERT_TRUE(sim::writeMesh(*broken, folder_.path() / "broken.ply").ok());
    std::string scene = readWhole(folder_.path() / "ball.toml");
    scene.replace(scene.find("ball.ply"), 8, "broken.ply");
    folder_.write("broken.toml", scene);
    const std::vector<std::string> arguments{"run",  "broken.toml", "--frames", "6",
                                             "--gl", glChoice(),    "--out",    "b"};
    const ChildResult refused = serosa(arguments);
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_NE(refused.err.find("--repair"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("broken.toml:3: "), std::string::npos) << refused.err;
    scene.insert(scene.find("nodes ="), "repair = true\n");
    folder_.write("broken.toml", scene);
    const ChildResult mended = serosa(arguments);
    ASSERT_EQ(mended.exitCode, 0) << mended.err;
    EXPECT_NE(mended.out.find("repair: filled 1 hole with 1 face\n"), std::string::npos) << mended.out;
    const nlohmann::json json = summary("b");
    EXPECT_EQ(json["organ"]["repair"]["holes_filled"], 1);
    EXPECT_EQ(json["organ"]["repair"]["faces_flipped"], 1);
    ASSERT_EQ(run("a").exitCode, 0);
    EXPECT_FALSE(summary("a")["organ"].contains("repair"));
    const std::string document = readWhole(fs::path(SEROSA_SOURCE_DIR) / "docs" / "cli.md");
    for (const auto& [key, value] : json["organ"]["repair"].items())
        EXPECT_NE(document.find("`" + key + "`"), std::string::npos)
            << "docs/cli.md does not explain " << key;
}

TEST_F(GlRun, BendsByItsPose) {
    folder_.write("bend.toml",
                  "schema = 1\n[[organ]]\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\nnodes = 200\n"
                  "[organ.pose]\nbend_radius = \"100 mm\"\n[output]\nsize = [64, 64]\n");
    const ChildResult result =
        serosa({"run", "bend.toml", "--frames", "2", "--gl", glChoice(), "--out", "bend"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(summary("bend")["solver"], "pose");
    EXPECT_GT(summary("bend")["largest_displacement_m"].get<double>(), 0.002);
}

} // namespace
} // namespace serosa::app
