// A surface on nodes that are no lattice's, through the vertex stage.
#include "render/surface_measures.h"
#include "render/surface_renderer.h"
#include "tests/gl_fixture.h"
#include "tests/render/shapes.h"

#include <algorithm>
#include <cmath>

namespace serosa::render {
namespace {

class GlControlNodes : public test::GlTest {};

TEST_F(GlControlNodes, AreFollowedAsByTheTwinAndDrawn) {
    const sim::TriangleMesh coarse = test::ballMesh(4, 0.04, {0.1, 1.2, -0.3}),
                            fine = test::ballMesh(20, 0.041, {0.1, 1.2, -0.3});
    const ControlNodes nodes = controlNodes(coarse);
    std::vector<glm::dvec3> moved; // twisted and stretched
    for (const glm::dvec3& p : nodes.rest) {
        const double angle = 0.4 * p.y;
        moved.emplace_back(glm::vec3(std::cos(angle) * p.x - std::sin(angle) * p.z, 1.3 * p.y,
                                     std::sin(angle) * p.x + std::cos(angle) * p.z));
    }
    sim::LatticeState state;
    state.positions = moved;
    state.increments.resize(moved.size(), glm::dvec3(0));
    state.normals = packedNormals(nodes, moved);
    state.heldBy.resize(moved.size());
    auto textures = sim::StateTextures::create(standInLattice(nodes), {});
    ASSERT_TRUE(textures.ok());
    textures.value().upload(state);
    for (const sim::Mapping mapping : {sim::Mapping::triangle, sim::Mapping::curvature, sim::Mapping::chosen,
                                       sim::Mapping::normalOffset, sim::Mapping::nodeFrames}) {
        SCOPED_TRACE(int(mapping));
        const SurfaceBinding binding = bindSurface(nodes, fine, mapping);
        auto renderer = SurfaceRenderer::create(nodes, fine, binding, textures.value(), 64, 64);
        ASSERT_TRUE(renderer.ok()) << renderer.error().message;
        EXPECT_TRUE(renderer.value().draws(mapping));
        const auto drawn = renderer.value().readDeformedPositions(textures.value(), mapping);
        const auto twin = mapSurface(binding, moved, state.normals);
        double apart = 0, away = 0;
        for (std::size_t v = 0; v < twin.size(); ++v) {
            apart = std::max(apart, glm::distance(nodes.toNodes(drawn[v]), twin[v]));
            away = std::max(away, glm::distance(drawn[v], fine.positions[v]));
        }
        EXPECT_LE(apart, 1e-5);
        EXPECT_GT(away, 0.005); // m: it moved
        View view;
        view.camera = makeCamera({}, fine.lowest(), fine.highest(), 1);
        view.look.mapping = mapping;
        renderer.value().draw(textures.value(), view);
        const Image image = renderer.value().readImage();
        const std::uint8_t* middle = &image.rgb[std::size_t(32 * 64 + 32) * 3];
        EXPECT_GT(middle[0], middle[2] + 30) << "no flesh in the middle";
    }
}

} // namespace
} // namespace serosa::render
