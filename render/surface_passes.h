#pragma once
// The surface on the GPU: vertex buffers for the mappings, for the undeformed twin and for the lattice's own
// boundary, and one program for each way to draw them (shaders/surface.vert, surface.frag).

#include "base/result.h"
#include "gpu/program.h"
#include "render/frame.h"
#include "render/frame_pass.h"
#include "render/surface_binding.h"
#include "sim/state_textures.h"

#include <map>
#include <optional>

namespace serosa::render {

enum class SurfaceStage { undeformed, nodes, constant, corrected, chosen, alongNormal, inCells, nodeFrames };

/// The stage that draws a mapping.
SurfaceStage stageOf(sim::Mapping mapping);

inline constexpr glm::vec3 kFleshColour{0.342F, 0.048F, 0.037F}; // linear
inline constexpr glm::vec3 kCoreColour{0.020F, 0.022F, 0.025F};  // linear: behind the lattice's lines

class SurfacePasses {
public:
    /// Ready to draw the mappings of the bindings, the undeformed twin and the boundary.
    static Result<SurfacePasses> create(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                        const std::vector<SurfaceBinding>& bindings,
                                        const sim::TextureLayout& layout);
    bool draws(SurfaceStage stage) const { return geometry_.count(stage) > 0; }

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
    void setBlend(SurfaceStage stage, const std::vector<float>& blend, float step);

    /// Draws from now on only these faces of the mesh (one flag a face), and these triangles over nodes for
    /// stage nodes.
    void show(const std::vector<glm::uvec3>& faces, const std::vector<bool>& left,
              const std::vector<glm::uvec3>& boundary, const sim::TextureLayout& layout);
    /// Takes other bindings of the same mesh, of mappings that it draws; nothing fades any more. Errors: of
    /// the shaders.
    Status rebind(const std::vector<SurfaceBinding>& bindings, const sim::TextureLayout& layout);

private:
    struct Geometry {
        gpu::VertexArray array;
        gpu::Buffer vertices;
    };
    SurfacePasses() = default;
    Status createCaptures();
    std::vector<gpu::ShaderDefine> defines(SurfaceStage stage) const;
    std::vector<SurfaceStage> mappedStages() const;
    Status createGeometry(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                          const std::vector<SurfaceBinding>& bindings, const sim::TextureLayout& layout);
    Status createMapped(const SurfaceBinding& binding, const sim::TextureLayout& layout);
    void createNodes(const std::vector<glm::uvec3>& boundary, const sim::TextureLayout& layout);
    gpu::Program& prepare(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage,
                          sim::SurfaceColour colour, const glm::vec3& bare);
    /// What a stage reads of the nodes; brings node frames up to date.
    void setNodes(gpu::Program& program, const sim::StateTextures& state, SurfaceStage stage);
    void drawTriangles(SurfaceStage stage);
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
    std::optional<FramePass> frames_;        // of stage nodeFrames
    std::optional<SurfaceStage> blendStage_; // while a switch of detail fades
    float blendFrame_ = 0, blendStep_ = 0;
    Programs blendPrograms_;
    std::map<SurfaceStage, gpu::Program> blendCaptures_, blendStarts_;
    gpu::Buffer blend_; // two vec3 a vertex
    gpu::Buffer indices_, nodeIndices_;
    int indexCount_ = 0, nodeIndexCount_ = 0;
    std::vector<std::uint32_t> newIndex_; // buffer index of each mesh vertex
};

} // namespace serosa::render
