#pragma once
// The surface on the GPU: vertex buffers for both bases, for the undeformed twin and for the lattice's own
// boundary, and one program for each way to draw them (shaders/surface.vert, surface.frag).

#include "base/result.h"
#include "gpu/program.h"
#include "render/cut_mask.h"
#include "render/cut_surface.h"
#include "render/frame.h"
#include "render/surface_binding.h"
#include "render/surface_clusters.h"
#include "render/surface_seams.h"
#include "render/surface_vertices.h"
#include "render/tissue_texture.h"
#include "sim/state_textures.h"

#include <map>
#include <optional>

namespace serosa::render {

/// A texture, and its size on the organ.
struct SurfaceDetail {
    TissueMaps maps;
    double tile = 0, relief = 0; // m
};

enum class SurfaceStage { undeformed, constant, corrected, nodes };

inline constexpr glm::vec3 kFleshColour{0.342F, 0.048F, 0.037F}; // linear
inline constexpr glm::vec3 kCoreColour{0.020F, 0.022F, 0.025F};  // linear: behind the lattice's lines

class SurfacePasses {
public:
    /// \param detail null: no texture
    static Result<SurfacePasses> create(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                        const SurfaceBinding& binding, const sim::TextureLayout& layout,
                                        const SurfaceDetail* detail = nullptr);

    using Programs = std::map<std::pair<SurfaceStage, sim::SurfaceColour>, gpu::Program>;
    /// The drawing programs from another source. Errors: as gpu::Program::create.
    Result<Programs> compile(const gpu::ShaderLibrary& library) const;
    Programs& programs() { return programs_; }

    /// Draws into the bound target with its depth test.
    /// \param bare linear colour of a boundary that has none of its own (stage nodes).
    void draw(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage,
              sim::SurfaceColour colour, const glm::vec3& bare = kFleshColour);
    /// Its depth alone, into the bound target.
    void drawDepth(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage);
    /// The same vertex stage with nothing rasterized.
    void drawDiscarded(const sim::StateTextures& state, SurfaceStage stage);

    /// Clusters of the uncut surface and of its levels of detail, for Frame::cull; the arguments are those of
    /// create. Errors: of SurfaceClusters::create.
    Status prepareSkipping(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                           const SurfaceBinding& binding, const sim::TextureLayout& layout);
    /// Triangles of the last draw() that were not skipped; reads back.
    std::size_t trianglesDrawn() const;
    std::size_t levels() const { return levels_.size(); }

    /// Transform feedback of the vertex stage, mesh order. Positions in lattice units, unit normals.
    struct Captured {
        std::vector<glm::vec3> positions, normals;
    };
    Captured capture(const sim::StateTextures& state, SurfaceStage stage);

    // A switch of level of detail: another SurfacePasses, of the same mesh over another lattice, drew it
    // until now. What the two differ by fades in the frames that follow.

    /// Makes the programs for it. Errors: of the shaders.
    Status prepareBlend();
    /// Positions (its lattice units) and normals as they are drawn, two vec3 a vertex in the buffers' order.
    gpu::Buffer shown(const sim::StateTextures& state, SurfaceStage stage);
    /// Draws `stage` (constant or corrected) from now on with what is missing to what the other one showed.
    /// \param scale, shift from its lattice units to this one's
    /// \param step lattice units that the fading may move a vertex a frame
    void startBlend(const sim::StateTextures& state, SurfaceStage stage, const gpu::Buffer& shown,
                    float scale, const glm::vec3& shift, float step);
    /// The frame after the switch that is drawn from now on; 0: the one of the switch.
    void setBlendFrame(float frames);
    /// What fades: six floats a vertex in the order of the buffers; empty: nothing does.
    std::vector<float> blend() const;
    void setBlend(SurfaceStage stage, const std::vector<float>& blend, float step);

    /// Draws from now on what cuts left of the mesh, and these triangles over nodes for stage nodes. The
    /// other arguments are those of create.
    void show(const CutSurface& cut, const sim::Lattice& lattice, const sim::TriangleMesh& metres,
              const SurfaceBinding& binding, const std::vector<glm::uvec3>& boundary,
              const sim::TextureLayout& layout);

    /// Makes the mask that strokes paint, and programs that ask it. Errors: of CutMask::create, of shaders.
    Status openMask(const sim::Lattice& lattice, const sim::TextureLayout& layout);
    /// Null before openMask.
    CutMask* mask() { return mask_ ? &*mask_ : nullptr; }
    const CutMask* mask() const { return mask_ ? &*mask_ : nullptr; }

private:
    struct Geometry {
        gpu::VertexArray array;
        gpu::Buffer vertices;
        gpu::Buffer rest; // RestVertex, where cuts or textures ask for it
    };
    SurfacePasses() = default;
    Status createCaptures();
    Result<Programs> compileBlend(const gpu::ShaderLibrary& library) const;
    /// Buffers of a stage, of vertices in the buffers' order.
    void setMapped(SurfaceStage stage, const std::vector<MappedVertex>& vertices);
    void setRest(SurfaceStage stage, const std::vector<RestVertex>& vertices);
    /// Rest states for all stages, from the arguments of create.
    void createRest(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                    const SurfaceBinding& binding);
    /// Vertices of all stages with those along cuts: pairs of a copy and the drawn vertex that it is one of.
    void fillCut(const CutSurface& cut, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& extras,
                 const sim::Lattice& lattice, const sim::TriangleMesh& metres, const SurfaceBinding& binding,
                 const sim::TextureLayout& layout);
    void setIndices(const std::vector<std::uint32_t>& indices);
    void createTextures(const SurfaceDetail& detail, const sim::Lattice& lattice);
    void createUvs();
    void attachUvs();
    std::vector<gpu::ShaderDefine> defines(SurfaceStage stage) const;
    void createGeometry(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                        const SurfaceBinding& binding, const sim::TextureLayout& layout);
    void createNodes(const std::vector<glm::uvec3>& boundary, const sim::TextureLayout& layout);
    gpu::Program& prepare(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage,
                          sim::SurfaceColour colour, const glm::vec3& bare);
    void drawTriangles(SurfaceStage stage, std::size_t level);
    /// Levels of detail of the uncut surface.
    void createLevels(const sim::Lattice& lattice, const sim::TriangleMesh& metres);
    std::size_t levelFor(const Frame& frame) const;
    void drawClusters(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage,
                      std::size_t level, const gpu::Program& program);
    void setVertexInputs(gpu::Program& program, const sim::StateTextures* state, const Frame& frame,
                         SurfaceStage stage) const;
    bool usesRest() const { return mask_ || textures_; }
    /// Items of mesh vertices as the buffers have them.
    template <class T>
    std::vector<T> inBuffers(const std::vector<T>& items) const {
        std::vector<T> ordered(drawn_.origin.size());
        for (std::size_t i = 0; i < ordered.size(); ++i)
            ordered[newIndex_[i]] = items[drawn_.origin[i]];
        return ordered;
    }
    bool blends(SurfaceStage stage) const { return blendStage_ == stage; }
    void setBlendUniforms(gpu::Program& program) const;
    void attachBlend(SurfaceStage stage, const gpu::Buffer& buffer);
    void feedBack(SurfaceStage stage, const gpu::Program& program, const gpu::Buffer& into);

    bool anyConstant_ = false; // a vertex of the corrected mapping falls back to the constant basis
    Programs programs_;
    std::map<SurfaceStage, gpu::Program> captures_;
    std::map<SurfaceStage, Geometry> geometry_;
    std::optional<SurfaceStage> blendStage_; // while a switch of detail fades
    float blendFrame_ = 0, blendStep_ = 0;
    Programs blendPrograms_;
    std::map<SurfaceStage, gpu::Program> blendCaptures_, blendStarts_;
    gpu::Buffer blend_; // two vec3 a vertex
    struct Level {
        gpu::Buffer indices;
        int count = 0;
        double error = 0; // lattice units, from the surface
        std::optional<SurfaceClusters> clusters;
        gpu::Buffer clusterIndices; // the same triangles, cluster after cluster
    };
    std::vector<Level> levels_;             // the first is the whole surface, or what cuts left of it
    std::size_t lastLevel_ = 0;             // that was drawn
    std::optional<std::size_t> lastCulled_; // the same, if clusters of it were skipped
    RestBox bounds_;                        // of the surface at rest
    gpu::Buffer nodeIndices_;
    int nodeIndexCount_ = 0;
    DrawnVertices drawn_;
    std::vector<std::uint32_t> newIndex_; // buffer index of each drawn vertex
    std::size_t meshVertices_ = 0;
    struct Textures {
        gpu::TiledTexture albedo, relief;
        glm::vec3 albedoScale{1}, shift{0};
        float tiles = 1, relief_ = 0; // a lattice unit; lattice units
    };
    std::optional<Textures> textures_;
    gpu::Buffer uvs_; // TextureVertex, in the buffers' order
    std::map<SurfaceStage, gpu::Program> depthPrograms_, blendDepthPrograms_; // made when first drawn
    gpu::Texture2D noShadow_, noOcclusion_;                                   // one texel each
    std::vector<glm::u8vec4> colours_;                                        // of each mesh vertex
    RestBox restBox_;
    std::optional<CutMask> mask_;
};

} // namespace serosa::render
