#pragma once
// The vertex stage of one surface under given node positions, read back: what tests and `serosa verify`
// measure. Positions are in lattice units.

#include "base/result.h"
#include "render/surface_binding.h"
#include "render/surface_renderer.h"
#include "sim/state_textures.h"

namespace serosa::render {

class MappedStage {
public:
    /// `lattice` outlives this. Needs a current context. Errors: as SurfaceRenderer::create.
    static Result<MappedStage> create(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                      const SurfaceBinding& binding);
    void upload(const sim::LatticeState& state) { state_.upload(state); }
    // One a mesh vertex, through the binding's mapping.
    std::vector<glm::dvec3> positions();
    std::vector<glm::dvec3> normals() { return renderer_.readDeformedNormals(state_, mapping_); }
    Result<std::vector<glm::dmat3>> axes() { return renderer_.readAxes(state_, mapping_); }

private:
    MappedStage(const sim::Lattice& lattice, sim::Mapping mapping, sim::StateTextures state,
                SurfaceRenderer renderer)
        : lattice_(&lattice), mapping_(mapping), state_(std::move(state)), renderer_(std::move(renderer)) {}
    const sim::Lattice* lattice_;
    sim::Mapping mapping_;
    sim::StateTextures state_;
    SurfaceRenderer renderer_;
};

} // namespace serosa::render
