#include "render/surface_renderer.h"

#include "base/check.h"
#include "gpu/gl.h"
#include "render/frame.h"
#include "render/lattice_overlay.h"
#include "render/picture_target.h"
#include "render/surface_passes.h"
#include "render/surface_vertices.h"
#include "render/tool_spheres.h"

namespace serosa::render {

struct SurfaceRenderer::Impl {
    sim::Lattice placement; // spacing and origin only: metres from lattice units
    SurfacePasses surface;
    LatticeOverlay lattice;
    ToolSpheres tools;
    gpu::Program backdrop;
    gpu::VertexArray empty;
    PictureTarget target;
};

namespace {

SurfaceStage stageOf(sim::Mapping mapping) {
    switch (mapping) {
    case sim::Mapping::oneToOne:
        return SurfaceStage::nodes;
    case sim::Mapping::triangle:
        return SurfaceStage::constant;
    case sim::Mapping::curvature:
        break;
    }
    return SurfaceStage::corrected;
}

Result<gpu::Program> compileBackdrop(const gpu::ShaderLibrary& library) {
    return gpu::Program::create(library, {"pass.vert", "backdrop.frag"});
}

} // namespace

SurfaceRenderer::SurfaceRenderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SurfaceRenderer::SurfaceRenderer(SurfaceRenderer&&) noexcept = default;
SurfaceRenderer& SurfaceRenderer::operator=(SurfaceRenderer&&) noexcept = default;
SurfaceRenderer::~SurfaceRenderer() = default;

Result<SurfaceRenderer> SurfaceRenderer::create(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                                const SurfaceBinding& binding,
                                                const sim::StateTextures& state, int width, int height) {
    SEROSA_ASSIGN(SurfacePasses surface, SurfacePasses::create(lattice, metres, binding, state.layout()));
    SEROSA_ASSIGN(LatticeOverlay overlay, LatticeOverlay::create(lattice, state.layout()));
    SEROSA_ASSIGN(ToolSpheres tools, ToolSpheres::create());
    SEROSA_ASSIGN(gpu::Program backdrop, compileBackdrop(gpu::ShaderLibrary()));
    sim::Lattice placement;
    placement.spacing = lattice.spacing;
    placement.origin = lattice.origin;
    return SurfaceRenderer(std::make_unique<Impl>(
        Impl{std::move(placement), std::move(surface), std::move(overlay), std::move(tools),
             std::move(backdrop), gpu::VertexArray("no attributes"), PictureTarget(width, height)}));
}

void SurfaceRenderer::draw(const sim::StateTextures& state, const View& view) {
    Impl& in = *impl_;
    const Spheres tools = view.look.tools ? view.toolSpheres : Spheres{};
    const Frame frame = makeFrame(in.placement, view.camera, view.light, view.look, tools, in.target.width(),
                                  in.target.height());
    in.target.begin();
    glDisable(GL_DEPTH_TEST);
    in.backdrop.set("u_size", frame.size);
    in.backdrop.use();
    gpu::drawFullScreen(in.empty);
    glEnable(GL_DEPTH_TEST);
    const bool core = view.look.lattice && !view.look.surface; // hides the lines on the far side
    if (core)
        in.surface.draw(state, frame, SurfaceStage::nodes, sim::SurfaceColour::tissue, kCoreColour);
    glPolygonMode(GL_FRONT_AND_BACK, view.wireframe ? GL_LINE : GL_FILL);
    if (view.look.surface)
        in.surface.draw(state, frame, stageOf(view.look.mapping), view.look.colour);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    in.tools.draw(frame);
    if (view.look.lattice)
        in.lattice.draw(state, frame,
                        !core && view.look.colour == sim::SurfaceColour::dynamicNormal
                            ? LatticeOverlay::Ink::dark
                            : LatticeOverlay::Ink::light);
    in.target.end();
}

void SurfaceRenderer::resize(int width, int height) {
    impl_->target = PictureTarget(width, height);
}

void SurfaceRenderer::show(int width, int height) const {
    impl_->target.show(width, height);
}

Status SurfaceRenderer::reload(const gpu::ShaderLibrary& library, const sim::StateTextures& state,
                               const View& view) {
    SEROSA_ASSIGN(SurfacePasses::Programs surface, impl_->surface.compile(library));
    SEROSA_ASSIGN(gpu::Program lattice, LatticeOverlay::compile(library));
    SEROSA_ASSIGN(gpu::Program tools, ToolSpheres::compile(library));
    SEROSA_ASSIGN(gpu::Program backdrop, compileBackdrop(library));
    const auto exchange = [&] {
        std::swap(impl_->surface.programs(), surface);
        std::swap(impl_->lattice.program(), lattice);
        std::swap(impl_->tools.program(), tools);
        std::swap(impl_->backdrop, backdrop);
    };
    exchange();
    std::vector<gpu::Program*> all = {&impl_->lattice.program(), &impl_->tools.program(), &impl_->backdrop};
    for (auto& [key, program] : impl_->surface.programs())
        all.push_back(&program);
    for (gpu::Program* program : all)
        program->tolerateMismatches();

    View rehearsal = view;
    rehearsal.look.surface = rehearsal.look.lattice = rehearsal.look.tools = true;
    if (rehearsal.toolSpheres.empty())
        rehearsal.toolSpheres.emplace_back(impl_->placement.origin, impl_->placement.spacing);
    for (const sim::Mapping mapping :
         {sim::Mapping::oneToOne, sim::Mapping::triangle, sim::Mapping::curvature})
        for (const sim::SurfaceColour colour :
             {sim::SurfaceColour::tissue, sim::SurfaceColour::dynamicNormal}) {
            rehearsal.look.mapping = mapping;
            rehearsal.look.colour = colour;
            draw(state, rehearsal);
        }
    std::string problems;
    for (gpu::Program* program : all)
        for (const std::string& problem : program->takeMismatches())
            problems += (problems.empty() ? "" : "\n") + problem;
    if (problems.empty())
        return {};
    exchange();
    return Error{problems};
}

Image SurfaceRenderer::readImage() const {
    return impl_->target.read();
}

std::vector<glm::dvec3> SurfaceRenderer::readDeformedPositions(const sim::StateTextures& state,
                                                               sim::Mapping mapping) {
    std::vector<glm::dvec3> metres;
    impl_->target.bind();
    for (const glm::vec3& q : impl_->surface.capture(state, stageOf(mapping)).positions)
        metres.push_back(impl_->placement.toWorld(q));
    return metres;
}

std::vector<glm::dvec3> SurfaceRenderer::readDeformedNormals(const sim::StateTextures& state,
                                                             sim::Mapping mapping) {
    impl_->target.bind();
    const std::vector<glm::vec3> normals = impl_->surface.capture(state, stageOf(mapping)).normals;
    return {normals.begin(), normals.end()};
}

void SurfaceRenderer::drawVertexStageOnly(const sim::StateTextures& state, VertexStage stage) {
    impl_->target.bind();
    impl_->surface.drawDiscarded(state, stage == VertexStage::undeformed ? SurfaceStage::undeformed
                                        : stage == VertexStage::constant ? SurfaceStage::constant
                                                                         : SurfaceStage::corrected);
}

std::size_t SurfaceRenderer::bytesPerVertex() {
    return sizeof(MappedVertex);
}

int SurfaceRenderer::samples() const {
    return impl_->target.samples();
}

} // namespace serosa::render
