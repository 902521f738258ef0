// Cuts of a SurfaceRenderer's organs: the mask that strokes are painted into, and the faces along them.
#include "render/cut_surface.h"
#include "render/surface_renderer-inl.h"
#include "shaders/shared_constants.h"
#include "sim/pieces.h"

namespace serosa::render {

Status SurfaceRenderer::prepareCuts(std::size_t organ, const sim::Lattice& lattice,
                                    const sim::TextureLayout& layout) {
    SurfacePasses& surface = impl_->organs.at(organ).surface;
    return surface.mask() ? Status() : surface.openMask(lattice, layout);
}

Status SurfaceRenderer::paintCut(std::size_t organ, const sim::Lattice& lattice,
                                 const sim::StateTextures& state, const sim::Stroke& stroke) {
    SurfacePasses& surface = impl_->organs.at(organ).surface;
    if (stroke.kind == sim::StrokeKind::tear && !surface.mask())
        return {};
    SEROSA_TRY(prepareCuts(organ, lattice, state.layout()));
    surface.mask()->paint(state, lattice, stroke, impl_->keepsCuts);
    return {};
}

void SurfaceRenderer::keepCutsForUndo(bool on) {
    impl_->keepsCuts = on;
}

bool SurfaceRenderer::undoCut(std::size_t organ) {
    CutMask* mask = impl_->organs.at(organ).surface.mask();
    return mask && mask->undo();
}

const CutMask* SurfaceRenderer::cutMask(std::size_t organ) const {
    return impl_->organs.at(organ).surface.mask();
}

std::string SurfaceRenderer::saveCuts(std::size_t organ) const {
    const CutMask* mask = impl_->organs.at(organ).surface.mask();
    return mask ? mask->save() : std::string();
}

Status SurfaceRenderer::restoreCuts(std::size_t organ, const sim::Lattice& lattice,
                                    const sim::StateTextures& state, std::string_view bytes) {
    SurfacePasses& surface = impl_->organs.at(organ).surface;
    if (bytes.empty()) {
        if (surface.mask())
            surface.mask()->clear();
        return {};
    }
    SEROSA_TRY(prepareCuts(organ, lattice, state.layout()));
    if (!surface.mask()->restore(bytes))
        return Error{"the mask of what was cut is of another lattice"};
    return {};
}

Status SurfaceRenderer::showCuts(std::size_t organ, const sim::Lattice& lattice,
                                 const sim::TriangleMesh& metres, const SurfaceBinding& binding,
                                 const sim::StateTextures& state,
                                 const std::vector<std::uint32_t>& connections, sim::Mapping mapping,
                                 bool fades) {
    SurfacePasses& surface = impl_->organs.at(organ).surface;
    const sim::TextureLayout& layout = state.layout();
    std::vector<SurfaceBinding> rebound{
        expressBinding(binding, lattice, metres, binding.mapping, connections)};
    for (const sim::Mapping drawn : sim::kSurfaceMappings)
        if (drawn != binding.mapping && surface.draws(stageOf(drawn))) // sides are chosen already
            rebound.push_back(expressBinding(rebound.front(), lattice, metres, drawn, connections));
    const std::vector<float> sides = surface.mask() ? surface.mask()->nodeSides() : std::vector<float>();
    const CutSurface cut = cutSurface(lattice, metres, binding, rebound.front(), connections, sides);
    const std::vector<glm::uvec3> boundary = sim::boundaryLeft(lattice, connections);
    impl_->target.bind();
    if (!fades)
        return surface.show(cut, lattice, metres, rebound, boundary, layout, connections);
    const SurfaceStage stage = stageOf(mapping == sim::Mapping::oneToOne ? sim::Mapping::curvature : mapping);
    const gpu::Buffer shown = surface.shown(state, stage);
    const std::vector<SurfacePasses::Copy> copies = surface.copies();
    SEROSA_TRY(surface.show(cut, lattice, metres, rebound, boundary, layout, connections));
    SEROSA_TRY(surface.prepareBlend());
    surface.startBlend(state, stage, surface.shownAfter(shown, copies), 1, glm::vec3(0),
                       float(SRS_BLEND_STEP));
    return {};
}

} // namespace serosa::render
