// MS05 3.3 on the CPU, in double: what must hold whatever the lattice.
#include "render/mapping_measures.h"
#include "render/surface_binding.h"
#include "render/triangle_choice.h"
#include "sim/solver.h"
#include "sim/triangle_tree.h"
#include "tests/render/shapes.h"

#include <gtest/gtest.h>

namespace serosa::render {
namespace {

const glm::dvec3 kOrigin(0.1, 1.6, -0.4); // m
constexpr double kSpacing = 0.004;        // m

struct Bound {
    sim::Lattice lattice;
    sim::TriangleMesh mesh;
    SurfaceBinding binding;
};

Bound ball(sim::Mapping mapping) {
    Bound bound{test::ballLattice(6.3, kSpacing, kOrigin), {}, {}};
    const glm::dvec3 centre = bound.lattice.toWorld(glm::dvec3(7) - glm::dvec3(bound.lattice.centre));
    bound.mesh = test::ballMesh(30, 6.3 * kSpacing, centre);
    bound.binding = bindSurface(bound.lattice, bound.mesh, mapping);
    return bound;
}

double largestDistance(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, glm::distance(a[i], b[i]));
    return largest;
}

std::vector<glm::dvec3> restOf(const Bound& bound) {
    std::vector<glm::dvec3> rest;
    for (const glm::dvec3& p : bound.mesh.positions)
        rest.push_back(bound.lattice.toLattice(p));
    return rest;
}

TEST(SurfaceBinding, RestReturnsWithinFloatRounding) {
    for (const auto mapping : {sim::Mapping::triangle, sim::Mapping::curvature}) {
        const Bound bound = ball(mapping);
        const sim::LatticeState rest = sim::restState(bound.lattice);
        EXPECT_LE(largestDistance(mapSurface(bound.binding, rest.positions, rest.normals), restOf(bound)),
                  3e-7);
    }
}

TEST(SurfaceBinding, WeightsAreOfTheClosestKindAndSumToOne) {
    const Bound bound = ball(sim::Mapping::curvature);
    ASSERT_EQ(bound.binding.vertices.size(), bound.mesh.positions.size());
    ASSERT_EQ(bound.binding.triangles.size(), bound.mesh.positions.size());
    for (std::size_t v = 0; v < bound.binding.vertices.size(); ++v) {
        const VertexBinding& vertex = bound.binding.vertices[v];
        const glm::uvec3& triangle = bound.lattice.boundary[bound.binding.triangles[v]];
        const int first = diagonalStart(controlNodes(bound.lattice), triangle);
        EXPECT_EQ(vertex.nodes,
                  glm::uvec3(triangle[first], triangle[(first + 1) % 3], triangle[(first + 2) % 3]));
        EXPECT_NEAR(glm::distance(bound.lattice.restPosition(vertex.nodes.x),
                                  bound.lattice.restPosition(vertex.nodes.y)),
                    std::sqrt(2), 1e-12);
        EXPECT_NEAR(vertex.weights.x + vertex.weights.y + vertex.weights.z, 1, 1e-6);
        EXPECT_GE(std::min({vertex.weights.x, vertex.weights.y, vertex.weights.z}), -2e-5);
        EXPECT_LE(glm::length(vertex.offset), 2.0); // the ball touches every cell under its boundary
        EXPECT_NEAR(glm::length(vertex.normal), 1, 1e-6);
    }
}

TEST(SurfaceBinding, StraightUpOffsetFollowsTheNormalByHand) {
    // One cell; a vertex over the middle of a top triangle's edge. Turn the lattice by a quarter about x: y
    // becomes z.
    const sim::Lattice lattice = test::boxLattice(2, 1, 2, 1.0, glm::dvec3(0));
    sim::TriangleMesh mesh;
    const glm::dvec3 top = lattice.toWorld(glm::dvec3(0.75, 1, 0.5) - glm::dvec3(lattice.centre));
    mesh.positions = {top + glm::dvec3(0, 0.25, 0), top + glm::dvec3(0.1, 0.25, 0),
                      top + glm::dvec3(0, 0.25, 0.1)};
    mesh.faces = {{0, 2, 1}};
    const SurfaceBinding binding = bindSurface(lattice, mesh, sim::Mapping::triangle);
    EXPECT_NEAR(binding.vertices[0].offset.y, 0.25, 1e-6);
    EXPECT_EQ(binding.vertices[0].correctedShare, 0);
    const auto turn = [](const glm::dvec3& q) { return glm::dvec3(q.x, -q.z, q.y); };
    const sim::LatticeState state = deformedState(lattice, turn);
    const glm::dvec3 moved = mapSurface(binding, state.positions, state.normals)[0];
    EXPECT_LE(glm::distance(moved, turn(lattice.toLattice(mesh.positions[0]))), 1e-6);
}

TEST(SurfaceBinding, ConstantBasisWhereANodeHasNoNormal) {
    // A node inside a step's concave corner misses no neighbour: eq. 3 sums to nothing there.
    const Bound bound = ball(sim::Mapping::curvature);
    const std::vector<glm::dvec3> sums = sim::restNormalSums(bound.lattice);
    std::size_t constant = 0;
    for (const VertexBinding& vertex : bound.binding.vertices) {
        bool defined = true;
        for (int i = 0; i < 3; ++i)
            defined = defined && glm::length(sums[vertex.nodes[i]]) >= 0.5;
        if (!defined) {
            EXPECT_EQ(vertex.correctedShare, 0);
        }
        constant += vertex.correctedShare == 0;
    }
    EXPECT_EQ(bound.binding.constantVertices, constant);
    EXPECT_GT(constant, 0U);
    EXPECT_LT(constant, bound.binding.vertices.size());
}

TEST(SurfaceBinding, ExpressingAnewGivesTheSameAsBinding) {
    const Bound corrected = ball(sim::Mapping::curvature), constant = ball(sim::Mapping::triangle);
    const SurfaceBinding other =
        expressBinding(corrected.binding, corrected.lattice, corrected.mesh, sim::Mapping::triangle);
    for (std::size_t v = 0; v < other.vertices.size(); ++v) {
        EXPECT_EQ(other.vertices[v].offset, constant.binding.vertices[v].offset);
        EXPECT_EQ(other.vertices[v].correctedShare, 0);
    }
}

TEST(SurfaceBinding, NoEdgeOfAFineBallIsTorn) {
    const Bound bound = ball(sim::Mapping::triangle);
    EXPECT_EQ(bound.binding.tornEdgesLeft, 0U);
}

TEST(SurfaceBinding, ThinWallBindsToItsOwnSide) {
    // A slab one cell thick whose surface lies deep inside: 0.8 below its own side, 0.2 above the other.
    const sim::Lattice lattice = test::boxLattice(6, 1, 6, 1.0, glm::dvec3(0));
    sim::TriangleMesh mesh;
    const int n = 20;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j)
            mesh.positions.push_back(lattice.toWorld(glm::dvec3(1 + 4.0 * i / n, 0.2, 1 + 4.0 * j / n) -
                                                     glm::dvec3(lattice.centre)));
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const auto a = std::uint32_t(i * (n + 1) + j), b = a + n + 1;
            mesh.faces.emplace_back(a, a + 1, b); // faces up
            mesh.faces.emplace_back(a + 1, b + 1, b);
        }
    const SurfaceBinding binding = bindSurface(lattice, mesh, sim::Mapping::triangle);
    const double topSide = 1 - lattice.centre.y;
    for (const VertexBinding& vertex : binding.vertices)
        for (int k = 0; k < 3; ++k)
            ASSERT_EQ(lattice.restPosition(vertex.nodes[k]).y, topSide);
}

TEST(CheckBinding, SaysWhatCannotBeFollowed) {
    const sim::Lattice lattice = test::boxLattice(3, 3, 3, kSpacing, kOrigin);
    sim::TriangleMesh mesh = test::ballMesh(6, kSpacing, lattice.toWorld(glm::dvec3(0.1)));
    const ControlNodes nodes = controlNodes(lattice);
    EXPECT_TRUE(checkBinding(nodes, mesh).ok());
    ControlNodes bare = nodes;
    bare.triangles.clear();
    EXPECT_NE(checkBinding(bare, mesh).error().message.find("no triangles"), std::string::npos);
    mesh.positions[17] += glm::dvec3(10 * kSpacing, 0, 0);
    const Status far = checkBinding(nodes, mesh);
    ASSERT_FALSE(far.ok());
    EXPECT_NE(far.error().message.find("vertex 17 "), std::string::npos) << far.error().message;
    EXPECT_NE(far.error().message.find(" mm from the nearest triangle"), std::string::npos);
    mesh.positions[17].x = std::nan("");
    EXPECT_FALSE(checkBinding(nodes, mesh).ok());
    mesh.faces.clear();
    EXPECT_NE(checkBinding(nodes, mesh).error().message.find("no faces"), std::string::npos);
}

TEST(ControlNodes, OfALatticeBindAsTheLatticeDoes) {
    const Bound bound = ball(sim::Mapping::curvature);
    for (const auto mapping : {sim::Mapping::triangle, sim::Mapping::curvature, sim::Mapping::chosen,
                               sim::Mapping::normalOffset, sim::Mapping::nodeFrames}) {
        const SurfaceBinding one = bindSurface(bound.lattice, bound.mesh, mapping),
                             other = bindSurface(controlNodes(bound.lattice), bound.mesh, mapping);
        const sim::LatticeState bent =
            deformedState(bound.lattice, [](const glm::dvec3& q) { return bend(q, {}, 20); });
        EXPECT_LE(largestDistance(mapSurface(one, bent.positions, bent.normals),
                                  mapSurface(other, bent.positions, bent.normals)),
                  1e-6);
    }
}

TEST(ControlNodes, OfASurfaceAreFollowedByTheClosestTriangle) {
    // A thin tube that sticks out of a coarse ball: both sides of its wall follow the same triangles.
    const sim::TriangleMesh coarse = test::ballMesh(3, 0.04, {0, 0, 0});
    sim::TriangleMesh tube = test::ballMesh(8, 0.004, {0, 0, 0});
    for (glm::dvec3& p : tube.positions)
        p = glm::dvec3(0.03, 0.03, 0.01) + glm::dvec3(5 * p.x, p.y, p.z);
    const ControlNodes nodes = controlNodes(coarse);
    const SurfaceBinding binding = bindSurface(nodes, tube, sim::Mapping::nodeFrames);
    const sim::TriangleTree tree(nodes.rest, nodes.triangles);
    EXPECT_EQ(binding.tornEdgesFound, 0U);
    for (std::size_t v = 0; v < tube.positions.size(); ++v)
        EXPECT_EQ(binding.triangles[v], tree.closest(nodes.toNodes(tube.positions[v])).triangle);
}

TEST(TornEdges, APatchOnTheWrongSideIsCountedAndFloodedBack) {
    const sim::Lattice lattice = test::boxLattice(8, 1, 8, 1.0, glm::dvec3(0));
    std::vector<glm::dvec3> positions;
    std::vector<glm::uvec3> faces;
    const int n = 32;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j)
            positions.push_back(glm::dvec3(8.0 * i / n, 0.6, 8.0 * j / n) - glm::dvec3(lattice.centre));
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const auto a = std::uint32_t(i * (n + 1) + j), b = a + n + 1;
            faces.emplace_back(a, a + 1, b);
            faces.emplace_back(a + 1, b + 1, b);
        }
    TriangleChoice good = chooseTriangles(controlNodes(lattice), faces, positions,
                                          std::vector<glm::dvec3>(positions.size(), {0, 1, 0}));
    ASSERT_EQ(good.tornEdgesLeft, 0U);
    TriangleChoice below = chooseTriangles(controlNodes(lattice), faces, positions,
                                           std::vector<glm::dvec3>(positions.size(), {0, -1, 0}));

    TriangleChoice choice = good;
    std::size_t wrong = 0;
    for (std::size_t v = 0; v < positions.size(); ++v)
        if (glm::length(positions[v] + glm::dvec3(lattice.centre) - glm::dvec3(4, 0.6, 4)) < 1.6) {
            choice.triangles[v] = below.triangles[v];
            choice.weights[v] = below.weights[v];
            ++wrong;
        }
    ASSERT_GT(wrong, 50U);
    repairTornEdges(controlNodes(lattice), faces, positions, choice);
    EXPECT_GT(choice.tornEdgesFound, 30U); // the patch's rim
    EXPECT_EQ(choice.tornEdgesLeft, 0U);
    const double top = 1 - lattice.centre.y;
    for (std::size_t v = 0; v < positions.size(); ++v)
        for (int k = 0; k < 3; ++k)
            ASSERT_EQ(lattice.restPosition(lattice.boundary[choice.triangles[v]][k]).y, top) << v;
}

TEST(Bend, KeepsArcLengthsAndTurnsByTheAngle) {
    const glm::dvec3 middle(1, 2, 3);
    const double radius = 5;
    EXPECT_LE(glm::distance(bend(middle, middle, radius), middle), 1e-14);
    const glm::dvec3 end = bend(middle + glm::dvec3(radius * 3.14159265358979 / 2, 0, 0.5), middle, radius);
    EXPECT_LE(glm::distance(end, middle + glm::dvec3(radius, -radius, 0.5)), 1e-12);
    const double up = glm::distance(bend(middle + glm::dvec3(2, 1, 0), middle, radius),
                                    bend(middle + glm::dvec3(2, 0, 0), middle, radius));
    EXPECT_NEAR(up, 1, 1e-12); // thickness stays
}

} // namespace
} // namespace serosa::render
