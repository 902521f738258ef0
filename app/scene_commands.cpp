// `serosa scene check|explain|keys`.

#include "app/commands.h"
#include "app/contact_notes.h"
#include "app/deformation_file.h"
#include "app/material_lines.h"
#include "app/organ_coupling.h"
#include "app/organ_setup.h"
#include "app/output_folder.h"
#include "app/pose.h"
#include "app/scene_deformation.h"
#include "sim/quantity.h"
#include "sim/scene_keys.h"

#include <algorithm>
#include <iomanip>
#include <ostream>

namespace serosa::app {

namespace {

/// What a run computes from an organ of a scene before its first step.
struct Derived {
    OrganSurface surface;
    sim::Lattice lattice;
    std::vector<bool> fixed; // one flag a node
    sim::StableStep step;
};

Result<Derived> derive(const sim::Scene& scene, const sim::Organ& organ) {
    Derived derived;
    SEROSA_ASSIGN(derived.surface, loadSurface(organ, scene.file));
    SEROSA_ASSIGN(derived.lattice, organLattice(organ, derived.surface.metres, scene.file));
    SEROSA_ASSIGN(derived.fixed, fixedNodes(organ, derived.lattice, derived.surface.metres, scene.file));
    if (organ.pose) {
        SEROSA_TRY(checkBend(derived.lattice, organ.pose->bendRadius));
    } else {
        SEROSA_ASSIGN(derived.step, organStep(organ, derived.lattice, scene));
    }
    return derived;
}

std::vector<PlacedOrgan> placedOrgans(const sim::Scene& scene, const std::vector<Derived>& all) {
    std::vector<PlacedOrgan> placed;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (!scene.organs[i].pose)
            placed.push_back({&scene.organs[i], &all[i].lattice, &all[i].fixed});
    return placed;
}

Result<std::vector<Derived>> deriveAll(const sim::Scene& scene) {
    std::vector<Derived> all;
    for (const sim::Organ& organ : scene.organs) {
        SEROSA_ASSIGN(Derived derived, derive(scene, organ));
        all.push_back(std::move(derived));
    }
    SEROSA_TRY(checkGrasps(scene, placedOrgans(scene, all)));
    SEROSA_TRY(tieThreads(scene, placedOrgans(scene, all)));
    std::vector<sim::StableStep*> together;
    for (const std::size_t i : coupledOrgans(scene))
        together.push_back(&all[i].step);
    shareStep(together, 1 / scene.frameRate);
    return all;
}

std::vector<std::string> sceneNotes(const sim::Scene& scene, const std::vector<Derived>& organs) {
    std::vector<std::string> notes = contactNotes(scene, placedOrgans(scene, organs));
    for (std::string& note : couplingNotes(scene, placedOrgans(scene, organs)))
        notes.push_back(std::move(note));
    return notes;
}

void printDerived(const sim::Organ& organ, const Derived& derived, std::ostream& out) {
    const sim::Lattice& lattice = derived.lattice;
    const glm::dvec3 size = derived.surface.metres.highest() - derived.surface.metres.lowest();
    const auto line = [&out](const char* name, const std::string& text) {
        out << std::left << std::setw(34) << name << text << "\n";
    };
    using sim::Dimension;
    line("surface", grouped(derived.surface.file.positions.size()) + " vertices, " +
                        grouped(derived.surface.file.faces.size()) + " faces");
    if (derived.surface.repair && !derived.surface.repair->changed())
        line("repair", "nothing to mend");
    if (derived.surface.repair)
        for (const std::string& mended : derived.surface.repair->lines())
            line("repair", mended);
    line("size", shortNumber(size.x) + " x " + shortNumber(size.y) + " x " + shortNumber(size.z) + " m");
    line("lattice nodes",
         grouped(lattice.nodeCount()) + ", " +
             grouped(std::size_t(std::count(derived.fixed.begin(), derived.fixed.end(), true))) +
             " of them fixed");
    line("lattice cells", grouped(lattice.cells.size()));
    line("lattice spacing", shortNumber(lattice.spacing) + " m");
    for (const MaterialLine& material : materialLines(organ, lattice))
        line(("material " + material.name).c_str(), material.text);
    for (const std::string& note : materialNotes(organ, lattice))
        line("note", note);
    if (organ.pose)
        return;
    line("spring constant k = 0.4 E h", shortNumber(organ.tissue.springConstant(lattice.spacing)) + " N/m");
    line("mass of a full node", shortNumber(organ.tissue.nodeMass(lattice.spacing)) + " kg");
    const sim::StableStep& step = derived.step;
    if (organ.method == sim::StepMethod::implicit) {
        line("explicit steps", shortNumber(explicitSteps(step, step.timeStep * step.stepsPerFrame)) +
                                   " a frame, stable below " + shortNumber(step.bound) + " s; not taken");
        line("time step", shortNumber(step.timeStep) + " s, implicit, " + implicitStepsText(step));
        return;
    }
    line("stable step", shortNumber(step.bound) + " s, used with a margin of " + shortNumber(step.margin));
    line("time step",
         shortNumber(step.timeStep) + " s, " + std::to_string(step.stepsPerFrame) + " steps a frame");
}

} // namespace

Result<int> checkSceneFile(const std::filesystem::path& file, std::ostream& out) {
    SEROSA_ASSIGN(const sim::Scene scene, sim::readScene(file));
    SEROSA_ASSIGN(const std::vector<Derived> organs, deriveAll(scene));
    std::size_t faces = 0, nodes = 0;
    int steps = 0, implicit = 0;
    for (const Derived& organ : organs) {
        faces += organ.surface.file.faces.size();
        nodes += organ.lattice.nodeCount();
        steps = std::max(steps, organ.step.stepsPerFrame);
    }
    for (const sim::Organ& organ : scene.organs)
        implicit += organ.method == sim::StepMethod::implicit;
    out << file.string() << ": ok: " << scene.frames() << " frames, ";
    if (organs.size() > 1)
        out << organs.size() << " organs, ";
    out << grouped(faces) << " faces, " << grouped(nodes) << " nodes, " << scene.tools.size()
        << (scene.tools.size() == 1 ? " tool" : " tools");
    if (!scene.bodies.empty())
        out << ", " << scene.bodies.size() << (scene.bodies.size() == 1 ? " body" : " bodies");
    if (!scene.threads.empty())
        out << ", " << scene.threads.size() << (scene.threads.size() == 1 ? " thread" : " threads");
    if (steps > 0)
        out << ", " << (organs.size() > 1 ? "up to " : "") << steps << " steps a frame";
    if (implicit > 0)
        out << " (" << implicit << " implicit)";
    out << "\n";
    for (std::size_t i = 0; i < organs.size(); ++i) {
        printRepair(organs[i].surface, out);
        if (!plainTissue(scene.organs[i]))
            for (const MaterialLine& line : materialLines(scene.organs[i], organs[i].lattice))
                out << "material " << line.name << ": " << line.text << "\n";
        for (const std::string& note : materialNotes(scene.organs[i], organs[i].lattice))
            out << "note: " << note << "\n";
    }
    for (const std::string& note : sceneNotes(scene, organs))
        out << "note: " << note << "\n";
    return int(exitOk);
}

Result<int> writeSceneDeformation(const std::filesystem::path& sceneFile, std::size_t number,
                                  const std::filesystem::path& file, bool force, std::ostream& out) {
    SEROSA_ASSIGN(const sim::Scene scene, sim::readScene(sceneFile));
    const std::size_t count = scene.deformations.size();
    if (number < 1 || number > count)
        return Error{sceneFile.string() + ": has " + std::to_string(count) +
                     " deformations, and none of number " + std::to_string(number)};
    SEROSA_TRY(checkTarget(file, "deformation.nrrd", force));
    SEROSA_ASSIGN(const SceneDeformation made, SceneDeformation::create(scene));
    if (!made.texture(number - 1))
        return made.errorOf(number - 1, "is by vertices, and has no texture to write");
    const render::DeformationTexture& texture = *made.texture(number - 1);
    SEROSA_TRY(writeDeformationTexture(texture, file));
    out << file.string() << ": " << texture.size().x << " x " << texture.size().y << " x " << texture.size().z
        << " texels, displacement in mm and what is kept\n";
    return int(exitOk);
}

Result<int> explainSceneFile(const std::filesystem::path& file, std::ostream& out) {
    std::vector<sim::SceneValue> values;
    SEROSA_ASSIGN(const sim::Scene scene, sim::readScene(file, &values));
    SEROSA_ASSIGN(const std::vector<Derived> organs, deriveAll(scene));
    for (const sim::SceneValue& value : values) {
        const std::string source = value.line > 0    ? "line " + std::to_string(value.line)
                                   : value.inherited ? "inherited"
                                                     : "default";
        const bool sameText = value.written == value.value;
        out << std::left << std::setw(34) << value.path << " " << std::setw(9) << source << " " << value.value
            << (value.line > 0 && !sameText ? "  (" + value.written + ")" : "") << "\n";
    }
    out << "\n" << std::left << std::setw(34) << "frames" << scene.frames() << "\n";
    for (std::size_t i = 0; i < organs.size(); ++i) {
        if (organs.size() > 1)
            out << "\n" << std::setw(34) << "organ" << scene.organs[i].name << "\n";
        printDerived(scene.organs[i], organs[i], out);
    }
    for (const std::string& note : sceneNotes(scene, organs))
        out << std::setw(34) << "note" << note << "\n";
    return int(exitOk);
}

Result<int> printSceneKeys(std::ostream& out) {
    out << sim::sceneReference();
    return int(exitOk);
}

} // namespace serosa::app
