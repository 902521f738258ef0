// See app/map_nodes.h.
#include "app/map_nodes.h"

#include "app/organ_setup.h"
#include "app/output_folder.h"
#include "render/camera.h"
#include "render/surface_renderer.h"
#include "sim/mesh_reader.h"
#include "sim/mesh_writer.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <ostream>
#include <vector>

namespace serosa::app {

namespace {

namespace fs = std::filesystem;

Result<std::vector<fs::path>> meshFiles(const fs::path& folder) {
    std::error_code code;
    if (!fs::is_directory(folder, code))
        return Error{folder.string() + ": is no folder: give one that holds a mesh for each frame"};
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
        const std::string extension = entry.path().extension().string();
        for (const char* known : {".ply", ".obj", ".off", ".stl", ".vtk"})
            if (extension == known)
                files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    if (files.empty())
        return Error{folder.string() +
                     ": holds no mesh (.ply, .obj, .off, .stl, .vtk): give a folder with one for each frame"};
    return files;
}

Result<sim::TriangleMesh> readScaled(const fs::path& file, double unit) {
    SEROSA_ASSIGN(sim::TriangleMesh mesh, sim::readMesh(file));
    for (glm::dvec3& p : mesh.positions)
        p *= unit;
    return mesh;
}

Status checkFrame(const fs::path& file, const sim::TriangleMesh& frame, const sim::TriangleMesh& nodes) {
    if (frame.positions.size() != nodes.positions.size())
        return Error{file.string() + ": has " + grouped(frame.positions.size()) +
                     " vertices, the nodes are " + grouped(nodes.positions.size()) +
                     ": each frame must be the same mesh, moved"};
    if (frame.faces != nodes.faces)
        return Error{file.string() +
                     ": has other faces than the nodes: each frame must be the same mesh, moved"};
    return {};
}

std::string frameName(const char* pattern, std::size_t frame) {
    char name[32];
    std::snprintf(name, sizeof name, pattern, frame);
    return name;
}

/// Draws the surface from the nodes, as a scene's organ is drawn from a solver's.
class Pictures {
public:
    static Result<Pictures> create(const MapOptions& options, const render::ControlNodes& nodes,
                                   const sim::TriangleMesh& metres, const render::SurfaceBinding& binding) {
        Pictures pictures;
        SEROSA_ASSIGN(pictures.context_, gpu::createContext(options.gl));
        SEROSA_ASSIGN(sim::StateTextures state,
                      sim::StateTextures::create(render::standInLattice(nodes), {}));
        pictures.state_.emplace(std::move(state));
        SEROSA_ASSIGN(render::SurfaceRenderer renderer,
                      render::SurfaceRenderer::create(nodes, metres, binding, *pictures.state_, options.width,
                                                      options.height));
        pictures.renderer_.emplace(std::move(renderer));
        pictures.view_.camera =
            render::makeCamera({}, metres.lowest(), metres.highest(), double(options.width) / options.height);
        pictures.view_.look.mapping = binding.mapping;
        return pictures;
    }
    render::Image draw(const std::vector<glm::dvec3>& positions, const std::vector<std::uint32_t>& normals) {
        sim::LatticeState state;
        state.positions = positions;
        state.increments.resize(positions.size(), glm::dvec3(0));
        state.normals = normals;
        state.heldBy.resize(positions.size());
        state_->upload(state);
        renderer_->draw(*state_, view_);
        return renderer_->readImage();
    }

private:
    Pictures() = default;
    std::unique_ptr<gpu::Context> context_; // dies last
    std::optional<sim::StateTextures> state_;
    std::optional<render::SurfaceRenderer> renderer_;
    render::View view_;
};

} // namespace

Result<int> mapNodes(const MapOptions& options, std::ostream& out) {
    if (options.mapping == sim::Mapping::oneToOne || options.mapping == sim::Mapping::trilinear)
        return Error{"--mapping: one-to-one and trilinear need a lattice: take triangle, curvature, chosen, "
                     "normal-offset or node-frames"};
    SEROSA_ASSIGN(const double unit, sim::parseLengthUnit(options.lengthUnit));
    SEROSA_ASSIGN(const sim::TriangleMesh nodes, readScaled(options.nodes, unit));
    SEROSA_ASSIGN(sim::TriangleMesh surface, readScaled(options.surface, unit));
    SEROSA_ASSIGN(const std::vector<fs::path> frames, meshFiles(options.frames));
    SEROSA_ASSIGN(OutputFolder folder, OutputFolder::check(options.out, options.force));
    if (nodes.lowest() == nodes.highest())
        return Error{options.nodes.string() +
                     ": all its vertices are in one place: give nodes that are apart"};

    const render::ControlNodes control = render::controlNodes(nodes);
    if (const Status fits = render::checkBinding(control, surface); !fits.ok())
        return Error{options.surface.string() + ": " + fits.error().message};
    const render::SurfaceBinding binding = render::bindSurface(control, surface, options.mapping);
    out << grouped(surface.positions.size()) << " vertices follow " << grouped(control.count()) << " nodes, "
        << shortNumber(1e3 * control.spacing) << " mm apart\n";

    std::optional<Pictures> pictures;
    if (options.pictures) {
        SEROSA_ASSIGN(Pictures made, Pictures::create(options, control, surface, binding));
        pictures.emplace(std::move(made));
    }
    SEROSA_TRY(folder.create());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        SEROSA_ASSIGN(const sim::TriangleMesh frame, readScaled(frames[i], unit));
        SEROSA_TRY(checkFrame(frames[i], frame, nodes));
        std::vector<glm::dvec3> moved;
        for (const glm::dvec3& p : frame.positions)
            moved.push_back(control.toNodes(p));
        const std::vector<std::uint32_t> normals = render::packedNormals(control, moved);
        if (pictures)
            SEROSA_TRY(render::writePng(pictures->draw(moved, normals),
                                        folder.file(frameName("frame_%06zu.png", i + 1))));
        const std::vector<glm::dvec3> mapped = render::mapSurface(binding, moved, normals);
        for (std::size_t v = 0; v < mapped.size(); ++v)
            surface.positions[v] = control.toWorld(mapped[v]) / unit;
        SEROSA_TRY(sim::writeMesh(surface, folder.file(frameName("surface_%06zu.ply", i + 1))));
    }
    folder.keep();
    out << "wrote " << grouped(frames.size())
        << (pictures ? " surfaces and pictures into " : " surfaces into ") << options.out.string() << "\n";
    return int(exitOk);
}

} // namespace serosa::app
