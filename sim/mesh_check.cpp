// Counts what makes a soup of triangles a closed solid, and refuses the first thing that does not.
// The parts: sim/mesh_topology (edges, fans, shells), sim/mesh_nesting (which shell lies in which),
// sim/mesh_crossings (self-intersections).
#include "sim/mesh_check.h"

#include "sim/mesh_crossings.h"
#include "sim/mesh_nesting.h"
#include "sim/mesh_topology.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>

namespace serosa::sim {
namespace {

constexpr double kSmallest = 1e-9, kLargest = 1e9; // file units

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

std::string counted(std::size_t count, const char* what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string near(const TriangleMesh& mesh, std::uint32_t vertex) {
    const glm::dvec3& p = mesh.positions[vertex];
    return " near (" + number(p.x) + ", " + number(p.y) + ", " + number(p.z) + ")";
}

std::string atEdge(const TriangleMesh& mesh, const MeshTopology::Edge& edge) {
    return "the first between vertices " + std::to_string(edge.a) + " and " + std::to_string(edge.b) +
           " (from 0) of triangle " + std::to_string(edge.face) + near(mesh, edge.a);
}

Status checkSize(const TriangleMesh& mesh, const std::string& name) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3& p = mesh.positions[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            return Error{name + ": vertex " + std::to_string(i) + " (from 0) is not finite; repair the mesh"};
    }
    const glm::dvec3 lowest = mesh.lowest(), highest = mesh.highest(), extent = highest - lowest;
    const double size = std::max({extent.x, extent.y, extent.z});
    const double reach = std::max({std::abs(lowest.x), std::abs(lowest.y), std::abs(lowest.z),
                                   std::abs(highest.x), std::abs(highest.y), std::abs(highest.z)});
    const std::string hint =
        "; scale the mesh to a usual unit and say which in length_unit (\"mm\", \"cm\", \"m\")";
    if (!(size <= kLargest))
        return Error{name + ": absurd size: it is " + number(size) + " units wide, above 1e9" + hint};
    if (!(reach <= kLargest))
        return Error{name + ": absurd place: it lies " + number(reach) + " units from the origin, above 1e9" +
                     hint};
    if (!(size >= kSmallest))
        return Error{name + ": absurd size: it is " + number(size) + " units wide, below 1e-9" + hint};
    return {};
}

Status checkTopology(const TriangleMesh& mesh, const MeshTopology& topology, const std::string& name) {
    const auto degenerate = std::find(topology.degenerate.begin(), topology.degenerate.end(), true);
    if (degenerate != topology.degenerate.end()) {
        const auto face = static_cast<std::size_t>(degenerate - topology.degenerate.begin());
        const glm::uvec3 t = mesh.faces[face];
        return Error{name + ": " +
                     counted(static_cast<std::size_t>(
                                 std::count(topology.degenerate.begin(), topology.degenerate.end(), true)),
                             "degenerate triangle") +
                     " (zero area), the first is triangle " + std::to_string(face) +
                     " (from 0) of vertices " + std::to_string(t.x) + ", " + std::to_string(t.y) + ", " +
                     std::to_string(t.z) + near(mesh, t.x) + "; collapse it in a mesh editor"};
    }
    if (!topology.duplicates.empty())
        return Error{name + ": " + counted(topology.duplicates.size(), "triangle") +
                     " with the same three vertices as an earlier one, the first is triangle " +
                     std::to_string(topology.duplicates[0]) + " (from 0)" +
                     near(mesh, mesh.faces[topology.duplicates[0]].x) + "; remove the doubles"};
    if (!topology.nonManifoldEdges.empty())
        return Error{name + ": " + counted(topology.nonManifoldEdges.size(), "non-manifold edge") +
                     " (more than two triangles), " + atEdge(mesh, topology.nonManifoldEdges[0]) +
                     "; separate or remove the inner faces"};
    if (!topology.openEdges.empty())
        return Error{name + ": the surface is open: " + counted(topology.openEdges.size(), "edge") +
                     " with one triangle only, " + atEdge(mesh, topology.openEdges[0]) +
                     "; fill the holes and weld vertices that differ slightly"};
    if (!topology.inconsistentEdges.empty())
        return Error{name + ": inconsistent winding: " + counted(topology.inconsistentEdges.size(), "edge") +
                     " whose two triangles wind against each other, " +
                     atEdge(mesh, topology.inconsistentEdges[0]) + "; make the normals consistent, outward"};
    if (!topology.nonManifoldVertices.empty())
        return Error{name + ": " + counted(topology.nonManifoldVertices.size(), "non-manifold vertex") +
                     " (a pinch, where parts of the surface meet in a point), the first is vertex " +
                     std::to_string(topology.nonManifoldVertices[0]) + " (from 0)" +
                     near(mesh, topology.nonManifoldVertices[0]) + "; give each part a vertex of its own"};
    return {};
}

Status checkNesting(const TriangleMesh& mesh, const MeshTopology& topology, const std::vector<Shell>& shells,
                    const std::string& name) {
    double volume = 0;
    for (const auto& shell : shells)
        volume += shell.volume;
    const glm::dvec3 extent = mesh.highest() - mesh.lowest();
    if (!(std::abs(volume) > 1e-12 * mesh.area() * glm::length(extent)))
        return Error{name + ": it encloses no volume (" + number(volume) +
                     " cubic units): the surface is folded flat; give it thickness"};
    if (volume < 0)
        return Error{name + ": inverted: the triangles wind clockwise seen from outside (volume " +
                     number(volume) + "); flip all faces"};

    const auto shellName = [&](std::size_t i) {
        return "shell " + std::to_string(i) + " (" + counted(topology.shellFaces[i].size(), "triangle") +
               near(mesh, mesh.faces[topology.shellFaces[i][0]].x) + ")";
    };
    const auto largest = static_cast<std::size_t>(
        std::max_element(shells.begin(), shells.end(),
                         [](const Shell& a, const Shell& b) { return a.volume < b.volume; }) -
        shells.begin());
    for (std::size_t i = 0; i < shells.size(); ++i) {
        const Shell& shell = shells[i];
        const bool outward = shell.volume > 0, wantsOutward = shell.depth % 2 == 0;
        if (outward && !wantsOutward)
            return Error{name + ": " + shellName(i) +
                         " lies inside another solid and is wound outward: two overlapping " +
                         "solids; flip its faces if it is a cavity, remove it if not"};
        if (!outward && !wantsOutward)
            continue;
        if (!outward)
            return Error{name + ": " + shellName(i) +
                         " is inverted: wound inward, but in no solid whose cavity it could be; flip its "
                         "faces or remove it"};
        if (i != largest)
            return Error{name + ": several solids: " + shellName(i) +
                         (shell.depth > 0 ? " floats in a cavity of another one"
                                          : " lies outside of the largest one") +
                         "; keep one solid a file and add an organ to the scene for each"};
    }
    return {};
}

} // namespace

MeshReport inspectMesh(const TriangleMesh& mesh, bool countSelfIntersections) {
    const MeshTopology topology = findTopology(mesh);
    MeshReport report;
    report.vertices = mesh.positions.size();
    report.faces = mesh.faces.size();
    report.unusedVertices = topology.unusedVertices;
    report.degenerateFaces =
        static_cast<std::size_t>(std::count(topology.degenerate.begin(), topology.degenerate.end(), true));
    report.duplicateFaces = topology.duplicates.size();
    report.openEdges = topology.openEdges.size();
    report.nonManifoldEdges = topology.nonManifoldEdges.size();
    report.nonManifoldVertices = topology.nonManifoldVertices.size();
    report.inconsistentEdges = topology.inconsistentEdges.size();
    report.shells = topology.shellFaces.size();
    report.volume = mesh.volume();
    report.area = mesh.area();
    report.lowest = mesh.lowest();
    report.highest = mesh.highest();
    if (topology.closedManifold()) {
        for (std::size_t i = 0; i < report.shells; ++i)
            report.genus.push_back(topology.genus(mesh, i));
        for (const auto& shell : findNesting(mesh, topology.shellFaces)) {
            report.solids += shell.volume > 0;
            report.cavities += shell.volume < 0 && shell.depth % 2 == 1;
        }
    }
    if (countSelfIntersections)
        report.selfIntersections = countCrossings(mesh);
    return report;
}

Status checkClosedSolid(const TriangleMesh& mesh, const std::string& name) {
    if (mesh.faces.empty())
        return Error{name + ": no triangles; export a surface"};
    SEROSA_TRY(checkSize(mesh, name));
    const MeshTopology topology = findTopology(mesh);
    SEROSA_TRY(checkTopology(mesh, topology, name));
    return checkNesting(mesh, topology, findNesting(mesh, topology.shellFaces), name);
}

} // namespace serosa::sim
