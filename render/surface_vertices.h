#pragma once
// What a vertex costs on the GPU: 36 bytes with a mapping, 20 without (the undeformed twin that benchmarks
// draw).

#include "render/surface_binding.h"
#include "sim/texture_layout.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace serosa::render {

constexpr double kWeightSteps = 65535;

/// Bit 30 of a packed normal is 0 (sim/packed_normal.h); here it says that the basis is the corrected one.
constexpr std::uint32_t kCorrectedBit = 1U << 30;

struct MappedVertex {
    glm::uvec3 texels;    // of the three nodes: y << 16 | x
    glm::u16vec2 weights; // w1, w2 in 1/65535
    glm::vec3 offset;     // lattice units, in the basis
    std::uint32_t normal; // packed, in the basis, with kCorrectedBit
    glm::u8vec4 colour;   // sRGB, and ambient light that reaches the vertex
};
static_assert(sizeof(MappedVertex) == 36);

struct StaticVertex {
    glm::vec3 position;   // lattice units, at rest
    std::uint32_t normal; // packed, lattice axes
    glm::u8vec4 colour;
};
static_assert(sizeof(StaticVertex) == 20);

std::vector<MappedVertex> mappedVertices(const SurfaceBinding& binding, const sim::TextureLayout& layout,
                                         const std::vector<glm::u8vec4>& colours);

std::vector<StaticVertex> staticVertices(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                         const std::vector<glm::u8vec4>& colours);

/// Vertex order and index order that suit a GPU's caches: newIndex[mesh vertex], and the faces in new
/// indices.
struct CacheOrder {
    std::vector<std::uint32_t> newIndex;
    std::vector<std::uint32_t> indices;
};
CacheOrder cacheOrder(const sim::TriangleMesh& mesh);

} // namespace serosa::render
