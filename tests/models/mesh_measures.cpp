// Brute and plain measures; a uniform grid finds the pairs of near faces.
#include "mesh_measures.h"

#include "models/phantom.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

namespace serosa::test {
namespace {

using V = glm::dvec3;

std::array<V, 3> corners(const sim::TriangleMesh& m, const glm::uvec3& f) {
    return {m.positions[f.x], m.positions[f.y], m.positions[f.z]};
}

/// Does the segment p-q meet the closed triangle t?
bool meets(const V& p, const V& q, const std::array<V, 3>& t) {
    const V e1 = t[1] - t[0], e2 = t[2] - t[0], d = q - p;
    const V h = glm::cross(d, e2);
    const double det = glm::dot(e1, h);
    const double scale = glm::length(e1) * glm::length(e2) * glm::length(d);
    if (std::abs(det) < 1e-12 * scale)
        return false; // parallel: the other edges of the pair tell
    constexpr double e = 1e-9;
    const V s = p - t[0];
    const double u = glm::dot(s, h) / det;
    const V c = glm::cross(s, e1);
    const double v = glm::dot(d, c) / det, at = glm::dot(e2, c) / det;
    return u >= -e && v >= -e && u + v <= 1 + e && at >= -e && at <= 1 + e;
}

bool touch(const sim::TriangleMesh& m, const glm::uvec3& f, const glm::uvec3& g) {
    std::vector<unsigned> shared;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (f[i] == g[j])
                shared.push_back(f[i]);
    const auto a = corners(m, f), b = corners(m, g);
    if (shared.size() == 3)
        return true;
    if (shared.size() == 2) {
        const V edge = m.positions[shared[1]] - m.positions[shared[0]];
        const auto away = [&](const glm::uvec3& t) {
            for (int i = 0; i < 3; ++i)
                if (t[i] != shared[0] && t[i] != shared[1]) {
                    const V d = m.positions[t[i]] - m.positions[shared[0]];
                    return glm::normalize(d - edge * (glm::dot(d, edge) / glm::dot(edge, edge)));
                }
            return V(0);
        };
        return glm::dot(away(f), away(g)) > std::cos(glm::radians(5.0));
    }
    for (int i = 0; i < 3; ++i) {
        const unsigned p = f[i], q = f[(i + 1) % 3], r = g[i], s = g[(i + 1) % 3];
        const auto has = [&](unsigned v) { return !shared.empty() && shared[0] == v; };
        if (!has(p) && !has(q) && meets(m.positions[p], m.positions[q], b))
            return true;
        if (!has(r) && !has(s) && meets(m.positions[r], m.positions[s], a))
            return true;
    }
    return false;
}

} // namespace

std::string manifoldFault(const sim::TriangleMesh& mesh) {
    std::map<std::pair<unsigned, unsigned>, int> halfEdges;
    std::vector<std::map<unsigned, unsigned>> link(mesh.positions.size()); // around v: from -> to
    for (const auto& f : mesh.faces)
        for (int i = 0; i < 3; ++i) {
            const unsigned a = f[i], b = f[(i + 1) % 3], c = f[(i + 2) % 3];
            if (a >= mesh.positions.size() || a == b)
                return "bad index or repeated corner";
            if (++halfEdges[{a, b}] > 1)
                return "two faces use the edge " + std::to_string(a) + "-" + std::to_string(b) + " alike";
            link[a][b] = c;
        }
    for (const auto& [edge, count] : halfEdges)
        if (!halfEdges.count({edge.second, edge.first}))
            return "open edge " + std::to_string(edge.first) + "-" + std::to_string(edge.second);
    for (std::size_t v = 0; v < link.size(); ++v) {
        if (link[v].empty())
            return "vertex " + std::to_string(v) + " is unused";
        std::size_t steps = 0;
        const unsigned start = link[v].begin()->first;
        unsigned at = start;
        do {
            at = link[v][at];
            ++steps;
        } while (at != start && steps <= link[v].size());
        if (steps != link[v].size())
            return "the faces of vertex " + std::to_string(v) + " are not one fan";
    }
    return "";
}

std::vector<Shell> shellsOf(const sim::TriangleMesh& mesh) {
    std::vector<unsigned> parent(mesh.positions.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](unsigned v) {
        while (parent[v] != v)
            v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const auto& f : mesh.faces) {
        parent[root(f.x)] = root(f.y);
        parent[root(f.y)] = root(f.z);
    }
    std::map<unsigned, Shell> shells;
    std::map<unsigned, std::size_t> vertices;
    for (unsigned v = 0; v < parent.size(); ++v)
        ++vertices[root(v)];
    for (const auto& f : mesh.faces) {
        const auto t = corners(mesh, f);
        Shell& s = shells[root(f.x)];
        ++s.faces;
        s.volume += glm::dot(t[0], glm::cross(t[1], t[2])) / 6;
    }
    std::vector<Shell> out;
    for (auto& [key, s] : shells) {
        s.genus = (2 - static_cast<int>(vertices[key]) + static_cast<int>(s.faces / 2)) / 2;
        out.push_back(s);
    }
    std::sort(out.begin(), out.end(), [](const Shell& a, const Shell& b) { return a.volume > b.volume; });
    return out;
}

double leastAngle(const sim::TriangleMesh& mesh) {
    double least = 180;
    for (const auto& f : mesh.faces) {
        const auto t = corners(mesh, f);
        for (std::size_t i = 0; i < 3; ++i) {
            const V u = t[(i + 1) % 3] - t[i], v = t[(i + 2) % 3] - t[i];
            least = std::min(least, glm::degrees(std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v))));
        }
    }
    return least;
}

std::size_t contacts(const sim::TriangleMesh& mesh) {
    double cell = 0;
    V low(1e300);
    for (const V& p : mesh.positions)
        low = glm::min(low, p);
    for (const auto& f : mesh.faces) {
        const auto t = corners(mesh, f);
        cell = std::max({cell, glm::length(t[0] - t[1]), glm::length(t[1] - t[2])});
    }
    const auto cellOf = [&](const V& p) { return glm::ivec3((p - low) / cell); };
    const auto key = [](const glm::ivec3& c) {
        return (static_cast<std::uint64_t>(c.x) << 40) | (static_cast<std::uint64_t>(c.y) << 20) |
               static_cast<std::uint64_t>(c.z);
    };
    std::map<std::uint64_t, std::vector<std::uint32_t>> grid;
    std::vector<std::pair<V, V>> bounds;
    for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) {
        const auto t = corners(mesh, mesh.faces[i]);
        const V lo = glm::min(glm::min(t[0], t[1]), t[2]), hi = glm::max(glm::max(t[0], t[1]), t[2]);
        bounds.emplace_back(lo, hi);
        const glm::ivec3 a = cellOf(lo), b = cellOf(hi);
        for (int x = a.x; x <= b.x; ++x)
            for (int y = a.y; y <= b.y; ++y)
                for (int z = a.z; z <= b.z; ++z)
                    grid[key({x, y, z})].push_back(i);
    }
    std::set<std::pair<std::uint32_t, std::uint32_t>> found;
    for (const auto& [k, list] : grid)
        for (std::size_t i = 0; i < list.size(); ++i)
            for (std::size_t j = i + 1; j < list.size(); ++j) {
                const auto &a = bounds[list[i]], &b = bounds[list[j]];
                if (glm::any(glm::greaterThan(a.first, b.second + 1e-9)) ||
                    glm::any(glm::greaterThan(b.first, a.second + 1e-9)))
                    continue;
                if (touch(mesh, mesh.faces[list[i]], mesh.faces[list[j]]))
                    found.insert({list[i], list[j]});
            }
    return found.size();
}

std::optional<double> rayHit(const sim::TriangleMesh& mesh, const V& from, const V& direction,
                             double beyond) {
    std::optional<double> nearest;
    for (const auto& f : mesh.faces) {
        const auto t = corners(mesh, f);
        const V e1 = t[1] - t[0], e2 = t[2] - t[0], h = glm::cross(direction, e2);
        const double det = glm::dot(e1, h);
        if (det == 0)
            continue;
        const V s = from - t[0], c = glm::cross(s, e1);
        const double u = glm::dot(s, h) / det, v = glm::dot(direction, c) / det, at = glm::dot(e2, c) / det;
        if (u >= 0 && v >= 0 && u + v <= 1 && at > beyond && (!nearest || at < *nearest))
            nearest = at;
    }
    return nearest;
}

double volumeOf(const sim::TriangleMesh& mesh) {
    double sum = 0;
    for (const auto& f : mesh.faces) {
        const auto t = corners(mesh, f);
        sum += glm::dot(t[0], glm::cross(t[1], t[2])) / 6;
    }
    return sum;
}

Extents extentsOf(const sim::TriangleMesh& mesh) {
    Extents box{V(1e300), V(-1e300)};
    for (const V& p : mesh.positions) {
        box.lowest = glm::min(box.lowest, p);
        box.highest = glm::max(box.highest, p);
    }
    return box;
}

const sim::TriangleMesh& defaultPhantom(const std::string& name) {
    static std::map<std::string, sim::TriangleMesh> made;
    if (const auto found = made.find(name); found != made.end())
        return found->second;
    std::size_t faces = 0;
    for (const models::PhantomInfo& info : models::phantoms())
        if (info.name == name)
            faces = info.defaultFaces;
    return made.emplace(name, models::makePhantom(name, faces).value()).first->second;
}

} // namespace serosa::test
