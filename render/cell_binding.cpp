// See render/cell_binding.h.
#include "render/cell_binding.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace serosa::render {

namespace {

using Corners = std::array<std::uint32_t, 8>;

bool before(const glm::ivec3& a, const glm::ivec3& b) {
    return a.z != b.z ? a.z < b.z : a.y != b.y ? a.y < b.y : a.x < b.x;
}

/// Is there material at this grid coordinate? Cells are sorted.
bool isCell(const sim::Lattice& lattice, const glm::ivec3& grid) {
    const auto at =
        std::lower_bound(lattice.cells.begin(), lattice.cells.end(), grid,
                         [](const sim::LatticeCell& c, const glm::ivec3& g) { return before(c.grid, g); });
    return at != lattice.cells.end() && at->grid == grid;
}

double distance2(const glm::ivec3& grid, const glm::dvec3& p) {
    const glm::dvec3 away = p - glm::clamp(p, glm::dvec3(grid), glm::dvec3(grid + 1));
    return glm::dot(away, away);
}

/// The cell that holds p, or the closest one: by rings around it.
glm::ivec3 closestCell(const sim::Lattice& lattice, const glm::dvec3& p) {
    const glm::ivec3 own(glm::floor(p));
    if (isCell(lattice, own))
        return own;
    glm::ivec3 best = lattice.cells.front().grid;
    double nearest = distance2(best, p);
    for (int reach = 1; nearest > double(reach - 1) * (reach - 1); ++reach)
        for (int z = -reach; z <= reach; ++z)
            for (int y = -reach; y <= reach; ++y)
                for (int x = -reach; x <= reach; ++x) {
                    const glm::ivec3 grid = own + glm::ivec3(x, y, z);
                    if (std::max({std::abs(x), std::abs(y), std::abs(z)}) == reach &&
                        distance2(grid, p) < nearest && isCell(lattice, grid)) {
                        nearest = distance2(grid, p);
                        best = grid;
                    }
                }
    return best;
}

} // namespace

CellBinding bindToCells(const sim::Lattice& lattice, const std::vector<glm::dvec3>& positions) {
    CellBinding binding;
    std::map<std::array<int, 3>, std::uint32_t> known;
    for (const glm::dvec3& position : positions) {
        const glm::dvec3 p = position + glm::dvec3(lattice.centre);
        const glm::ivec3 grid = closestCell(lattice, p);
        const auto [it, fresh] =
            known.try_emplace({grid.x, grid.y, grid.z}, std::uint32_t(binding.corners.size()));
        if (fresh) {
            Corners corners{};
            for (int c = 0; c < 8; ++c)
                corners[std::size_t(c)] = std::uint32_t(lattice.nodeAt(grid + sim::cornerOffset(c)));
            binding.corners.push_back(corners);
        }
        binding.vertices.push_back({it->second, glm::vec3(p - glm::dvec3(grid))});
    }
    return binding;
}

} // namespace serosa::render
