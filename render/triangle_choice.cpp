// MS05 3.3.1: "the reference point is chosen as a projection of the vertex onto the triangle base". The
// boundary is a staircase around the surface, and the closest of its triangles changes abruptly from vertex
// to vertex (on a ball one edge in twenty is torn by it) and lies on the wrong side of a thin wall.
// Departure: the projection goes along the vertex' normal, smoothed over about one spacing, to where it
// leaves the lattice. Seen that way the staircase is a graph over the surface, so neighbours land on
// neighbours. Where that finds nothing within two spacings (deep folds), the closest triangle that faces the
// same way serves, and after it the closest of all.
#include "render/triangle_choice.h"

#include "render/parallel.h"
#include "sim/triangle_tree.h"

#include <algorithm>
#include <span>
#include <utility>

namespace serosa::render {

namespace {

constexpr double kRayReach = 2.0;    // spacings: a half-space needs at most sqrt(3)
constexpr double kRayStart = 0.01;   // spacings behind the vertex, which may lie on the boundary itself
constexpr double kSmoothing = 0.7;   // spacings over which normals are averaged
constexpr double kFacing = 0.1;      // least n_vertex . n_triangle
constexpr double kReach = 1.5;       // spacings within which a facing triangle is preferred
constexpr double kRepairReach = 1.5; // spacings by which a repair may move the reference point away
constexpr int kPasses = 4;
constexpr std::uint32_t kNone = 0xffffffffU;

/// Lists of items by key, in two flat arrays.
class Adjacency {
public:
    Adjacency(std::size_t keys, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs)
        : begin_(keys + 1) {
        for (const auto& [key, item] : pairs)
            ++begin_[key + 1];
        for (std::size_t k = 0; k < keys; ++k)
            begin_[k + 1] += begin_[k];
        items_.resize(pairs.size());
        std::vector<std::uint32_t> at(begin_.begin(), begin_.end() - 1);
        for (const auto& [key, item] : pairs)
            items_[at[key]++] = item;
    }
    std::span<const std::uint32_t> operator[](std::uint32_t key) const {
        return std::span(items_).subspan(begin_[key], begin_[key + 1] - begin_[key]);
    }

private:
    std::vector<std::uint32_t> begin_, items_;
};

using Edges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Edges edgesOf(const std::vector<glm::uvec3>& faces) {
    Edges edges;
    for (const glm::uvec3& f : faces)
        for (int i = 0; i < 3; ++i)
            edges.emplace_back(std::min(f[i], f[(i + 1) % 3]), std::max(f[i], f[(i + 1) % 3]));
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

class Repair {
public:
    Repair(const ControlNodes& control, const std::vector<glm::uvec3>& faces,
           const std::vector<glm::dvec3>& positions, std::vector<std::uint32_t>& triangles)
        : control_(control), positions_(positions), triangles_(triangles), edges_(edgesOf(faces)),
          around_(neighbours()), ofNode_(trianglesOfNodes()) {}

    std::size_t tornEdges() const {
        return std::size_t(std::count_if(edges_.begin(), edges_.end(),
                                         [&](const auto& e) { return torn(e.first, e.second); }));
    }

    /// One sweep over single vertices with torn edges: the triangle around a neighbour's nodes that tears
    /// fewest edges, the closest of several. Returns whether anything changed.
    bool sweep() {
        bool changed = false;
        for (std::uint32_t v = 0; v < positions_.size(); ++v) {
            std::size_t fewest = tornAround({v});
            if (fewest == 0)
                continue;
            const double reach = distanceTo(v, triangles_[v]) + kRepairReach;
            std::uint32_t best = triangles_[v];
            double bestDistance = 0;
            for (const std::uint32_t w : around_[v])
                for (int i = 0; i < 3; ++i)
                    for (const std::uint32_t t : ofNode_[control_.triangles[triangles_[w]][i]]) {
                        const double d = distanceTo(v, t);
                        if (d > reach)
                            continue;
                        const std::uint32_t old = std::exchange(triangles_[v], t);
                        const std::size_t torn = tornAround({v});
                        triangles_[v] = old;
                        if (torn < fewest || (torn == fewest && best != old && d < bestDistance)) {
                            fewest = torn;
                            best = t;
                            bestDistance = d;
                        }
                    }
            changed = changed || best != triangles_[v];
            triangles_[v] = best;
        }
        return changed;
    }

    /// One pass over all patches, small ones first. Returns whether anything changed.
    bool pass() {
        const std::vector<std::vector<std::uint32_t>> patches = findPatches();
        bool changed = false;
        for (const auto& patch : patches)
            changed = floodInto(patch) || changed;
        return changed;
    }

private:
    Adjacency neighbours() const {
        Edges both = edges_;
        for (const auto& [a, b] : edges_)
            both.emplace_back(b, a);
        return {positions_.size(), both};
    }
    Adjacency trianglesOfNodes() const {
        Edges pairs;
        for (std::uint32_t t = 0; t < control_.triangles.size(); ++t)
            for (int i = 0; i < 3; ++i)
                pairs.emplace_back(control_.triangles[t][i], t);
        return {control_.count(), pairs};
    }

    bool torn(std::uint32_t a, std::uint32_t b) const {
        const glm::uvec3 &s = control_.triangles[triangles_[a]], &t = control_.triangles[triangles_[b]];
        for (int i = 0; i < 3; ++i)
            if (s[i] == t.x || s[i] == t.y || s[i] == t.z)
                return false;
        return true;
    }
    std::size_t tornAround(const std::vector<std::uint32_t>& patch) const {
        std::size_t count = 0;
        for (const std::uint32_t v : patch)
            for (const std::uint32_t w :
                 around_[v]) // an edge inside the patch counts from both ends, before and after alike
                count += torn(v, w);
        return count;
    }

    /// Vertices joined by edges that are not torn; all patches that touch a torn edge, smallest first.
    std::vector<std::vector<std::uint32_t>> findPatches() {
        patchOf_.assign(positions_.size(), kNone);
        std::vector<std::vector<std::uint32_t>> patches;
        std::vector<bool> touched;
        for (std::uint32_t seed = 0; seed < positions_.size(); ++seed) {
            if (patchOf_[seed] != kNone)
                continue;
            const auto id = std::uint32_t(patches.size());
            std::vector<std::uint32_t> patch{seed};
            bool touches = false;
            patchOf_[seed] = id;
            for (std::size_t i = 0; i < patch.size(); ++i)
                for (const std::uint32_t w : around_[patch[i]]) {
                    const bool isTorn = torn(patch[i], w);
                    touches = touches || isTorn;
                    if (!isTorn && patchOf_[w] == kNone) {
                        patchOf_[w] = id;
                        patch.push_back(w);
                    }
                }
            patches.push_back(std::move(patch));
            touched.push_back(touches);
        }
        std::vector<std::vector<std::uint32_t>> result;
        for (std::size_t i = 0; i < patches.size(); ++i)
            if (touched[i])
                result.push_back(std::move(patches[i]));
        std::stable_sort(result.begin(), result.end(),
                         [](const auto& a, const auto& b) { return a.size() < b.size(); });
        return result;
    }

    double distanceTo(std::uint32_t vertex, std::uint32_t triangle) const {
        const glm::uvec3& t = control_.triangles[triangle];
        const glm::dvec3& p = positions_[vertex];
        return glm::distance(
            p,
            sim::closestPointOnTriangle(p, control_.rest[t.x], control_.rest[t.y], control_.rest[t.z]).point);
    }

    /// The closest triangle around the nodes of the triangle of `from`; kNone if it lies too far out.
    std::uint32_t closestAround(std::uint32_t vertex, std::uint32_t from) const {
        const glm::uvec3& nodes = control_.triangles[triangles_[from]];
        std::uint32_t best = kNone;
        double bestDistance = distanceTo(vertex, triangles_[vertex]) + kRepairReach;
        for (int i = 0; i < 3; ++i)
            for (const std::uint32_t t : ofNode_[nodes[i]])
                if (const double d = distanceTo(vertex, t);
                    d < bestDistance || (d == bestDistance && t < best)) {
                    best = t;
                    bestDistance = d;
                }
        return best;
    }

    /// Binds a patch anew from outside, breadth first; keeps it only if fewer edges are torn then.
    bool floodInto(const std::vector<std::uint32_t>& patch) {
        if (patch.size() > positions_.size() / 2)
            return false; // the part that others are bound to
        const std::size_t before = tornAround(patch);
        std::vector<std::uint32_t> old;
        for (const std::uint32_t v : patch) {
            old.push_back(triangles_[v]);
            state_[v] = State::waiting;
        }
        std::vector<std::uint32_t> queue;
        const auto visit = [&](std::uint32_t v, std::uint32_t from) {
            if (const std::uint32_t t = closestAround(v, from); t != kNone)
                triangles_[v] = t;
            state_[v] = State::bound;
            queue.push_back(v);
        };
        for (const std::uint32_t v : patch)
            for (const std::uint32_t w : around_[v])
                if (state_[v] == State::waiting && state_[w] == State::outside && torn(v, w))
                    visit(v, w);
        for (std::size_t i = 0; i < queue.size(); ++i)
            for (const std::uint32_t w : around_[queue[i]])
                if (state_[w] == State::waiting)
                    visit(w, queue[i]);
        for (const std::uint32_t v : patch)
            state_[v] = State::outside;
        if (tornAround(patch) < before)
            return true;
        for (std::size_t i = 0; i < patch.size(); ++i)
            triangles_[patch[i]] = old[i];
        return false;
    }

    enum class State : std::uint8_t { outside, waiting, bound };

    const ControlNodes& control_;
    const std::vector<glm::dvec3>& positions_;
    std::vector<std::uint32_t>& triangles_;
    Edges edges_;
    Adjacency around_, ofNode_;
    std::vector<std::uint32_t> patchOf_;
    std::vector<State> state_ = std::vector<State>(positions_.size(), State::outside);
};

/// Unit normals averaged over neighbours, again and again until detail below the lattice's is gone.
std::vector<glm::dvec3> smoothed(const std::vector<glm::uvec3>& faces,
                                 const std::vector<glm::dvec3>& positions, std::vector<glm::dvec3> normals) {
    double length = 0;
    for (const glm::uvec3& f : faces)
        length += glm::distance(positions[f.x], positions[f.y]) / double(faces.size());
    const double rounds =
        length > 0 ? (kSmoothing / length) * (kSmoothing / length) : 0; // a random walk's reach squared
    for (int round = 0; round < int(std::clamp(rounds, 1.0, 50.0)); ++round) {
        std::vector<glm::dvec3> sums = normals;
        for (const glm::uvec3& f : faces)
            for (int i = 0; i < 3; ++i)
                sums[f[i]] += 0.5 * (normals[f[(i + 1) % 3]] + normals[f[(i + 2) % 3]]);
        for (std::size_t v = 0; v < sums.size(); ++v)
            if (glm::length(sums[v]) > 1e-3)
                normals[v] = glm::normalize(sums[v]);
    }
    return normals;
}

} // namespace

int diagonalStart(const ControlNodes& control, const glm::uvec3& nodes) {
    int start = 0;
    double longest = 0;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 edge = control.rest[nodes[(i + 1) % 3]] - control.rest[nodes[i]];
        const double length2 = glm::dot(edge, edge);
        if (length2 > longest) {
            longest = length2;
            start = i;
        }
    }
    return start;
}

void repairTornEdges(const ControlNodes& control, const std::vector<glm::uvec3>& faces,
                     const std::vector<glm::dvec3>& positions, TriangleChoice& choice) {
    const std::vector<std::uint32_t> before = choice.triangles;
    Repair repair(control, faces, positions, choice.triangles);
    choice.tornEdgesLeft = choice.tornEdgesFound = repair.tornEdges();
    for (int pass = 0; pass < kPasses && choice.tornEdgesLeft > 0; ++pass) {
        const bool single = repair.sweep();
        if (!repair.pass() && !single)
            break;
        choice.tornEdgesLeft = repair.tornEdges();
    }
    for (std::size_t v = 0; v < positions.size(); ++v)
        if (choice.triangles[v] != before[v]) {
            const glm::uvec3& t = control.triangles[choice.triangles[v]];
            choice.weights[v] = sim::closestPointOnTriangle(positions[v], control.rest[t.x],
                                                            control.rest[t.y], control.rest[t.z])
                                    .weights;
        }
}

TriangleChoice chooseTriangles(const ControlNodes& control, const std::vector<glm::uvec3>& faces,
                               const std::vector<glm::dvec3>& positions,
                               const std::vector<glm::dvec3>& normals) {
    const std::vector<glm::dvec3>& nodes = control.rest;
    const sim::TriangleTree tree(nodes, control.triangles);
    std::vector<glm::dvec3> facing;
    for (const glm::uvec3& t : control.triangles)
        facing.push_back(glm::normalize(glm::cross(nodes[t.y] - nodes[t.x], nodes[t.z] - nodes[t.x])));
    // A surface's own triangles are no staircase, and what follows may lie on either side of them, a vessel's
    // wall all around: the closest serves.
    const bool closestOfAll = control.normalsOfTriangles;
    const std::vector<glm::dvec3> outward = closestOfAll ? normals : smoothed(faces, positions, normals);

    TriangleChoice choice;
    choice.triangles.resize(positions.size());
    choice.weights.resize(positions.size());
    parallelFor(positions.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const glm::dvec3 start = positions[v] - kRayStart * outward[v];
            if (closestOfAll) {
                const auto closest = tree.closest(positions[v]);
                choice.triangles[v] = closest.triangle;
                choice.weights[v] = closest.weights;
                continue;
            }
            if (const auto hit = tree.firstHit(start, outward[v], kRayReach + kRayStart);
                hit && !hit->front) {
                choice.triangles[v] = hit->triangle;
                choice.weights[v] = hit->weights;
                continue;
            }
            const auto agrees = [&](std::uint32_t t) { return glm::dot(normals[v], facing[t]) >= kFacing; };
            auto closest = tree.closest(positions[v], kReach, agrees);
            if (!closest)
                closest = tree.closest(positions[v]);
            choice.triangles[v] = closest.triangle;
            choice.weights[v] = closest.weights;
        }
    });
    repairTornEdges(control, faces, positions, choice);
    return choice;
}

} // namespace serosa::render
