// See app/run_setup.h.

#include "app/run_setup.h"

#include "app/material_lines.h"
#include "app/other_surfaces.h"
#include "app/pose.h"
#include "app/solver_choice.h"
#include "app/tool_entry.h"
#include "shaders/shared_constants.h"
#include "sim/split_edges.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace serosa::app {

namespace {

Status applyOverrides(const RunOptions& options, sim::Scene& scene, std::size_t& timesLeftOut) {
    if (options.frames) {
        scene.duration = *options.frames / scene.frameRate;
        const double end = (*options.frames + 0.5) / scene.frameRate;
        sim::Output& output = scene.output;
        for (std::vector<double>* times :
             {&output.surfacesAt, &output.snapshotsAt, &output.displacementsAt, &output.sheetAt})
            timesLeftOut += std::erase_if(*times, [end](double time) { return time > end; });
    }
    if (options.width)
        scene.output.width = *options.width;
    if (options.height)
        scene.output.height = *options.height;
    if (options.mapping)
        scene.look.mapping = *options.mapping;
    if (options.show)
        scene.look.show = *options.show;
    if (scene.look.show == sim::Show::both) // the mapping whose inverse is ray-cast
        scene.look.mapping = sim::Mapping::trilinear;
    for (sim::Organ& organ : scene.organs) {
        if (options.nodes) {
            organ.nodes = *options.nodes;
            organ.spacing = 0;
        }
        if (options.spacing)
            organ.spacing = *options.spacing;
    }
    if (const auto problem = sim::findSceneProblem(scene))
        return Error{(problem->table.empty() ? "" : problem->table + ".") + problem->key + ": " +
                     problem->message};
    return {};
}

Status readSceneAndSurfaces(const RunOptions& options, RunParts& parts) {
    const auto addOrgan = [&parts](OrganSurface surface) {
        parts.organs.push_back(std::make_unique<OrganParts>());
        parts.organs.back()->surface = std::move(surface);
    };
    if (!options.scene.empty()) {
        SEROSA_ASSIGN(parts.scene, sim::readScene(options.scene));
        SEROSA_TRY(takeSurfaces(options.surfaces, parts.scene));
        for (const sim::Organ& organ : parts.scene.organs) {
            SEROSA_ASSIGN(OrganSurface surface, loadSurface(organ, options.scene));
            addOrgan(std::move(surface));
        }
    } else {
        sim::Organ organ;
        organ.model = options.model;
        organ.upAxis = options.upAxis;
        organ.repair = options.repair;
        SEROSA_ASSIGN(organ.lengthUnit, sim::parseLengthUnit(options.lengthUnit));
        SEROSA_ASSIGN(OrganSurface surface, loadSurface(organ, {}));
        parts.scene = sim::defaultScene(options.model, organ.lengthUnit, surface.metres);
        parts.scene.organs.front().upAxis = organ.upAxis;
        parts.scene.organs.front().repair = organ.repair;
        addOrgan(std::move(surface));
    }
    return applyOverrides(options, parts.scene, parts.timesLeftOut);
}

/// The texture that an organ's look asks for. Errors: of the pictures.
Result<std::optional<render::SurfaceDetail>> organDetail(const sim::Organ& organ,
                                                         const std::filesystem::path& scene) {
    std::optional<render::SurfaceDetail> detail;
    if (organ.look.textured()) {
        SEROSA_ASSIGN(render::TissueMaps maps, render::tissueMaps(organ.look, scene));
        detail = render::SurfaceDetail{std::move(maps), organ.look.tile, organ.look.relief};
    }
    return detail;
}

} // namespace

Status prepareOrgan(const sim::Scene& scene, const sim::Organ& organ, OrganParts& parts) {
    SEROSA_ASSIGN(parts.lattice, organLattice(organ, parts.surface.metres, scene.file));
    if (scene.look.colour == sim::SurfaceColour::material)
        parts.surface.metres.colours = materialColours(parts.lattice, parts.surface.metres);
    // A level of detail has the surface of its organ, which the finest lattice has split.
    sim::splitLongEdges(parts.surface.metres, parts.lattice.spacing);
    parts.setup.lattice = &parts.lattice;
    parts.setup.tissue = organ.tissue;
    parts.setup.gravity = scene.gravity;
    parts.setup.tools = scene.tools;
    parts.setup.bodies = scene.bodies;
    parts.setup.method = organ.method;
    SEROSA_ASSIGN(parts.setup.fixed, fixedNodes(organ, parts.lattice, parts.surface.metres, scene.file));
    if (organ.pose) {
        SEROSA_TRY(checkBend(parts.lattice, organ.pose->bendRadius));
    } else {
        SEROSA_ASSIGN(parts.step, organStep(organ, parts.lattice, scene));
        parts.setup.timeStep = parts.step.timeStep;
    }
    return {};
}

/// Where something is simulated and the solvers have room for them.
void addHands(RunParts& parts) {
    sim::Scene& scene = parts.scene;
    double spacing = 0, young = 0, fastest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < parts.organs.size(); ++i)
        if (!scene.organs[i].pose) {
            spacing = std::max(spacing, parts.organs[i]->lattice.spacing);
            for (std::size_t m = 0; m < scene.organs[i].tissue.materialCount(); ++m)
                young = std::max(young, scene.organs[i].tissue.material(m).young);
            if (scene.organs[i].method == sim::StepMethod::implicit)
                fastest = std::min(fastest, sim::implicitToolSpeed(parts.organs[i]->lattice.spacing,
                                                                   parts.organs[i]->step.timeStep));
        }
    Hands hands(spacing, glm::distance(parts.lowest(), parts.highest()), young, fastest);
    const std::size_t tools = scene.tools.size() + hands.tools().size();
    if (spacing == 0 || tools > SRS_MAX_TOOLS || tools + scene.bodies.size() > SRS_MAX_COLLIDERS)
        return;
    for (const sim::Tool& tool : hands.tools()) {
        scene.tools.push_back(tool);
        for (const auto& organ : parts.organs)
            organ->setup.tools.push_back(tool);
    }
    parts.hands.emplace(std::move(hands));
}

Status makeOrganSolver(const RunOptions& options, bool pose, OrganParts& parts) {
    if (!pose) {
        SEROSA_ASSIGN(parts.solver, makeSolver(options.solver, parts.setup, options.layout));
        if (parts.solver->textures())
            return {};
    }
    SEROSA_ASSIGN(sim::StateTextures textures,
                  sim::StateTextures::create(parts.lattice, parts.setup.fixed, options.layout));
    parts.uploaded.emplace(std::move(textures));
    return {};
}

sim::Mapping RunParts::surfaceMapping() const {
    return scene.look.mapping == sim::Mapping::oneToOne ? sim::Mapping::curvature : scene.look.mapping;
}

std::vector<PlacedOrgan> RunParts::placedOrgans() const {
    std::vector<PlacedOrgan> placed;
    for (std::size_t i = 0; i < organs.size(); ++i)
        if (!scene.organs[i].pose)
            placed.push_back({&scene.organs[i], &organs[i]->lattice, &organs[i]->setup.fixed});
    return placed;
}

std::vector<const sim::StateTextures*> RunParts::textures() const {
    std::vector<const sim::StateTextures*> all;
    for (const auto& organ : organs)
        all.push_back(&organ->textures());
    return all;
}

glm::dvec3 RunParts::lowest() const {
    glm::dvec3 bound = organs.front()->surface.metres.lowest();
    for (const auto& organ : organs)
        bound = glm::min(bound, organ->surface.metres.lowest());
    return bound;
}

glm::dvec3 RunParts::highest() const {
    glm::dvec3 bound = organs.front()->surface.metres.highest();
    for (const auto& organ : organs)
        bound = glm::max(bound, organ->surface.metres.highest());
    return bound;
}

/// Can its tissue be anywhere but at rest?
static bool canMove(const sim::Scene& scene, const sim::Organ& organ) {
    return organ.pose || scene.gravity != glm::dvec3(0) || !scene.tools.empty() || !scene.bodies.empty() ||
           !scene.threads.empty() || !scene.cuts.empty() || scene.organsTouch;
}

/// Organs at rest that deformations alone move: tissue that these take out of a lattice could not be shown
/// through it.
static bool isOfDeformationsAlone(const sim::Scene& scene) {
    return !scene.deformations.empty() &&
           std::none_of(scene.organs.begin(), scene.organs.end(),
                        [&scene](const sim::Organ& organ) { return canMove(scene, organ); });
}

/// An organ that is ray-cast.
static Status prepareImplicit(RunParts& parts, std::size_t i) {
    const OrganParts& organ = *parts.organs[i];
    const sim::Organ& wanted = parts.scene.organs[i];
    if (wanted.levels > 1)
        return Error{parts.scene.file.string() +
                     ": what is ray-cast needs organs of one level of detail, and " + wanted.name + " has " +
                     std::to_string(wanted.levels)};
    return parts.implicit.add(parts.scene, organ.surface.metres, organ.lattice, organ.textures().layout(),
                              canMove(parts.scene, wanted));
}

Status prepareRun(const RunOptions& options, RunParts& parts, const ContextMaker& makeContext) {
    SEROSA_TRY(readSceneAndSurfaces(options, parts));
    for (std::size_t i = 0; i < parts.organs.size(); ++i)
        SEROSA_TRY(prepareOrgan(parts.scene, parts.scene.organs[i], *parts.organs[i]));
    parts.toolNotes = bringToolsIn(parts.scene, parts.placedOrgans());
    for (const auto& organ : parts.organs)
        organ->setup.tools = parts.scene.tools;
    SEROSA_TRY(prepareCoupling(parts));
    if (options.hands && !isOfDeformationsAlone(parts.scene))
        addHands(parts);
    SEROSA_TRY(checkGrasps(parts.scene, parts.placedOrgans()));
    SEROSA_ASSIGN(parts.context, makeContext ? makeContext(parts.scene) : gpu::createContext(options.gl));
    for (std::size_t i = 0; i < parts.organs.size(); ++i) {
        OrganParts& organ = *parts.organs[i];
        SEROSA_TRY(makeOrganSolver(options, parts.scene.organs[i].pose.has_value(), organ));
        SEROSA_ASSIGN(organ.detail, organDetail(parts.scene.organs[i], parts.scene.file));
        const render::SurfaceDetail* detail = organ.detail ? &*organ.detail : nullptr;
        organ.binding = render::bindSurface(organ.lattice, organ.surface.metres, parts.surfaceMapping());
        if (i > 0) {
            SEROSA_TRY(parts.renderer->addOrgan(organ.lattice, organ.surface.metres, organ.binding,
                                                organ.textures(), detail));
            continue;
        }
        SEROSA_ASSIGN(render::SurfaceRenderer renderer,
                      render::SurfaceRenderer::create(organ.lattice, organ.surface.metres, organ.binding,
                                                      organ.textures(), parts.scene.output.width,
                                                      parts.scene.output.height, detail));
        parts.renderer.emplace(std::move(renderer));
    }
    for (std::size_t i = 0; i < parts.organs.size() && !parts.scene.cuts.empty(); ++i)
        if (parts.organs[i]->solver)
            SEROSA_TRY(parts.renderer->prepareCuts(i, parts.organs[i]->lattice,
                                                   parts.organs[i]->textures().layout()));
    for (std::size_t i = 0; i < parts.organs.size() && parts.scene.look.show != sim::Show::surface; ++i)
        SEROSA_TRY(prepareImplicit(parts, i));
    std::vector<ImplicitOrgans::OpenedSurface> surfaces;
    for (const auto& organ : parts.organs)
        surfaces.push_back({&organ->lattice, &organ->surface.metres, &organ->binding});
    SEROSA_TRY(parts.implicit.open(*parts.renderer, surfaces));
    SEROSA_TRY(makeGroup(parts));
    for (std::size_t i = 0; i < parts.organs.size() && !parts.implicit.empty(); ++i)
        if (parts.organs[i]->solver)
            parts.implicit.setSteps(i, parts.organs[i]->step.stepsPerFrame);
    parts.levels.resize(parts.organs.size());
    for (std::size_t i = 0; i < parts.organs.size(); ++i)
        SEROSA_TRY(OrganLevels::prepare(options, parts, i));
    return {};
}

std::filesystem::path defaultOutputFolder(const RunOptions& options) {
    const std::filesystem::path& input = options.scene.empty() ? options.model : options.scene;
    return input.stem().string() + "-out";
}

} // namespace serosa::app
