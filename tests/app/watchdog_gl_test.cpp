// The watchdog in a run: an organ that goes wrong is set back and frozen, with node and reason, and the
// others take the same bytes as without it. All four solvers.
#include "app/scene_player.h"
#include "app/solver_choice.h"
#include "models/phantom.h"
#include "sim/mesh_writer.h"
#include "tests/app/child.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace serosa::app {
namespace {

class GlWatchdog : public ::testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        const auto ball = models::makePhantom("ball", 500);
        ASSERT_TRUE(ball);
        ASSERT_TRUE(sim::writeMesh(*ball, folder_.path() / "ball.ply"));
        const std::string organ = "[[organ]]\nname = \"NAME\"\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\n"
                                  "nodes = 200\n[[organ.fixed]]\nshape = \"lowest\"\nshare = 0.3\n";
        const auto named = [&](const char* name) {
            std::string text = organ;
            return text.replace(text.find("NAME"), 4, name);
        };
        folder_.write("two.toml",
                      "schema = 1\n" + named("first") + "[organ.tissue]\ndamping_time = \"0 ms\"\n" +
                          named("second") +
                          "[[tool]]\nradius = \"30 mm\"\nkeys = [{ t = \"0 s\", at = [\"0 mm\", \"72 mm\", "
                          "\"0 mm\"] }, { t = \"100 ms\", at = [\"0 mm\", \"62 mm\", \"0 mm\"] }]\n"
                          "[output]\nsize = [64, 48]\n");
        options_.scene = folder_.path() / "two.toml";
        options_.solver = GetParam();
        if (const char* gl = std::getenv("SEROSA_TEST_GL"))
            options_.gl = gpu::parseGlChoice(gl).value();
        const Status prepared = prepareRun(options_, parts_);
        ASSERT_TRUE(prepared.ok()) << prepared.error().message;
    }

    static void play(ScenePlayer& player, int frames) {
        while (player.frame() < frames)
            player.advance();
    }

    TestFolder folder_;
    RunOptions options_;
    RunParts parts_;
};

TEST_P(GlWatchdog, FreezesOneOrganAndTheOtherLivesOn) {
    ScenePlayer player(parts_);
    play(player, 12);
    const sim::LatticeState good = player.state(0);
    play(player, 25);
    const std::string unharmed[] = {player.state(0).hash(), player.state(1).hash()};

    player.reset();
    play(player, 12);
    ASSERT_EQ(player.state(0).hash(), good.hash());
    sim::LatticeState bad = good;
    bad.positions[5].x = std::numeric_limits<double>::quiet_NaN();
    parts_.organs[0]->solver->setState(bad);
    player.check();
    const auto alarm = player.alarm(0);
    ASSERT_TRUE(alarm);
    EXPECT_FALSE(player.alarm(1));
    EXPECT_EQ(alarm->kind, sim::AlarmKind::notFinite);
    EXPECT_EQ(alarm->node, 5u);
    EXPECT_NEAR(alarm->time, 12 / 60.0, 1e-9);
    EXPECT_LT(glm::distance(alarm->position, parts_.organs[0]->lattice.toWorld(good.positions[5])), 1e-12);
    EXPECT_EQ(player.state(0).hash(), good.hash()) << "as it was last good";
    ASSERT_EQ(player.alarmLines().size(), 1u);
    EXPECT_EQ(player.alarmLines()[0].rfind("first: node 5 at (", 0), 0u) << player.alarmLines()[0];
    play(player, 25);
    EXPECT_EQ(player.state(0).hash(), good.hash()) << "frozen";
    EXPECT_EQ(player.state(1).hash(), unharmed[1]);

    player.reset();
    EXPECT_TRUE(player.alarmLines().empty());
    play(player, 25);
    EXPECT_EQ(player.state(0).hash(), unharmed[0]);
}

TEST_P(GlWatchdog, GoesBackToTheStepBeforeABlowUp) {
    OrganParts& organ = *parts_.organs[0];
    organ.setup.timeStep = 1.1 * organ.step.bound;
    auto solver = makeSolver(GetParam(), organ.setup);
    ASSERT_TRUE(solver);
    organ.solver = std::move(*solver);
    ScenePlayer player(parts_);
    play(player, 60);
    const auto alarm = player.alarm(0);
    ASSERT_TRUE(alarm);
    EXPECT_FALSE(player.alarm(1));
    EXPECT_NE(alarm->kind, sim::AlarmKind::notFinite);
    EXPECT_GT(alarm->measured, alarm->allowed);
    const sim::LatticeState last = player.state(0);
    EXPECT_EQ(last.step, alarm->step - 1);
    for (std::size_t node = 0; node < last.positions.size(); ++node)
        EXPECT_LT(glm::distance(last.positions[node], organ.lattice.restPosition(node)), 3) << node;
}

INSTANTIATE_TEST_SUITE_P(Solvers, GlWatchdog, ::testing::Values("fragment", "compute", "cpu", "reference"));

} // namespace
} // namespace serosa::app
