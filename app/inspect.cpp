// `serosa inspect`, `serosa repair` and `serosa phantom`: the commands about a mesh alone.

#include "app/commands.h"
#include "app/organ_setup.h"
#include "app/output_folder.h"
#include "app/vector_image.h"
#include "models/phantom.h"
#include "sim/mesh_check.h"
#include "sim/mesh_reader.h"
#include "sim/mesh_repair.h"
#include "sim/mesh_writer.h"

#include <algorithm>
#include <array>
#include <map>
#include <ostream>
#include <utility>
#include <vector>

namespace serosa::app {

namespace {

constexpr std::size_t kAnyFaces = 10000; // for a name that makePhantom will refuse

std::string sizeText(const glm::dvec3& size) {
    return shortNumber(size.x) + " x " + shortNumber(size.y) + " x " + shortNumber(size.z);
}

void printReport(const sim::MeshReport& report, const std::string& unit, std::ostream& out) {
    const auto line = [&out](const char* name, const std::string& text) { out << name << text << "\n"; };
    const auto count = [&](const char* name, std::size_t n) {
        if (n > 0)
            line(name, grouped(n));
    };
    line("vertices            ", grouped(report.vertices));
    line("faces               ", grouped(report.faces));
    line("size                ", sizeText(report.highest - report.lowest) + " " + unit);
    line("from                ", "(" + shortNumber(report.lowest.x) + ", " + shortNumber(report.lowest.y) +
                                     ", " + shortNumber(report.lowest.z) + ")");
    line("to                  ", "(" + shortNumber(report.highest.x) + ", " + shortNumber(report.highest.y) +
                                     ", " + shortNumber(report.highest.z) + ")");
    line("area                ", shortNumber(report.area) + " " + unit + "^2");
    line("volume              ", shortNumber(report.volume) + " " + unit + "^3");
    line("shells              ", grouped(report.shells) + " (" + grouped(report.solids) + " solid, " +
                                     grouped(report.cavities) + " cavities)");
    if (!report.genus.empty()) {
        std::string text;
        for (const int genus : report.genus)
            text += (text.empty() ? "" : ", ") + std::to_string(genus);
        line("genus               ", text);
    }
    line("self-intersections  ", grouped(report.selfIntersections) + " pairs of faces");
    count("open edges          ", report.openEdges);
    count("non-manifold edges  ", report.nonManifoldEdges);
    count("non-manifold points ", report.nonManifoldVertices);
    count("edges wound wrongly ", report.inconsistentEdges);
    count("degenerate faces    ", report.degenerateFaces);
    count("duplicate faces     ", report.duplicateFaces);
    count("unused vertices     ", report.unusedVertices);
}

/// What a painted region of a scene could go by: the most frequent colours of the vertices.
void printColours(const sim::TriangleMesh& mesh, std::ostream& out) {
    constexpr std::size_t kShown = 4;
    if (mesh.colours.empty())
        return;
    std::map<std::array<int, 3>, std::size_t> counts;
    for (const glm::u8vec3& colour : mesh.colours)
        ++counts[{colour.x, colour.y, colour.z}];
    std::vector<std::pair<std::array<int, 3>, std::size_t>> sorted(counts.begin(), counts.end());
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    out << "vertex colours      " << grouped(sorted.size()) << ": ";
    for (std::size_t i = 0; i < std::min(kShown, sorted.size()); ++i) {
        const auto& [colour, count] = sorted[i];
        out << (i > 0 ? ", [" : "[") << colour[0] << ", " << colour[1] << ", " << colour[2] << "] ("
            << grouped(count) << ")";
    }
    out << (sorted.size() > kShown ? ", ..." : "") << "\n";
}

} // namespace

Result<int> inspectModel(const std::filesystem::path& file, bool repair, const std::string& lengthUnit,
                         std::size_t nodes, std::optional<double> spacing, std::ostream& out) {
    sim::Organ organ;
    organ.lengthUnit = 1;
    if (!lengthUnit.empty()) {
        SEROSA_ASSIGN(organ.lengthUnit, sim::parseLengthUnit(lengthUnit));
    }
    SEROSA_ASSIGN(sim::TriangleMesh mesh, sim::readMesh(file));
    if (repair) {
        SEROSA_ASSIGN(sim::RepairedMesh mended, sim::repairMesh(std::move(mesh), file.string()));
        mesh = std::move(mended.mesh);
        printRepair(mended.report, out);
    }
    printReport(sim::inspectMesh(mesh, true), lengthUnit.empty() ? "file units" : lengthUnit, out);
    printColours(mesh, out);
    out << std::flush;
    if (const Status solid = sim::checkClosedSolid(mesh, file.string()); !solid.ok())
        return sim::withRepairHint(solid.error(), mesh);

    for (glm::dvec3& position : mesh.positions)
        position *= organ.lengthUnit;
    organ.nodes = nodes;
    organ.spacing = spacing.value_or(0);
    SEROSA_ASSIGN(const sim::Lattice lattice, organLattice(organ, mesh, {}));
    const std::string unit = lengthUnit.empty() ? "file units" : "mm";
    const double shown = lengthUnit.empty() ? lattice.spacing : 1e3 * lattice.spacing;
    out << "lattice             " << grouped(lattice.nodeCount()) << " nodes, "
        << grouped(lattice.cells.size()) << " cells, spacing " << shortNumber(shown) << " " << unit
        << ", grid " << lattice.nodeDims.x << " x " << lattice.nodeDims.y << " x " << lattice.nodeDims.z
        << "\n";
    if (lengthUnit.empty())
        out << "a mesh file has no unit: say --length-unit mm (or cm, m, um, in) to see the lattice in "
               "metres\n";
    return int(exitOk);
}

Result<int> repairModel(const std::filesystem::path& from, const std::filesystem::path& to, bool force,
                        std::ostream& out) {
    SEROSA_TRY(checkTarget(to, from.stem().string() + ".ply", force));
    SEROSA_ASSIGN(sim::TriangleMesh mesh, sim::readMesh(from));
    SEROSA_ASSIGN(const sim::RepairedMesh mended, sim::repairMesh(std::move(mesh), from.string()));
    SEROSA_TRY(sim::writeMesh(mended.mesh, to));
    printRepair(mended.report, out);
    out << to.string() << ": " << grouped(mended.mesh.positions.size()) << " vertices, "
        << grouped(mended.mesh.faces.size()) << " faces\n";
    return int(exitOk);
}

Result<int> writePhantom(const PhantomRequest& request, std::ostream& out) {
    const std::string& name = request.name;
    const std::filesystem::path &file = request.file, &volumeFile = request.volume;
    if (!file.empty())
        SEROSA_TRY(checkTarget(file, name + ".ply", request.force));
    if (!volumeFile.empty()) {
        SEROSA_TRY(checkTarget(volumeFile, name + ".nrrd", request.force));
        SEROSA_ASSIGN(const models::ColourVolume volume, models::makePhantomVolume(name, request.voxel));
        SEROSA_TRY(writeColourVolume(volume, volumeFile));
        out << volumeFile.string() << ": " << volume.size.x << " x " << volume.size.y << " x "
            << volume.size.z << " voxels of " << shortNumber(volume.voxel) << " mm, colours\n";
    }
    if (file.empty())
        return int(exitOk);
    std::size_t faces = request.faces;
    if (faces == 0) {
        faces = kAnyFaces;
        for (const models::PhantomInfo& info : models::phantoms())
            if (info.name == name)
                faces = info.defaultFaces;
    }
    SEROSA_ASSIGN(const sim::TriangleMesh mesh, models::makePhantom(name, faces));
    SEROSA_TRY(sim::writeMesh(mesh, file));
    out << file.string() << ": " << grouped(mesh.positions.size()) << " vertices, "
        << grouped(mesh.faces.size()) << " faces, " << sizeText(mesh.highest() - mesh.lowest()) << " mm\n";
    return int(exitOk);
}

} // namespace serosa::app
