#pragma once
// Organs of a scene that touch each other or themselves, or that threads tie: they take the same steps
// together (sim/organ_group.h). Those that are coupled with nothing step on their own, as ever.

#include "app/contact_notes.h"
#include "base/result.h"
#include "render/thread_renderer.h"
#include "sim/organ_group.h"
#include "sim/scene.h"
#include "sim/setup_traits.h"

#include <memory>
#include <string>
#include <vector>

namespace serosa::app {

struct RunParts;

struct CoupledOrgans {
    std::vector<std::size_t> organs;        // numbers in the scene, ascending; empty: none is coupled
    std::vector<sim::TiedThread> threads;   // between places in `organs`
    std::unique_ptr<sim::OrganGroup> group; // null where none is coupled, or no solvers are made yet

    /// Place in `organs` of an organ of the scene, or -1.
    int placeOf(std::size_t organ) const;
};

/// Numbers of the scene's organs that are coupled, ascending.
std::vector<std::size_t> coupledOrgans(const sim::Scene& scene);

/// The scene's threads on its lattices, between places in coupledOrgans. Errors, with the line: an end
/// further than a spacing outside of its organ; both ends on fixed nodes.
/// \param organs all that are simulated
Result<std::vector<sim::TiedThread>> tieThreads(const sim::Scene& scene,
                                                const std::vector<PlacedOrgan>& organs);

/// The one step for organs that step together: as many a frame as the one that needs most.
/// \param steps of these organs; not null
void shareStep(const std::vector<sim::StableStep*>& steps, double frameTime);

/// Once lattices and steps are there: who is coupled, in one step, and by which threads. Errors: as
/// tieThreads; implicit steps.
Status prepareCoupling(RunParts& parts);
/// Once the solvers are there. Errors: of the shaders.
Status makeGroup(RunParts& parts);

/// A line for each pair of organs that touch and begin inside of each other.
std::vector<std::string> couplingNotes(const sim::Scene& scene, const std::vector<PlacedOrgan>& organs);

/// The threads that hold at a time (s), between the organs that are drawn. \param states one a thread
std::vector<render::DrawnThread> drawnThreads(const RunParts& parts,
                                              const std::vector<sim::ThreadState>& states, double time);

/// What an organ's motion owes to its coupling, for snapshots; none where it is not coupled.
std::vector<sim::Trait> couplingTraits(const sim::Scene& scene, std::size_t organ);

} // namespace serosa::app
