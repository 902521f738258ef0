// See sim/cpu_layout.h.
#include "sim/cpu_layout.h"

#include "base/check.h"

namespace serosa::sim {

namespace {

/// A piece of a grid row, stored side by side.
struct Run {
    glm::ivec3 start{0};    // grid coordinate of its first node
    std::int32_t slot = 0;  // of that node
    std::int32_t nodes = 0; // gaps included
};

/// Two nodes that any window of lanes + 2 slots sees together are in one run.
std::vector<Run> runsOf(const Lattice& lattice, std::int32_t lanes) {
    std::vector<Run> runs;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        const glm::ivec3 grid = lattice.nodes[node];
        if (!runs.empty()) {
            Run& last = runs.back();
            const bool sameRow = grid.y == last.start.y && grid.z == last.start.z;
            if (sameRow && grid.x - (last.start.x + last.nodes) <= lanes) {
                last.nodes = grid.x - last.start.x + 1;
                continue;
            }
        }
        runs.push_back({grid, 0, 1});
    }
    return runs;
}

} // namespace

CpuLayout makeCpuLayout(const Lattice& lattice, std::size_t laneCount) {
    SEROSA_CHECK(laneCount >= 1, "at least one lane");
    const auto lanes = std::int32_t(laneCount);
    CpuLayout layout;
    layout.lanes = laneCount;
    layout.first = 2 * laneCount; // a multiple of the lanes keeps the blocks aligned
    std::vector<Run> runs = runsOf(lattice, lanes);
    auto next = std::int32_t(layout.first);
    for (Run& run : runs) {
        run.slot = next;
        next += (run.nodes + lanes - 1) / lanes * lanes;
    }
    layout.slotOfNode.resize(lattice.nodeCount());
    for (const Run& run : runs)
        for (std::int32_t i = 0; i < run.nodes; ++i)
            if (const std::int64_t node = lattice.nodeAt(run.start + glm::ivec3(i, 0, 0)); node >= 0)
                layout.slotOfNode[std::size_t(node)] = run.slot + i;

    for (const Run& run : runs)
        for (std::int32_t i = 0; i < run.nodes; i += lanes) {
            std::array<std::int32_t, 8>& offsets = layout.rows.emplace_back();
            for (std::size_t row = 0; row < kCpuRows.size(); ++row) {
                offsets[row] = 0;
                for (std::int32_t dx = -1; dx <= lanes; ++dx) {
                    const std::int64_t other =
                        lattice.nodeAt(run.start + glm::ivec3(i + dx, kCpuRows[row].x, kCpuRows[row].y));
                    if (other < 0)
                        continue;
                    offsets[row] = layout.slotOfNode[std::size_t(other)] - dx - (run.slot + i);
                    break;
                }
            }
        }
    return layout;
}

} // namespace serosa::sim
