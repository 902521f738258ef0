#pragma once
// The surface on the GPU: vertex buffers for the mappings, for the undeformed twin and for the lattice's own
// boundary, and one program for each way to draw them (shaders/surface.vert, surface.frag).

#include "base/result.h"
#include "gpu/program.h"
#include "render/cut_mask.h"
#include "render/cut_surface.h"
#include "render/frame.h"
#include "render/frame_pass.h"
#include "render/side_nodes.h"
#include "render/stage_box.h"
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

enum class SurfaceStage { undeformed, nodes, constant, corrected, chosen, alongNormal, inCells, nodeFrames };

/// The stage that draws a mapping.
SurfaceStage stageOf(sim::Mapping mapping);

inline constexpr glm::vec3 kFleshColour{0.342F, 0.048F, 0.037F}; // linear
inline constexpr glm::vec3 kCoreColour{0.020F, 0.022F, 0.025F};  // linear: behind the lattice's lines

class SurfacePasses {
public:
    /// Ready to draw the mappings of the bindings, the undeformed twin and the boundary.
    /// \param detail null: no texture
    static Result<SurfacePasses> create(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                        const std::vector<SurfaceBinding>& bindings,
                                        const sim::TextureLayout& layout,
                                        const SurfaceDetail* detail = nullptr);
    bool draws(SurfaceStage stage) const { return geometry_.count(stage) > 0; }

    using Programs = std::map<std::pair<SurfaceStage, sim::SurfaceColour>, gpu::Program>;
    /// The drawing programs from another source. Errors: as gpu::Program::create.
    Result<Programs> compile(const gpu::ShaderLibrary& library) const;
    Programs& programs() { return programs_; }

    /// What a stage derives of the state's nodes before it draws them: once a state, before draw and
    /// drawDepth.
    void follow(const sim::StateTextures& state, SurfaceStage stage);
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

    /// The axes that turn with each vertex, of a stage with a mapping. Errors: of the shader.
    Result<std::vector<glm::mat3>> captureAxes(const sim::StateTextures& state, SurfaceStage stage);

    // A switch of level of detail: another SurfacePasses, of the same mesh over another lattice, drew it
    // until now. What the two differ by fades in the frames that follow.

    /// Makes the programs for it. Errors: of the shaders.
    Status prepareBlend();
    /// Positions (its lattice units) and normals as they are drawn, two vec3 a vertex in the buffers' order.
    gpu::Buffer shown(const sim::StateTextures& state, SurfaceStage stage);
    /// Draws `stage` (one with a mapping) from now on with what is missing to what the other one showed.
    /// \param scale, shift from its lattice units to this one's
    /// \param step lattice units that the fading may move a vertex a frame
    void startBlend(const sim::StateTextures& state, SurfaceStage stage, const gpu::Buffer& shown,
                    float scale, const glm::vec3& shift, float step);
    /// The frame after the switch that is drawn from now on; 0: the one of the switch.
    void setBlendFrame(float frames);
    /// What fades: six floats a vertex in the order of the buffers; empty: nothing does.
    std::vector<float> blend() const;
    /// Nothing fades where it is not of as many vertices as are drawn.
    void setBlend(SurfaceStage stage, const std::vector<float>& blend, float step);

    /// Draws from now on what cuts left of the mesh, bound anew, and these triangles over nodes for stage
    /// nodes; nothing fades any more. \param bindings of all mappings that it draws. Errors: of the shaders.
    Status show(const CutSurface& cut, const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                const std::vector<SurfaceBinding>& bindings, const std::vector<glm::uvec3>& boundary,
                const sim::TextureLayout& layout, const std::vector<std::uint32_t>& connections = {});
    /// Vertices of the buffers beyond those of the surface: copies along cuts.
    struct Copy {
        std::uint32_t vertex = 0; // of the mesh
        int side = 0;
        std::uint32_t drawn = 0;   // the vertex of the surface that it is one of
        std::int64_t follows = -1; // a triangle of the boundary, instead of its own
        auto operator<=>(const Copy&) const = default;
    };
    const std::vector<Copy>& copies() const { return copies_; }
    /// What shown() gave before show() in the buffers' order of now: a copy that is new was shown where its
    /// vertex was. Reads back.
    gpu::Buffer shownAfter(const gpu::Buffer& shown, const std::vector<Copy>& copiesBefore) const;

    /// Makes the mask that strokes paint, and programs that ask it. Errors: of CutMask::create, of shaders.
    Status openMask(const sim::Lattice& lattice, const sim::TextureLayout& layout);
    /// Leaves out from now on what rests in this box beyond its seam (without one: all that does). The
    /// arguments are those of create. Errors: of shaders.
    Status openBox(const StageBox& box, const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                   const std::vector<SurfaceBinding>& bindings);
    /// Where it has moved to.
    void setBox(const StageBox& box) { box_ = box; }
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
    void setIndices(const std::vector<std::uint32_t>& indices);
    void createTextures(const SurfaceDetail& detail, const sim::Lattice& lattice);
    void createUvs();
    void attachUvs();
    std::vector<gpu::ShaderDefine> defines(SurfaceStage stage) const;
    std::vector<SurfaceStage> mappedStages() const;
    Status createGeometry(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                          const std::vector<SurfaceBinding>& bindings, const sim::TextureLayout& layout);
    /// The vertex buffer of a binding's mapping, of the surface and then of the copies along cuts.
    Status createMapped(const SurfaceBinding& binding, const sim::TextureLayout& layout);
    /// Their rest states, where cuts or textures ask for them.
    void createRest(const SurfaceBinding& binding, const sim::Lattice& lattice,
                    const sim::TriangleMesh& metres, const RestNormals& rest);
    /// The undeformed twin, without and with a rest state.
    void createStatic(const sim::Lattice& lattice, const sim::TriangleMesh& metres);
    void createStaticRest(const sim::Lattice& lattice, const sim::TriangleMesh& metres);
    void setRest(SurfaceStage stage, const std::vector<RestVertex>& vertices);
    /// The cells of vertices that ride in them beside cuts.
    void createCarried(const CutSurface& cut, const std::vector<float>& copyShares,
                       const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                       const sim::TextureLayout& layout);
    /// \param of 1 + place in `cells`, or 0, a vertex of the buffers
    void setCarried(const std::vector<std::uint32_t>& of, const CellBinding& cells,
                    const std::vector<float>& shares, const sim::TextureLayout& layout);
    void createNodes(const std::vector<glm::uvec3>& boundary, const sim::TextureLayout& layout);
    /// All programs once more, after what defines() says has changed.
    Status recompile();
    gpu::Program& prepare(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage,
                          sim::SurfaceColour colour, const glm::vec3& bare);
    void drawTriangles(SurfaceStage stage, std::size_t level);
    /// Levels of detail of the uncut surface.
    void createLevels(const sim::Lattice& lattice, const sim::TriangleMesh& metres);
    std::size_t levelFor(const Frame& frame) const;
    void drawClusters(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage,
                      std::size_t level, const gpu::Program& program);
    /// What a stage reads of the nodes; brings node frames up to date.
    void setNodes(gpu::Program& program, const sim::StateTextures& state, SurfaceStage stage);
    void setVertexInputs(gpu::Program& program, const sim::StateTextures& state, const Frame& frame,
                         SurfaceStage stage);
    bool usesRest() const { return mask_ || textures_ || box_; }
    std::size_t vertexCount() const { return newIndex_.size() + copies_.size(); }
    /// Items of mesh vertices, and after them of copies, as the buffers have them.
    template <class T>
    std::vector<T> inBuffers(const std::vector<T>& items) const {
        std::vector<T> ordered(drawn_.origin.size());
        for (std::size_t i = 0; i < ordered.size(); ++i)
            ordered[newIndex_[i]] = items[drawn_.origin[i]];
        ordered.insert(ordered.end(), items.begin() + std::ptrdiff_t(meshVertices_), items.end());
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
    std::vector<glm::u8vec4> colours_;       // one a mesh vertex
    gpu::Texture2D cells_;                   // of stage inCells
    gpu::Buffer carriedOf_;                  // attribute 12: 1 + its place in carried_, or 0
    std::optional<FramePass> frames_;        // of stage nodeFrames
    std::vector<Copy> copies_;               // in the buffers after the surface's vertices
    std::vector<double> copyAway_;           // CutVertex::away of each
    std::optional<SurfaceStage> blendStage_; // while a switch of detail or of binding fades
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
    gpu::Texture2D none_; // one texel, where there is no map of shadows or occlusion
    RestBox restBox_;
    std::optional<CutMask> mask_;
    std::optional<SideNodes> sideNodes_; // where there is a mask
    gpu::Texture2D carried_;             // of vertices that ride in cells (shaders/mapping_carried.glsl)
    std::optional<StageBox> box_;
    glm::dvec3 origin_{0}; // m: of lattice units,
    double unit_ = 1;      // and their size
};

} // namespace serosa::render
