// The vertex stage on the CPU, in double: twins of shaders/mapping_triangle.glsl (MS05 eq. 9, 3.5, 3.6),
// mapping_frames.glsl and mapping_cell.glsl.
#include "render/surface_binding.h"
#include "render/triangle_basis.h"
#include "sim/packed_normal.h"

namespace serosa::render {

namespace {

using sim::Mapping;

struct Nodes {
    const std::vector<glm::dvec3>& positions;
    const std::vector<std::uint32_t>& normals; // packed
    std::vector<glm::uvec2> frames;            // packed; nodeFrames only
};

/// Weights as the GPU has them: w1 and w2 exact, w3 = 1 - w1 - w2.
glm::dvec3 exactWeights(const glm::vec3& weights) {
    const double w1 = weights.x, w2 = weights.y;
    return {w1, w2, 1 - w1 - w2};
}

template <class Value>
auto weighted(const glm::dvec3& w, const Value& of, const glm::uvec3& nodes) {
    return w.x * of(nodes.x) + w.y * of(nodes.y) + w.z * of(nodes.z);
}

glm::dvec3 trilinear(const std::array<std::uint32_t, 8>& corners, const glm::dvec3& at,
                     const std::vector<glm::dvec3>& positions) {
    glm::dvec3 sum(0);
    for (unsigned c = 0; c < 8; ++c)
        sum += ((c & 1U) ? at.x : 1 - at.x) * ((c & 2U) ? at.y : 1 - at.y) * ((c & 4U) ? at.z : 1 - at.z) *
               positions[corners[c]];
    return sum;
}

glm::dvec3 mapped(const SurfaceBinding& binding, std::size_t v, const Nodes& nodes) {
    const VertexBinding& bound = binding.vertices[v];
    if (binding.mapping == Mapping::trilinear) {
        const CellBinding::Vertex& vertex = binding.cells.vertices[v];
        return trilinear(binding.cells.corners[vertex.cell], vertex.at, nodes.positions);
    }
    const bool along = binding.mapping == Mapping::normalOffset;
    const glm::dvec3 w = exactWeights(along ? binding.alongNormal[v].weights : bound.weights);
    const auto position = [&](std::uint32_t node) { return nodes.positions[node]; };
    const glm::dvec3 reference = weighted(w, position, bound.nodes);
    if (binding.mapping == Mapping::nodeFrames) {
        const auto frame = [&](std::uint32_t node) { return unpackFrame(nodes.frames[node]); };
        return reference + blendFrames(frame(bound.nodes.x), frame(bound.nodes.y), frame(bound.nodes.z), w) *
                               glm::dvec3(bound.offset);
    }
    const glm::dvec3 p1 = position(bound.nodes.x), edge = position(bound.nodes.y) - p1;
    glm::dvec3 normal = triangleNormal(p1, position(bound.nodes.y), position(bound.nodes.z));
    if (bound.correctedShare > 0) {
        const auto nodeNormal = [&](std::uint32_t node) {
            return glm::dvec3(sim::unpackNormal(nodes.normals[node]));
        };
        const glm::dvec3 mean = weighted(w * glm::dvec3(bound.normalShares), nodeNormal, bound.nodes);
        normal = bound.correctedShare == 1
                     ? mean
                     : glm::mix(glm::normalize(normal), glm::normalize(mean), double(bound.correctedShare));
    }
    if (along)
        return reference + double(binding.alongNormal[v].distance) * glm::normalize(normal);
    return reference + fromBasis(basisAlong(normal, edge), glm::dvec3(bound.offset));
}

} // namespace

std::vector<glm::dvec3> mapSurface(const SurfaceBinding& binding,
                                   const std::vector<glm::dvec3>& nodePositions,
                                   const std::vector<std::uint32_t>& packedNormals) {
    Nodes nodes{nodePositions, packedNormals, {}};
    if (binding.mapping == Mapping::nodeFrames)
        nodes.frames = nodeFrames(binding.frames, nodePositions);
    std::vector<glm::dvec3> result;
    result.reserve(binding.vertices.size());
    for (std::size_t v = 0; v < binding.vertices.size(); ++v)
        result.push_back(mapped(binding, v, nodes));
    return result;
}

std::vector<glm::dvec3> referencePoints(const SurfaceBinding& binding,
                                        const std::vector<glm::dvec3>& nodePositions) {
    std::vector<glm::dvec3> points;
    points.reserve(binding.vertices.size());
    for (std::size_t v = 0; v < binding.vertices.size(); ++v) {
        if (binding.mapping == Mapping::trilinear) {
            const CellBinding::Vertex& vertex = binding.cells.vertices[v];
            points.push_back(trilinear(binding.cells.corners[vertex.cell], vertex.at, nodePositions));
            continue;
        }
        const VertexBinding& bound = binding.vertices[v];
        const bool along = binding.mapping == Mapping::normalOffset;
        points.push_back(weighted(
            exactWeights(along ? binding.alongNormal[v].weights : bound.weights),
            [&](std::uint32_t node) { return nodePositions[node]; }, bound.nodes));
    }
    return points;
}

} // namespace serosa::render
