#pragma once
// What can be said of tools, bodies and organs before the first step: who begins inside of whom, and tools
// that would hold the same tissue. Shared by run, view and the scene commands.

#include "base/result.h"
#include "sim/lattice.h"
#include "sim/scene.h"

#include <string>
#include <vector>

namespace serosa::app {

/// An organ that is simulated.
struct PlacedOrgan {
    const sim::Organ* organ = nullptr;        // not null
    const sim::Lattice* lattice = nullptr;    // not null
    const std::vector<bool>* fixed = nullptr; // one flag a node; not null
};

/// Two grasps that want the same nodes, as far as it is known at rest: those that the first one took hold of
/// and carries are inside of the second one as that closes. The first would keep them. The error names the
/// line of the second.
Status checkGrasps(const sim::Scene& scene, const std::vector<PlacedOrgan>& organs);

/// A line for each pushing tool and body that begins inside of an organ, for a grasp that finds nothing to
/// hold where it closes, and for an organ that will fall.
std::vector<std::string> contactNotes(const sim::Scene& scene, const std::vector<PlacedOrgan>& organs);

} // namespace serosa::app
