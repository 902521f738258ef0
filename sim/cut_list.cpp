// See sim/cut_list.h, and what every solver does to cut unless it has a way of its own.
#include "sim/cut_list.h"

#include "base/check.h"
#include "sim/pieces.h"

#include <algorithm>

namespace serosa::sim {

Status CutList::cut(Solver& solver, std::int64_t step, const Stroke& stroke) {
    SEROSA_TRY(solver.cut(stroke));
    entries_.push_back({step, stroke});
    entries_.back().stroke.continues = stroke.continues && entries_.size() > 1;
    return {};
}

bool CutList::undo(Solver& solver) {
    if (entries_.empty() || !solver.undoCut())
        return false;
    while (entries_.back().stroke.continues)
        entries_.pop_back();
    entries_.pop_back();
    return true;
}

Status CutList::replay(Solver& solver, std::int64_t step) const {
    std::int64_t taken = 0;
    for (const Entry& entry : entries_) {
        if (entry.step > step)
            break;
        solver.advance(int(entry.step - taken));
        taken = entry.step;
        SEROSA_TRY(solver.cut(entry.stroke));
    }
    solver.advance(int(step - taken));
    return {};
}

std::size_t CutList::strokes() const {
    return std::size_t(std::count_if(entries_.begin(), entries_.end(),
                                     [](const Entry& entry) { return !entry.stroke.continues; }));
}

CutLayer cutLayerOf(const std::vector<std::uint32_t>& words) {
    CutLayer layer;
    for (std::size_t node = 0; node < words.size(); ++node)
        if (words[node] != 0)
            layer.push_back({std::uint32_t(node), words[node]});
    return layer;
}

Status Solver::cut(const Stroke& stroke) {
    LatticeState now = state();
    if (now.connections.empty())
        now.connections = lattice().connections;
    const std::vector<std::uint32_t> cleared =
        cutConnections(lattice(), now.positions, toLattice(stroke, lattice()), now.connections);
    if (!stroke.continues || cutLayers_.empty())
        cutLayers_.emplace_back(cleared.size(), 0u);
    for (std::size_t node = 0; node < cleared.size(); ++node)
        cutLayers_.back()[node] |= cleared[node];
    setState(now);
    return {};
}

bool Solver::undoCut() {
    if (cutLayers_.empty())
        return false;
    LatticeState now = state();
    if (now.connections.empty())
        now.connections = lattice().connections;
    for (std::size_t node = 0; node < now.connections.size(); ++node)
        now.connections[node] |= cutLayers_.back()[node];
    if (now.connections == lattice().connections)
        now.connections.clear();
    cutLayers_.pop_back();
    setState(now);
    return true;
}

void Solver::forgetCuts() {
    cutLayers_.clear();
}

std::vector<CutLayer> Solver::cutLayers() const {
    std::vector<CutLayer> layers;
    for (const std::vector<std::uint32_t>& words : cutLayers_)
        layers.push_back(cutLayerOf(words));
    return layers;
}

Status Solver::setCutLayers(const std::vector<CutLayer>& layers) {
    cutLayers_.assign(layers.size(), std::vector<std::uint32_t>(lattice().nodeCount(), 0u));
    for (std::size_t i = 0; i < layers.size(); ++i)
        for (const ClearedBits& cleared : layers[i])
            cutLayers_[i][cleared.node] = cleared.bits;
    return {};
}

Result<std::vector<std::uint32_t>> Solver::pieces() const {
    const LatticeState now = state();
    return pieceLabels(lattice(), now.connections.empty() ? lattice().connections : now.connections);
}

} // namespace serosa::sim
