// What lies under the pointer: the hierarchy's answers against the drawn surface, read back, while an organ
// swings, at another level of detail and after a cut.
#include "app/scene_player.h"
#include "app/tissue_pick.h"
#include "models/phantom.h"
#include "sim/mesh_writer.h"
#include "sim/triangle_tree.h"
#include "tests/app/child.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace serosa::app {
namespace {

const char kScene[] = "schema = 1\nduration = \"1 s\"\n[[organ]]\nname = \"ball\"\nmodel = \"ball.ply\"\n"
                      "length_unit = \"mm\"\nnodes = 900\nlevels = 2\nlevel = [{ t = \"200 ms\", level = 2 "
                      "}]\n[[organ.fixed]]\nshape = \"lowest\"\nshare = 0.3\n[organ.tissue]\nyoung = \"2 "
                      "kPa\"\n[output]\nsize = [64, 48]\n";

std::unique_ptr<RunParts> play(const TestFolder& folder, const std::string& scene) {
    const auto ball = models::makePhantom("ball", 500);
    EXPECT_TRUE(ball && sim::writeMesh(*ball, folder.path() / "ball.ply"));
    folder.write("scene.toml", scene);
    RunOptions options;
    options.scene = folder.path() / "scene.toml";
    if (const char* gl = std::getenv("SEROSA_TEST_GL"))
        options.gl = gpu::parseGlChoice(gl).value();
    auto made = std::make_unique<RunParts>();
    const Status prepared = prepareRun(options, *made);
    EXPECT_TRUE(prepared.ok()) << (prepared.ok() ? "" : prepared.error().message);
    return made;
}

/// Rays from all around. Returns how many met the drawn surface.
int compare(TissuePick& pick, RunParts& parts, const ScenePlayer& player) {
    const OrganParts& organ = *parts.organs[0];
    const std::vector<glm::dvec3> drawn =
        parts.renderer->readDeformedPositions(organ.textures(), parts.surfaceMapping());
    const sim::TriangleTree surface(drawn, organ.surface.metres.faces);
    const double h = organ.lattice.spacing, far = 20 * h;
    int met = 0;
    for (int i = 0; i < 60; ++i) {
        const double y = 1 - (2 * i + 1) / 60.0, turn = 2.4 * i, r = std::sqrt(1 - y * y);
        const glm::dvec3 out(r * std::cos(turn), y, r * std::sin(turn)),
            aside = 0.6 * h * (i % 5) * glm::normalize(glm::dvec3(out.y, -out.x, 0.1));
        const Ray ray{far * out + aside, -out};
        const auto answer = pick.firstHit(0, organ, player.connections(0), ray);
        EXPECT_TRUE(answer.ok());
        const auto exact = surface.firstHit(ray.from, ray.along, 2 * far);
        if (!exact || !answer.ok())
            continue;
        ++met;
        EXPECT_TRUE(answer->has_value()) << "ray " << i;
        if (answer->has_value()) {
            // Off what is drawn by the way that is taken off along the ray, not along the normal.
            EXPECT_LT(std::sqrt(surface.closest(ray.from + **answer * ray.along).distance2), 0.5 * h)
                << "ray " << i;
        }
    }
    const auto miss = pick.firstHit(0, organ, player.connections(0), {{0, far, 0}, {0, 1, 0}});
    EXPECT_TRUE(miss.ok() && !miss->has_value()) << "away from it";
    return met;
}

TEST(GlTissuePick, LiesUpToHalfASpacingFromWhatIsDrawn) {
    const TestFolder folder;
    const auto parts = play(folder, kScene);
    ScenePlayer player(*parts);
    TissuePick pick;
    EXPECT_GT(compare(pick, *parts, player), 40);
    while (player.frame() < 10)
        player.advance();
    EXPECT_GT(compare(pick, *parts, player), 40);
    while (player.frame() < 14)
        player.advance();
    ASSERT_EQ(parts->levels[0].active(), 2);
    EXPECT_GT(compare(pick, *parts, player), 40);
}

// Through the channel that a cut burns the ray goes on.
TEST(GlTissuePick, GoesThroughWhatIsCutAway) {
    const TestFolder folder;
    const auto parts =
        play(folder, std::string(kScene) + "[[cut]]\nkind = \"cauterize\"\nradius = \"20 mm\"\nkeys = [{ t = "
                                           "\"20 ms\", at = [\"0 mm\", \"50 mm\", \"0 mm\"] }]\n");
    ScenePlayer player(*parts);
    TissuePick pick;
    const double far = 0.2;
    const Ray down{{0.001, far, 0.002}, {0, -1, 0}};
    const auto whole = pick.firstHit(0, *parts->organs[0], player.connections(0), down);
    while (player.frame() < 3)
        player.advance();
    ASSERT_FALSE(player.connections(0).empty());
    const auto cut = pick.firstHit(0, *parts->organs[0], player.connections(0), down);
    ASSERT_TRUE(whole.ok() && cut.ok() && whole->has_value());
    EXPECT_TRUE(!cut->has_value() || **cut > **whole + 0.01);
}

} // namespace
} // namespace serosa::app
