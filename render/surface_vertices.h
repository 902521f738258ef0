#pragma once
// What a vertex costs on the GPU: 36 bytes with a mapping by three nodes, 40 with a choice between two bases,
// 32 along the normal alone, 24 in a cell, 20 without a mapping (the undeformed twin that benchmarks draw);
// 16 more where cuts or textures ask for its rest state.

#include "render/surface_binding.h"
#include "render/triangle_basis.h"
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

/// What fragments are told of the rest state: 16 bytes a vertex, in a buffer of its own.
struct RestVertex {
    glm::u16vec3 position; // at rest, in 1/65535 of the mesh's box
    std::uint16_t side;    // of a cut that the vertex follows (render/cut_surface.h): 0: -1, 1: both, 2: +1;
                           // plus 3 times its signed distance from there, in steps (SRS_AWAY_STEPS)
    std::uint32_t normal,
        tangent; // packed: rest normal in lattice axes; a tangent to it, in the vertex' basis
};
static_assert(sizeof(RestVertex) == 16);

/// Lattice units of RestVertex::position 0, and what 65535 adds.
struct RestBox {
    glm::vec3 from{0}, extent{1};
};
RestBox restBox(const sim::Lattice& lattice, const sim::TriangleMesh& metres);

/// The tangent that shaders give a normal, too (Duff et al. 2017, Building an Orthonormal Basis, Revisited).
glm::dvec3 anyTangent(const glm::dvec3& normal);

/// \param normal at rest, unit, world axes. \param basis that the vertex rides in, at rest (restAxes). \param
/// side, away as CutVertex has them
RestVertex restVertex(const RestBox& box, const glm::dvec3& lattice, const glm::dvec3& normal,
                      const TriangleBasis& basis, int side = 0, double away = 0);

MappedVertex mappedVertex(const VertexBinding& bound, const sim::TextureLayout& layout,
                          const glm::u8vec4& colour);
std::vector<MappedVertex> mappedVertices(const SurfaceBinding& binding, const sim::TextureLayout& layout,
                                         const std::vector<glm::u8vec4>& colours);

std::vector<ChosenVertex> chosenVertices(const SurfaceBinding& binding, const sim::TextureLayout& layout,
                                         const std::vector<glm::u8vec4>& colours);
std::vector<NormalVertex> normalVertices(const SurfaceBinding& binding, const sim::TextureLayout& layout,
                                         const std::vector<glm::u8vec4>& colours);
std::vector<CellVertex> cellVertices(const SurfaceBinding& binding, const std::vector<glm::u8vec4>& colours);

/// Node texels of the cells' corners, two RGBA32UI texels a cell, in rows of SRS_TABLE_WIDTH that are whole.
std::vector<glm::uvec4> cellTexels(const CellBinding& cells, const sim::TextureLayout& layout);

/// The same of vertices that ride in cells beside cuts, three texels each: the corners, then where the vertex
/// lies in the cell, and its share (shaders/mapping_carried.glsl).
std::vector<glm::uvec4> carriedTexels(const CellBinding& cells, const std::vector<float>& shares,
                                      const sim::TextureLayout& layout);

std::vector<StaticVertex> staticVertices(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                         const std::vector<glm::u8vec4>& colours);

/// Vertex order and index order that suit a GPU's caches: newIndex[mesh vertex], and the faces in new
/// indices.
struct CacheOrder {
    std::vector<std::uint32_t> newIndex;
    std::vector<std::uint32_t> indices;
};
CacheOrder cacheOrder(const std::vector<glm::uvec3>& faces, std::size_t vertices);

/// Vertices a triangle that a GPU shades with a cache of the last 32: 3 in the worst case, 0.5 at best.
double cacheMisses(const CacheOrder& order);

} // namespace serosa::render
