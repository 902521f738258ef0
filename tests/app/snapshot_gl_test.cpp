// `serosa run --from`: what follows a snapshot is the same bytes as without a stop, whatever the solver; and
// each snapshot that does not belong is refused in one line.

#include "sim/snapshot.h"
#include "tests/app/child.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace serosa::app {
namespace {

namespace fs = std::filesystem;

std::string glChoice() {
    const char* gl = std::getenv("SEROSA_TEST_GL");
    return gl ? gl : "auto";
}

/// A ball that is pressed, held, burnt at the second frame, cut from the third to the sixth by a blade, which
/// is the second of its cuts, and torn.
const char kBall[] =
    "[[organ]]\nname = \"ball\"\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\nnodes = 200\ntear_strain = 0.6\n"
    "[[organ.fixed]]\nshape = \"lowest\"\nshare = 0.3\n";
const char kTools[] =
    "[[tool]]\nradius = \"30 mm\"\nkeys = [{ t = \"0 s\", at = [\"0 mm\", \"72 mm\", \"0 mm\"] },"
    " { t = \"100 ms\", at = [\"0 mm\", \"55 mm\", \"0 mm\"] }]\n"
    "[[tool]]\nradius = \"30 mm\"\nmode = \"grasp\"\nkeys = [{ t = \"20 ms\", at = [\"40 mm\", \"0 mm\", \"0 "
    "mm\"] }, { t = \"130 ms\", at = [\"60 mm\", \"0 mm\", \"0 mm\"] }]\n";
const char kRest[] =
    "[[cut]]\nkind = \"cauterize\"\nradius = \"10 mm\"\nkeys = [{ t = \"25 ms\", at = [\"-40 mm\", \"5 mm\", "
    "\"0 mm\"] }]\n"
    "[[cut]]\nkeys = [{ t = \"40 ms\", at = [\"-60 mm\", \"21 mm\", \"-60 mm\"], end = [\"-60 mm\", \"21 "
    "mm\", \"60 mm\"] }, { t = \"95 ms\", at = [\"20 mm\", \"18 mm\", \"-60 mm\"], end = [\"20 mm\", \"18 "
    "mm\", \"60 mm\"] }]\n"
    "[output]\nsize = [64, 48]\nsurfaces_at = [\"50 ms\", \"100 ms\"]\nsnapshots_at = [\"67 ms\"]\n"
    "displacements_at = [\"67 ms\", \"133 ms\"]\n";
const char kSnapshot[] = "whole/snapshot_000004.serosa";

class GlSnapshotRun : public ::testing::Test {
protected:
    void SetUp() override {
        folder_.write("ball.toml",
                      std::string("schema = 1\nduration = \"134 ms\"\n") + kBall + kTools + kRest);
        const ChildResult made = serosa({"phantom", "ball", "--faces", "500", "-o", "ball.ply"});
        ASSERT_EQ(made.exitCode, 0) << made.err;
    }
    ChildResult serosa(const std::vector<std::string>& arguments) const {
        return runSerosa(folder_.path(), arguments);
    }
    ChildResult run(const std::string& out, const std::vector<std::string>& more = {},
                    const std::string& scene = "ball.toml") const {
        std::vector<std::string> arguments{"run", scene, "--gl", glChoice(), "--out", out};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return serosa(arguments);
    }
    nlohmann::json summary(const std::string& out) const {
        return nlohmann::json::parse(readWhole(folder_.path() / out / "summary.json"), nullptr, false);
    }
    std::string bytes(const std::string& file) const { return readWhole(folder_.path() / file); }
    /// Pictures, surfaces, displacements and the state after the fourth frame.
    void expectSameFrom(const std::string& whole, const std::string& rest) const {
        for (const char* file :
             {"frame_000005.png", "frame_000006.png", "frame_000007.png", "frame_000008.png",
              "surface_000006.ply", "displacement_000004.nrrd", "displacement_000008.nrrd",
              "displacement_000008.ply", "displacement_mask.nrrd", "snapshot_000004.serosa"}) {
            EXPECT_NE(bytes(whole + "/" + file), "") << file;
            EXPECT_EQ(bytes(whole + "/" + file), bytes(rest + "/" + file)) << file;
        }
        EXPECT_FALSE(fs::exists(folder_.path() / rest / "frame_000004.png"));
        EXPECT_FALSE(fs::exists(folder_.path() / rest / "surface_000003.ply"));
        const nlohmann::json a = summary(whole), b = summary(rest);
        EXPECT_EQ(a["state_hash"], b["state_hash"]);
        EXPECT_EQ(a["cuts"], b["cuts"]);
        EXPECT_EQ(a["solver"], b["solver"]);
        EXPECT_EQ(a["energies"].back(), b["energies"].back());
        for (std::size_t tool = 0; tool < 2; ++tool) { // frames 5 to 8
            ASSERT_EQ(b["tools"][tool]["force"].size(), 4u);
            for (std::size_t i = 0; i < 4; ++i)
                EXPECT_EQ(a["tools"][tool]["force"][i + 4], b["tools"][tool]["force"][i]);
        }
    }
    TestFolder folder_;
};

TEST_F(GlSnapshotRun, goesOnWithTheSameBytes) {
    for (const std::string solver : {"fragment", "compute", "cpu", "reference"}) {
        const ChildResult whole = run("whole", {"--force", "--solver", solver});
        ASSERT_EQ(whole.exitCode, 0) << whole.err;
        EXPECT_NE(whole.out.find("1 snapshots, 2 displacements"), std::string::npos) << whole.out;
        const nlohmann::json json = summary("whole");
        EXPECT_EQ(json["snapshots"], 1);
        EXPECT_EQ(json["displacements"], 2);
        EXPECT_GT(json["cuts"]["springs_cut"].get<int>(), 20);
        // Without --solver: that of the snapshot.
        const ChildResult rest = run("rest", {"--force", "--from", kSnapshot});
        ASSERT_EQ(rest.exitCode, 0) << rest.err;
        EXPECT_NE(rest.out.find("goes on from whole/snapshot_000004.serosa, frame 4, 0.06667 s\n"),
                  std::string::npos)
            << rest.out;
        EXPECT_EQ(rest.out.find("note: the"), std::string::npos) << rest.out;
        expectSameFrom("whole", "rest");
        const nlohmann::json from = summary("rest")["from"];
        EXPECT_EQ(from["snapshot"], "snapshot_000004.serosa");
        EXPECT_EQ(from["frame"], 4);
        EXPECT_EQ(from["solver"], solver);
        EXPECT_EQ(summary("rest")["frames"], 8);
    }
}

TEST_F(GlSnapshotRun, goesOnWithImplicitSteps) {
    folder_.write("stiff.toml", std::string("schema = 1\nduration = \"134 ms\"\n") + kBall +
                                    "[organ.tissue]\nyoung = \"1 MPa\"\n" + kRest);
    std::string text = bytes("stiff.toml");
    text.replace(text.find("nodes = 200"), 11, "nodes = 200\nmethod = \"implicit\"");
    folder_.write("stiff.toml", text);
    for (const std::string solver : {"fragment", "compute", "cpu", "reference"}) {
        const ChildResult whole = run("whole", {"--force", "--solver", solver}, "stiff.toml");
        ASSERT_EQ(whole.exitCode, 0) << whole.err;
        const ChildResult rest = run("rest", {"--force", "--from", kSnapshot}, "stiff.toml");
        ASSERT_EQ(rest.exitCode, 0) << rest.err;
        for (const char* file : {"frame_000005.png", "frame_000008.png", "displacement_000008.nrrd"}) {
            EXPECT_NE(bytes(std::string("whole/") + file), "") << file;
            EXPECT_EQ(bytes(std::string("whole/") + file), bytes(std::string("rest/") + file)) << file;
        }
        const nlohmann::json a = summary("whole"), b = summary("rest");
        EXPECT_EQ(a["state_hash"], b["state_hash"]);
        EXPECT_EQ(b["step"]["method"], "implicit");
        EXPECT_EQ(b["step"]["steps_per_frame"], 1);
        EXPECT_GT(b["cuts"]["springs_cut"].get<int>(), 20);
        EXPECT_GT(b["largest_displacement_m"].get<double>(), 0);
    }
    // The same scene with explicit steps is another.
    text.replace(text.find("\"implicit\""), 10, "\"explicit\"");
    folder_.write("other.toml", text);
    const ChildResult other = run("other", {"--from", kSnapshot}, "other.toml");
    EXPECT_EQ(other.exitCode, 2);
    EXPECT_NE(other.err.find("time step is 0.016"), std::string::npos) << other.err;
}

TEST_F(GlSnapshotRun, goesOnWithSeveralOrgansAndPoses) {
    const std::string pose =
        "[[organ]]\nname = \"bent\"\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\nnodes = "
        "100\n[organ.pose]\nbend_radius = \"150 mm\"\n";
    folder_.write("two.toml",
                  std::string("schema = 1\nduration = \"134 ms\"\n") + kBall + pose + kTools + kRest);
    ASSERT_EQ(run("whole", {}, "two.toml").exitCode, 0);
    const ChildResult rest = run("rest", {"--from", kSnapshot}, "two.toml");
    ASSERT_EQ(rest.exitCode, 0) << rest.err;
    for (const char* file : {"frame_000005.png", "frame_000008.png", "displacement_ball_000008.nrrd",
                             "displacement_bent_000008.ply", "displacement_bent_mask.nrrd"}) {
        EXPECT_NE(bytes(std::string("whole/") + file), "") << file;
        EXPECT_EQ(bytes(std::string("whole/") + file), bytes(std::string("rest/") + file)) << file;
    }
    EXPECT_EQ(summary("whole")["state_hash"], summary("rest")["state_hash"]);
}

TEST_F(GlSnapshotRun, isInspected) {
    ASSERT_EQ(run("whole").exitCode, 0);
    const ChildResult said = serosa({"inspect", kSnapshot});
    ASSERT_EQ(said.exitCode, 0) << said.err;
    for (const char* text : {"frame               4, 0.06667 s at 60 Hz", "of fragment, ", "young", "5000 Pa",
                             "tool 2 mode", "state hash"})
        EXPECT_NE(said.out.find(text), std::string::npos) << text << " is not in\n" << said.out;
    const ChildResult bad = serosa({"inspect", kSnapshot, "--nodes", "300"});
    EXPECT_EQ(bad.exitCode, 2);
}

TEST_F(GlSnapshotRun, refusesWhatDoesNotBelong) {
    ASSERT_EQ(run("whole").exitCode, 0);
    const std::string good = bytes(kSnapshot);
    const auto write = [this](const std::string& name, std::string content) { folder_.write(name, content); };
    std::string flipped = good;
    flipped[good.size() / 2] = char(flipped[good.size() / 2] ^ 4);
    write("flipped.serosa", flipped);
    write("short.serosa", good.substr(0, good.size() / 3));
    auto other = sim::parseSnapshot(good, "good");
    ASSERT_TRUE(other);
    other->program = "9.9.9";
    write("newer.serosa", sim::snapshotBytes(*other));
    const std::string scene = bytes("ball.toml");
    const auto changed = [&](const std::string& name, const std::string& from, const std::string& to) {
        std::string text = scene;
        ASSERT_NE(text.find(from), std::string::npos) << from;
        write(name, text.replace(text.find(from), from.size(), to));
    };
    changed("soft.toml", "tear_strain = 0.6\n", "tear_strain = 0.6\n[organ.tissue]\nyoung = \"4 kPa\"\n");
    changed("named.toml", "\"ball\"", "\"liver\"");
    changed("cut.toml", "18 mm", "19 mm");
    changed("tear.toml", "0.6", "0.5");
    changed("clock.toml", "schema = 1\n", "schema = 1\nframe_rate = \"50 Hz\"\n");
    changed("gravity.toml", "schema = 1\n", "schema = 1\ngravity = [\"0 m/s2\", \"-9 m/s2\", \"0 m/s2\"]\n");
    changed("tool.toml", "72 mm", "73 mm");
    const auto before = folder_.names();

    struct Bad {
        std::string scene, snapshot, says;
        std::vector<std::string> more = {};
    };
    const Bad bads[] = {
        {"ball.toml", "no.serosa", "no such file"},
        {"ball.toml", "ball.ply", "is not a snapshot"},
        {"ball.toml", "flipped.serosa", "is damaged: its checksum"},
        {"ball.toml", "short.serosa",
         "is cut off: it ends at byte " + std::to_string(good.size() / 3) + " of " +
             std::to_string(good.size())},
        {"ball.toml", "newer.serosa", "was written by serosa 9.9.9, this is"},
        {"soft.toml", kSnapshot, "another scene: ball: young is 5000 Pa in the snapshot, 4000 Pa here"},
        {"named.toml", kSnapshot, "another scene: the organ is \"ball\" in the snapshot, \"liver\" here"},
        {"cut.toml", kSnapshot, "another scene: ball: cuts is 2 ("},
        {"tear.toml", kSnapshot, "tear_strain is 0.6 in the snapshot, 0.5 here"},
        {"clock.toml", kSnapshot, "frame_rate is 60 Hz in the snapshot, 50 Hz here"},
        {"gravity.toml", kSnapshot, "gravity is 0 -9.81 0 m/s2"},
        {"tool.toml", kSnapshot, "tool 1 keys is 2 ("},
        {"ball.toml", kSnapshot, "lattice spacing is ", {"--nodes", "300"}},
        {"ball.toml", kSnapshot, "is of frame 4, and the run ends at frame 4", {"--frames", "4"}},
        {"ball.toml",
         kSnapshot,
         "another solver: ball was stepped by fragment, here by cpu",
         {"--solver", "cpu"}},
        {"ball.toml", kSnapshot, "--any-solver belongs to --from with --solver", {"--any-solver"}},
    };
    for (const Bad& bad : bads) {
        std::vector<std::string> more{"--from", bad.snapshot};
        more.insert(more.end(), bad.more.begin(), bad.more.end());
        const ChildResult result = run("out", more, bad.scene);
        EXPECT_EQ(result.exitCode, 2) << bad.says << result.out << result.err;
        EXPECT_EQ(result.errorLines(), 1u) << result.err;
        EXPECT_NE(result.err.find(bad.says), std::string::npos) << bad.says << " / " << result.err;
        EXPECT_EQ(folder_.names(), before);
    }
    // The folder that --force empties is not the one that the snapshot lies in.
    const ChildResult own = run("whole", {"--force", "--from", kSnapshot});
    EXPECT_EQ(own.exitCode, 2);
    EXPECT_NE(own.err.find("lies in the output folder"), std::string::npos) << own.err;
    EXPECT_EQ(bytes(kSnapshot), good);
    // Asked for, another solver goes on, and says so.
    const ChildResult any = run("any", {"--from", kSnapshot, "--solver", "reference", "--any-solver"});
    EXPECT_EQ(any.exitCode, 0) << any.err;
    EXPECT_NE(any.out.find("note: fragment made the snapshot, reference goes on"), std::string::npos)
        << any.out;
    EXPECT_NE(summary("any")["state_hash"], summary("whole")["state_hash"]);
}

} // namespace
} // namespace serosa::app
