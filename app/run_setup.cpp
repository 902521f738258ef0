// See app/run_setup.h.

#include "app/run_setup.h"

#include "app/pose.h"

#include <algorithm>
#include <cmath>

namespace serosa::app {

namespace {

Status applyOverrides(const RunOptions& options, sim::Scene& scene) {
    sim::Organ& organ = scene.organs.front();
    if (options.frames)
        scene.duration = *options.frames / scene.frameRate;
    if (options.width)
        scene.output.width = *options.width;
    if (options.height)
        scene.output.height = *options.height;
    if (options.mapping)
        scene.look.mapping = *options.mapping;
    if (options.nodes) {
        organ.nodes = *options.nodes;
        organ.spacing = 0;
    }
    if (options.spacing)
        organ.spacing = *options.spacing;
    if (const auto problem = sim::findSceneProblem(scene))
        return Error{(problem->table.empty() ? "" : problem->table + ".") + problem->key + ": " +
                     problem->message};
    return {};
}

Status readSceneAndSurface(const RunOptions& options, RunParts& parts) {
    if (!options.scene.empty()) {
        SEROSA_ASSIGN(parts.scene, sim::readScene(options.scene));
        SEROSA_ASSIGN(parts.surface, loadSurface(parts.scene.organs.front(), options.scene));
    } else {
        sim::Organ organ;
        organ.model = options.model;
        SEROSA_ASSIGN(organ.lengthUnit, sim::parseLengthUnit(options.lengthUnit));
        SEROSA_ASSIGN(parts.surface, loadSurface(organ, {}));
        parts.scene = sim::defaultScene(options.model, organ.lengthUnit, parts.surface.metres);
    }
    return applyOverrides(options, parts.scene);
}

Status makeSolver(const RunOptions& options, RunParts& parts) {
    const bool pose = parts.scene.organs.front().pose.has_value();
    if (pose || options.solver == "reference") {
        if (!pose)
            parts.solver = sim::makeReferenceSolver(parts.setup);
        SEROSA_ASSIGN(sim::StateTextures textures,
                      sim::StateTextures::create(parts.lattice, parts.setup.fixed, options.layout));
        parts.uploaded.emplace(std::move(textures));
        return {};
    }
    sim::FragmentOptions fragment;
    fragment.layout = options.layout;
    SEROSA_ASSIGN(parts.solver, sim::makeFragmentSolver(parts.setup, fragment));
    return {};
}

} // namespace

sim::Mapping RunParts::surfaceMapping() const {
    return scene.look.mapping == sim::Mapping::oneToOne ? sim::Mapping::curvature : scene.look.mapping;
}

Status prepareRun(const RunOptions& options, RunParts& parts) {
    SEROSA_TRY(readSceneAndSurface(options, parts));
    const sim::Organ& organ = parts.scene.organs.front();
    SEROSA_ASSIGN(parts.lattice, organLattice(organ, parts.surface.metres));
    parts.setup.lattice = &parts.lattice;
    parts.setup.tissue = organ.tissue;
    parts.setup.gravity = parts.scene.gravity;
    parts.setup.tools = parts.scene.tools;
    SEROSA_ASSIGN(parts.setup.fixed,
                  fixedNodes(organ, parts.lattice, parts.surface.metres, parts.scene.file));
    if (organ.pose) {
        SEROSA_TRY(checkBend(parts.lattice, organ.pose->bendRadius));
    } else {
        SEROSA_ASSIGN(parts.step, organStep(organ, parts.lattice, 1 / parts.scene.frameRate));
        parts.setup.timeStep = parts.step.timeStep;
    }
    SEROSA_ASSIGN(parts.context, gpu::createContext(options.gl));
    SEROSA_TRY(makeSolver(options, parts));
    parts.binding = render::bindSurface(parts.lattice, parts.surface.metres, parts.surfaceMapping());
    SEROSA_ASSIGN(render::SurfaceRenderer renderer,
                  render::SurfaceRenderer::create(parts.lattice, parts.surface.metres, parts.binding,
                                                  parts.textures(), parts.scene.output.width,
                                                  parts.scene.output.height));
    parts.renderer.emplace(std::move(renderer));
    return {};
}

std::filesystem::path defaultOutputFolder(const RunOptions& options) {
    const std::filesystem::path& input = options.scene.empty() ? options.model : options.scene;
    return input.stem().string() + "-out";
}

} // namespace serosa::app
