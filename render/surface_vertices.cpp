#include "render/surface_vertices.h"

#include "shaders/mapping_constants.h"
#include "shaders/shared_constants.h"
#include "sim/packed_normal.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace serosa::render {

namespace {

std::uint32_t texel(const sim::TextureLayout& layout, std::uint32_t node) {
    const glm::uvec2& at = layout.texelOfNode[node];
    return at.y << 16 | at.x;
}

/// Of the eight corners of a cell.
void addCorners(const std::array<std::uint32_t, 8>& corners, const sim::TextureLayout& layout,
                std::vector<glm::uvec4>& texels) {
    for (std::size_t half = 0; half < 8; half += 4)
        texels.emplace_back(texel(layout, corners[half]), texel(layout, corners[half + 1]),
                            texel(layout, corners[half + 2]), texel(layout, corners[half + 3]));
}

/// Filled up to whole rows of a table, one at least.
std::vector<glm::uvec4> inRows(std::vector<glm::uvec4> texels) {
    const std::size_t rows = (texels.size() + SRS_TABLE_WIDTH - 1) / SRS_TABLE_WIDTH;
    texels.resize(std::max<std::size_t>(rows, 1) * SRS_TABLE_WIDTH);
    return texels;
}

} // namespace

MappedVertex mappedVertex(const VertexBinding& bound, const sim::TextureLayout& layout,
                          const glm::u8vec4& colour) {
    MappedVertex vertex;
    for (int i = 0; i < 3; ++i)
        vertex.texels[i] = texel(layout, bound.nodes[i]);
    vertex.weights = {std::lround(double(bound.weights.x) * SRS_WEIGHT_STEPS),
                      std::lround(double(bound.weights.y) * SRS_WEIGHT_STEPS)};
    vertex.offset = bound.offset;
    vertex.normal = sim::packNormal(bound.normal) | (bound.correctedShare == 1 ? kCorrectedBit : 0U);
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

RestVertex restVertex(const RestBox& box, const glm::dvec3& lattice, const glm::dvec3& normal,
                      const TriangleBasis& basis, int side, double away) {
    RestVertex vertex;
    const glm::dvec3 inBox = (lattice - glm::dvec3(box.from)) / glm::dvec3(box.extent);
    vertex.position = glm::u16vec3(glm::round(65535.0 * glm::clamp(inBox, 0.0, 1.0)));
    const double share = std::clamp(away / (2 * SRS_MASK_SIDES) + 0.5, 0.0, 1.0);
    vertex.side = std::uint16_t(side + 1 + 3 * int(std::round(share * SRS_AWAY_STEPS)));
    vertex.normal = sim::packNormal(glm::vec3(normal));
    // Of the normal as it is unpacked: the shader makes the same tangent of it.
    const glm::dvec3 tangent = anyTangent(glm::dvec3(sim::unpackNormal(vertex.normal)));
    vertex.tangent = sim::packNormal(glm::vec3(inBasis(basis, tangent)));
    return vertex;
}

std::vector<ChosenVertex> chosenVertices(const SurfaceBinding& binding, const sim::TextureLayout& layout,
                                         const std::vector<glm::u8vec4>& colours) {
    std::vector<ChosenVertex> vertices;
    for (const MappedVertex& mapped : mappedVertices(binding, layout, colours)) {
        const VertexBinding& bound = binding.vertices[vertices.size()];
        const glm::dvec4 shares(bound.normalShares, bound.correctedShare);
        vertices.push_back({mapped, glm::u8vec4(glm::round(shares * SRS_SHARE_STEPS))});
    }
    return vertices;
}

std::vector<NormalVertex> normalVertices(const SurfaceBinding& binding, const sim::TextureLayout& layout,
                                         const std::vector<glm::u8vec4>& colours) {
    std::vector<NormalVertex> vertices;
    for (std::size_t v = 0; v < binding.vertices.size(); ++v) {
        const VertexBinding& bound = binding.vertices[v];
        const NormalOffset& along = binding.alongNormal[v];
        vertices.push_back(
            {{texel(layout, bound.nodes.x), texel(layout, bound.nodes.y), texel(layout, bound.nodes.z)},
             glm::vec2(along.weights),
             along.distance,
             sim::packNormal(bound.normal) | (along.corrected ? kCorrectedBit : 0U),
             colours[v]});
    }
    return vertices;
}

std::vector<CellVertex> cellVertices(const SurfaceBinding& binding, const std::vector<glm::u8vec4>& colours) {
    std::vector<CellVertex> vertices;
    for (std::size_t v = 0; v < binding.vertices.size(); ++v)
        vertices.push_back({binding.cells.vertices[v].cell, binding.cells.vertices[v].at,
                            sim::packNormal(binding.vertices[v].normal), colours[v]});
    return vertices;
}

std::vector<glm::uvec4> cellTexels(const CellBinding& cells, const sim::TextureLayout& layout) {
    std::vector<glm::uvec4> texels;
    for (const auto& corners : cells.corners)
        addCorners(corners, layout, texels);
    return inRows(std::move(texels));
}

std::vector<glm::uvec4> carriedTexels(const CellBinding& cells, const std::vector<float>& shares,
                                      const sim::TextureLayout& layout) {
    std::vector<glm::uvec4> texels;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const CellBinding::Vertex& vertex = cells.vertices[i];
        addCorners(cells.corners[vertex.cell], layout, texels);
        texels.push_back(glm::floatBitsToUint(glm::vec4(vertex.at, shares[i])));
    }
    return inRows(std::move(texels));
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
