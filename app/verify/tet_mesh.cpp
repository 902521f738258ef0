// See app/verify/tet_mesh.h. TetGen 1.5: the surface goes as a .poly file in millimetres, with the loops in
// the plane as one facet more; tetrahedra come back as .node and .ele files. Whether one belongs to the solid
// its centre decides: tetgen knows no cavities without a point in each.
#include "app/verify/tet_mesh.h"

#include "base/child_process.h"
#include "sim/node_depths.h"
#include "sim/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>

namespace serosa::app {

namespace {

namespace fs = std::filesystem;

constexpr double kMillimetre = 1e-3;
constexpr double kRadiusEdgeRatio = 1.5; // of the worst element: circumradius over shortest edge
constexpr double kVolumeTolerance = 1e-6;

Status writePoly(const PlaneCut& cut, const fs::path& file) {
    std::FILE* out = std::fopen(file.c_str(), "w");
    if (!out)
        return Error{file.string() + ": cannot be written: is the disk full?"};
    std::fprintf(out, "%zu 3 0 0\n", cut.above.positions.size());
    for (std::size_t v = 0; v < cut.above.positions.size(); ++v) {
        const glm::dvec3 p = cut.above.positions[v] / kMillimetre;
        std::fprintf(out, "%zu %.17g %.17g %.17g\n", v, p.x, p.y, p.z);
    }
    std::fprintf(out, "%zu 0\n", cut.above.faces.size() + 1);
    for (const glm::uvec3& face : cut.above.faces)
        std::fprintf(out, "1\n3 %u %u %u\n", face.x, face.y, face.z);
    std::fprintf(out, "%zu\n", cut.loops.size());
    for (const std::vector<std::uint32_t>& loop : cut.loops) {
        std::fprintf(out, "%zu", loop.size());
        for (const std::uint32_t v : loop)
            std::fprintf(out, " %u", v);
        std::fprintf(out, "\n");
    }
    std::fprintf(out, "0\n"); // no holes
    const bool failed = std::ferror(out) != 0;
    if (std::fclose(out) != 0 || failed)
        return Error{file.string() + ": cannot be written: is the disk full?"};
    return {};
}

/// The numbers of a .node or .ele file, row by row without their index, which must count from 0.
template <std::size_t Columns>
Result<std::vector<std::array<double, Columns>>> readRows(const fs::path& file) {
    std::ifstream in(file);
    const auto error = [&](std::size_t line, const std::string& what) {
        return Error{file.filename().string() + ":" + std::to_string(line) + ": " + what +
                         ": tetgen was cut short, or is of another version than 1.5",
                     exitChildFailed};
    };
    std::string text;
    std::size_t count = 0, columns = 0;
    if (!std::getline(in, text) || !(std::istringstream(text) >> count >> columns) || columns != Columns)
        return error(1, "no header with " + std::to_string(Columns) + " columns");
    std::vector<std::array<double, Columns>> rows;
    for (std::size_t i = 0; i < count; ++i) {
        std::array<double, Columns> row;
        std::size_t index = 0;
        bool good = bool(std::getline(in, text));
        std::istringstream words(text);
        good = good && words >> index && index == i;
        for (double& value : row)
            good = good && words >> value && std::isfinite(value);
        if (!good)
            return error(i + 2, "no row " + std::to_string(i) + " of " + std::to_string(count));
        rows.push_back(row);
    }
    return rows;
}

double signedVolume(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    return glm::dot(b - a, glm::cross(c - a, d - a)) / 6;
}

} // namespace

double TetMesh::volume(std::size_t element) const {
    const std::array<std::uint32_t, 10>& e = elements[element];
    return signedVolume(nodes[e[0]], nodes[e[1]], nodes[e[2]], nodes[e[3]]);
}

double TetMesh::volume() const {
    double sum = 0;
    for (std::size_t element = 0; element < elements.size(); ++element)
        sum += volume(element);
    return sum;
}

double TetMesh::meanEdge() const {
    double sum = 0;
    for (const std::array<std::uint32_t, 10>& e : elements)
        for (const auto& [a, b] : kTetEdges)
            sum += glm::distance(nodes[e[std::size_t(a)]], nodes[e[std::size_t(b)]]);
    return sum / double(6 * elements.size());
}

TetMesh quadraticTets(std::vector<glm::dvec3> corners,
                      const std::vector<std::array<std::uint32_t, 4>>& elements) {
    TetMesh mesh;
    mesh.corners = corners.size();
    mesh.nodes = std::move(corners);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    for (std::array<std::uint32_t, 4> tet : elements) {
        if (signedVolume(mesh.nodes[tet[0]], mesh.nodes[tet[1]], mesh.nodes[tet[2]], mesh.nodes[tet[3]]) < 0)
            std::swap(tet[2], tet[3]);
        std::array<std::uint32_t, 10> element{tet[0], tet[1], tet[2], tet[3]};
        for (std::size_t edge = 0; edge < kTetEdges.size(); ++edge) {
            const std::uint32_t a = tet[std::size_t(kTetEdges[edge][0])],
                                b = tet[std::size_t(kTetEdges[edge][1])];
            const auto [found, isNew] =
                middles.try_emplace(std::minmax(a, b), std::uint32_t(mesh.nodes.size()));
            if (isNew)
                mesh.nodes.push_back(0.5 * (mesh.nodes[a] + mesh.nodes[b]));
            element[4 + edge] = found->second;
        }
        mesh.elements.push_back(element);
    }
    return mesh;
}

bool tetgenExists() {
    return programExists("tetgen");
}

Result<TetMesh> fillWithTets(const PlaneCut& cut, double largestVolume, double seconds) {
    if (!tetgenExists())
        return Error{kTetgenMissing};
    SEROSA_ASSIGN(const TemporaryFolder folder, TemporaryFolder::create());
    SEROSA_TRY(writePoly(cut, folder.path() / "solid.poly"));
    char options[64];
    std::snprintf(options, sizeof options, "-pq%ga%.9f", kRadiusEdgeRatio,
                  largestVolume / std::pow(kMillimetre, 3));
    SEROSA_TRY(runChild({"tetgen", {options, "solid.poly"}, folder.path(), seconds}));
    SEROSA_ASSIGN(const auto points, readRows<3>(folder.path() / "solid.1.node"));
    SEROSA_ASSIGN(const auto tets, readRows<4>(folder.path() / "solid.1.ele"));

    std::vector<glm::dvec3> corners;
    for (const std::array<double, 3>& p : points)
        corners.push_back(kMillimetre * glm::dvec3(p[0], p[1], p[2]));
    if (corners.size() < cut.above.positions.size())
        return Error{"solid.1.node: fewer nodes than the surface has: tetgen was cut short", exitChildFailed};
    // As they were given, without the rounding to millimetres and back.
    std::copy(cut.above.positions.begin(), cut.above.positions.end(), corners.begin());
    const sim::TriangleTree tree(cut.whole.positions, cut.whole.faces);
    const double reach = 2 * glm::distance(cut.whole.lowest(), cut.whole.highest());
    std::vector<std::array<std::uint32_t, 4>> kept;
    for (const std::array<double, 4>& row : tets) {
        std::array<std::uint32_t, 4> tet;
        glm::dvec3 centre(0);
        for (std::size_t i = 0; i < 4; ++i) {
            if (row[i] < 0 || row[i] >= double(corners.size()))
                return Error{"solid.1.ele: a corner that is no node: tetgen was cut short", exitChildFailed};
            tet[i] = std::uint32_t(row[i]);
            centre += 0.25 * corners[tet[i]];
        }
        if (centre.y > cut.height && sim::isInside(tree, centre, reach))
            kept.push_back(tet);
    }
    TetMesh mesh = quadraticTets(std::move(corners), kept);
    const double miss = mesh.volume() / cut.volume() - 1;
    if (!(std::abs(miss) < kVolumeTolerance))
        return Error{"tetgen's tetrahedra do not fill the solid: their volume is off by " +
                         std::to_string(100 * miss) + "%",
                     exitChildFailed};
    return mesh;
}

} // namespace serosa::app
