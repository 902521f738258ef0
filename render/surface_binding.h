#pragma once
// Binding of a detailed surface to the lattice's boundary (MS05 3.3, eq. 4-8): for each vertex a triangle of
// nodes, weights of the reference point, the offset and the rest normal in what turns with the tissue: the
// triangle basis, the curvature-corrected one, a share of both, or the nodes' frames. Made once on the CPU,
// with the packed rest normals as the GPU has them; drawn by shaders/surface.vert (eq. 9).

#include "base/result.h"
#include "render/cell_binding.h"
#include "render/control_nodes.h"
#include "render/node_frames.h"
#include "render/normal_offset.h"
#include "render/triangle_basis.h"
#include "sim/lattice.h"
#include "sim/scene.h"
#include "sim/triangle_mesh.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace serosa::render {

class RestNormals; // render/basis_choice.h

struct VertexBinding {
    glm::uvec3 nodes;     // indices into the lattice's nodes; the first edge is the triangle's diagonal
    glm::vec3 weights;    // of eq. 4, sum 1; the first two are multiples of 1/65535 (16 bits on the GPU)
    glm::vec3 offset;     // lattice units, in the axes (T, N, B) of the basis; nodeFrames: in the lattice's
    glm::vec3 normal;     // unit rest normal in the same axes; trilinear: in the lattice's
    float correctedShare; // of the basis, 0 constant to 1 corrected: multiples of 1/255
    glm::vec3 normalShares{1}; // how much each node's normal counts in it: multiples of 1/255
};

struct SurfaceBinding {
    sim::Mapping mapping;
    std::vector<VertexBinding> vertices;   // one a mesh vertex
    std::vector<std::uint32_t> triangles;  // boundary triangle of each vertex
    std::vector<NormalOffset> alongNormal; // normalOffset only: in place of weights and offset, one a vertex
    CellBinding cells;                     // trilinear only: in place of nodes, weights and offset
    FrameStencil frames;                   // nodeFrames only
    // Edges of the mesh whose ends bind to triangles that share no node: found by the closest-triangle
    // search, and left after flooding from neighbours.
    std::size_t tornEdgesFound = 0, tornEdgesLeft = 0;
    std::size_t constantVertices = 0; // vertices that fall back to the constant basis
    std::size_t blendedVertices = 0;  // that take a share of both
    double bytesPerVertex = 0;
};

/// Binds every vertex. `metres` is the rest surface in world metres. mapping: any but one-to-one.
SurfaceBinding bindSurface(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                           sim::Mapping mapping);

/// The same to any nodes: a surface that another solver or an animation moves. mapping: neither one-to-one
/// nor trilinear, which needs cells. What it follows passes checkBinding.
SurfaceBinding bindSurface(const ControlNodes& nodes, const sim::TriangleMesh& metres, sim::Mapping mapping);

/// Errors: nodes without triangles; a surface without faces, or with a vertex farther than kFarthestSpacings
/// from every triangle (names the vertex and the distance).
Status checkBinding(const ControlNodes& nodes, const sim::TriangleMesh& metres);
inline constexpr double kFarthestSpacings = 4;

/// The same triangles and weights, offsets and normals for another mapping (any but one-to-one), or for what
/// connections a cut left (18 bits a node; empty: those of the lattice).
SurfaceBinding expressBinding(const SurfaceBinding& binding, const sim::Lattice& lattice,
                              const sim::TriangleMesh& metres, sim::Mapping mapping,
                              const std::vector<std::uint32_t>& connections = {});

/// The binding, and MS05's two bases over the same triangles.
std::vector<SurfaceBinding> withBothBases(const SurfaceBinding& binding, const sim::Lattice& lattice,
                                          const sim::TriangleMesh& metres);

/// The axes at rest that what is given in a vertex's own turns with: T, N, B of its basis; those of the
/// lattice of node frames and in cells. \param rest of this lattice
TriangleBasis restAxes(const SurfaceBinding& binding, std::size_t vertex, const sim::Lattice& lattice,
                       const RestNormals& rest);

/// A triangle of the boundary, and where on it (weights of its corners).
struct FollowedTriangle {
    std::uint32_t triangle = 0;
    glm::dvec3 weights{1, 0, 0};
};
/// The same binding after its vertices with more of them: copies of vertices, bound as they are, or to
/// another triangle (in cells: always as they are).
struct VertexCopy {
    std::uint32_t vertex = 0;
    std::optional<FollowedTriangle> follows;
};
SurfaceBinding withCopies(const SurfaceBinding& binding, const std::vector<VertexCopy>& copies,
                          const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                          const std::vector<std::uint32_t>& connections);

/// What the vertex stage does, on the CPU in double (the twin of shaders/mapping.glsl, for tests): vertex
/// positions in lattice units from node positions (lattice units) and packed node normals.
std::vector<glm::dvec3> mapSurface(const SurfaceBinding& binding,
                                   const std::vector<glm::dvec3>& nodePositions,
                                   const std::vector<std::uint32_t>& packedNormals);
/// Eq. 4 alone: the reference points, lattice units; trilinear: the points themselves.
std::vector<glm::dvec3> referencePoints(const SurfaceBinding& binding,
                                        const std::vector<glm::dvec3>& nodePositions);

} // namespace serosa::render
