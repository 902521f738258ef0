#include "base/check.h"
#include "gpu/gl.h"
#include "render/raycaster.h"
#include "render/surface_renderer-inl.h"
#include "shaders/shared_constants.h"

namespace serosa::render {

namespace {

constexpr int kShadowSide = 2048;       // texels
constexpr double kOcclusionReach = 0.1; // of the organs' diagonal

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
                                                const sim::StateTextures& state, int width, int height,
                                                const SurfaceDetail* detail) {
    return create(lattice, metres, withBothBases(binding, lattice, metres), state.layout(), width, height,
                  detail);
}

Result<SurfaceRenderer> SurfaceRenderer::create(const ControlNodes& nodes, const sim::TriangleMesh& metres,
                                                const SurfaceBinding& binding,
                                                const sim::StateTextures& state, int width, int height) {
    return create(standInLattice(nodes), metres, std::vector<SurfaceBinding>{binding}, state.layout(), width,
                  height, nullptr);
}

Result<SurfaceRenderer> SurfaceRenderer::create(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                                const std::vector<SurfaceBinding>& bindings,
                                                const sim::TextureLayout& layout, int width, int height,
                                                const SurfaceDetail* detail) {
    SEROSA_ASSIGN(DrawnOrgan organ, DrawnOrgan::create(lattice, metres, bindings, layout, detail));
    SEROSA_ASSIGN(ToolRenderer tools, ToolRenderer::create());
    SEROSA_ASSIGN(ThreadRenderer threads, ThreadRenderer::create());
    SEROSA_ASSIGN(gpu::Program backdrop, compileBackdrop(gpu::ShaderLibrary()));
    auto impl = std::make_unique<Impl>(Impl{{},
                                            {},
                                            {},
                                            std::move(tools),
                                            std::move(threads),
                                            std::move(backdrop),
                                            gpu::VertexArray("no attributes"),
                                            PictureTarget(width, height),
                                            {},
                                            {}});
    impl->organs.push_back(std::move(organ));
    return SurfaceRenderer(std::move(impl));
}

Status SurfaceRenderer::addOrgan(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                 const SurfaceBinding& binding, const sim::StateTextures& state,
                                 const SurfaceDetail* detail) {
    SEROSA_ASSIGN(
        DrawnOrgan organ,
        DrawnOrgan::create(lattice, metres, withBothBases(binding, lattice, metres), state.layout(), detail));
    impl_->organs.push_back(std::move(organ));
    return {};
}

Status SurfaceRenderer::addLevel(std::size_t organ, const sim::Lattice& lattice,
                                 const sim::TriangleMesh& metres, const SurfaceBinding& binding,
                                 const sim::StateTextures& state, const SurfaceDetail* detail) {
    SEROSA_ASSIGN(
        DrawnOrgan drawn,
        DrawnOrgan::create(lattice, metres, withBothBases(binding, lattice, metres), state.layout(), detail));
    SEROSA_TRY(drawn.surface.prepareBlend());
    SEROSA_TRY(impl_->organs.at(organ).surface.prepareBlend());
    impl_->levels.resize(impl_->organs.size());
    impl_->level.resize(impl_->organs.size(), 0);
    if (impl_->levels.at(organ).empty())
        impl_->levels[organ].emplace_back(); // its own
    impl_->levels[organ].emplace_back(std::move(drawn));
    return {};
}

void SurfaceRenderer::setLevel(std::size_t organ, std::size_t level) {
    SEROSA_CHECK(level < impl_->levels.at(organ).size(), "a level that was added");
    std::optional<DrawnOrgan>& next = impl_->levels[organ][level];
    if (!next)
        return; // it is drawn
    impl_->levels[organ][impl_->level[organ]] = std::move(impl_->organs[organ]);
    impl_->organs[organ] = std::move(*next);
    next.reset();
    impl_->level[organ] = level;
    impl_->organs[organ].surface.setBlendFrame(SRS_BLEND_MOST_FRAMES);
}

void SurfaceRenderer::useLevel(std::size_t organ, std::size_t level, const sim::StateTextures& from,
                               const sim::StateTextures& to, sim::Mapping mapping, double finest) {
    SEROSA_CHECK(mapping != sim::Mapping::oneToOne, "a mapping of the detailed surface");
    impl_->target.bind();
    const SurfaceStage stage = stageOf(mapping);
    DrawnOrgan& drawn = impl_->organs.at(organ);
    const gpu::Buffer shown = drawn.surface.shown(from, stage);
    const double spacing = drawn.placement.spacing;
    const glm::dvec3 origin = drawn.placement.origin;
    setLevel(organ, level); // `drawn` is another one now
    drawn.surface.startBlend(to, stage, shown, float(spacing / drawn.placement.spacing),
                             glm::vec3(drawn.placement.toLattice(origin)),
                             float(SRS_BLEND_STEP * finest / drawn.placement.spacing));
}

void SurfaceRenderer::setBlendFrame(std::size_t organ, int frames) {
    impl_->organs.at(organ).surface.setBlendFrame(float(frames));
}

std::vector<float> SurfaceRenderer::blend(std::size_t organ) const {
    return impl_->organs.at(organ).surface.blend();
}

void SurfaceRenderer::setBlend(std::size_t organ, sim::Mapping mapping, const std::vector<float>& blend,
                               double finest) {
    DrawnOrgan& drawn = impl_->organs.at(organ);
    const Status ready = blend.empty() ? Status() : drawn.surface.prepareBlend();
    SEROSA_CHECK(ready.ok(), "shaders that compiled before");
    drawn.surface.setBlend(stageOf(mapping), blend, float(SRS_BLEND_STEP * finest / drawn.placement.spacing));
}

glm::dvec3 SurfaceRenderer::Impl::lowest() const {
    glm::dvec3 bound = organs[0].lowest;
    for (const DrawnOrgan& organ : organs)
        bound = glm::min(bound, organ.lowest);
    return bound;
}

glm::dvec3 SurfaceRenderer::Impl::highest() const {
    glm::dvec3 bound = organs[0].highest;
    for (const DrawnOrgan& organ : organs)
        bound = glm::max(bound, organ.highest);
    return bound;
}

/// Organs and tools into a bound target without colours.
void SurfaceRenderer::Impl::drawDepths(const OrganStates& states, const View& view, const CameraView& camera,
                                       int width, int height) {
    std::vector<Frame> frames;
    for (std::size_t i = 0; i < organs.size(); ++i) {
        frames.push_back(makeFrame(organs[i].placement, camera, view.light, view.look, width, height));
        if (view.look.surface && view.look.show != sim::Show::implicit)
            organs[i].surface.drawDepth(*states[i], frames[i], stageOf(view.look.mapping));
    }
    std::vector<DrawnShape> solid; // floors fade out: they throw no shadow
    for (const DrawnShape& shape : view.shapes)
        if (view.look.tools && shape.finish != Finish::floor)
            solid.push_back(shape);
    tools.draw(frames[0], organs[0].placement, solid);
}

void SurfaceRenderer::Impl::drawShadow(const OrganStates& states, const View& view,
                                       std::vector<Frame>& frames) {
    if (!shadow)
        shadow.emplace(kShadowSide);
    const CameraView lamp = lampView(view.light.direction, lowest(), highest());
    shadow->begin();
    View whole = view; // a section shows the inside: it lets no light in
    whole.look.sectionAt.reset();
    drawDepths(states, whole, lamp, kShadowSide, kShadowSide);
    shadow->end();
    for (std::size_t i = 0; i < organs.size(); ++i) {
        const sim::Lattice& placement = organs[i].placement;
        frames[i].shadow = &shadow->depth();
        frames[i].shadowFromLattice =
            makeFrame(placement, lamp, view.light, view.look, kShadowSide, kShadowSide).clipFromLattice;
        frames[i].shadowTexel = float(lampExtent(lowest(), highest()) / kShadowSide / placement.spacing);
    }
}

void SurfaceRenderer::Impl::drawOcclusion(const OrganStates& states, const View& view,
                                          std::vector<Frame>& frames) {
    if (!occlusion) {
        Result<ScreenOcclusion> made = ScreenOcclusion::create(target.width(), target.height());
        SEROSA_CHECK(made.ok(), "the driver compiles GLSL 4.5");
        occlusion.emplace(std::move(made).value());
    }
    occlusion->begin();
    drawDepths(states, view, view.camera, target.width(), target.height());
    occlusion->make(view.camera, kOcclusionReach * glm::distance(lowest(), highest()));
    for (Frame& frame : frames)
        frame.occlusion = &occlusion->light();
}

void SurfaceRenderer::draw(const OrganStates& states, const View& view) {
    Impl& in = *impl_;
    SEROSA_CHECK(states.size() == in.organs.size(), "one state an organ");
    std::vector<Frame> frames; // in the units of each lattice, of one view
    for (const DrawnOrgan& organ : in.organs) {
        frames.push_back(makeFrame(organ.placement, view.camera, view.light, view.look, in.target.width(),
                                   in.target.height()));
        frames.back().blood = view.look.blood;
        frames.back().cull = view.cull && !view.wireframe;
        frames.back().mostError = view.wireframe ? 0 : float(view.surfaceError);
        for (const DrawnShape& drawn : view.shapes)
            if (view.look.tools && drawn.shape.kind == sim::ShapeKind::sphere)
                frames.back().shades.emplace_back(organ.placement.toLattice(drawn.pose.at),
                                                  drawn.shape.radius / organ.placement.spacing);
    }
    for (std::size_t i = 0; i < in.organs.size() && view.look.surface; ++i)
        in.organs[i].surface.follow(*states[i], stageOf(view.look.mapping));
    if (view.look.shadows)
        in.drawShadow(states, view, frames);
    if (view.look.occlusion)
        in.drawOcclusion(states, view, frames);
    in.target.begin();
    glDisable(GL_DEPTH_TEST);
    in.backdrop.set("u_size", frames[0].size);
    in.backdrop.use();
    gpu::drawFullScreen(in.empty);
    glEnable(GL_DEPTH_TEST);
    const bool core = view.look.lattice && !view.look.surface; // hides the lines on the far side
    for (std::size_t i = 0; i < in.organs.size() && core; ++i)
        in.organs[i].surface.draw(*states[i], frames[i], SurfaceStage::nodes, sim::SurfaceColour::tissue,
                                  kCoreColour);
    glPolygonMode(GL_FRONT_AND_BACK, view.wireframe ? GL_LINE : GL_FILL);
    const sim::Stage stage = view.look.show == sim::Show::implicit ? view.look.stage : sim::Stage::whole;
    const bool implicit = view.look.show != sim::Show::surface && stage != sim::Stage::mesh;
    const bool mesh =
        view.look.show != sim::Show::implicit || stage == sim::Stage::mesh || stage == sim::Stage::composite;
    for (std::size_t i = 0; i < in.organs.size() && view.look.surface && mesh; ++i)
        in.organs[i].surface.draw(*states[i], frames[i], stageOf(view.look.mapping), view.look.colour);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL); // a ray for each pixel, also where the surface is of wires
    for (std::size_t i = 0; i < view.casters.size() && implicit; ++i) {
        const Status drawn = view.casters[i]->draw(frames[i], raycastLook(view.look));
        SEROSA_CHECK(drawn.ok(), "the driver compiles GLSL 4.5: " + drawn.error().message);
    }
    std::vector<const sim::Lattice*> placements;
    for (const DrawnOrgan& organ : in.organs)
        placements.push_back(&organ.placement);
    if (view.look.tools)
        in.threads.draw(frames[0], placements, states, view.threads);
    if (view.look.tools)
        in.tools.draw(frames[0], in.organs[0].placement, view.shapes);
    for (std::size_t i = 0; i < in.organs.size() && view.look.lattice; ++i)
        in.organs[i].lattice.draw(*states[i], frames[i],
                                  !core && view.look.colour == sim::SurfaceColour::dynamicNormal
                                      ? LatticeOverlay::Ink::dark
                                      : LatticeOverlay::Ink::light);
    in.target.end();
}

Status SurfaceRenderer::prepareSkipping(std::size_t organ, const sim::Lattice& lattice,
                                        const sim::TriangleMesh& metres, const SurfaceBinding& binding,
                                        const sim::StateTextures& state) {
    return impl_->organs.at(organ).surface.prepareSkipping(lattice, metres, binding, state.layout());
}

Status SurfaceRenderer::openBox(std::size_t organ, const StageBox& box, const sim::Lattice& lattice,
                                const sim::TriangleMesh& metres, const SurfaceBinding& binding) {
    return impl_->organs.at(organ).surface.openBox(box, lattice, metres,
                                                   withBothBases(binding, lattice, metres));
}

void SurfaceRenderer::setBox(std::size_t organ, const StageBox& box) {
    impl_->organs.at(organ).surface.setBox(box);
}

void SurfaceRenderer::resize(int width, int height) {
    impl_->target = PictureTarget(width, height);
    impl_->occlusion.reset();
}

void SurfaceRenderer::show(int width, int height) const {
    impl_->target.show(width, height);
}

Status SurfaceRenderer::reload(const gpu::ShaderLibrary& library, const OrganStates& states,
                               const View& view) {
    std::vector<SurfacePasses::Programs> surfaces;
    std::vector<gpu::Program> lattices;
    for (const DrawnOrgan& organ : impl_->organs) {
        SEROSA_ASSIGN(SurfacePasses::Programs surface, organ.surface.compile(library));
        surfaces.push_back(std::move(surface));
        SEROSA_ASSIGN(gpu::Program lattice, LatticeOverlay::compile(library));
        lattices.push_back(std::move(lattice));
    }
    SEROSA_ASSIGN(ToolRenderer::Programs tools, ToolRenderer::compile(library));
    SEROSA_ASSIGN(gpu::Program threads, ThreadRenderer::compile(library));
    SEROSA_ASSIGN(gpu::Program backdrop, compileBackdrop(library));
    const auto exchange = [&] {
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            std::swap(impl_->organs[i].surface.programs(), surfaces[i]);
            std::swap(impl_->organs[i].lattice.program(), lattices[i]);
        }
        std::swap(impl_->tools.programs(), tools);
        std::swap(impl_->threads.program(), threads);
        std::swap(impl_->backdrop, backdrop);
    };
    exchange();
    std::vector<gpu::Program*> all = {&impl_->tools.programs().tool, &impl_->tools.programs().floor,
                                      &impl_->threads.program(), &impl_->backdrop};
    for (DrawnOrgan& organ : impl_->organs) {
        all.push_back(&organ.lattice.program());
        for (auto& [key, program] : organ.surface.programs())
            all.push_back(&program);
    }
    for (gpu::Program* program : all)
        program->tolerateMismatches();

    View rehearsal = view;
    rehearsal.look.surface = rehearsal.look.lattice = rehearsal.look.tools = true;
    const sim::Lattice& place = impl_->organs[0].placement;
    for (const Finish finish : {Finish::steel, Finish::floor}) {
        DrawnShape shape{{}, {place.origin, {1, 0, 0, 0}}, finish, place.spacing};
        shape.shape.kind = finish == Finish::floor ? sim::ShapeKind::halfSpace : sim::ShapeKind::sphere;
        rehearsal.shapes.push_back(shape);
    }
    rehearsal.threads.emplace_back(); // from a node to itself
    std::vector<sim::Mapping> mappings{sim::Mapping::oneToOne};
    for (const sim::Mapping mapping : sim::kSurfaceMappings)
        if (draws(mapping))
            mappings.push_back(mapping);
    for (const sim::Mapping mapping : mappings)
        for (const sim::SurfaceColour colour :
             {sim::SurfaceColour::tissue, sim::SurfaceColour::dynamicNormal, sim::SurfaceColour::plain}) {
            rehearsal.look.mapping = mapping;
            rehearsal.look.colour = colour;
            draw(states, rehearsal);
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
                                                               sim::Mapping mapping, std::size_t organ) {
    std::vector<glm::dvec3> metres;
    impl_->target.bind();
    DrawnOrgan& drawn = impl_->organs.at(organ);
    for (const glm::vec3& q : drawn.surface.capture(state, stageOf(mapping)).positions)
        metres.push_back(drawn.placement.toWorld(q));
    return metres;
}

std::vector<glm::dvec3> SurfaceRenderer::readDeformedNormals(const sim::StateTextures& state,
                                                             sim::Mapping mapping) {
    impl_->target.bind();
    const std::vector<glm::vec3> normals = impl_->organs[0].surface.capture(state, stageOf(mapping)).normals;
    return {normals.begin(), normals.end()};
}

Result<std::vector<glm::dmat3>> SurfaceRenderer::readAxes(const sim::StateTextures& state,
                                                          sim::Mapping mapping) {
    impl_->target.bind();
    SEROSA_ASSIGN(const std::vector<glm::mat3> axes,
                  impl_->organs[0].surface.captureAxes(state, stageOf(mapping)));
    return std::vector<glm::dmat3>(axes.begin(), axes.end());
}

void SurfaceRenderer::drawVertexStageOnly(const sim::StateTextures& state,
                                          std::optional<sim::Mapping> mapping) {
    impl_->target.bind();
    impl_->organs[0].surface.drawDiscarded(state, mapping ? stageOf(*mapping) : SurfaceStage::undeformed);
}

bool SurfaceRenderer::draws(sim::Mapping mapping) const {
    for (const DrawnOrgan& organ : impl_->organs)
        if (!organ.surface.draws(stageOf(mapping)))
            return false;
    return true;
}

std::size_t SurfaceRenderer::trianglesDrawn(std::size_t organ) const {
    return impl_->organs.at(organ).surface.trianglesDrawn();
}

int SurfaceRenderer::samples() const {
    return impl_->target.samples();
}

} // namespace serosa::render
