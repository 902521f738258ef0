// See app/describe_setup.h.
#include "app/describe_setup.h"

#include "app/contact_notes.h"
#include "app/coupling_record.h"
#include "app/material_lines.h"
#include "app/run_setup.h"

#include <ostream>

namespace serosa::app {

namespace {

void describeOrgan(const sim::Organ& organ, const OrganParts& parts, const OrganLevels& levels,
                   std::ostream& out, std::vector<std::string>& notes) {
    out << organ.name << ": " << grouped(parts.surface.file.positions.size()) << " vertices, "
        << grouped(parts.surface.file.faces.size()) << " faces\n";
    printRepair(parts.surface, out);
    if (parts.surface.metres.faces.size() > parts.surface.file.faces.size())
        out << "surface: edges longer than the lattice's spacing are split to bend and part with it: "
            << grouped(parts.surface.metres.positions.size()) << " vertices, "
            << grouped(parts.surface.metres.faces.size()) << " faces are drawn; files keep the model's\n";
    out << "lattice: " << grouped(parts.lattice.nodeCount()) << " nodes, "
        << grouped(parts.lattice.cells.size()) << " cells, spacing "
        << shortNumber(1e3 * parts.lattice.spacing) << " mm\n";
    if (!plainTissue(organ))
        for (const MaterialLine& line : materialLines(organ, parts.lattice))
            out << "material " << line.name << ": " << line.text << "\n";
    for (std::string& note : materialNotes(organ, parts.lattice))
        notes.push_back(std::move(note));
    const sim::StableStep& step = parts.step;
    if (parts.solver && organ.method == sim::StepMethod::implicit)
        out << "step: implicit, " << implicitStepsText(step) << " of " << shortNumber(1e3 * step.timeStep)
            << " ms (explicit ones would be "
            << shortNumber(explicitSteps(step, step.timeStep * step.stepsPerFrame)) << " a frame)\n";
    else if (parts.solver)
        out << "step: " << parts.step.stepsPerFrame << " steps a frame of "
            << shortNumber(1e3 * parts.step.timeStep) << " ms (stable below "
            << shortNumber(1e3 * parts.step.bound) << " ms; computed, with a margin of "
            << shortNumber(parts.step.margin) << ")\n";
    for (const std::string& line : levels.lines())
        out << line << "\n";
    if (parts.binding.tornEdgesFound > 0)
        out << "binding: " << parts.binding.tornEdgesFound << " torn edges, " << parts.binding.tornEdgesLeft
            << " left after flooding\n";
}

} // namespace

std::vector<std::string> describeSetup(const RunParts& parts, std::ostream& out) {
    std::vector<std::string> notes;
    for (std::size_t i = 0; i < parts.organs.size(); ++i)
        describeOrgan(parts.scene.organs[i], *parts.organs[i], parts.levels[i], out, notes);
    notes.insert(notes.end(), parts.toolNotes.begin(), parts.toolNotes.end());
    for (std::string& note : parts.implicit.notes())
        notes.push_back(std::move(note));
    for (std::string& note : contactNotes(parts.scene, parts.placedOrgans()))
        notes.push_back(std::move(note));
    for (std::string& note : couplingNotes(parts.scene, parts.placedOrgans()))
        notes.push_back(std::move(note));
    if (parts.timesLeftOut > 0)
        notes.push_back(std::to_string(parts.timesLeftOut) +
                        " of the times in [output] lie after the frames asked for and are left out");
    for (const std::string& note : notes)
        out << "note: " << note << "\n";
    out << "context: " << gpu::contextKindName(parts.context->kind()) << ", "
        << parts.context->info().renderer << "\n"
        << std::flush;
    return notes;
}

} // namespace serosa::app
