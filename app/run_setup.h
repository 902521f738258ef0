#pragma once
// All that a run needs, made and checked before anything is written: scene, surface, lattice, context,
// solver, renderer.

#include "app/contact_notes.h"
#include "app/hands.h"
#include "app/implicit_organs.h"
#include "app/organ_coupling.h"
#include "app/organ_levels.h"
#include "app/organ_setup.h"
#include "app/run.h"
#include "render/surface_passes.h"
#include "render/surface_renderer.h"
#include "sim/solver.h"
#include "sim/state_textures.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace serosa::app {

/// One organ of a run.
struct OrganParts {
    OrganSurface surface;
    sim::Lattice lattice;
    sim::SolverSetup setup; // points at `lattice`
    sim::StableStep step;   // zero for a pose
    render::SurfaceBinding binding;
    std::optional<render::SurfaceDetail> detail; // its texture, if its look asks for one
    std::unique_ptr<sim::Solver> solver;         // null for a pose
    std::optional<sim::StateTextures> uploaded;  // where the solver has no textures of its own

    OrganParts() = default;
    OrganParts(const OrganParts&) = delete;
    OrganParts& operator=(const OrganParts&) = delete;

    const sim::StateTextures& textures() const { return uploaded ? *uploaded : *solver->textures(); }
};

struct RunParts {
    sim::Scene scene;
    std::unique_ptr<gpu::Context> context;           // dies after all GL objects below
    std::vector<std::unique_ptr<OrganParts>> organs; // one an organ of the scene, in its order
    std::vector<OrganLevels> levels;                 // one an organ: its levels of detail
    CoupledOrgans coupled;                           // those that step together
    std::optional<render::SurfaceRenderer> renderer; // draws them all, in the same order
    ImplicitOrgans implicit;                         // where look.show asks for it
    std::vector<std::string> toolNotes; // of tools that would have begun inside (app/tool_entry.h)
    std::optional<Hands> hands;         // where they were asked for; their tools are the scene's last ones
    std::size_t timesLeftOut =
        0; // of surfaces_at, sheet_at and the like: after the last of the frames that were asked for

    RunParts() = default;
    RunParts(const RunParts&) = delete;
    RunParts& operator=(const RunParts&) = delete;

    /// Those that are simulated.
    std::vector<PlacedOrgan> placedOrgans() const;
    /// What the renderer draws from, one an organ.
    std::vector<const sim::StateTextures*> textures() const;
    /// Bounds of all organs at rest, m.
    glm::dvec3 lowest() const;
    glm::dvec3 highest() const;
    /// The basis that deformed surfaces are mapped with: one-to-one draws no detailed surface of its own.
    sim::Mapping surfaceMapping() const;
};

/// Makes the context once all that needs none is checked.
using ContextMaker = std::function<Result<std::unique_ptr<gpu::Context>>(const sim::Scene&)>;

/// Fills `parts`. Errors: all bad input, no context.
/// \param makeContext empty: what options.gl says
Status prepareRun(const RunOptions& options, RunParts& parts, const ContextMaker& makeContext = {});

// Of one organ: what prepareRun does, for further levels of detail.

/// Lattice, fixed nodes and time step: all that needs no context.
Status prepareOrgan(const sim::Scene& scene, const sim::Organ& organ, OrganParts& parts);
/// \param pose it has no solver, but textures
Status makeOrganSolver(const RunOptions& options, bool pose, OrganParts& parts);

/// Folder that a run writes into where --out is not given.
std::filesystem::path defaultOutputFolder(const RunOptions& options);

} // namespace serosa::app
