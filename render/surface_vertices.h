#pragma once
// What a vertex costs on the GPU: 36 bytes with a mapping, 20 without (the undeformed twin that benchmarks
// draw); 16 more where cuts or textures ask for its rest state.

#include "render/surface_binding.h"
#include "render/triangle_basis.h"
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

/// What fragments are told of the rest state: 16 bytes a vertex, in a buffer of its own.
struct RestVertex {
    glm::u16vec3 position; // at rest, in 1/65535 of the mesh's box
    std::uint16_t side;    // of a cut that the vertex follows (render/cut_surface.h): 0: -1, 1: both, 2: +1
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

/// The bases of vertices at rest, with the packed rest normals as the GPU has them.
class RestBases {
public:
    explicit RestBases(const sim::Lattice& lattice);
    TriangleBasis of(const VertexBinding& bound) const;

private:
    const sim::Lattice& lattice_;
    std::vector<std::uint32_t> normals_; // packed, one a node
};

/// \param normal at rest, unit, world axes. \param basis that the vertex rides in, at rest
RestVertex restVertex(const RestBox& box, const glm::dvec3& lattice, const glm::dvec3& normal,
                      const TriangleBasis& basis, int side);
/// In the order of the mesh. \param binding null: of the undeformed surface, in world axes
std::vector<RestVertex> restVertices(const sim::Lattice& lattice, const RestBox& box,
                                     const sim::TriangleMesh& metres, const SurfaceBinding* binding);

MappedVertex mappedVertex(const VertexBinding& bound, const sim::TextureLayout& layout,
                          const glm::u8vec4& colour);
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
CacheOrder cacheOrder(const std::vector<glm::uvec3>& faces, std::size_t vertices);

/// Vertices a triangle that a GPU shades with a cache of the last 32: 3 in the worst case, 0.5 at best.
double cacheMisses(const CacheOrder& order);

} // namespace serosa::render
