// Scenes whose organs touch and are tied, run by the program: what the summary says of them, the same bytes
// after a snapshot, what is refused once lattices are there, and the watchdog over organs that step together.
#include "app/scene_player.h"
#include "models/phantom.h"
#include "sim/mesh_writer.h"
#include "tests/app/child.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace serosa::app {
namespace {

std::string glChoice() {
    const char* gl = std::getenv("SEROSA_TEST_GL");
    return gl ? gl : "auto";
}

const char kSolvers[][12] = {"fragment", "compute", "cpu", "reference"};

/// Two balls of 40 mm, one above the other with a gap of 2 mm, and a third beside them; the high one is
/// pressed down.
std::string balls(const std::string& top, const std::string& more) {
    const std::string ball = "model = \"ball.ply\"\nlength_unit = \"mm\"\n";
    const std::string fixed = "[[organ.fixed]]\nshape = \"lowest\"\nshare = 0.3\n";
    return "schema = 1\nduration = \"400 ms\"\ngravity = [\"0 m/s2\", \"0 m/s2\", \"0 m/s2\"]\n" + top +
           "[[organ]]\nname = \"low\"\n" + ball + "nodes = 250\n" + fixed + "[[organ]]\nname = \"high\"\n" +
           ball + "at = [\"0 mm\", \"82 mm\", \"0 mm\"]\nnodes = 150\n[[organ]]\nname = \"beside\"\n" + ball +
           "at = [\"120 mm\", \"0 mm\", \"0 mm\"]\nnodes = 150\n" + fixed +
           "[[tool]]\nradius = \"30 mm\"\nkeys = [{ t = \"0 s\", at = [\"0 mm\", \"152 mm\", \"0 mm\"] },"
           " { t = \"300 ms\", at = [\"0 mm\", \"140 mm\", \"0 mm\"] }]\n" +
           more + "[output]\nsize = [64, 48]\nframe_every = 12\nsnapshots_at = [\"200 ms\"]\n";
}
std::string thread(const std::string& name, const std::string& more, double x, const std::string& second) {
    const std::string at = std::to_string(x);
    return "[[thread]]\nname = \"" + name + "\"\n" + more + "ends = [{ organ = \"low\", at = [\"" + at +
           " mm\", \"30 mm\", \"0 mm\"] }, " + second + "]\n";
}
const std::string kHigh = "{ organ = \"high\", at = [\"5 mm\", \"60 mm\", \"0 mm\"] }";
const std::string kThreads =
    thread("suture", "length = \"20 mm\"\ntightening = \"100 ms\"\n", 5, kHigh) +
    thread("weak", "t = \"50 ms\"\nlength = \"10 mm\"\ntightening = \"200 ms\"\nstrength = \"50 mN\"\n", -5,
           kHigh);

class GlCoupling : public ::testing::Test {
protected:
    void SetUp() override {
        const auto ball = models::makePhantom("ball", 500);
        ASSERT_TRUE(ball);
        ASSERT_TRUE(sim::writeMesh(*ball, folder_.path() / "ball.ply"));
    }
    ChildResult run(const std::string& out, const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"run", "scene.toml", "--gl", glChoice(), "--out", out, "--force"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runSerosa(folder_.path(), arguments);
    }
    nlohmann::json summary(const std::string& out) const {
        return nlohmann::json::parse(readWhole(folder_.path() / out / "summary.json"), nullptr, false);
    }
    std::string bytes(const std::string& file) const { return readWhole(folder_.path() / file); }
    void expectRefused(const std::string& scene, const std::string& says) {
        folder_.write("scene.toml", scene);
        for (const char* command : {"check", "run"}) {
            const ChildResult result = command == std::string("run")
                                           ? run("out", {})
                                           : runSerosa(folder_.path(), {"scene", "check", "scene.toml"});
            EXPECT_EQ(result.exitCode, 2) << command;
            EXPECT_NE(result.err.find(says), std::string::npos) << command << ": " << result.err;
        }
    }
    TestFolder folder_;
};

TEST_F(GlCoupling, runsSayWhatOrgansGiveEachOtherAndGoOnWithTheSameBytes) {
    const std::string burnt = "[[cut]]\nkind = \"cauterize\"\nradius = \"14 mm\"\nkeys = [{ t = \"100 ms\", "
                              "at = [\"-36 mm\", \"0 mm\", \"0 mm\"] }]\n";
    folder_.write("scene.toml", balls("organs_touch = true\norgan_friction = 0.2\n", kThreads + burnt));
    for (const std::string solver : kSolvers) {
        SCOPED_TRACE(solver);
        const ChildResult whole = run("whole", {"--solver", solver});
        ASSERT_EQ(whole.exitCode, 0) << whole.err << whole.out;
        const nlohmann::json json = summary("whole");
        // All organs of the scene may touch, in one step.
        for (const auto& organ : json["organs"])
            EXPECT_EQ(organ["step"]["time_step_s"], json["organs"][0]["step"]["time_step_s"]);
        EXPECT_GT(json["organs"][0]["cuts"]["springs_cut"], 20);
        ASSERT_EQ(json["contacts"].size(), 3u);
        const nlohmann::json& contact = json["contacts"][0];
        EXPECT_EQ(contact["organs"], nlohmann::json({"low", "high"}));
        EXPECT_GT(contact["largest_pressed_N"], 0.05);
        EXPECT_LT(contact["force"].back()["N"][1], -0.05) << "the low one is pressed down";
        EXPECT_EQ(json["contacts"][1]["largest_pressed_N"], 0) << "nothing reaches the one beside";
        const nlohmann::json& suture = json["threads"][0];
        EXPECT_EQ(suture["broken"], false);
        EXPECT_GT(suture["largest_force_N"], 0.01);
        const nlohmann::json& weak = json["threads"][1];
        EXPECT_EQ(weak["broken"], true);
        EXPECT_GT(weak["broken_t_s"], 0.05);
        EXPECT_LT(weak["broken_t_s"], 0.2);
        EXPECT_GE(weak["largest_force_N"], 0.05);

        const ChildResult rest = run("rest", {"--from", "whole/snapshot_000012.serosa"});
        ASSERT_EQ(rest.exitCode, 0) << rest.err;
        for (const char* file : {"frame_000024.png", "snapshot_000012.serosa"})
            EXPECT_EQ(bytes(std::string("whole/") + file), bytes(std::string("rest/") + file)) << file;
        const nlohmann::json after = summary("rest");
        EXPECT_EQ(json["state_hash"], after["state_hash"]);
        EXPECT_EQ(json["contacts"][0]["force"].back(), after["contacts"][0]["force"].back());
        EXPECT_EQ(weak["broken_t_s"], after["threads"][1]["broken_t_s"]);
        EXPECT_EQ(suture["force_N"], after["threads"][0]["force_N"]);
    }
    folder_.write("scene.toml", balls("organs_touch = true\norgan_friction = 0.3\n", kThreads + burnt));
    const ChildResult other = run("rest", {"--from", "whole/snapshot_000012.serosa"});
    EXPECT_EQ(other.exitCode, 2);
    EXPECT_NE(other.err.find("organ_friction is 0.2 in the snapshot, 0.3 here"), std::string::npos)
        << other.err;
}

TEST_F(GlCoupling, whatIsNotCoupledKeepsItsStep) {
    folder_.write("scene.toml", balls("", kThreads));
    ASSERT_EQ(run("tied", {"--frames", "2"}).exitCode, 0);
    const nlohmann::json tied = summary("tied");
    EXPECT_EQ(tied["organs"][0]["step"]["time_step_s"], tied["organs"][1]["step"]["time_step_s"]);
    EXPECT_FALSE(tied.contains("contacts"));
    folder_.write("scene.toml", balls("", ""));
    ASSERT_EQ(run("free", {"--frames", "2"}).exitCode, 0);
    EXPECT_EQ(tied["organs"][2]["state_hash"], summary("free")["organs"][2]["state_hash"]);
    EXPECT_FALSE(summary("free").contains("threads"));
}

TEST_F(GlCoupling, threadsAreDrawnUntilTheyBreak) {
    folder_.write("scene.toml", balls("", kThreads));
    RunOptions options;
    options.scene = folder_.path() / "scene.toml";
    options.solver = "cpu";
    options.gl = gpu::parseGlChoice(glChoice()).value();
    RunParts parts;
    ASSERT_TRUE(prepareRun(options, parts).ok());
    ScenePlayer player(parts);
    const auto drawn = [&] { return drawnThreads(parts, player.threads(), player.time()); };
    ASSERT_EQ(drawn().size(), 1u) << "the other is tied later";
    EXPECT_EQ(drawn()[0].ends[0].organ, 0u);
    EXPECT_EQ(drawn()[0].ends[1].organ, 1u);
    while (player.frame() < 4)
        player.advance();
    ASSERT_FALSE(player.threads()[1].broken);
    EXPECT_EQ(drawn().size(), 2u);
    while (player.frame() < 24)
        player.advance();
    ASSERT_TRUE(player.threads()[1].broken);
    EXPECT_EQ(drawn().size(), 1u);
    player.reset();
    EXPECT_FALSE(player.threads()[1].broken);
}

TEST_F(GlCoupling, endsThatReachNothingAreRefused) {
    const std::string far = "{ organ = \"high\", at = [\"0 mm\", \"200 mm\", \"0 mm\"] }",
                      fixed = "{ organ = \"low\", at = [\"0 mm\", \"-38 mm\", \"0 mm\"] }";
    expectRefused(balls("", thread("suture", "", 5, far)),
                  "an end of suture reaches no node of high: it lies ");
    std::string both = thread("suture", "", 5, fixed);
    both.replace(both.find("30 mm"), 5, "-36 mm");
    expectRefused(balls("", both), "suture has no effect: both its ends are tied to fixed nodes");
}

class GlCoupledWatchdog : public GlCoupling, public ::testing::WithParamInterface<const char*> {};

TEST_P(GlCoupledWatchdog, stopsTheGroupAndNoOther) {
    folder_.write("scene.toml", balls("", kThreads)); // the third is tied to nothing
    RunOptions options;
    options.scene = folder_.path() / "scene.toml";
    options.solver = GetParam();
    options.gl = gpu::parseGlChoice(glChoice()).value();
    RunParts parts;
    const Status prepared = prepareRun(options, parts);
    ASSERT_TRUE(prepared.ok()) << prepared.error().message;
    ScenePlayer player(parts);
    const auto play = [&](int frames) {
        while (player.frame() < frames)
            player.advance();
    };
    play(12);
    const std::string good[] = {player.state(0).hash(), player.state(1).hash()};
    play(14);
    const std::string later = player.state(1).hash(), beside = player.state(2).hash();
    player.reset();
    play(12);
    ASSERT_EQ(player.state(0).hash(), good[0]) << "again from rest";
    sim::LatticeState bad = player.state(0);
    bad.positions[5].x = std::numeric_limits<double>::quiet_NaN();
    parts.organs[0]->solver->setState(bad);
    player.check();
    ASSERT_TRUE(player.alarm(0));
    EXPECT_FALSE(player.alarm(1));
    EXPECT_EQ(player.alarm(0)->node, 5u);
    EXPECT_EQ(player.alarmLines().size(), 1u);
    EXPECT_EQ(player.state(0).hash(), good[0]) << "retraced to the last good one";
    EXPECT_EQ(player.state(1).hash(), good[1]) << "and what is tied to it";
    play(14);
    EXPECT_EQ(player.state(1).hash(), good[1]) << "frozen with it";
    EXPECT_EQ(player.state(2).hash(), beside) << "the other goes on as ever";
    player.reset();
    EXPECT_FALSE(player.alarm(0));
    play(14);
    EXPECT_EQ(player.state(1).hash(), later);
    // More energy than all of them together can have.
    sim::LatticeState wild = player.state(1);
    wild.increments[3] += glm::dvec3(20, 0, 0);
    parts.organs[1]->solver->setState(wild);
    player.check();
    ASSERT_TRUE(player.alarm(1));
    EXPECT_EQ(player.alarm(1)->kind, sim::AlarmKind::energy);
    EXPECT_EQ(player.alarm(1)->node, 3u);
}

INSTANTIATE_TEST_SUITE_P(Solvers, GlCoupledWatchdog,
                         ::testing::Values("fragment", "compute", "cpu", "reference"));

} // namespace
} // namespace serosa::app
