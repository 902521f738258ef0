#pragma once
// Skips hidden work (MS05 3.6): the detailed surface in clusters of triangles, each with the lattice's nodes
// that carry it. Before it is drawn a pass looks at these nodes alone: a cluster whose nodes lie outside the
// view, or face away from the eye by more than its triangles can lean, is not drawn. What a cluster's
// triangles lean against the mean of their nodes' normals is measured at rest; a margin covers what
// deformation adds.

#include "base/result.h"
#include "gpu/program.h"
#include "render/frame.h"
#include "render/surface_binding.h"
#include "sim/state_textures.h"

#include <cstdint>
#include <vector>

namespace serosa::render {

struct SurfaceCluster {         // as shaders/surface_cull.comp
    std::uint32_t first, count; // of the index buffer
    std::uint32_t node, nodes;  // of SurfaceClusters' list
    float reach;                // lattice units: longest offset of a vertex from its nodes' triangle
    float facing; // skipped where the nodes' mean normal has less than this towards the eye; -2: never
};

constexpr std::size_t kClusterTriangles = 256; // at most

class SurfaceClusters {
public:
    /// \param indices of the drawn triangles, in the order of the buffers. \param faces the same faces over
    /// vertices of the binding. Errors: of the shader.
    static Result<SurfaceClusters> create(const sim::Lattice& lattice, const sim::TextureLayout& layout,
                                          const SurfaceBinding& binding,
                                          const std::vector<glm::dvec3>& positions,
                                          const std::vector<glm::uvec3>& faces);
    /// Decides which clusters are drawn.
    void cull(const sim::StateTextures& state, const Frame& frame);
    /// Draws them, with the vertex array that is bound.
    void draw() const;

    std::size_t count() const { return clusters_.size(); }
    /// Triangles that the last cull() left; reads back.
    std::size_t trianglesLeft() const;

private:
    SurfaceClusters() = default;
    std::vector<SurfaceCluster> clusters_;
    gpu::Program program_;
    gpu::Buffer clusterBuffer_, nodes_, commands_;
};

} // namespace serosa::render
