// See sim/implicit_levels.h.
#include "sim/implicit_levels.h"

#include "base/check.h"
#include "shaders/implicit_constants.h"
#include "shaders/shared_constants.h"

#include <algorithm>
#include <bit>
#include <unordered_map>

namespace serosa::sim {

namespace {

/// Indices of grid points, by coordinate.
class GridIndex {
public:
    /// Of a point; -1 where it was never added.
    std::int32_t at(const glm::ivec3& point) const {
        const auto found = index_.find(key(point));
        return found == index_.end() ? -1 : found->second;
    }
    void add(const glm::ivec3& point) { index_.emplace(key(point), std::int32_t(index_.size())); }

private:
    static std::uint64_t key(const glm::ivec3& point) { // 21 bits a coordinate, from -1 on
        return std::uint64_t(point.x + 1) | std::uint64_t(point.y + 1) << 21 |
               std::uint64_t(point.z + 1) << 42;
    }
    std::unordered_map<std::uint64_t, std::int32_t> index_;
};

bool before(const glm::ivec3& a, const glm::ivec3& b) { // z, y, x, as the lattice's nodes
    return a.z != b.z ? a.z < b.z : a.y != b.y ? a.y < b.y : a.x < b.x;
}

void sortUnique(std::vector<glm::ivec3>& points) {
    std::sort(points.begin(), points.end(), before);
    points.erase(std::unique(points.begin(), points.end()), points.end());
}

/// \param places of the cells' lowest corners
ImplicitLevel levelOf(std::vector<glm::ivec3> nodes, const std::vector<glm::ivec3>& places) {
    ImplicitLevel level;
    level.nodes = std::move(nodes);
    GridIndex index;
    for (const glm::ivec3& node : level.nodes)
        index.add(node);
    level.cellsAround.assign(level.nodes.size(), {-1, -1, -1, -1, -1, -1, -1, -1});
    for (const glm::ivec3& place : places) {
        std::array<std::int32_t, 8>& corners = level.cells.emplace_back();
        for (int c = 0; c < 8; ++c) {
            corners[std::size_t(c)] = index.at(place + cornerOffset(c));
            SEROSA_CHECK(corners[std::size_t(c)] >= 0, "a cell has its corners");
            // Seen from its corner c a cell lies in the opposite octant.
            level.cellsAround[std::size_t(corners[std::size_t(c)])][std::size_t(7 - c)] =
                std::int32_t(level.cells.size()) - 1;
        }
    }
    return level;
}

/// The points of the next level that a point takes its value from: both neighbours along each odd coordinate.
std::vector<glm::ivec3> coarserPoints(const glm::ivec3& point) {
    std::vector<glm::ivec3> points;
    for (int c = 0; c < 8; ++c) {
        const glm::ivec3 corner = cornerOffset(c), odd = point & 1;
        if ((corner & ~odd) == glm::ivec3(0))
            points.push_back((point >> 1) + corner);
    }
    return points;
}

/// Makes the level above `below`, whose cells lie at `places`, which become those of the new level.
ImplicitLevel coarserLevel(ImplicitLevel& below, std::vector<glm::ivec3>& places) {
    std::vector<glm::ivec3> nodes, cells;
    for (const glm::ivec3& node : below.nodes)
        for (const glm::ivec3& point : coarserPoints(node))
            nodes.push_back(point);
    for (const glm::ivec3& place : places)
        cells.push_back(place >> 1);
    sortUnique(nodes);
    sortUnique(cells);
    ImplicitLevel level = levelOf(std::move(nodes), cells);

    GridIndex nodeIndex, cellIndex;
    for (const glm::ivec3& node : level.nodes)
        nodeIndex.add(node);
    for (const glm::ivec3& cell : cells)
        cellIndex.add(cell);
    level.finer.resize(level.nodes.size());
    for (auto& finer : level.finer)
        finer.fill(-1);
    level.finerCells.assign(level.cells.size(), {-1, -1, -1, -1, -1, -1, -1, -1});
    below.coarser.assign(below.nodes.size(), {-1, -1, -1, -1, -1, -1, -1, -1});
    for (std::size_t i = 0; i < below.nodes.size(); ++i) {
        std::size_t found = 0;
        for (const glm::ivec3& point : coarserPoints(below.nodes[i])) {
            const std::int32_t node = nodeIndex.at(point);
            below.coarser[i][found++] = node;
            const glm::ivec3 place = below.nodes[i] - 2 * point + 1;
            level.finer[std::size_t(node)][std::size_t(place.x + 3 * (place.y + 3 * place.z))] =
                std::int32_t(i);
        }
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
        const glm::ivec3 octant = places[i] & 1;
        const std::int32_t cell = cellIndex.at(places[i] >> 1);
        level.finerCells[std::size_t(cell)][std::size_t(octant.x | octant.y << 1 | octant.z << 2)] =
            std::int32_t(i);
    }
    places = std::move(cells);
    return level;
}

} // namespace

double finerWeight(std::size_t place) {
    double weight = 1;
    for (std::size_t rest = place, axis = 0; axis < 3; ++axis, rest /= 3)
        weight *= rest % 3 == 1 ? 1 : 0.5;
    return weight;
}

glm::dvec3 octantGradient(int corner, int octant) {
    const auto near = [&](int axis) { return ((corner ^ octant) >> axis & 1) == 0 ? 0.75 : 0.25; };
    const auto sign = [&](int axis) { return (corner >> axis & 1) != 0 ? 1.0 : -1.0; };
    return {sign(0) * near(1) * near(2), sign(1) * near(2) * near(0), sign(2) * near(0) * near(1)};
}

std::vector<ImplicitLevel> implicitLevels(const Lattice& lattice) {
    std::vector<glm::ivec3> places;
    for (const LatticeCell& cell : lattice.cells)
        places.push_back(cell.grid);
    std::vector<ImplicitLevel> levels;
    levels.push_back(levelOf(lattice.nodes, places));
    do
        levels.push_back(coarserLevel(levels.back(), places));
    while (levels.back().nodes.size() > SRS_IMPLICIT_COARSEST);
    return levels;
}

} // namespace serosa::sim
