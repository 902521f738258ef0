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
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace serosa::render {

class CutMask;   // render/cut_mask.h
class Raycaster; // render/raycaster.h
struct StageBox; // render/stage_box.h

/// What is drawn in one picture.
struct View {
    CameraView camera;
    sim::Light light;
    sim::Look look;
    std::vector<DrawnShape> shapes;       // tools and bodies (render/tool_shapes.h)
    std::vector<DrawnThread> threads;     // between organs, drawn where tools are
    bool wireframe = false;               // the surface as the edges of its front faces
    std::vector<Raycaster*> casters = {}; // one an organ, drawn if look.show says so
    bool cull = false;         // skip what cannot be seen (prepareSkipping); saves nothing in software
    double surfaceError = 0.5; // pixels that a level of detail of it may be off by; 0: the whole surface
};

struct SurfaceDetail; // render/surface_passes.h

/// What each organ is drawn from, in the order in which they were added; not null.
using OrganStates = std::vector<const sim::StateTextures*>;

class SurfaceRenderer {
public:
    /// Uploads mesh, binding and lattice once. `metres` is the surface in world metres, `binding` made for it
    /// (of any mapping). It draws one-to-one, triangle, curvature and the binding's own mapping, over the
    /// same triangles. Needs a current context; the renderer dies before it. \param detail its texture
    /// (render/tissue_texture.h); null: none. Errors: shader errors of the driver.
    static Result<SurfaceRenderer> create(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                          const SurfaceBinding& binding, const sim::StateTextures& state,
                                          int width, int height, const SurfaceDetail* detail = nullptr);
    /// The same of nodes that something else moves: it draws one-to-one (their triangles) and the binding's
    /// own mapping. `state` is of standInLattice(nodes); its positions are in the nodes' unit, its normals
    /// packedNormals.
    static Result<SurfaceRenderer> create(const ControlNodes& nodes, const sim::TriangleMesh& metres,
                                          const SurfaceBinding& binding, const sim::StateTextures& state,
                                          int width, int height);
    SurfaceRenderer(SurfaceRenderer&&) noexcept;
    SurfaceRenderer& operator=(SurfaceRenderer&&) noexcept;
    ~SurfaceRenderer();

    /// May a look ask for this mapping?
    bool draws(sim::Mapping mapping) const;

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
    /// An organ's surface without what rests in a box that is ray-cast instead (render/stage_box.h): opened
    /// once with what the organ was added with, then moved. Errors: of the shaders.
    Status openBox(std::size_t organ, const StageBox& box, const sim::Lattice& lattice,
                   const sim::TriangleMesh& metres, const SurfaceBinding& binding);
    void setBox(std::size_t organ, const StageBox& box);
    /// Makes an organ's mask (render/cut_mask.h) before the first stroke does. Errors: of CutMask::create.
    Status prepareCuts(std::size_t organ, const sim::Lattice& lattice, const sim::TextureLayout& layout);
    /// Paints a stroke into an organ's mask, made by the first one, with the organ as `state` has it. Errors:
    /// of CutMask::create.
    Status paintCut(std::size_t organ, const sim::Lattice& lattice, const sim::StateTextures& state,
                    const sim::Stroke& stroke);
    /// Whether undoCut can take back the strokes that begin from now on; at first it cannot. Costs a stall a
    /// stroke (CutMask::keepForUndo).
    void keepCutsForUndo(bool on);
    /// Takes the last stroke out of an organ's mask, where sim::CutList::undo took it back; showCuts shows
    /// it. False: no stroke was kept.
    bool undoCut(std::size_t organ);
    /// What strokes left of an organ, for other passes; null where no mask was made.
    const CutMask* cutMask(std::size_t organ) const;
    /// The mask of an organ for snapshots, empty where none was made, and set again; empty: nothing is cut.
    /// Errors: as paintCut; bytes of another mask.
    std::string saveCuts(std::size_t organ) const;
    Status restoreCuts(std::size_t organ, const sim::Lattice& lattice, const sim::StateTextures& state,
                       std::string_view bytes);
    /// After cuts: draws from now on what they left of an organ's surface (render/cut_surface.h), and binds
    /// its vertices anew: those that follow a cut node no longer read its normal, which turns towards the
    /// cut, so that a cut organ at rest is drawn at rest. Lattice, surface and binding are those that the
    /// organ was added with; connections: 18 bits a node. Reads the mask's sides back. \param fades the
    /// surface stays where `state` shows it now through `mapping`, and what the new binding differs by fades
    /// in the frames to come (setBlendFrame), no vertex by more than SRS_BLEND_STEP spacings in one. Errors:
    /// of the shaders.
    Status showCuts(std::size_t organ, const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                    const SurfaceBinding& binding, const sim::StateTextures& state,
                    const std::vector<std::uint32_t>& connections, sim::Mapping mapping, bool fades);

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
    /// for surface files; any mapping that is drawn but one-to-one. `state` is that of the organ of this
    /// number.
    std::vector<glm::dvec3> readDeformedPositions(const sim::StateTextures& state, sim::Mapping mapping,
                                                  std::size_t organ = 0);
    /// Deformed unit normals, in mesh order, from the same stage.
    std::vector<glm::dvec3> readDeformedNormals(const sim::StateTextures& state, sim::Mapping mapping);

    /// The axes that turn with each vertex (T, N, B of the triangle bases; the lattice's, turned, of the
    /// other mappings), as columns, in mesh order. Errors: of the shader.
    Result<std::vector<glm::dmat3>> readAxes(const sim::StateTextures& state, sim::Mapping mapping);

    /// For benchmarks: the indexed triangles with GL_RASTERIZER_DISCARD; nothing is drawn.
    /// \param mapping none: the undeformed surface
    void drawVertexStageOnly(const sim::StateTextures& state, std::optional<sim::Mapping> mapping);
    /// Triangles of an organ's surface that the last picture drew, of it and of its surface's level of
    /// detail; reads back.
    std::size_t trianglesDrawn(std::size_t organ = 0) const;
    /// Samples a pixel of the target.
    int samples() const;

private:
    struct Impl;
    static Result<SurfaceRenderer> create(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                          const std::vector<SurfaceBinding>& bindings,
                                          const sim::TextureLayout& layout, int width, int height,
                                          const SurfaceDetail* detail);
    explicit SurfaceRenderer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

} // namespace serosa::render
