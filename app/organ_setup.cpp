// See app/organ_setup.h.

#include "app/organ_setup.h"

#include "sim/assign_materials.h"
#include "sim/mesh_check.h"
#include "sim/mesh_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>

namespace serosa::app {

namespace {

constexpr int kMostStepsAFrame = 100000;

/// "scene.toml:12: " or "".
std::string scenePosition(const std::filesystem::path& scene, int line) {
    return scene.empty() || line == 0 ? "" : scene.string() + ":" + std::to_string(line) + ": ";
}

} // namespace

Result<sim::RepairedMesh> readSolid(const std::filesystem::path& file, bool repair) {
    SEROSA_ASSIGN(sim::TriangleMesh mesh, sim::readMesh(file));
    if (repair)
        mesh.uvs.clear(); // faces come and go
    if (repair)
        return sim::repairMesh(std::move(mesh), file.string());
    if (const Status closed = sim::checkClosedSolid(mesh, file.string()); !closed.ok())
        return sim::withRepairHint(closed.error(), mesh);
    return sim::RepairedMesh{std::move(mesh), {}};
}

sim::TriangleMesh deformedFile(const sim::Organ& organ, const OrganSurface& surface,
                               const std::vector<glm::dvec3>& deformed, const std::vector<glm::dvec3>& rest) {
    sim::TriangleMesh mesh = surface.file;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.positions[i] += sim::fileFromWorld(organ.upAxis, deformed[i] - rest[i]) / organ.lengthUnit;
    return mesh;
}

Result<OrganSurface> loadSurface(const sim::Organ& organ, const std::filesystem::path& scene) {
    const auto inScene = [&](const Error& error) {
        return Error{scenePosition(scene, organ.modelLine) + error.message, error.exitCode};
    };
    OrganSurface surface;
    Result<sim::RepairedMesh> solid = readSolid(organ.model, organ.repair);
    if (!solid)
        return inScene(solid.error());
    surface.file = std::move(solid->mesh);
    if (organ.repair)
        surface.repair = solid->report;
    surface.metres = surface.file;
    for (glm::dvec3& position : surface.metres.positions)
        position = organ.at + sim::worldFromFile(organ.upAxis, position) * organ.lengthUnit;
    return surface;
}

Result<std::vector<bool>> fixedNodes(const sim::Organ& organ, const sim::Lattice& lattice,
                                     const sim::TriangleMesh& metres, const std::filesystem::path& scene) {
    std::vector<bool> fixed(lattice.nodeCount(), false);
    for (const sim::Region& region : organ.fixed) {
        std::size_t held = 0;
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            if (region.contains(lattice.toWorld(lattice.restPosition(node)))) {
                fixed[node] = true;
                ++held;
            }
        if (held == 0)
            return Error{scenePosition(scene, region.line) +
                         "this fixed region holds no node of the organ: look at its position and unit"};
    }
    if (organ.fixedLowestShare > 0) {
        const double lowest = metres.lowest().y, height = metres.highest().y - lowest;
        const double limit = lowest + organ.fixedLowestShare * height;
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            if (lattice.toWorld(lattice.restPosition(node)).y <= limit)
                fixed[node] = true;
    }
    if (std::find(fixed.begin(), fixed.end(), false) == fixed.end())
        return Error{scenePosition(scene, organ.fixed.empty() ? 0 : organ.fixed.back().line) + organ.name +
                     ": every node is fixed, so that nothing can move: make the fixed regions smaller"};
    return fixed;
}

Result<sim::Lattice> organLattice(const sim::Organ& organ, const sim::TriangleMesh& metres,
                                  const std::filesystem::path& scene) {
    sim::LatticeRequest request;
    request.spacing = organ.spacing;
    request.nodes = organ.nodes;
    request.gridPoint = organ.gridPoint;
    Result<sim::Lattice> lattice = sim::buildLattice(metres, request);
    if (!lattice.ok())
        return Error{scenePosition(scene, organ.modelLine) + lattice.error().message};
    SEROSA_TRY(sim::assignMaterials(*lattice, metres, organ.regions,
                                    [&scene](int line) { return scenePosition(scene, line); }));
    return lattice;
}

Result<sim::StableStep> organStep(const sim::Organ& organ, const sim::Lattice& lattice,
                                  const sim::Scene& scene) {
    const double frameTime = 1 / scene.frameRate;
    sim::StableStep step = sim::stableStep(lattice, organ.tissue, frameTime);
    if (organ.method == sim::StepMethod::implicit) {
        step.stepsPerFrame = sim::implicitStepsPerFrame(scene.tools, lattice.spacing, frameTime);
        step.timeStep = frameTime / step.stepsPerFrame;
        return step;
    }
    if (step.stepsPerFrame > kMostStepsAFrame)
        return Error{scenePosition(scene.file, organ.modelLine) +
                     "the tissue is so stiff or damped on so fine a lattice that a frame would take " +
                     shortNumber(explicitSteps(step, frameTime)) +
                     " steps (at most 100,000): set method = \"implicit\", lower young or damping_time, or "
                     "raise spacing"};
    return step;
}

double explicitSteps(const sim::StableStep& step, double frameTime) {
    return frameTime / (step.margin * step.bound);
}

std::string implicitStepsText(const sim::StableStep& step) {
    if (step.stepsPerFrame == 1)
        return "one a frame";
    return std::to_string(step.stepsPerFrame) +
           " a frame (no tool then goes further than half a spacing in a step" +
           (step.stepsPerFrame == sim::kMostImplicitSteps ? ", or nearly so: these are the most)" : ")");
}

const char* methodName(sim::StepMethod method) {
    return method == sim::StepMethod::implicit ? "implicit" : "explicit";
}

void printRepair(const sim::RepairReport& repair, std::ostream& out) {
    for (const std::string& line : repair.lines())
        out << "repair: " << line << "\n";
    if (!repair.changed())
        out << "repair: nothing to mend\n";
}

void printRepair(const OrganSurface& surface, std::ostream& out) {
    if (surface.repair)
        printRepair(*surface.repair, out);
}

std::string grouped(std::size_t number) {
    std::string digits = std::to_string(number);
    for (int at = int(digits.size()) - 3; at > 0; at -= 3)
        digits.insert(std::size_t(at), ",");
    return digits;
}

std::string shortNumber(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

} // namespace serosa::app
