// Distances to rigid shapes against points of their cores, gradients against differences, and the deepest
// point of a triangle against dense sampling.
#include "sim/contact_triangle.h"
#include "sim/distance_field.h"
#include "sim/shape_distance.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

using namespace serosa;
using sim::RigidShape;
using sim::ShapeKind;

namespace {

struct Named {
    const char* name;
    RigidShape shape;
};

std::vector<Named> roundedShapes() {
    RigidShape sphere, capsule, box, blade, hook;
    sphere.radius = 1.5;
    capsule.kind = ShapeKind::capsule;
    capsule.radius = 0.4;
    capsule.length = 3;
    box.kind = ShapeKind::box;
    box.radius = 0.3;
    box.middle = {0.2, -0.5, 0.4};
    box.halfSize = {1, 0.5, 2};
    blade.kind = ShapeKind::box;
    blade.radius = 0.05;
    blade.middle = {0, 0, 1};
    blade.halfSize = {0, 0.8, 1};
    hook.kind = ShapeKind::hook;
    hook.radius = 0.3;
    hook.bend = 1;
    hook.length = 2.5;
    return {{"sphere", sphere}, {"capsule", capsule}, {"box", box}, {"blade", blade}, {"hook", hook}};
}

/// Points of a shape's core, as sim/rigid_shape.h describes it; `fine` apart or nearer.
std::vector<glm::dvec3> corePoints(const RigidShape& shape, double fine) {
    std::vector<glm::dvec3> points;
    const auto line = [&](const glm::dvec3& a, const glm::dvec3& b) {
        const int cuts = std::max(1, int(glm::distance(a, b) / fine));
        for (int i = 0; i <= cuts; ++i)
            points.push_back(a + (b - a) * (double(i) / cuts));
    };
    switch (shape.kind) {
    case ShapeKind::capsule:
        line({0, 0, 0}, {0, 0, shape.length});
        break;
    case ShapeKind::hook: {
        line({0, -shape.bend, 0}, {0, -shape.bend, shape.length});
        const int cuts = int(3.15 * shape.bend / fine);
        for (int i = 0; i <= cuts; ++i) {
            const double angle = std::acos(-1.0) * i / cuts;
            points.emplace_back(0, shape.bend * std::cos(angle), -shape.bend * std::sin(angle));
        }
        break;
    }
    case ShapeKind::box: { // its faces: from outside nothing else is nearest
        const glm::dvec3 half = shape.halfSize;
        const glm::ivec3 cuts = glm::max(glm::ivec3(2.0 * half / fine), glm::ivec3(1));
        for (int x = 0; x <= cuts.x; ++x)
            for (int y = 0; y <= cuts.y; ++y)
                for (int z = 0; z <= cuts.z; ++z)
                    if (x == 0 || x == cuts.x || y == 0 || y == cuts.y || z == 0 || z == cuts.z)
                        points.push_back(shape.middle - half +
                                         2.0 * half * glm::dvec3(x, y, z) / glm::dvec3(cuts));
        break;
    }
    default:
        points.emplace_back(0);
    }
    return points;
}

std::function<glm::dvec3()> pointsAround(double size) {
    return [size, random = std::mt19937(7)]() mutable {
        const auto one = [&] { return size * (double(random()) / 2147483648.0 - 1); };
        const double x = one(), y = one(), z = one();
        return glm::dvec3(x, y, z);
    };
}

RigidShape meshShape(const sim::TriangleMesh& metres, double scale) {
    RigidShape shape;
    shape.kind = ShapeKind::mesh;
    shape.radius = 0;
    shape.field = std::make_shared<const sim::DistanceField>(metres);
    shape.fieldScale = scale;
    return shape;
}

} // namespace

TEST(ShapeDistance, isThatToTheCoreLessTheRounding) {
    const double fine = 0.02;
    for (const auto& [name, shape] : roundedShapes()) {
        SCOPED_TRACE(name);
        const std::vector<glm::dvec3> core = corePoints(shape, fine);
        auto next = pointsAround(4);
        for (int i = 0; i < 400; ++i) {
            const glm::dvec3 p = next();
            double nearest = 1e9;
            for (const glm::dvec3& q : core)
                nearest = std::min(nearest, glm::distance(p, q));
            const glm::dvec3 in = glm::abs(p - shape.middle) - shape.halfSize;
            if (shape.kind == ShapeKind::box && std::max({in.x, in.y, in.z}) < 0)
                EXPECT_NEAR(sim::shapeDistance(shape, p), -nearest - shape.radius, fine);
            else
                EXPECT_NEAR(sim::shapeDistance(shape, p), nearest - shape.radius,
                            fine * std::min(1.0, fine / nearest));
        }
    }
}

TEST(ShapeDistance, ofAHalfSpaceIsTheHeight) {
    RigidShape floor;
    floor.kind = ShapeKind::halfSpace;
    floor.radius = 0;
    EXPECT_EQ(sim::shapeDistance(floor, {3, 0.25, -7}), 0.25);
    EXPECT_EQ(sim::shapeDistance(floor, {3, -2, -7}), -2);
    EXPECT_EQ(sim::sampleShape(floor, {3, -2, -7}).normal, glm::dvec3(0, 1, 0));
}

TEST(ShapeDistance, hasItsGradientAsNormal) {
    std::vector<Named> shapes = roundedShapes();
    shapes.push_back({"mesh", meshShape(test::ballMesh(0.01, 4), 150)});
    const double eps = 1e-5;
    for (const auto& [name, shape] : shapes) {
        SCOPED_TRACE(name);
        auto next = pointsAround(3);
        int bends = 0; // a corner of the field lies between the points
        for (int i = 0; i < 400; ++i) {
            const glm::dvec3 p = next() * (shape.field ? 0.5 : 1.0); // beyond its grid a field is no distance
            glm::dvec3 slope;
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 e(0);
                e[axis] = eps;
                slope[axis] =
                    (sim::shapeDistance(shape, p + e) - sim::shapeDistance(shape, p - e)) / (2 * eps);
            }
            const sim::ShapeSample sample = sim::sampleShape(shape, p);
            EXPECT_NEAR(glm::length(sample.normal), 1, 1e-12);
            bends += glm::distance(sample.normal, shape.field ? glm::normalize(slope) : slope) > 1e-4;
        }
        EXPECT_LE(bends, 2);
    }
}

TEST(ShapeDistance, knowsHowThinAndHowLargeAShapeIs) {
    for (const auto& [name, shape] : roundedShapes()) {
        SCOPED_TRACE(name);
        const double thin = sim::thinnestHalfWidth(shape), large = sim::boundingRadius(shape);
        double furthest = 0;
        for (const glm::dvec3& p : corePoints(shape, 0.02))
            furthest = std::max(furthest, glm::length(p) + shape.radius);
        EXPECT_GE(large, furthest - 1e-12);
        EXPECT_LE(large, 1.5 * furthest);
        EXPECT_EQ(thin, shape.kind == ShapeKind::box
                            ? shape.radius + std::min({shape.halfSize.x, shape.halfSize.y, shape.halfSize.z})
                            : shape.radius);
        const RigidShape twice = sim::scaledShape(shape, 2);
        EXPECT_NEAR(sim::shapeDistance(twice, {2, 4, -6}), 2 * sim::shapeDistance(shape, {1, 2, -3}), 1e-12);
    }
}

// Against all points of a fine grid on the triangle; in turn from far, touching and cutting through.
TEST(DeepestPoint, isTheLeastOfAllPointsOfATriangle) {
    std::vector<Named> shapes = roundedShapes();
    shapes.push_back({"mesh", meshShape(test::ballMesh(0.01, 4), 150)});
    shapes.push_back(
        {"tetrahedron", meshShape({{{-0.01, -0.01, -0.01}, {0.02, 0, 0}, {0, 0.02, 0}, {0, 0, 0.02}},
                                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}},
                                   {},
                                   {},
                                   {}},
                                  100)});
    for (const auto& [name, shape] : shapes) {
        SCOPED_TRACE(name);
        auto next = pointsAround(1);
        double worst = 0, worstInside = 0, sum = 0; // less than a tenth inside, deeper
        const int count = 600;
        for (int i = 0; i < count; ++i) {
            const glm::dvec3 middle = 2.5 * next();
            const sim::Corners p = {middle + next(), middle + next(), middle + next()};
            const glm::dvec3 depth = i % 2 ? 0.3 * next() : glm::dvec3(0.1);
            const sim::TriangleGap found = sim::deepestPoint(shape, p, depth);
            EXPECT_NEAR(found.weights.x + found.weights.y + found.weights.z, 1, 1e-9);
            EXPECT_GE(std::min({found.weights.x, found.weights.y, found.weights.z}), -1e-12);
            EXPECT_NEAR(sim::shapeDistance(shape, found.weights.x * p[0] + found.weights.y * p[1] +
                                                      found.weights.z * p[2]) -
                            glm::dot(found.weights, depth),
                        found.gap, 1e-9);
            double least = 1e9;
            const int cuts = 40;
            for (int a = 0; a <= cuts; ++a)
                for (int b = 0; a + b <= cuts; ++b) {
                    const glm::dvec3 w = glm::dvec3(a, b, cuts - a - b) / double(cuts);
                    least = std::min(least, sim::shapeDistance(shape, w.x * p[0] + w.y * p[1] + w.z * p[2]) -
                                                glm::dot(w, depth));
                }
            const double off = std::max(0.0, found.gap - least);
            // Beyond its grid a mesh's distance is a bound, whose least may lie elsewhere: what is far is
            // far.
            if (least < 0.1) {
                double& most = least > -0.1 ? worst : worstInside;
                most = std::max(most, off);
            }
            sum += off;
        }
        // The mean, as edges are 1 long. Inside of a box the distance has edges that steps get caught at.
        EXPECT_LT(sum / count, shape.field ? 0.003 : 0.001);
        EXPECT_LT(worst, shape.kind == ShapeKind::sphere                ? 1e-6
                         : shape.field || shape.kind == ShapeKind::hook ? 0.07 // not convex
                                                                        : 0.01);
        EXPECT_LT(worstInside, 0.15);
    }
}
