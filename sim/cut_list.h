#pragma once
// The strokes of a session, in order: what was cut, and before which step. Cuts go through the list, so that
// a session can be replayed from rest with the same bytes, and undone stroke by stroke.

#include "base/result.h"
#include "sim/solver.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace serosa::sim {

/// The nodes of which a stroke cleared something, from one word a node.
CutLayer cutLayerOf(const std::vector<std::uint32_t>& words);

class CutList {
public:
    struct Entry {
        std::int64_t step = 0; // steps that were taken before the cut
        Stroke stroke;
    };

    /// Cuts and notes it. \param step steps taken so far. Errors: of Solver::cut.
    Status cut(Solver& solver, std::int64_t step, const Stroke& stroke);
    /// Gives back what the last stroke (with the parts that continue it) cut, and forgets it. False: none
    /// left.
    bool undo(Solver& solver);
    /// From a solver at rest with nothing cut: steps and cuts until `step` steps are taken. Errors: of
    /// Solver::cut.
    Status replay(Solver& solver, std::int64_t step) const;
    void clear() { entries_.clear(); }
    /// The list of a state that was set, with its layers (Solver::setCutLayers).
    void assign(std::vector<Entry> entries) { entries_ = std::move(entries); }

    const std::vector<Entry>& entries() const { return entries_; }
    /// Strokes; the parts of one count together.
    std::size_t strokes() const;

private:
    std::vector<Entry> entries_;
};

} // namespace serosa::sim
