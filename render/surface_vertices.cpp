#include "render/surface_vertices.h"

#include "shaders/shared_constants.h"
#include "sim/packed_normal.h"
#include "sim/solver.h"

#include <meshoptimizer.h>

#include <cmath>

namespace serosa::render {

namespace {

std::uint32_t texel(const sim::TextureLayout& layout, std::uint32_t node) {
    const glm::uvec2& at = layout.texelOfNode[node];
    return at.y << 16 | at.x;
}

} // namespace

MappedVertex mappedVertex(const VertexBinding& bound, const sim::TextureLayout& layout,
                          const glm::u8vec4& colour) {
    MappedVertex vertex;
    for (int i = 0; i < 3; ++i)
        vertex.texels[i] = texel(layout, bound.nodes[i]);
    vertex.weights = {std::lround(double(bound.weights.x) * kWeightSteps),
                      std::lround(double(bound.weights.y) * kWeightSteps)};
    vertex.offset = bound.offset;
    vertex.normal = sim::packNormal(bound.normal) | (bound.basis == SRS_BASIS_CORRECTED ? kCorrectedBit : 0U);
    vertex.colour = colour;
    return vertex;
}

std::vector<MappedVertex> mappedVertices(const SurfaceBinding& binding, const sim::TextureLayout& layout,
                                         const std::vector<glm::u8vec4>& colours) {
    std::vector<MappedVertex> vertices;
    vertices.reserve(binding.vertices.size());
    for (std::size_t v = 0; v < binding.vertices.size(); ++v)
        vertices.push_back(mappedVertex(binding.vertices[v], layout, colours[v]));
    return vertices;
}

RestBox restBox(const sim::Lattice& lattice, const sim::TriangleMesh& metres) {
    const glm::dvec3 low = lattice.toLattice(metres.lowest()), high = lattice.toLattice(metres.highest());
    return {glm::vec3(low), glm::vec3(glm::max(high - low, glm::dvec3(1e-6)))};
}

glm::dvec3 anyTangent(const glm::dvec3& n) {
    const double sign = n.z < 0 ? -1 : 1, a = -1 / (sign + n.z);
    return {1 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

RestBases::RestBases(const sim::Lattice& lattice)
    : lattice_(lattice), normals_(sim::restState(lattice).normals) {}

TriangleBasis RestBases::of(const VertexBinding& bound) const {
    const glm::dvec3 p1 = lattice_.restPosition(bound.nodes.x), p2 = lattice_.restPosition(bound.nodes.y),
                     p3 = lattice_.restPosition(bound.nodes.z);
    glm::dvec3 normal = triangleNormal(p1, p2, p3);
    if (bound.basis == SRS_BASIS_CORRECTED) {
        normal = glm::dvec3(0);
        for (int i = 0; i < 3; ++i)
            normal += double(bound.weights[i]) * glm::dvec3(sim::unpackNormal(normals_[bound.nodes[i]]));
    }
    return basisAlong(normal, p2 - p1);
}

RestVertex restVertex(const RestBox& box, const glm::dvec3& lattice, const glm::dvec3& normal,
                      const TriangleBasis& basis, int side) {
    RestVertex vertex;
    const glm::dvec3 share = (lattice - glm::dvec3(box.from)) / glm::dvec3(box.extent);
    vertex.position = glm::u16vec3(glm::round(65535.0 * glm::clamp(share, 0.0, 1.0)));
    vertex.side = std::uint16_t(side + 1);
    vertex.normal = sim::packNormal(glm::vec3(normal));
    // Of the normal as it is unpacked: the shader makes the same tangent of it.
    const glm::dvec3 tangent = anyTangent(glm::dvec3(sim::unpackNormal(vertex.normal)));
    vertex.tangent = sim::packNormal(glm::vec3(inBasis(basis, tangent)));
    return vertex;
}

std::vector<RestVertex> restVertices(const sim::Lattice& lattice, const RestBox& box,
                                     const sim::TriangleMesh& metres, const SurfaceBinding* binding) {
    const std::vector<glm::dvec3> normals = metres.vertexNormals();
    const RestBases bases(lattice);
    const TriangleBasis axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::vector<RestVertex> vertices;
    vertices.reserve(normals.size());
    for (std::size_t v = 0; v < normals.size(); ++v)
        vertices.push_back(restVertex(box, lattice.toLattice(metres.positions[v]), normals[v],
                                      binding ? bases.of(binding->vertices[v]) : axes, 0));
    return vertices;
}

std::vector<StaticVertex> staticVertices(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                         const std::vector<glm::u8vec4>& colours) {
    const std::vector<glm::dvec3> normals = metres.vertexNormals();
    std::vector<StaticVertex> vertices(metres.positions.size());
    for (std::size_t v = 0; v < vertices.size(); ++v)
        vertices[v] = {glm::vec3(lattice.toLattice(metres.positions[v])),
                       sim::packNormal(glm::vec3(normals[v])), colours[v]};
    return vertices;
}

CacheOrder cacheOrder(const std::vector<glm::uvec3>& faces, std::size_t vertices) {
    std::vector<std::uint32_t> indices;
    indices.reserve(faces.size() * 3);
    for (const glm::uvec3& face : faces)
        indices.insert(indices.end(), {face.x, face.y, face.z});
    CacheOrder order;
    order.indices.resize(indices.size());
    meshopt_optimizeVertexCache(order.indices.data(), indices.data(), indices.size(), vertices);
    order.newIndex.resize(vertices);
    auto next = std::uint32_t(meshopt_optimizeVertexFetchRemap(order.newIndex.data(), order.indices.data(),
                                                               indices.size(), vertices));
    for (std::uint32_t& index : order.newIndex) // vertices that no face uses come last
        if (index == ~0U)
            index = next++;
    for (std::uint32_t& index : order.indices)
        index = order.newIndex[index];
    return order;
}

double cacheMisses(const CacheOrder& order) {
    return double(meshopt_analyzeVertexCache(order.indices.data(), order.indices.size(),
                                             order.newIndex.size(), 32, 0, 0)
                      .acmr);
}

} // namespace serosa::render
