// See app/verify/plane_cut.h. Each face is clipped to y >= height; edges that have lost their twin bound the
// openings.
#include "app/verify/plane_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace serosa::app {

namespace {

using sim::TriangleMesh;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

constexpr double kSnap = 1.0 / 6; // of a vertex's shortest edge

void snapToPlane(TriangleMesh& mesh, double height) {
    std::vector<double> shortest(mesh.positions.size(), std::numeric_limits<double>::infinity());
    for (const glm::uvec3& face : mesh.faces)
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = face[i], b = face[(i + 1) % 3];
            const double length = glm::distance(mesh.positions[a], mesh.positions[b]);
            shortest[a] = std::min(shortest[a], length);
            shortest[b] = std::min(shortest[b], length);
        }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        if (std::abs(mesh.positions[v].y - height) < kSnap * shortest[v])
            mesh.positions[v].y = height;
}

/// Faces of the part above, over the vertices of `whole` and new ones behind them.
class Clipper {
public:
    std::vector<glm::dvec3> positions;
    std::vector<glm::uvec3> faces;

    Clipper(const TriangleMesh& whole, double height) : positions(whole.positions), height_(height) {
        for (const glm::uvec3& face : whole.faces)
            clip(face);
    }

private:
    bool strictlyAbove(std::uint32_t v) const { return positions[v].y > height_; }
    bool strictlyBelow(std::uint32_t v) const { return positions[v].y < height_; }

    void clip(const glm::uvec3& face) {
        std::vector<std::uint32_t> kept;
        bool anyAbove = false;
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = face[i], b = face[(i + 1) % 3];
            anyAbove = anyAbove || strictlyAbove(a);
            if (!strictlyBelow(a))
                kept.push_back(a);
            if ((strictlyAbove(a) && strictlyBelow(b)) || (strictlyBelow(a) && strictlyAbove(b)))
                kept.push_back(crossing(a, b));
        }
        if (!anyAbove)
            return;
        if (kept.size() == 3) {
            faces.emplace_back(kept[0], kept[1], kept[2]);
            return;
        }
        const auto length = [&](int i, int j) {
            return glm::distance(positions[kept[std::size_t(i)]], positions[kept[std::size_t(j)]]);
        };
        if (length(0, 2) <= length(1, 3)) {
            faces.emplace_back(kept[0], kept[1], kept[2]);
            faces.emplace_back(kept[0], kept[2], kept[3]);
        } else {
            faces.emplace_back(kept[1], kept[2], kept[3]);
            faces.emplace_back(kept[1], kept[3], kept[0]);
        }
    }

    /// Where an edge passes the plane: the same vertex from either face.
    std::uint32_t crossing(std::uint32_t a, std::uint32_t b) {
        const Edge edge = std::minmax(a, b);
        const auto [found, isNew] = crossings_.try_emplace(edge, std::uint32_t(positions.size()));
        if (isNew) {
            const glm::dvec3 p = positions[edge.first], q = positions[edge.second];
            glm::dvec3 middle = glm::mix(p, q, (height_ - p.y) / (q.y - p.y));
            middle.y = height_;
            positions.push_back(middle);
        }
        return found->second;
    }

    double height_;
    std::map<Edge, std::uint32_t> crossings_;
};

Result<std::vector<std::vector<std::uint32_t>>> openings(const std::vector<glm::uvec3>& faces) {
    std::map<Edge, int> edges;
    for (const glm::uvec3& face : faces)
        for (int i = 0; i < 3; ++i)
            ++edges[{face[i], face[(i + 1) % 3]}];
    std::map<std::uint32_t, std::uint32_t> next;
    for (const auto& [edge, count] : edges)
        if (!edges.contains({edge.second, edge.first}) && !next.emplace(edge.first, edge.second).second)
            return Error{"the plane touches the surface in a point: take another height"};
    std::vector<std::vector<std::uint32_t>> loops;
    while (!next.empty()) {
        std::vector<std::uint32_t> loop;
        for (auto at = next.begin(); at != next.end(); at = next.find(loop.back())) {
            if (loop.empty())
                loop.push_back(at->first);
            loop.push_back(at->second);
            next.erase(at);
        }
        SEROSA_CHECK(loop.front() == loop.back(), "edges without a twin form loops");
        loop.pop_back();
        loops.push_back(std::move(loop));
    }
    return loops;
}

} // namespace

double PlaneCut::volume() const {
    double sum = 0; // of pyramids from a point of the plane, so that the openings have none
    const glm::dvec3 tip(0, height, 0);
    for (const glm::uvec3& face : above.faces) {
        const glm::dvec3 a = above.positions[face.x] - tip, b = above.positions[face.y] - tip,
                         c = above.positions[face.z] - tip;
        sum += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return sum;
}

Result<PlaneCut> cutAbove(const TriangleMesh& closed, double height) {
    if (closed.lowest().y >= height || closed.highest().y <= height)
        return Error{"the plane misses the surface: take a height between its lowest and highest point"};
    PlaneCut cut;
    cut.whole = closed;
    cut.height = height;
    snapToPlane(cut.whole, height);
    const Clipper clipper(cut.whole, height);
    SEROSA_ASSIGN(cut.loops, openings(clipper.faces));
    std::vector<std::int64_t> renumbered(clipper.positions.size(), -1);
    const auto use = [&](std::uint32_t v) {
        if (renumbered[v] < 0) {
            renumbered[v] = std::int64_t(cut.above.positions.size());
            cut.above.positions.push_back(clipper.positions[v]);
            cut.sources.push_back(v < closed.positions.size() ? std::int64_t(v) : -1);
        }
        return std::uint32_t(renumbered[v]);
    };
    for (const glm::uvec3& face : clipper.faces) {
        const std::uint32_t a = use(face.x), b = use(face.y), c = use(face.z);
        cut.above.faces.emplace_back(a, b, c);
    }
    for (std::vector<std::uint32_t>& loop : cut.loops)
        for (std::uint32_t& v : loop)
            v = use(v);
    return cut;
}

} // namespace serosa::app
