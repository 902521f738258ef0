// The picture of a deformed surface against an independent path: rays through the mesh that was read back,
// with the same plain light.
#include "render/mapping_measures.h"
#include "render/surface_renderer.h"
#include "sim/triangle_tree.h"
#include "tests/gl_fixture.h"
#include "tests/render/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace serosa::render {
namespace {

constexpr int kSize = 384;    // pixels
constexpr int kSubpixels = 4; // along each axis

double linearOf(double srgb) {
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}
double srgbOf(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

struct Traced {
    const sim::TriangleTree& tree;
    std::vector<glm::dvec3> normals, colours; // of the vertices; linear
    const View& view;

    /// Linear colour along a ray; false: it meets nothing.
    bool colourAt(const glm::dvec2& ndc, glm::dvec3& colour) const {
        const glm::dmat4 worldFromClip =
            glm::inverse(view.camera.clipFromCamera * view.camera.cameraFromWorld);
        const auto at = [&](double depth) {
            const glm::dvec4 p = worldFromClip * glm::dvec4(ndc, depth, 1);
            return glm::dvec3(p) / p.w;
        };
        const glm::dvec3 from = at(-1), to = at(1), direction = glm::normalize(to - from);
        const auto hit = tree.firstHit(from, direction, glm::distance(from, to));
        if (!hit)
            return false;
        const glm::uvec3 face = tree.triangles()[hit->triangle];
        glm::dvec3 n(0), albedo(0);
        for (int i = 0; i < 3; ++i) {
            n += hit->weights[i] * normals[face[i]];
            albedo += hit->weights[i] * colours[face[i]];
        }
        n = glm::normalize(n);
        if (const double away = glm::dot(n, -direction); away < 0.02)
            n = glm::normalize(n + (0.02 - away) * -direction);
        const double lit = std::max(glm::dot(n, glm::normalize(-view.light.direction)), 0.0);
        colour = albedo * (0.25 * view.light.ambient + 0.75 * view.light.intensity * lit);
        return true;
    }
};

class GlRayTraced : public test::GlTest, public ::testing::WithParamInterface<sim::Mapping> {};

TEST_P(GlRayTraced, PictureIsTheOneThatRaysGive) {
    constexpr double kSpacing = 0.004, kRadius = 7.3 * kSpacing; // m
    const sim::Lattice lattice = test::ballLattice(kRadius / kSpacing, kSpacing, {0.3, -0.2, 0.7});
    const glm::dvec3 middle = lattice.toWorld(glm::dvec3(8 - lattice.centre));
    sim::TriangleMesh mesh = test::ballMesh(24, kRadius, middle);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::dvec3 p = (mesh.positions[v] - middle) / kRadius;
        mesh.colours.emplace_back(120 + 100 * std::sin(5 * p.x), 90 + 70 * std::cos(7 * p.y), 60 + 50 * p.z);
        mesh.positions[v] = middle + kRadius * (1 - 0.05 * std::sin(9 * p.x) * std::sin(8 * p.y)) * p;
    }
    const SurfaceBinding binding = bindSurface(lattice, mesh, GetParam());
    auto state = sim::StateTextures::create(lattice, {});
    ASSERT_TRUE(state.ok());
    auto renderer = SurfaceRenderer::create(lattice, mesh, binding, *state, kSize, kSize);
    ASSERT_TRUE(renderer.ok()) << renderer.error().message;
    const glm::dvec3 c = lattice.toLattice(middle);
    state->upload(deformedState(lattice, [&](const glm::dvec3& q) { // bent, twisted and pressed
        const glm::dvec3 p = q - c;
        const double turn = 0.06 * p.y;
        return c + glm::dvec3(1.2 * p.x * std::cos(turn) - p.z * std::sin(turn) + 0.03 * p.y * p.y, 0.8 * p.y,
                              p.z * std::cos(turn) + p.x * std::sin(turn));
    }));
    View view;
    sim::Camera camera;
    camera.direction = {-0.4, -0.3, -1};
    view.camera = makeCamera(camera, mesh.lowest(), mesh.highest(), 1);
    view.look.colour = sim::SurfaceColour::plain;
    view.look.mapping = GetParam();
    view.look.surface = false;
    renderer->draw(*state, view);
    const Image empty = renderer->readImage();
    view.look.surface = true;
    renderer->draw(*state, view);
    const Image drawn = renderer->readImage();

    const sim::TriangleTree tree(renderer->readDeformedPositions(*state, GetParam()), mesh.faces);
    Traced traced{tree, renderer->readDeformedNormals(*state, GetParam()), {}, view};
    for (glm::dvec3& n : traced.normals)
        n = glm::normalize(n);
    for (const glm::u8vec3& colour : mesh.colours)
        traced.colours.emplace_back(linearOf(colour.r / 255.0), linearOf(colour.g / 255.0),
                                    linearOf(colour.b / 255.0));
    int off = 0, covered = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const std::size_t at = 3 * (std::size_t(y) * kSize + std::size_t(x));
            glm::dvec3 sum(0);
            int hits = 0;
            for (int s = 0; s < kSubpixels * kSubpixels; ++s) {
                const double px = x + (s % kSubpixels + 0.5) / kSubpixels,
                             py = y + (s / kSubpixels + 0.5) / kSubpixels;
                glm::dvec3 colour(0);
                if (traced.colourAt({2 * px / kSize - 1, 1 - 2 * py / kSize}, colour)) {
                    sum += colour;
                    ++hits;
                } else {
                    for (int i = 0; i < 3; ++i)
                        sum[i] += linearOf(empty.rgb[at + std::size_t(i)] / 255.0);
                }
            }
            covered += hits > 0;
            int largest = 0;
            for (int i = 0; i < 3; ++i) {
                const auto value =
                    int(std::lround(255 * srgbOf(std::clamp(sum[i] / (kSubpixels * kSubpixels), 0.0, 1.0))));
                largest = std::max(largest, std::abs(value - int(drawn.rgb[at + std::size_t(i)])));
            }
            off += largest > 8;
        }
    EXPECT_GT(covered, kSize * kSize / 5);
    EXPECT_LE(off, kSize * kSize / 100) << "pixels off by more than 8/255, of " << kSize * kSize;
    RecordProperty("pixels_off", off);
}

INSTANTIATE_TEST_SUITE_P(Mappings, GlRayTraced,
                         ::testing::Values(sim::Mapping::triangle, sim::Mapping::curvature));

} // namespace
} // namespace serosa::render
