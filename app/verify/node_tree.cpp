// The part of group `lod` about the tree of boxes (sim/node_tree.h): a heart that is bent and shaken; rays,
// closest points and candidates from the GPU against plain loops over all triangles in double.
#include "sim/node_tree.h"

#include "app/verify/verify.h"
#include "models/phantom.h"
#include "sim/solver.h"
#include "sim/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace serosa::app {

namespace {

using sim::NodeTree;
using Corners = std::array<glm::dvec3, 3>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSame = 1e-3; // h: float32 on slopes, and a ray that grazes

double number(std::mt19937& random, double low, double high) {
    return low + (high - low) * double(random()) / 4294967296.0;
}

/// Along the ray, in lengths of its direction, by the triangle's plane; infinity where it passes.
double distanceAlong(const NodeTree::Ray& ray, const Corners& t) {
    const glm::dvec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double at = glm::dot(n, t[0] - ray.origin) / glm::dot(n, ray.direction);
    const glm::dvec3 p = ray.origin + at * ray.direction;
    for (std::size_t i = 0; i < 3; ++i)
        if (glm::dot(glm::cross(t[(i + 1) % 3] - t[i], p - t[i]), n) < 0)
            return kInfinity;
    return at >= 0 ? at : kInfinity;
}

struct Differences {
    std::size_t rays = 0, hits = 0, points = 0, boxes = 0;
};

} // namespace

Status verifyNodeTree(const VerifyOptions& options, CheckList& checks) {
    const int queries = options.full ? 4000 : 600;
    SEROSA_ASSIGN(const sim::Lattice lattice,
                  models::phantomLattice("heart", 12000, options.full ? 20000 : 3000));
    std::mt19937 random(5);
    const auto somewhere = [&random](const glm::dvec3& reach) {
        const double x = number(random, -reach.x, reach.x), y = number(random, -reach.y, reach.y),
                     z = number(random, -reach.z, reach.z);
        return glm::dvec3(glm::vec3(float(x), float(y), float(z)));
    };
    sim::LatticeState state = sim::restState(lattice);
    for (glm::dvec3& p : state.positions)
        p = glm::vec3(p + glm::dvec3(1.5 * std::sin(0.3 * p.y), 0.2 * p.x, std::cos(0.25 * p.z)) +
                      somewhere(glm::dvec3(0.2)));
    SEROSA_ASSIGN(sim::StateTextures textures, sim::StateTextures::create(lattice, {}));
    textures.upload(state);
    SEROSA_ASSIGN(NodeTree tree, NodeTree::create(lattice, textures.layout()));
    tree.refit(textures);

    const glm::dvec3 half = 0.6 * glm::dvec3(lattice.nodeDims);
    std::vector<NodeTree::Ray> rays;
    std::vector<NodeTree::Sphere> points;
    std::vector<NodeTree::Box> boxes;
    for (int i = 0; i < queries; ++i) {
        const glm::dvec3 origin = somewhere(2.0 * half), at = somewhere(half);
        rays.push_back({origin, glm::dvec3(glm::vec3(somewhere(half) - origin)), 1e6});
        points.push_back({at, kInfinity});
        const glm::dvec3 size = glm::abs(somewhere(glm::dvec3(1.2)));
        boxes.push_back({glm::dvec3(glm::vec3(at - size)), glm::dvec3(glm::vec3(at + size))});
    }
    SEROSA_ASSIGN(const auto hits, tree.cast(textures, rays));
    SEROSA_ASSIGN(const auto closest, tree.closest(textures, points));
    SEROSA_ASSIGN(const auto candidates, tree.overlapping(textures, boxes));
    Differences off;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        double along = kInfinity, near = kInfinity;
        std::size_t inBox = 0;
        for (const glm::uvec3& t : lattice.boundary) {
            const Corners c{state.positions[t.x], state.positions[t.y], state.positions[t.z]};
            along = std::min(along, distanceAlong(rays[i], c));
            near = std::min(
                near, glm::distance(points[i].centre,
                                    sim::closestPointOnTriangle(points[i].centre, c[0], c[1], c[2]).point));
            const glm::dvec3 low = glm::min(c[0], glm::min(c[1], c[2])),
                             high = glm::max(c[0], glm::max(c[1], c[2]));
            inBox += glm::all(glm::lessThanEqual(low, boxes[i].highest)) &&
                     glm::all(glm::greaterThanEqual(high, boxes[i].lowest));
        }
        const double unit = glm::length(rays[i].direction);
        off.hits += along < kInfinity;
        off.rays += hits[i].has_value() != (along < kInfinity) ||
                    (hits[i] && std::abs(hits[i]->distance - along) * unit > kSame);
        off.points += !closest[i] || std::abs(closest[i]->distance - near) > kSame;
        off.boxes += candidates[i].found != inBox;
    }
    const std::string of = "tree on the GPU against loops over " + std::to_string(lattice.boundary.size()) +
                           " triangles, " + std::to_string(queries) + " ";
    checks.equalAbs(of + "rays: that differ", double(off.rays), 0, 0, "");
    checks.atLeast(of + "rays: that hit", double(off.hits), queries / 4.0, "");
    checks.equalAbs(of + "closest points: that differ", double(off.points), 0, 0, "");
    checks.equalAbs(of + "boxes: whose candidates differ", double(off.boxes), 0, 0, "");
    // A mouse's ray through a known point of the surface, in the world.
    const glm::uvec3& t = lattice.boundary[lattice.boundary.size() / 2];
    const glm::dvec3 aim =
        lattice.toWorld((state.positions[t.x] + state.positions[t.y] + state.positions[t.z]) / 3.0);
    const glm::dvec3 normal =
        glm::cross(state.positions[t.y] - state.positions[t.x], state.positions[t.z] - state.positions[t.x]);
    const glm::dvec3 eye = aim + 0.1 * lattice.spacing * glm::normalize(normal);
    SEROSA_ASSIGN(const auto picked, tree.pick(textures, eye, aim - eye));
    checks.atMost("picking from a point near the surface: off the point aimed at",
                  picked ? glm::distance(picked->at, aim) / lattice.spacing : kInfinity, kSame, "h");
    return {};
}

} // namespace serosa::app
