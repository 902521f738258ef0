#pragma once
// All that a run needs, made and checked before anything is written: scene, surface, lattice, context,
// solver, renderer.

#include "app/organ_setup.h"
#include "app/run.h"
#include "render/surface_renderer.h"
#include "sim/solver.h"
#include "sim/state_textures.h"

#include <memory>
#include <optional>
#include <vector>

namespace serosa::app {

struct RunParts {
    sim::Scene scene;
    OrganSurface surface;
    sim::Lattice lattice;
    sim::SolverSetup setup; // points at `lattice`
    sim::StableStep step;   // zero for a pose
    render::SurfaceBinding binding;
    std::unique_ptr<gpu::Context> context;      // dies after all GL objects below
    std::unique_ptr<sim::Solver> solver;        // null for a pose
    std::optional<sim::StateTextures> uploaded; // where the solver has no textures of its own
    std::optional<render::SurfaceRenderer> renderer;

    RunParts() = default;
    RunParts(const RunParts&) = delete;
    RunParts& operator=(const RunParts&) = delete;

    const sim::StateTextures& textures() const { return uploaded ? *uploaded : *solver->textures(); }
    /// The basis that deformed surfaces are mapped with: one-to-one draws no detailed surface of its own.
    sim::Mapping surfaceMapping() const;
};

/// Fills `parts`, which must not move afterwards. Errors: all bad input, no context.
Status prepareRun(const RunOptions& options, RunParts& parts);

/// Folder that a run writes into where --out is not given.
std::filesystem::path defaultOutputFolder(const RunOptions& options);

} // namespace serosa::app
