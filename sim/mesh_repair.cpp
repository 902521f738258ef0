// The order matters: what is removed first leaves no edge with three faces behind; only a surface that winds
// alike has directed holes; only a closed one an inside, which says how its shells have to wind.
#include "sim/mesh_repair.h"

#include "base/check.h"
#include "sim/hole_filling.h"
#include "sim/mesh_check.h"
#include "sim/mesh_nesting.h"
#include "sim/mesh_topology.h"
#include "sim/mesh_winding.h"

#include <algorithm>
#include <cstdio>

namespace serosa::sim {
namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

std::string counted(std::size_t count, const char* one, const char* several) {
    return std::to_string(count) + " " + (count == 1 ? one : several);
}

std::string near(const TriangleMesh& mesh, std::uint32_t vertex) {
    const glm::dvec3& p = mesh.positions[vertex];
    return " near (" + number(p.x) + ", " + number(p.y) + ", " + number(p.z) + ")";
}

bool repeats(const glm::uvec3& t) {
    return t.x == t.y || t.y == t.z || t.z == t.x;
}

class Repair {
public:
    Repair(TriangleMesh mesh, const std::string& name, const RepairLimits& limits)
        : mesh_(std::move(mesh)), name_(name), limits_(limits) {}

    Result<RepairedMesh> all() {
        if (mesh_.faces.empty())
            return Error{name_ + ": no triangles; export a surface"};
        removeFaces();
        SEROSA_TRY(refuseBeyondRepair());
        turned_.assign(mesh_.faces.size(), false);
        SEROSA_TRY(windAlike());
        SEROSA_TRY(fillHoles());
        SEROSA_TRY(windShells());
        report_.flippedFaces = std::size_t(std::count(turned_.begin(), turned_.end(), true));
        removeStrayVertices();
        if (const Status solid = checkClosedSolid(mesh_, name_); !solid.ok())
            return Error{solid.error().message + " (this is beyond --repair)"};
        return RepairedMesh{std::move(mesh_), report_};
    }

private:
    Error refuse(const std::string& text) const { return {name_ + ": beyond --repair: " + text}; }

    void removeFaces() {
        const auto kept = std::remove_if(mesh_.faces.begin(), mesh_.faces.end(), repeats);
        report_.repeatedCornerFaces = std::size_t(mesh_.faces.end() - kept);
        mesh_.faces.erase(kept, mesh_.faces.end());
        const std::vector<std::uint32_t> duplicates = findTopology(mesh_).duplicates;
        report_.duplicateFaces = duplicates.size();
        if (duplicates.empty())
            return;
        std::vector<bool> doubled(mesh_.faces.size(), false);
        for (const std::uint32_t face : duplicates)
            doubled[face] = true;
        std::size_t count = 0;
        for (std::size_t face = 0; face < mesh_.faces.size(); ++face)
            if (!doubled[face])
                mesh_.faces[count++] = mesh_.faces[face];
        mesh_.faces.resize(count);
    }

    Status refuseBeyondRepair() const {
        if (mesh_.faces.empty())
            return refuse("every face has a repeated corner; export the mesh again");
        const MeshTopology topology = findTopology(mesh_);
        const auto flat = std::find(topology.degenerate.begin(), topology.degenerate.end(), true);
        if (flat != topology.degenerate.end()) {
            const auto face = std::size_t(flat - topology.degenerate.begin());
            return refuse(counted(std::size_t(std::count(flat, topology.degenerate.end(), true)),
                                  "zero-area face of three different vertices",
                                  "zero-area faces of three different vertices") +
                          ", the first" + near(mesh_, mesh_.faces[face].x) +
                          "; collapse it in a mesh editor");
        }
        if (!topology.nonManifoldEdges.empty()) {
            const MeshTopology::Edge& edge = topology.nonManifoldEdges[0];
            return refuse(
                counted(topology.nonManifoldEdges.size(), "non-manifold edge", "non-manifold edges") +
                " (more than two triangles), the first between vertices " + std::to_string(edge.a) + " and " +
                std::to_string(edge.b) + " (from 0)" + near(mesh_, edge.a) +
                "; which of its faces belong to the surface is not for a program to guess");
        }
        return {};
    }

    void turn(std::size_t face) {
        std::swap(mesh_.faces[face].y, mesh_.faces[face].z);
        if (face < turned_.size())
            turned_[face] = !turned_[face];
    }

    Status windAlike() {
        const auto flip = facesToFlip(mesh_);
        if (!flip)
            return refuse("the surface is one-sided, as a Moebius strip is; it has no inside to wind by");
        for (std::size_t face = 0; face < flip->size(); ++face)
            if ((*flip)[face])
                turn(face);
        return {};
    }

    /// Diagonal of the box of all faces: stray vertices may lie anywhere.
    double usedSize() const {
        glm::dvec3 lowest = mesh_.positions[mesh_.faces[0].x], highest = lowest;
        for (const glm::uvec3& face : mesh_.faces)
            for (int corner = 0; corner < 3; ++corner) {
                lowest = glm::min(lowest, mesh_.positions[face[corner]]);
                highest = glm::max(highest, mesh_.positions[face[corner]]);
            }
        return glm::length(highest - lowest);
    }

    Status fillHoles() {
        auto loops = boundaryLoops(mesh_, name_ + ": beyond --repair");
        if (!loops)
            return loops.error();
        if (loops->empty())
            return {};
        const double size = usedSize();
        for (const BoundaryLoop& loop : *loops) {
            glm::dvec3 lowest = mesh_.positions[loop[0]], highest = lowest;
            for (const std::uint32_t vertex : loop) {
                lowest = glm::min(lowest, mesh_.positions[vertex]);
                highest = glm::max(highest, mesh_.positions[vertex]);
            }
            const double extent = glm::length(highest - lowest);
            if (loop.size() > limits_.holeEdges || !(extent <= limits_.holeExtent * size))
                return refuse("a hole of " + std::to_string(loop.size()) + " edges, " +
                              number(100 * extent / size) + "% of the mesh's size" + near(mesh_, loop[0]) +
                              "; holes of at most " + std::to_string(limits_.holeEdges) + " edges and " +
                              number(100 * limits_.holeExtent) +
                              "% are filled, close this one in a mesh editor");
        }
        HoleFiller filler(std::move(mesh_));
        const std::size_t faces = filler.mesh().faces.size(), vertices = filler.mesh().positions.size();
        for (const BoundaryLoop& loop : *loops)
            if (!filler.fill(loop))
                return refuse("a hole of " + std::to_string(loop.size()) + " edges" +
                              near(filler.mesh(), loop[0]) +
                              " cannot be filled without touching the surface; weld vertices that differ "
                              "slightly, or fill it in a mesh editor");
        mesh_ = filler.mesh();
        report_.filledHoles = loops->size();
        report_.addedFaces = mesh_.faces.size() - faces;
        report_.addedVertices = mesh_.positions.size() - vertices;
        return {};
    }

    /// Outermost shells bound material from outside, shells in a shell a cavity.
    Status windShells() {
        const MeshTopology topology = findTopology(mesh_);
        if (!topology.nonManifoldVertices.empty())
            return refuse(
                counted(topology.nonManifoldVertices.size(), "non-manifold vertex", "non-manifold vertices") +
                " (a pinch), the first is vertex " + std::to_string(topology.nonManifoldVertices[0]) +
                " (from 0)" + near(mesh_, topology.nonManifoldVertices[0]) +
                "; give each part a vertex of its own");
        const std::vector<Shell> shells = findNesting(mesh_, topology.shellFaces);
        for (std::size_t i = 0; i < shells.size(); ++i) {
            const bool outward = shells[i].depth % 2 == 0;
            if (shells[i].volume == 0 || (shells[i].volume > 0) == outward)
                continue;
            for (const std::uint32_t face : topology.shellFaces[i])
                turn(face);
            ++report_.turnedShells;
        }
        return {};
    }

    void removeStrayVertices() {
        std::vector<bool> used(mesh_.positions.size(), false);
        for (const glm::uvec3& face : mesh_.faces)
            used[face.x] = used[face.y] = used[face.z] = true;
        report_.strayVertices = std::size_t(std::count(used.begin(), used.end(), false));
        if (report_.strayVertices == 0)
            return;
        std::vector<std::uint32_t> newIndex(used.size(), 0);
        std::uint32_t count = 0;
        for (std::size_t vertex = 0; vertex < used.size(); ++vertex) {
            if (!used[vertex])
                continue;
            mesh_.positions[count] = mesh_.positions[vertex];
            if (!mesh_.colours.empty())
                mesh_.colours[count] = mesh_.colours[vertex];
            newIndex[vertex] = count++;
        }
        mesh_.positions.resize(count);
        if (!mesh_.colours.empty())
            mesh_.colours.resize(count);
        for (glm::uvec3& face : mesh_.faces)
            face = {newIndex[face.x], newIndex[face.y], newIndex[face.z]};
    }

    TriangleMesh mesh_;
    const std::string& name_;
    const RepairLimits& limits_;
    RepairReport report_;
    std::vector<bool> turned_; // against the file; one a face that was there before holes were filled
};

} // namespace

bool RepairReport::changed() const {
    return !lines().empty();
}

std::vector<std::string> RepairReport::lines() const {
    std::vector<std::string> lines;
    if (repeatedCornerFaces > 0)
        lines.push_back("removed " + counted(repeatedCornerFaces, "face", "faces") +
                        " with a repeated corner");
    if (duplicateFaces > 0)
        lines.push_back("removed " + counted(duplicateFaces, "duplicate face", "duplicate faces"));
    if (turnedShells > 0 || flippedFaces > 0)
        lines.push_back("flipped " + counted(flippedFaces, "face", "faces") + " that wound wrongly" +
                        (turnedShells > 0
                             ? " (" + counted(turnedShells, "shell", "shells") + " turned as a whole)"
                             : ""));
    if (filledHoles > 0)
        lines.push_back(
            "filled " + counted(filledHoles, "hole", "holes") + " with " +
            counted(addedFaces, "face", "faces") +
            (addedVertices > 0 ? " and " + counted(addedVertices, "new vertex", "new vertices") : ""));
    if (strayVertices > 0)
        lines.push_back("removed " + counted(strayVertices, "stray vertex", "stray vertices") +
                        " that no face used");
    return lines;
}

Result<RepairedMesh> repairMesh(TriangleMesh mesh, const std::string& name, const RepairLimits& limits) {
    return Repair(std::move(mesh), name, limits).all();
}

Error withRepairHint(const Error& error, const TriangleMesh& mesh) {
    const auto repaired = repairMesh(mesh, "");
    if (!repaired.ok())
        return error;
    return {error.message + "; or let --repair do it (in a scene: repair = true)", error.exitCode};
}

} // namespace serosa::sim
