#pragma once
// What a snapshot keeps of an organ's levels of detail beside the level itself: what was decided, the detail
// that finer levels left, and what the drawing still lets fade.

#include "sim/lod.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace serosa::app {

struct RunParts;

struct LevelChoice {
    int wanted = 1;     // by the rule (app/level_rule.h), at the last look
    int calmer = 1;     // by the last look, whatever was made of it
    int changedAt = 0;  // frame of the last change of level, or of a cut that the drawing lets fade
    int looks = 0;      // in a row that asked for a coarser level than the active one
    int patience = 2;   // so many must
    int coarserAt = -1; // frame of the last change to a coarser one by the rule; -1: none
};

struct LevelState {
    LevelChoice choice;
    std::vector<sim::LodDetail> details; // OrganLevels::details
    std::vector<float> blend;            // SurfaceRenderer::blend

    /// Empty for an organ of one level whose drawing lets nothing fade.
    std::string bytes() const;
    /// Nothing where the bytes do not belong to the organ. \param frame of the snapshot
    static std::optional<LevelState> parse(std::string_view bytes, const RunParts& parts, std::size_t organ,
                                           int frame);
};

} // namespace serosa::app
