// A surface of a million faces over 20,000 nodes: what skipping hidden clusters and levels of detail save,
// whole, from near and from far; what a texture, shadows and occlusion cost.

#include "bench/cases.h"
#include "gpu/gl.h"
#include "render/camera.h"
#include "render/surface_passes.h"
#include "render/surface_renderer.h"
#include "render/surface_vertices.h"
#include "sim/state_textures.h"

#include <chrono>

namespace serosa::bench {

namespace {

constexpr int kPictureSize = 1024;        // pixels
constexpr std::size_t kFaces = 1'000'000; // at least
constexpr std::size_t kNodes = 20'000;

double secondsOf(const std::function<void()>& what) {
    const auto start = std::chrono::steady_clock::now();
    what();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

Status benchLook(const Options& options, Report& report) {
    SEROSA_ASSIGN(const sim::TriangleMesh* heart, heartSurface());
    const sim::TriangleMesh fine = refined(*heart, kFaces);
    sim::LatticeRequest request;
    request.nodes = kNodes;
    SEROSA_ASSIGN(const sim::Lattice lattice, sim::buildLattice(*heart, request));
    SEROSA_ASSIGN(const sim::StateTextures state, sim::StateTextures::create(lattice, {}));
    render::SurfaceBinding binding;
    const double bindSeconds =
        secondsOf([&] { binding = render::bindSurface(lattice, fine, sim::Mapping::curvature); });
    Result<render::SurfaceRenderer> made = Error{""};
    const double uploadSeconds = secondsOf([&] {
        made = render::SurfaceRenderer::create(lattice, fine, binding, state, kPictureSize, kPictureSize);
    });
    if (!made)
        return made.error();
    render::SurfaceRenderer renderer = std::move(made).value();
    SEROSA_TRY(renderer.prepareSkipping(0, lattice, fine, binding, state));
    const render::SurfaceDetail detail{render::makeTissue(sim::TissueTexture::heartMuscle, 0.024, 0.0004),
                                       0.024, 0.0004};
    SEROSA_ASSIGN(render::SurfaceRenderer textured,
                  render::SurfaceRenderer::create(
                      lattice, *heart, render::bindSurface(lattice, *heart, sim::Mapping::curvature), state,
                      kPictureSize, kPictureSize, &detail));

    Rounds rounds;
    std::vector<std::vector<std::string>> triangles;
    const auto frame = [&](render::SurfaceRenderer& by, const std::string& name, const render::View& view) {
        by.draw(state, view);
        triangles.push_back({name, std::to_string(by.trianglesDrawn())});
        rounds.add(name, [&by, &state, view](int repeats) {
            for (int i = 0; i < repeats; ++i)
                by.draw(state, view);
            glFinish();
        });
    };
    for (const auto& [place, zoom] : {std::pair{"whole", 1.0}, {"near", 6.0}, {"far", 0.15}})
        for (const auto& [way, cull, error] : {std::tuple{"all", false, 0.0},
                                               {"skipping", true, 0.0},
                                               {"level of detail", false, 0.5},
                                               {"both", true, 0.5}}) {
            sim::Camera camera;
            camera.zoom = zoom;
            render::View view;
            view.camera = render::makeCamera(camera, fine.lowest(), fine.highest(), 1);
            view.cull = cull;
            view.surfaceError = error;
            frame(renderer, std::string(place) + ", " + way, view);
        }
    render::View view;
    view.camera = render::makeCamera({}, heart->lowest(), heart->highest(), 1);
    frame(textured, "textured", view);
    view.look.shadows = true;
    frame(textured, "textured, shadows", view);
    view.look.occlusion = true;
    frame(textured, "textured, shadows, occlusion", view);
    rounds.measure(options.rounds, options.seconds);

    const double misses = render::cacheMisses(render::cacheOrder(fine.faces, fine.positions.size()));
    report.heading("A surface of " + std::to_string(fine.faces.size()) + " faces (" +
                   std::to_string(fine.positions.size()) + " vertices) on " +
                   std::to_string(lattice.nodeCount()) + " nodes, 1024 x 1024");
    report.line("Bound in " + figure(bindSeconds) + " s, made ready in " + figure(uploadSeconds) + " s; " +
                std::to_string(int(binding.bytesPerVertex)) + " bytes a vertex; " + figure(misses) +
                " vertices a triangle through a cache of 32.");
    std::vector<std::vector<std::string>> rows;
    for (const std::vector<std::string>& row : triangles)
        rows.push_back({row[0], row[1], figure(rounds.milliseconds(row[0]))});
    report.table({"picture", "triangles", "ms"}, rows);
    report.ratio("skipping_over_all", rounds.ratio("whole, skipping", "whole, all"));
    report.ratio("skipping_over_all_near", rounds.ratio("near, skipping", "near, all"));
    report.ratio("surface_lod_over_all_far", rounds.ratio("far, level of detail", "far, all"));
    report.ratio("both_over_all_far", rounds.ratio("far, both", "far, all"));
    report.ratio("shadows_over_none", rounds.ratio("textured, shadows", "textured"));
    report.ratio("occlusion_over_none", rounds.ratio("textured, shadows, occlusion", "textured, shadows"));
    return {};
}

} // namespace serosa::bench
