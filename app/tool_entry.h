#pragma once
// Pushing tools that begin inside of an organ. Pushed out from within, tissue would close around the tool, or
// be thrown: so the tool begins outside, where it is clear of all organs, and comes to its place in a
// straight line, slowly. What it meets on its way it pushes as any tool does.

#include "app/contact_notes.h"
#include "sim/tool.h"

#include <optional>
#include <string>
#include <vector>

namespace serosa::app {

/// Where a tool begins instead of its first pose, and when it has come to where its keys have it.
struct ToolEntry {
    glm::dvec3 offset{0}; // m, world: from where it is meant to be at the start
    double time = 0;      // s: from then on it is where its keys say
    double deep = 0;      // m: that it would begin inside
    std::string organ;    // of which
};

/// How deep an organ begins inside of a shape, m; negative where it does not.
double depthInside(const sim::RigidShape& shape, const sim::RigidPose& pose, const sim::Lattice& lattice);

/// Nothing for a tool that begins outside, that does not push, or that a hand moves. The shortest way out in
/// one of 26 directions.
std::optional<ToolEntry> toolEntry(const sim::Tool& tool, const std::vector<PlacedOrgan>& organs);

/// "probe begins inside of liver, 12 mm deep: it comes in from outside, until 0.4 s; let it begin outside"
std::string entryNote(const sim::Tool& tool, const ToolEntry& entry);

/// Changes the keys of the scene's tools. Returns a note for each that it changed.
std::vector<std::string> bringToolsIn(sim::Scene& scene, const std::vector<PlacedOrgan>& organs);

} // namespace serosa::app
