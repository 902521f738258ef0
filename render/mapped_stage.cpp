// See render/mapped_stage.h.
#include "render/mapped_stage.h"

namespace serosa::render {

namespace {
constexpr int kPixels = 8; // nothing is drawn
}

Result<MappedStage> MappedStage::create(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                        const SurfaceBinding& binding) {
    SEROSA_ASSIGN(sim::StateTextures state, sim::StateTextures::create(lattice, {}));
    SEROSA_ASSIGN(SurfaceRenderer renderer,
                  SurfaceRenderer::create(lattice, metres, binding, state, kPixels, kPixels));
    return MappedStage(lattice, binding.mapping, std::move(state), std::move(renderer));
}

std::vector<glm::dvec3> MappedStage::positions() {
    std::vector<glm::dvec3> q;
    for (const glm::dvec3& metres : renderer_.readDeformedPositions(state_, mapping_))
        q.push_back(lattice_->toLattice(metres));
    return q;
}

} // namespace serosa::render
