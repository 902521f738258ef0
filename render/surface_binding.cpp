// MS05 3.3, eq. 4-9. All arithmetic is double and rounded to float once: the rounded weights give the
// reference point, and the offset takes up what they miss, so that every vertex returns at rest.
#include "render/surface_binding.h"

#include "base/check.h"
#include "render/basis_choice.h"
#include "render/cut_sides.h"
#include "render/parallel.h"
#include "render/surface_vertices.h"
#include "render/triangle_basis.h"
#include "render/triangle_choice.h"
#include "shaders/mapping_constants.h"
#include "sim/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace serosa::render {

namespace {

using sim::Mapping;

/// Weights as the GPU has them: w1 and w2 exact, w3 = 1 - w1 - w2.
glm::dvec3 exactWeights(const glm::vec3& weights) {
    const double w1 = weights.x, w2 = weights.y;
    return {w1, w2, 1 - w1 - w2};
}

BoundPoint boundPoint(const VertexBinding& bound, const ControlNodes& nodes, const glm::dvec3& vertex) {
    return {bound.nodes,
            {nodes.rest[bound.nodes.x], nodes.rest[bound.nodes.y], nodes.rest[bound.nodes.z]},
            exactWeights(bound.weights),
            vertex};
}

/// In the steps that the GPU has.
double inSteps(double share) {
    return std::round(share * SRS_SHARE_STEPS) / SRS_SHARE_STEPS;
}

double shareOf(Mapping mapping, const RestNormals& rest, const BoundPoint& point) {
    if (mapping == Mapping::curvature)
        return correctedIsDefined(rest, point) ? 1 : 0;
    return mapping == Mapping::chosen ? inSteps(correctedShare(rest, point)) : 0;
}

/// The normal of the basis with a share of the corrected one, as shaders/mapping_triangle.glsl has it.
glm::dvec3 sharedNormal(const RestNormals& rest, const BoundPoint& point, double share) {
    const glm::dvec3 flat = triangleNormal(point.corners[0], point.corners[1], point.corners[2]);
    if (share == 0)
        return flat;
    const glm::dvec3 mean = point.mean(rest);
    return share == 1 ? mean : glm::mix(glm::normalize(flat), glm::normalize(mean), share);
}

/// Eq. 5-8 for one vertex whose triangle and weights stand.
void express(VertexBinding& bound, const RestNormals& rest, BoundPoint point, const glm::dvec3& normal,
             Mapping mapping) {
    bound.normalShares = glm::vec3(1);
    if (mapping == Mapping::chosen)
        for (int i = 0; i < 3; ++i) {
            point.counts[i] = inSteps(rest.trust(bound.nodes[i]));
            bound.normalShares[i] = float(point.counts[i]);
        }
    const double share = shareOf(mapping, rest, point);
    bound.correctedShare = float(share);
    const glm::dvec3 offset = point.vertex - point.reference();
    if (mapping == Mapping::nodeFrames || mapping == Mapping::trilinear) {
        bound.offset = offset;
        bound.normal = normal;
        return;
    }
    const TriangleBasis basis =
        basisAlong(sharedNormal(rest, point, share), point.corners[1] - point.corners[0]);
    bound.offset = inBasis(basis, offset);
    bound.normal = inBasis(basis, normal);
}

/// MS05 3.5 for one vertex: where it lies on its normal, and the rest normal in the basis there.
NormalOffset expressAlongNormal(VertexBinding& bound, const RestNormals& rest, BoundPoint point,
                                const glm::dvec3& normal) {
    const NormalOffset along = offsetAlongNormal(rest, point);
    point.weights = exactWeights(along.weights);
    bound.correctedShare = along.corrected ? 1.0F : 0.0F;
    bound.offset = {0, along.distance, 0};
    const TriangleBasis basis =
        basisAlong(sharedNormal(rest, point, bound.correctedShare), point.corners[1] - point.corners[0]);
    bound.normal = inBasis(basis, normal);
    return along;
}

std::size_t bytesOf(Mapping mapping) {
    return mapping == Mapping::trilinear      ? sizeof(CellVertex)
           : mapping == Mapping::normalOffset ? sizeof(NormalVertex)
           : mapping == Mapping::chosen       ? sizeof(ChosenVertex)
                                              : sizeof(MappedVertex);
}

/// What one of them needs beside the vertices is left to the caller: cells and frames.
void expressVertices(SurfaceBinding& binding, const ControlNodes& nodes, const RestNormals& rest,
                     const sim::TriangleMesh& metres, Mapping mapping) {
    SEROSA_CHECK(mapping != Mapping::oneToOne, "one-to-one draws the nodes themselves and has no binding");
    const std::vector<glm::dvec3> normals = metres.vertexNormals();
    binding.mapping = mapping;
    binding.alongNormal.assign(mapping == Mapping::normalOffset ? normals.size() : 0, {});
    parallelFor(normals.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            VertexBinding& bound = binding.vertices[v];
            const BoundPoint point = boundPoint(bound, nodes, nodes.toNodes(metres.positions[v]));
            if (mapping == Mapping::normalOffset)
                binding.alongNormal[v] = expressAlongNormal(bound, rest, point, normals[v]);
            else
                express(bound, rest, point, normals[v], mapping);
        }
    });
    binding.constantVertices = binding.blendedVertices = 0;
    const bool bases = mapping != Mapping::nodeFrames && mapping != Mapping::trilinear;
    for (const VertexBinding& bound : binding.vertices) {
        binding.constantVertices += bases && bound.correctedShare == 0;
        binding.blendedVertices += bound.correctedShare > 0 && bound.correctedShare < 1;
    }
    binding.cells = {};
    binding.frames = {};
    binding.bytesPerVertex = double(bytesOf(mapping));
}

std::vector<glm::dvec3> inNodes(const ControlNodes& nodes, const sim::TriangleMesh& metres) {
    std::vector<glm::dvec3> positions;
    positions.reserve(metres.positions.size());
    for (const glm::dvec3& p : metres.positions)
        positions.push_back(nodes.toNodes(p));
    return positions;
}

} // namespace

void followTriangle(VertexBinding& bound, std::uint32_t& triangle, const ControlNodes& nodes,
                    std::uint32_t chosen, const glm::dvec3& weights) {
    const glm::uvec3& corners = nodes.triangles[chosen];
    const int first = diagonalStart(nodes, corners);
    for (int i = 0; i < 3; ++i) {
        bound.nodes[i] = corners[(first + i) % 3];
        const double weight = weights[(first + i) % 3];
        bound.weights[i] = float(std::round(weight * SRS_WEIGHT_STEPS) / SRS_WEIGHT_STEPS);
    }
    bound.weights.z = float(exactWeights(bound.weights).z);
    triangle = chosen;
}

namespace {

/// Triangles and weights.
SurfaceBinding choose(const ControlNodes& nodes, const sim::TriangleMesh& metres) {
    SEROSA_CHECK(!nodes.triangles.empty(), "triangles to follow (checkBinding)");
    TriangleChoice choice =
        chooseTriangles(nodes, metres.faces, inNodes(nodes, metres), metres.vertexNormals());
    SurfaceBinding binding;
    binding.tornEdgesFound = choice.tornEdgesFound;
    binding.tornEdgesLeft = choice.tornEdgesLeft;
    binding.vertices.resize(metres.positions.size());
    binding.triangles.resize(metres.positions.size());
    for (std::size_t v = 0; v < binding.vertices.size(); ++v)
        followTriangle(binding.vertices[v], binding.triangles[v], nodes, choice.triangles[v],
                       choice.weights[v]);
    return binding;
}

} // namespace

SurfaceBinding bindSurface(const ControlNodes& nodes, const sim::TriangleMesh& metres, Mapping mapping) {
    SEROSA_CHECK(mapping != Mapping::trilinear, "nodes without a lattice have no cells");
    SurfaceBinding binding = choose(nodes, metres);
    expressVertices(binding, nodes, RestNormals(nodes), metres, mapping);
    if (mapping == Mapping::nodeFrames)
        binding.frames = frameStencil(nodes);
    return binding;
}

SurfaceBinding bindSurface(const sim::Lattice& lattice, const sim::TriangleMesh& metres, Mapping mapping) {
    return expressBinding(choose(controlNodes(lattice), metres), lattice, metres, mapping);
}

SurfaceBinding expressBinding(const SurfaceBinding& binding, const sim::Lattice& lattice,
                              const sim::TriangleMesh& metres, Mapping mapping,
                              const std::vector<std::uint32_t>& connections) {
    SEROSA_CHECK(binding.vertices.size() == metres.positions.size(), "the binding is of another mesh");
    SurfaceBinding other = binding;
    const ControlNodes nodes = controlNodes(lattice);
    if (!connections.empty() && connections != lattice.connections) {
        CutSides sides(lattice, connections);
        followOwnSides(other, lattice, inNodes(nodes, metres), sides);
    }
    expressVertices(other, nodes, RestNormals(lattice, connections), metres, mapping);
    if (mapping == Mapping::trilinear)
        other.cells = bindToCells(lattice, inNodes(nodes, metres));
    if (mapping == Mapping::nodeFrames)
        other.frames = frameStencil(lattice, connections);
    return other;
}

std::vector<SurfaceBinding> withBothBases(const SurfaceBinding& binding, const sim::Lattice& lattice,
                                          const sim::TriangleMesh& metres) {
    std::vector<SurfaceBinding> bindings{binding};
    for (const sim::Mapping mapping : {sim::Mapping::triangle, sim::Mapping::curvature})
        if (mapping != binding.mapping)
            bindings.push_back(expressBinding(binding, lattice, metres, mapping));
    return bindings;
}

TriangleBasis restAxes(const SurfaceBinding& binding, std::size_t vertex, const sim::Lattice& lattice,
                       const RestNormals& rest) {
    if (binding.mapping == Mapping::nodeFrames || binding.mapping == Mapping::trilinear)
        return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const VertexBinding& bound = binding.vertices[vertex];
    BoundPoint point{
        bound.nodes, {}, exactWeights(bound.weights), glm::dvec3(0), glm::dvec3(bound.normalShares)};
    for (int i = 0; i < 3; ++i)
        point.corners[i] = lattice.restPosition(bound.nodes[i]);
    if (binding.mapping == Mapping::normalOffset)
        point.weights = exactWeights(binding.alongNormal[vertex].weights);
    return basisAlong(sharedNormal(rest, point, bound.correctedShare), point.corners[1] - point.corners[0]);
}

SurfaceBinding withCopies(const SurfaceBinding& binding, const std::vector<VertexCopy>& copies,
                          const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                          const std::vector<std::uint32_t>& connections) {
    SurfaceBinding all = binding;
    const bool elsewhere = binding.mapping != Mapping::trilinear &&
                           std::any_of(copies.begin(), copies.end(),
                                       [](const VertexCopy& copy) { return copy.follows.has_value(); });
    std::optional<ControlNodes> nodes;
    std::optional<RestNormals> rest;
    std::vector<glm::dvec3> normals;
    if (elsewhere) {
        nodes.emplace(controlNodes(lattice));
        rest.emplace(lattice, connections);
        normals = metres.vertexNormals();
    }
    for (const VertexCopy& copy : copies) {
        const std::uint32_t vertex = copy.vertex;
        VertexBinding bound = binding.vertices[vertex];
        std::uint32_t triangle = binding.triangles[vertex];
        std::optional<NormalOffset> along;
        if (!binding.alongNormal.empty())
            along = binding.alongNormal[vertex];
        if (elsewhere && copy.follows) {
            followTriangle(bound, triangle, *nodes, copy.follows->triangle, copy.follows->weights);
            const BoundPoint point = boundPoint(bound, *nodes, nodes->toNodes(metres.positions[vertex]));
            if (along)
                along = expressAlongNormal(bound, *rest, point, normals[vertex]);
            else
                express(bound, *rest, point, normals[vertex], binding.mapping);
        }
        all.vertices.push_back(bound);
        all.triangles.push_back(triangle);
        if (along)
            all.alongNormal.push_back(*along);
        if (!all.cells.vertices.empty())
            all.cells.vertices.push_back(binding.cells.vertices[vertex]);
    }
    return all;
}

Status checkBinding(const ControlNodes& nodes, const sim::TriangleMesh& metres) {
    if (nodes.triangles.empty())
        return Error{"the nodes have no triangles that a surface could follow: give a mesh with faces"};
    if (metres.faces.empty())
        return Error{"the surface has no faces: give a mesh with faces"};
    const sim::TriangleTree tree(nodes.rest, nodes.triangles);
    double farthest = 0;
    std::size_t vertex = 0;
    for (std::size_t v = 0; v < metres.positions.size(); ++v)
        if (const double distance = std::sqrt(tree.closest(nodes.toNodes(metres.positions[v])).distance2);
            !(distance <= farthest)) {
            farthest = distance;
            vertex = v;
        }
    if (farthest <= kFarthestSpacings)
        return {};
    std::ostringstream text;
    text.precision(4);
    text << "vertex " << vertex << " of the surface (the first is 0) lies " << 1e3 * farthest * nodes.spacing
         << " mm from the nearest triangle of nodes, " << farthest << " times their spacing of "
         << 1e3 * nodes.spacing << " mm, and at most " << kFarthestSpacings
         << " can be followed: do the two belong together, in one unit and one place?";
    return Error{text.str()};
}

} // namespace serosa::render
