// The tree on the GPU against plain loops over all triangles in double, on deformed bodies, both layouts, and
// after cuts.
#include "sim/node_tree.h"
#include "sim/pieces.h"
#include "sim/triangle_tree.h"
#include "tests/gl_fixture.h"
#include "tests/sim/cut_strokes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

using namespace serosa;
using sim::NodeTree;
using Corners = std::array<glm::dvec3, 3>;

namespace {

class GlNodeTree : public test::GlTest {
protected:
    /// A lattice bent, stretched and shaken, in float32.
    static sim::LatticeState shaken(const sim::Lattice& lattice, unsigned seed, double noise = 0.3) {
        sim::LatticeState state = sim::restState(lattice);
        std::mt19937 random(seed);
        for (std::size_t i = 0; i < state.positions.size(); ++i) {
            glm::dvec3& p = state.positions[i];
            p += glm::dvec3(1.5 * std::sin(0.3 * p.y), 0.8 * std::cos(0.25 * p.z), 0.1 * p.x);
            for (int axis = 0; axis < 3; ++axis) {
                p[axis] = float(p[axis] + test::number(random, -noise, noise));
                state.increments[i][axis] = float(test::number(random, -0.5, 0.5));
            }
        }
        return state;
    }

    static sim::Lattice ball() {
        sim::LatticeRequest request;
        request.spacing = 0.004;
        return sim::buildLattice(test::ballMesh(0.05, 4), request).value();
    }

    void make(const sim::Lattice& lattice, const sim::LatticeState& state, int layout) {
        textures_.emplace(sim::StateTextures::create(lattice, {}, layout).value());
        textures_->upload(state);
        tree_.emplace(NodeTree::create(lattice, textures_->layout()).value());
        tree_->refit(*textures_);
    }
    Corners corners(const sim::LatticeState& state, std::size_t triangle) const {
        const glm::uvec3& t = tree_->triangles()[triangle];
        return {state.positions[t.x], state.positions[t.y], state.positions[t.z]};
    }

    std::optional<sim::StateTextures> textures_;
    std::optional<NodeTree> tree_;
};

/// By the plane of the triangle; infinity where the ray passes it.
double distanceAlong(const NodeTree::Ray& ray, const Corners& t) {
    const glm::dvec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double along = glm::dot(n, glm::dvec3(ray.direction));
    const double at = glm::dot(n, t[0] - ray.origin) / along;
    const glm::dvec3 p = ray.origin + at * ray.direction;
    for (std::size_t i = 0; i < 3; ++i)
        if (glm::dot(glm::cross(t[(i + 1) % 3] - t[i], p - t[i]), n) < 0)
            return std::numeric_limits<double>::infinity();
    return at >= 0 ? at : std::numeric_limits<double>::infinity();
}

glm::dvec3 rounded(const glm::dvec3& v) {
    return glm::dvec3(glm::vec3(v));
}

glm::dvec3 somewhere(std::mt19937& random, double reach) {
    const double x = test::number(random, -reach, reach), y = test::number(random, -reach, reach),
                 z = test::number(random, -reach, reach);
    return rounded({x, y, z});
}

glm::dvec3 pointOf(const Corners& t, const glm::dvec3& weights) {
    return weights.x * t[0] + weights.y * t[1] + weights.z * t[2];
}

constexpr double kRounding = 2e-4; // lattice units: float32 at coordinates of some ten, on slopes

} // namespace

TEST(NodeTreeShape, holdsEveryTriangleOnceAndEveryNodeBelowOneOther) {
    for (const int size : {1, 2, 5, 12}) {
        const sim::Lattice lattice = test::blockLattice(size, size, 2);
        const auto shape = sim::NodeTreeShape::make(lattice, lattice.boundary);
        std::vector<std::uint32_t> sorted = shape.order, all(lattice.boundary.size());
        std::iota(all.begin(), all.end(), 0u);
        std::sort(sorted.begin(), sorted.end());
        EXPECT_EQ(sorted, all);
        EXPECT_LE(shape.counts.back(), SRS_TREE_WIDTH);
        for (std::size_t level = 1; level < shape.counts.size(); ++level) {
            EXPECT_EQ(shape.counts[level], (shape.counts[level - 1] + 7) / 8);
            EXPECT_GE(shape.starts[level] - shape.starts[level - 1], 8 * shape.counts[level]);
        }
        EXPECT_EQ(shape.counts[0], int(all.size() + 3) / 4);
    }
    EXPECT_EQ(sim::NodeTreeShape::make(test::blockLattice(1, 1, 1), {}).counts, std::vector<int>{0});
}

TEST_F(GlNodeTree, findsTheFirstTriangleOnEveryRay) {
    std::size_t hits = 0, passes = 0;
    for (const sim::Lattice& lattice : {test::hollowBall(), ball()})
        for (const int layout : {SRS_LAYOUT_GRID, SRS_LAYOUT_ROWS}) {
            const sim::LatticeState state = shaken(lattice, 5);
            make(lattice, state, layout);
            std::mt19937 random(7);
            std::vector<NodeTree::Ray> rays;
            for (int i = 0; i < 400; ++i) {
                NodeTree::Ray ray{somewhere(random, 20), {}, 1e6};
                ray.direction = rounded(i % 2 ? somewhere(random, 10) - ray.origin : somewhere(random, 1));
                if (i % 7 == 0) // along an axis
                    ray.direction = glm::dvec3(i % 3 == 0, i % 3 == 1, i % 3 == 2) * (i % 14 ? 1.0 : -1.0);
                if (i % 5 == 0)
                    ray.reach = float(test::number(random, 0.1, 2));
                rays.push_back(ray);
            }
            const auto found = tree_->cast(*textures_, rays).value();
            for (std::size_t i = 0; i < rays.size(); ++i) {
                double nearest = std::numeric_limits<double>::infinity();
                for (std::size_t t = 0; t < lattice.boundary.size(); ++t)
                    nearest = std::min(nearest, distanceAlong(rays[i], corners(state, t)));
                const double unit = glm::length(rays[i].direction);
                const bool expected = nearest <= rays[i].reach;
                if (std::abs(nearest - rays[i].reach) * unit < kRounding)
                    continue;
                ASSERT_EQ(found[i].has_value(), expected) << i;
                (expected ? hits : passes) += 1;
                if (!expected)
                    continue;
                EXPECT_NEAR(found[i]->distance * unit, nearest * unit, kRounding * (1 + nearest)) << i;
                const glm::dvec3 on = pointOf(corners(state, found[i]->triangle), found[i]->weights);
                EXPECT_LT(glm::distance(on, rays[i].origin + nearest * rays[i].direction), 20 * kRounding)
                    << i;
            }
        }
    EXPECT_GT(hits, 300u);
    EXPECT_GT(passes, 300u);
}

TEST_F(GlNodeTree, noRayPassesBetweenTwoTriangles) {
    const sim::Lattice lattice = ball();
    const sim::LatticeState state = shaken(lattice, 3, 0);
    make(lattice, state, -1);
    std::mt19937 random(11);
    std::vector<NodeTree::Ray> rays; // from inside, to points of edges and to nodes
    const glm::dvec3 inside = rounded(state.positions[std::size_t(lattice.nodeAt(lattice.nodeDims / 2))]);
    for (std::size_t t = 0; t < lattice.boundary.size(); ++t) {
        const Corners c = corners(state, t);
        const double share = t % 3 == 0 ? 0 : test::number(random, 0, 1);
        rays.push_back({inside, rounded(c[0] + share * (c[1] - c[0]) - inside), 1e6});
    }
    const auto found = tree_->cast(*textures_, rays).value();
    for (std::size_t i = 0; i < rays.size(); ++i)
        ASSERT_TRUE(found[i]) << i;
}

TEST_F(GlNodeTree, findsTheClosestTriangle) {
    for (const sim::Lattice& lattice : {test::hollowBall(), ball()})
        for (const int layout : {SRS_LAYOUT_GRID, SRS_LAYOUT_ROWS}) {
            sim::LatticeState state = shaken(lattice, 9);
            // Crushed ones too: to a line and to a point.
            const glm::uvec3 line = lattice.boundary[3], point = lattice.boundary[40];
            state.positions[line.y] = 0.5 * (state.positions[line.x] + state.positions[line.z]);
            state.positions[point.y] = state.positions[point.z] = state.positions[point.x];
            for (glm::dvec3& p : state.positions)
                p = rounded(p);
            make(lattice, state, layout);
            std::mt19937 random(13);
            std::vector<NodeTree::Sphere> points;
            for (int i = 0; i < 400; ++i)
                points.push_back(
                    {somewhere(random, 16), i % 4 == 0 ? 1.0 : std::numeric_limits<double>::infinity()});
            const auto found = tree_->closest(*textures_, points).value();
            for (std::size_t i = 0; i < points.size(); ++i) {
                double nearest = std::numeric_limits<double>::infinity();
                for (std::size_t t = 0; t < lattice.boundary.size(); ++t) {
                    const Corners c = corners(state, t);
                    const auto at = sim::closestPointOnTriangle(points[i].centre, c[0], c[1], c[2]);
                    nearest = std::min(nearest, glm::distance(at.point, points[i].centre));
                }
                if (std::abs(nearest - points[i].radius) < kRounding)
                    continue;
                ASSERT_EQ(found[i].has_value(), nearest < points[i].radius) << i;
                if (!found[i])
                    continue;
                EXPECT_NEAR(found[i]->distance, nearest, kRounding);
                const glm::dvec3 on = pointOf(corners(state, found[i]->triangle), found[i]->weights);
                EXPECT_NEAR(glm::distance(on, points[i].centre), nearest, kRounding);
            }
        }
}

TEST_F(GlNodeTree, listsWhatOverlapsBoxesAndSpheres) {
    const sim::Lattice lattice = ball();
    const sim::LatticeState state = shaken(lattice, 21);
    make(lattice, state, -1);
    std::mt19937 random(17);
    std::vector<NodeTree::Box> boxes;
    std::vector<NodeTree::Sphere> spheres;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 at = somewhere(random, 14), size = glm::abs(somewhere(random, i % 10 ? 1.5 : 12));
        boxes.push_back({rounded(at - size), rounded(at + size)});
        spheres.push_back({at, float(size.x)});
    }
    const auto inBoxes = tree_->overlapping(*textures_, boxes).value();
    const auto inSpheres = tree_->overlapping(*textures_, spheres).value();
    std::size_t most = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        std::vector<std::uint32_t> box, sphere;
        for (std::uint32_t t = 0; t < lattice.boundary.size(); ++t) {
            const Corners c = corners(state, t);
            const glm::dvec3 low = glm::min(c[0], glm::min(c[1], c[2])),
                             high = glm::max(c[0], glm::max(c[1], c[2]));
            if (glm::all(glm::lessThanEqual(low, boxes[i].highest)) &&
                glm::all(glm::greaterThanEqual(high, boxes[i].lowest)))
                box.push_back(t);
            const glm::dvec3 away = spheres[i].centre - glm::clamp(spheres[i].centre, low, high);
            if (glm::length(away) <= spheres[i].radius)
                sphere.push_back(t);
        }
        for (const auto& [listed, expected] : {std::pair(inBoxes[i], box), std::pair(inSpheres[i], sphere)}) {
            ASSERT_EQ(listed.found, expected.size()) << i;
            ASSERT_EQ(listed.triangles.size(), std::min<std::size_t>(expected.size(), 64));
            std::vector<std::uint32_t> sorted = listed.triangles;
            std::sort(sorted.begin(), sorted.end());
            EXPECT_TRUE(std::includes(expected.begin(), expected.end(), sorted.begin(), sorted.end()));
            EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end());
            most = std::max(most, expected.size());
        }
    }
    EXPECT_GT(most, 100u); // more than fit a list
}

TEST_F(GlNodeTree, boundsHoldTheBoundaryAndItsWay) {
    const sim::Lattice lattice = test::hollowBall();
    const sim::LatticeState state = shaken(lattice, 23);
    make(lattice, state, -1);
    NodeTree::Box now{glm::dvec3(1e9), glm::dvec3(-1e9)}, swept = now;
    for (const glm::uvec3& t : lattice.boundary)
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 x = state.positions[t[i]], before = x - 2.0 * state.increments[t[i]];
            now = {glm::min(now.lowest, x), glm::max(now.highest, x)};
            swept = {glm::min(swept.lowest, glm::min(x, before)),
                     glm::max(swept.highest, glm::max(x, before))};
        }
    EXPECT_EQ(tree_->bounds().lowest, now.lowest);
    EXPECT_EQ(tree_->bounds().highest, now.highest);
    tree_->refit(*textures_, 2);
    EXPECT_LT(glm::distance(tree_->bounds().lowest, swept.lowest), kRounding);
    EXPECT_LT(glm::distance(tree_->bounds().highest, swept.highest), kRounding);
    EXPECT_GT(glm::distance(swept.highest, now.highest), 0.1);
}

TEST_F(GlNodeTree, picksInTheWorldAndFollowsCuts) {
    const sim::Lattice lattice = test::hollowBall();
    const auto solver = sim::makeFragmentSolver(test::plainSetup(lattice)).value();
    tree_.emplace(NodeTree::create(lattice, solver->textures()->layout()).value());
    tree_->refit(*solver->textures());
    const glm::dvec3 eye = lattice.toWorld({40, 0.3, 0.2}), towards(-2, 0, 0);
    const auto picked = tree_->pick(*solver->textures(), eye, towards).value();
    ASSERT_TRUE(picked);
    EXPECT_NEAR(picked->at.x, lattice.toWorld({4, 0, 0}).x, 1e-5);
    EXPECT_NEAR(picked->distance, 36 * lattice.spacing, 1e-5);
    EXPECT_EQ(picked->nodes, lattice.boundary[picked->triangle]);
    EXPECT_FALSE(tree_->pick(*solver->textures(), eye, {1, 0, 0}).value());
    // All is cut away but what lies at x < 0.
    std::vector<std::uint32_t> connections = lattice.connections;
    for (std::size_t i = 0; i < connections.size(); ++i)
        if (lattice.restPosition(i).x > 0.1)
            connections[i] = 0;
    tree_->rebuild(lattice, sim::boundaryLeft(lattice, connections));
    tree_->refit(*solver->textures());
    const auto behind = tree_->pick(*solver->textures(), eye, towards).value();
    ASSERT_TRUE(behind);
    EXPECT_LT(behind->at.x, lattice.toWorld({0.51, 0, 0}).x);
    tree_->rebuild(lattice, {});
    tree_->refit(*solver->textures());
    EXPECT_FALSE(tree_->pick(*solver->textures(), eye, towards).value());
}
