#pragma once
// What a vertex costs on the GPU: 36 bytes with a mapping by three nodes, 40 with a choice between two bases,
// 32 along the normal alone, 24 in a cell, 20 without a mapping (the undeformed twin that benchmarks draw).

#include "render/surface_binding.h"
#include "sim/texture_layout.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace serosa::render {

/// Bit 30 of a packed normal is 0 (sim/packed_normal.h); here it says that the basis is the corrected one.
constexpr std::uint32_t kCorrectedBit = 1U << 30;

struct MappedVertex {
    glm::uvec3 texels;    // of the three nodes: y << 16 | x
    glm::u16vec2 weights; // w1, w2 in 1/65535
    glm::vec3 offset;     // lattice units, in the axes
    std::uint32_t normal; // packed, in the axes, with kCorrectedBit
    glm::u8vec4 colour;   // sRGB, and ambient light that reaches the vertex
};
static_assert(sizeof(MappedVertex) == 36);

struct ChosenVertex : MappedVertex {
    glm::u8vec4 shares; // xyz: how much each node's normal counts; w: of the corrected basis
};
static_assert(sizeof(ChosenVertex) == 40);

struct NormalVertex {
    glm::uvec3 texels;
    glm::vec2 weights;    // w1, w2: the offset cannot take up what fewer bits would miss
    float distance;       // lattice units, along the normal
    std::uint32_t normal; // packed, in the basis, with kCorrectedBit
    glm::u8vec4 colour;
};
static_assert(sizeof(NormalVertex) == 32);

struct CellVertex {
    std::uint32_t cell;   // into cellTexels
    glm::vec3 at;         // from its lowest corner
    std::uint32_t normal; // packed, lattice axes
    glm::u8vec4 colour;
};
static_assert(sizeof(CellVertex) == 24);

struct StaticVertex {
    glm::vec3 position;   // lattice units, at rest
    std::uint32_t normal; // packed, lattice axes
    glm::u8vec4 colour;
};
static_assert(sizeof(StaticVertex) == 20);

std::vector<MappedVertex> mappedVertices(const SurfaceBinding& binding, const sim::TextureLayout& layout,
                                         const std::vector<glm::u8vec4>& colours);

std::vector<ChosenVertex> chosenVertices(const SurfaceBinding& binding, const sim::TextureLayout& layout,
                                         const std::vector<glm::u8vec4>& colours);
std::vector<NormalVertex> normalVertices(const SurfaceBinding& binding, const sim::TextureLayout& layout,
                                         const std::vector<glm::u8vec4>& colours);
std::vector<CellVertex> cellVertices(const SurfaceBinding& binding, const std::vector<glm::u8vec4>& colours);

/// Node texels of the cells' corners, two RGBA32UI texels a cell, in rows of SRS_TABLE_WIDTH that are whole.
std::vector<glm::uvec4> cellTexels(const CellBinding& cells, const sim::TextureLayout& layout);

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
