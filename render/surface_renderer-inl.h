#pragma once
// What a SurfaceRenderer holds, for the files that implement it.

#include "render/frame.h"
#include "render/lamp_shadow.h"
#include "render/lattice_overlay.h"
#include "render/picture_target.h"
#include "render/screen_occlusion.h"
#include "render/surface_passes.h"
#include "render/surface_renderer.h"
#include "render/thread_renderer.h"
#include "render/tool_renderer.h"

#include <optional>
#include <vector>

namespace serosa::render {

struct DrawnOrgan {
    sim::Lattice placement; // spacing and origin only: metres from lattice units
    SurfacePasses surface;
    LatticeOverlay lattice;
    glm::dvec3 lowest, highest; // at rest, m

    static Result<DrawnOrgan> create(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                     const std::vector<SurfaceBinding>& bindings,
                                     const sim::TextureLayout& layout, const SurfaceDetail* detail) {
        SEROSA_ASSIGN(SurfacePasses surface,
                      SurfacePasses::create(lattice, metres, bindings, layout, detail));
        SEROSA_ASSIGN(LatticeOverlay overlay, LatticeOverlay::create(lattice, layout));
        sim::Lattice placement;
        placement.spacing = lattice.spacing;
        placement.origin = lattice.origin;
        return DrawnOrgan{std::move(placement), std::move(surface), std::move(overlay), metres.lowest(),
                          metres.highest()};
    }
};

struct SurfaceRenderer::Impl {
    std::vector<DrawnOrgan> organs; // at least one
    // Of each organ its levels of detail; the one that is drawn stands in `organs`, and is none here.
    std::vector<std::vector<std::optional<DrawnOrgan>>> levels;
    std::vector<std::size_t> level; // that is drawn, one an organ
    ToolRenderer tools;
    ThreadRenderer threads;
    gpu::Program backdrop;
    gpu::VertexArray empty;
    PictureTarget target;
    std::optional<LampShadow> shadow;         // made when first asked for
    std::optional<ScreenOcclusion> occlusion; // of the target's size; the same
    bool keepsCuts = false;                   // for undoCut

    glm::dvec3 lowest() const; // of all organs at rest, m
    glm::dvec3 highest() const;
    void drawDepths(const OrganStates& states, const View& view, const CameraView& camera, int width,
                    int height);
    void drawShadow(const OrganStates& states, const View& view, std::vector<Frame>& frames);
    void drawOcclusion(const OrganStates& states, const View& view, std::vector<Frame>& frames);
};

} // namespace serosa::render
