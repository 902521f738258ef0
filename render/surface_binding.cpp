// MS05 3.3, eq. 4-9. All arithmetic is double and rounded to float once: the rounded weights give the
// reference point, and the offset takes up what they miss, so that every vertex returns at rest.
#include "render/surface_binding.h"

#include "base/check.h"
#include "render/parallel.h"
#include "render/surface_vertices.h"
#include "render/triangle_basis.h"
#include "render/triangle_choice.h"
#include "shaders/shared_constants.h"
#include "sim/packed_normal.h"
#include "sim/solver.h"

#include <cmath>

namespace serosa::render {

namespace {

// Where the corrected basis is not well defined, the constant one is used (MS05 3.6 asks for the choice per
// vertex).
constexpr double kShortestNormalSum = 0.5; // of eq. 3 at a node: one-node-thin sheets
constexpr double kShortestMean = 0.35; // of eq. 8's N_c before it is normalized: nodes whose normals oppose
constexpr double kSmallestSine = 0.3;  // between N_c and the first edge

struct Rest {
    const sim::Lattice& lattice;
    std::vector<glm::dvec3> normals; // as packed
    std::vector<bool> defined;       // eq. 3 is long enough

    explicit Rest(const sim::Lattice& source) : lattice(source) {
        const sim::LatticeState state = sim::restState(source);
        const std::vector<glm::dvec3> sums = sim::restNormalSums(source);
        for (std::size_t i = 0; i < source.nodeCount(); ++i) {
            normals.emplace_back(sim::unpackNormal(state.normals[i]));
            defined.push_back(glm::length(sums[i]) >= kShortestNormalSum);
        }
    }
};

/// Weights as the GPU has them: w1 and w2 exact, w3 = 1 - w1 - w2.
glm::dvec3 exactWeights(const glm::vec3& weights) {
    const double w1 = weights.x, w2 = weights.y;
    return {w1, w2, 1 - w1 - w2};
}

/// Eq. 5-8 for one vertex whose triangle and weights stand.
void express(VertexBinding& bound, const Rest& rest, const glm::dvec3& vertex, const glm::dvec3& normal,
             sim::Mapping mapping) {
    const glm::dvec3 p1 = rest.lattice.restPosition(bound.nodes.x),
                     p2 = rest.lattice.restPosition(bound.nodes.y),
                     p3 = rest.lattice.restPosition(bound.nodes.z);
    const glm::dvec3 w = exactWeights(bound.weights), edge = p2 - p1;
    const glm::dvec3 mean = w.x * rest.normals[bound.nodes.x] + w.y * rest.normals[bound.nodes.y] +
                            w.z * rest.normals[bound.nodes.z];
    const bool corrected =
        mapping == sim::Mapping::curvature && rest.defined[bound.nodes.x] && rest.defined[bound.nodes.y] &&
        rest.defined[bound.nodes.z] && glm::length(mean) >= kShortestMean &&
        glm::length(glm::cross(mean, edge)) >= kSmallestSine * glm::length(mean) * glm::length(edge);
    const TriangleBasis basis = basisAlong(corrected ? mean : triangleNormal(p1, p2, p3), edge);
    bound.basis = corrected ? SRS_BASIS_CORRECTED : SRS_BASIS_CONSTANT;
    bound.offset = inBasis(basis, vertex - (w.x * p1 + w.y * p2 + w.z * p3));
    bound.normal = inBasis(basis, normal);
}

void expressAll(SurfaceBinding& binding, const sim::Lattice& lattice,
                const std::vector<glm::dvec3>& positions, const std::vector<glm::dvec3>& normals,
                sim::Mapping mapping) {
    SEROSA_CHECK(mapping != sim::Mapping::oneToOne,
                 "one-to-one draws the nodes themselves and has no binding");
    const Rest rest(lattice);
    binding.mapping = mapping;
    binding.constantVertices = 0;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        express(binding.vertices[v], rest, positions[v], normals[v], mapping);
        binding.constantVertices += binding.vertices[v].basis == SRS_BASIS_CONSTANT;
    }
    binding.bytesPerVertex = sizeof(MappedVertex);
}

std::vector<glm::dvec3> inLattice(const sim::Lattice& lattice, const sim::TriangleMesh& metres) {
    std::vector<glm::dvec3> positions;
    positions.reserve(metres.positions.size());
    for (const glm::dvec3& p : metres.positions)
        positions.push_back(lattice.toLattice(p));
    return positions;
}

} // namespace

SurfaceBinding bindSurface(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                           sim::Mapping mapping) {
    const std::vector<glm::dvec3> positions = inLattice(lattice, metres), normals = metres.vertexNormals();
    TriangleChoice choice = chooseTriangles(lattice, metres.faces, positions, normals);
    SurfaceBinding binding;
    binding.tornEdgesFound = choice.tornEdgesFound;
    binding.tornEdgesLeft = choice.tornEdgesLeft;
    binding.vertices.resize(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
        VertexBinding& bound = binding.vertices[v];
        const glm::uvec3& nodes = lattice.boundary[choice.triangles[v]];
        const int first = diagonalStart(lattice, nodes);
        for (int i = 0; i < 3; ++i) {
            bound.nodes[i] = nodes[(first + i) % 3];
            const double weight = choice.weights[v][(first + i) % 3];
            bound.weights[i] = float(std::round(weight * kWeightSteps) / kWeightSteps);
        }
        bound.weights.z = float(exactWeights(bound.weights).z);
    }
    binding.triangles = std::move(choice.triangles);
    expressAll(binding, lattice, positions, normals, mapping);
    return binding;
}

SurfaceBinding expressBinding(const SurfaceBinding& binding, const sim::Lattice& lattice,
                              const sim::TriangleMesh& metres, sim::Mapping mapping) {
    SEROSA_CHECK(binding.vertices.size() == metres.positions.size(), "the binding is of another mesh");
    SurfaceBinding other = binding;
    expressAll(other, lattice, inLattice(lattice, metres), metres.vertexNormals(), mapping);
    return other;
}

std::vector<glm::dvec3> mapSurface(const SurfaceBinding& binding,
                                   const std::vector<glm::dvec3>& nodePositions,
                                   const std::vector<std::uint32_t>& packedNormals) {
    std::vector<glm::dvec3> mapped;
    mapped.reserve(binding.vertices.size());
    for (const VertexBinding& bound : binding.vertices) {
        const glm::dvec3 &p1 = nodePositions[bound.nodes.x], &p2 = nodePositions[bound.nodes.y],
                         &p3 = nodePositions[bound.nodes.z];
        const glm::dvec3 w = exactWeights(bound.weights);
        glm::dvec3 normal = triangleNormal(p1, p2, p3);
        if (bound.basis == SRS_BASIS_CORRECTED)
            normal = w.x * glm::dvec3(sim::unpackNormal(packedNormals[bound.nodes.x])) +
                     w.y * glm::dvec3(sim::unpackNormal(packedNormals[bound.nodes.y])) +
                     w.z * glm::dvec3(sim::unpackNormal(packedNormals[bound.nodes.z]));
        const glm::dvec3 offset = fromBasis(basisAlong(normal, p2 - p1), glm::dvec3(bound.offset));
        mapped.push_back(w.x * p1 + w.y * p2 + w.z * p3 + offset);
    }
    return mapped;
}

std::vector<glm::dvec3> referencePoints(const SurfaceBinding& binding,
                                        const std::vector<glm::dvec3>& nodePositions) {
    std::vector<glm::dvec3> points;
    points.reserve(binding.vertices.size());
    for (const VertexBinding& bound : binding.vertices) {
        const glm::dvec3 w = exactWeights(bound.weights);
        points.push_back(w.x * nodePositions[bound.nodes.x] + w.y * nodePositions[bound.nodes.y] +
                         w.z * nodePositions[bound.nodes.z]);
    }
    return points;
}

} // namespace serosa::render
