#pragma once
// The surface on the GPU: vertex buffers for both bases, for the undeformed twin and for the lattice's own
// boundary, and one program for each way to draw them (shaders/surface.vert, surface.frag).

#include "base/result.h"
#include "gpu/program.h"
#include "render/frame.h"
#include "render/surface_binding.h"
#include "sim/state_textures.h"

#include <map>

namespace serosa::render {

enum class SurfaceStage { undeformed, constant, corrected, nodes };

inline constexpr glm::vec3 kFleshColour{0.342F, 0.048F, 0.037F}; // linear
inline constexpr glm::vec3 kCoreColour{0.020F, 0.022F, 0.025F};  // linear: behind the lattice's lines

class SurfacePasses {
public:
    static Result<SurfacePasses> create(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                        const SurfaceBinding& binding, const sim::TextureLayout& layout);

    using Programs = std::map<std::pair<SurfaceStage, sim::SurfaceColour>, gpu::Program>;
    /// The drawing programs from another source. Errors: as gpu::Program::create.
    Result<Programs> compile(const gpu::ShaderLibrary& library) const;
    Programs& programs() { return programs_; }

    /// Draws into the bound target with its depth test.
    /// \param bare linear colour of a boundary that has none of its own (stage nodes).
    void draw(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage,
              sim::SurfaceColour colour, const glm::vec3& bare = kFleshColour);
    /// The same vertex stage with nothing rasterized.
    void drawDiscarded(const sim::StateTextures& state, SurfaceStage stage);

    /// Transform feedback of the vertex stage, mesh order. Positions in lattice units, unit normals.
    struct Captured {
        std::vector<glm::vec3> positions, normals;
    };
    Captured capture(const sim::StateTextures& state, SurfaceStage stage);

    /// Draws from now on only these faces of the mesh (one flag a face), and these triangles over nodes for
    /// stage nodes.
    void show(const std::vector<glm::uvec3>& faces, const std::vector<bool>& left,
              const std::vector<glm::uvec3>& boundary, const sim::TextureLayout& layout);

private:
    struct Geometry {
        gpu::VertexArray array;
        gpu::Buffer vertices;
    };
    SurfacePasses() = default;
    Status createCaptures();
    std::vector<gpu::ShaderDefine> defines(SurfaceStage stage) const;
    void createGeometry(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                        const SurfaceBinding& binding, const sim::TextureLayout& layout);
    void createNodes(const std::vector<glm::uvec3>& boundary, const sim::TextureLayout& layout);
    gpu::Program& prepare(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage,
                          sim::SurfaceColour colour, const glm::vec3& bare);
    void drawTriangles(SurfaceStage stage);

    bool anyConstant_ = false; // a vertex of the corrected mapping falls back to the constant basis
    Programs programs_;
    std::map<SurfaceStage, gpu::Program> captures_;
    std::map<SurfaceStage, Geometry> geometry_;
    gpu::Buffer indices_, nodeIndices_;
    int indexCount_ = 0, nodeIndexCount_ = 0;
    std::vector<std::uint32_t> newIndex_; // buffer index of each mesh vertex
};

} // namespace serosa::render
