#pragma once
// Draws organs from their state textures: the detailed surfaces through a mapping of MS05 3.2-3.3, the
// lattices' springs over them, the tools, a backdrop. Nothing is read back to draw; only the finished picture
// is.

#include "base/result.h"
#include "gpu/program.h"
#include "render/camera.h"
#include "render/image.h"
#include "render/surface_binding.h"
#include "render/thread_renderer.h"
#include "render/tool_shapes.h"
#include "sim/scene.h"
#include "sim/state_textures.h"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace serosa::render {

/// What is drawn in one picture.
struct View {
    CameraView camera;
    sim::Light light;
    sim::Look look;
    std::vector<DrawnShape> shapes;   // tools and bodies (render/tool_shapes.h)
    std::vector<DrawnThread> threads; // between organs, drawn where tools are
    bool wireframe = false;           // the surface as the edges of its front faces
    bool cull = false;                // skip what cannot be seen (prepareSkipping); saves nothing in software
    double surfaceError = 0.5; // pixels that a level of detail of it may be off by; 0: the whole surface
};

struct SurfaceDetail; // render/surface_passes.h

/// Which vertex stage a benchmark runs: undeformed, or through one of the two bases.
enum class VertexStage { undeformed, constant, corrected };

/// What each organ is drawn from, in the order in which they were added; not null.
using OrganStates = std::vector<const sim::StateTextures*>;

class SurfaceRenderer {
public:
    /// Uploads mesh, binding and lattice once. `metres` is the surface in world metres, `binding` made for it
    /// (either mapping: the other one is expressed over the same triangles). Needs a current context; the
    /// renderer dies before it. \param detail its texture (render/tissue_texture.h); null: none. Errors:
    /// shader errors of the driver.
    static Result<SurfaceRenderer> create(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                          const SurfaceBinding& binding, const sim::StateTextures& state,
                                          int width, int height, const SurfaceDetail* detail = nullptr);
    SurfaceRenderer(SurfaceRenderer&&) noexcept;
    SurfaceRenderer& operator=(SurfaceRenderer&&) noexcept;
    ~SurfaceRenderer();

    /// One more organ in the same picture; the arguments as for create. Draws from now on take a state more.
    Status addOrgan(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                    const SurfaceBinding& binding, const sim::StateTextures& state,
                    const SurfaceDetail* detail = nullptr);

    /// One more level of detail of an organ (sim/lod.h): the same surface over another lattice. Its own is
    /// level 0, those added follow.
    Status addLevel(std::size_t organ, const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                    const SurfaceBinding& binding, const sim::StateTextures& state,
                    const SurfaceDetail* detail = nullptr);
    /// Draws an organ on another level from now on.
    void setLevel(std::size_t organ, std::size_t level);
    /// The same, in motion, from its state `to`; `from` is what it was drawn from. The
    /// surface stays where it was, and what the levels differ by fades in the frames to come
    /// (setBlendFrame), no vertex by more than SRS_BLEND_STEP of `finest`, m, in one.
    void useLevel(std::size_t organ, std::size_t level, const sim::StateTextures& from,
                  const sim::StateTextures& to, sim::Mapping mapping, double finest);
    /// Frames since an organ's last switch.
    void setBlendFrame(std::size_t organ, int frames);
    /// What fades, six floats a vertex in the order of the buffers; empty: nothing does. Reads back (stalls).
    std::vector<float> blend(std::size_t organ) const;
    /// Sets it again; the frame follows.
    void setBlend(std::size_t organ, sim::Mapping mapping, const std::vector<float>& blend, double finest);

    /// Makes clusters of an organ's surface, which View::cull asks for: skipped where they cannot be seen
    /// (render/surface_clusters.h). The arguments are those that the organ was added with. Errors: of the
    /// shader.
    Status prepareSkipping(std::size_t organ, const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                           const SurfaceBinding& binding, const sim::StateTextures& state);
    /// Makes an organ's mask (render/cut_mask.h) before the first stroke does. Errors: of CutMask::create.
    Status prepareCuts(std::size_t organ, const sim::Lattice& lattice, const sim::TextureLayout& layout);
    /// Paints a stroke into an organ's mask, made by the first one, with the organ as `state` has it. Errors:
    /// of CutMask::create.
    Status paintCut(std::size_t organ, const sim::Lattice& lattice, const sim::StateTextures& state,
                    const sim::Stroke& stroke);
    /// The mask of an organ for snapshots, empty where none was made, and set again; empty: nothing is cut.
    /// Errors: as paintCut; bytes of another mask.
    std::string saveCuts(std::size_t organ) const;
    Status restoreCuts(std::size_t organ, const sim::Lattice& lattice, const sim::StateTextures& state,
                       std::string_view bytes);
    /// After cuts: draws from now on what they left of an organ's surface (render/cut_surface.h). The
    /// arguments are those that the organ was added with; connections: 18 bits a node. Reads the mask's sides
    /// back.
    void showCuts(std::size_t organ, const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                  const SurfaceBinding& binding, const sim::TextureLayout& layout,
                  const std::vector<std::uint32_t>& connections);

    /// Another size of the target, pixels; what was drawn is lost.
    void resize(int width, int height);
    /// Takes the drawing shaders from another source, and draws every way there is to see that they fit.
    /// Errors (compiler logs; inputs that do not fit, by name): the shaders in use stay.
    Status reload(const gpu::ShaderLibrary& library, const OrganStates& states, const View& view);
    Status reload(const gpu::ShaderLibrary& library, const sim::StateTextures& state, const View& view) {
        return reload(library, OrganStates{&state}, view);
    }

    /// Draws a frame into the renderer's own multisampled target and resolves it.
    void draw(const OrganStates& states, const View& view);
    void draw(const sim::StateTextures& state, const View& view) { draw(OrganStates{&state}, view); }
    /// Copies the last drawn frame into framebuffer 0 (a window) of this size, pixels.
    void show(int width, int height) const;
    /// The last drawn frame, sRGB, top row first.
    Image readImage() const;
    /// Deformed vertex positions, m, world, in mesh order, from the same vertex stage (transform feedback),
    /// for surface files; `mapping` triangle or curvature. `state` is that of the organ of this number.
    std::vector<glm::dvec3> readDeformedPositions(const sim::StateTextures& state, sim::Mapping mapping,
                                                  std::size_t organ = 0);
    /// Deformed unit normals, in mesh order, from the same stage.
    std::vector<glm::dvec3> readDeformedNormals(const sim::StateTextures& state, sim::Mapping mapping);

    /// For benchmarks: the indexed triangles with GL_RASTERIZER_DISCARD; nothing is drawn.
    void drawVertexStageOnly(const sim::StateTextures& state, VertexStage stage);
    /// Bytes of vertex attributes that a mapped vertex takes.
    static std::size_t bytesPerVertex();
    /// Triangles of an organ's surface that the last picture drew, of it and of its surface's level of
    /// detail; reads back.
    std::size_t trianglesDrawn(std::size_t organ = 0) const;
    /// Samples a pixel of the target.
    int samples() const;

private:
    struct Impl;
    explicit SurfaceRenderer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

} // namespace serosa::render
