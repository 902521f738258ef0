// Drawing: what the mappings (those of MS05 3.3 and those beside them) cost against the undeformed surface,
// whole frames, and vertex fetch against reading back and uploading; and the figures that MS05 3.4 gives.

#include "bench/cases.h"
#include "gpu/gl.h"
#include "gpu/handles.h"
#include "render/camera.h"
#include "render/surface_binding.h"
#include "render/surface_renderer.h"
#include "render/surface_vertices.h"
#include "sim/state_textures.h"

#include <optional>

namespace serosa::bench {

namespace {

constexpr int kPictureSize = 1024; // pixels
constexpr double kYoung = 3000;    // Pa

struct OtherMapping {
    sim::Mapping mapping;
    const char* name;
    const char* ratio;
};
constexpr OtherMapping kOthers[] = {
    {sim::Mapping::chosen, "chosen per vertex", "chosen_over_static"},
    {sim::Mapping::normalOffset, "along the normal", "normal_offset_over_static"},
    {sim::Mapping::trilinear, "trilinear in cells", "trilinear_over_static"},
    {sim::Mapping::nodeFrames, "node frames, their pass included", "node_frames_over_static"}};

/// What a program without vertex texture fetch does every frame: node positions to the CPU, eq. 9 there (one
/// thread), positions and normals back into a vertex buffer.
class ReadbackPath {
public:
    ReadbackPath(const sim::Solver& solver, const render::SurfaceBinding& binding)
        : solver_(solver), binding_(binding),
          buffer_("mapped vertices", binding.vertices.size() * sizeof(Vertex), nullptr) {}

    void run() {
        const sim::StateTextures& textures = *solver_.textures();
        texels_.resize(textures.layout().texels());
        textures.positions().download(texels_.data(), texels_.size() * sizeof texels_[0]);
        vertices_.resize(binding_.vertices.size());
        for (std::size_t i = 0; i < vertices_.size(); ++i)
            vertices_[i] = map(binding_.vertices[i], textures.layout());
        buffer_.upload(0, vertices_.size() * sizeof(Vertex), vertices_.data());
    }

private:
    struct Vertex {
        glm::vec3 position, normal;
    };
    glm::vec3 node(std::uint32_t index, const sim::TextureLayout& layout) const {
        const glm::uvec2 texel = layout.texelOfNode[index];
        return glm::vec3(texels_[std::size_t(texel.y) * std::size_t(layout.width) + texel.x]);
    }
    Vertex map(const render::VertexBinding& vertex, const sim::TextureLayout& layout) const {
        const glm::vec3 p1 = node(vertex.nodes.x, layout), p2 = node(vertex.nodes.y, layout),
                        p3 = node(vertex.nodes.z, layout);
        const glm::vec3 edge = p2 - p1, n = glm::normalize(glm::cross(edge, p3 - p1));
        const glm::mat3 basis(glm::normalize(edge), n, glm::normalize(glm::cross(n, edge)));
        const glm::vec3 r = vertex.weights.x * p1 + vertex.weights.y * p2 + vertex.weights.z * p3;
        return {r + basis * vertex.offset, basis * vertex.normal};
    }

    const sim::Solver& solver_;
    const render::SurfaceBinding& binding_;
    gpu::Buffer buffer_;
    std::vector<glm::vec4> texels_;
    std::vector<Vertex> vertices_;
};

render::View viewOf(const sim::TriangleMesh& surface, sim::Mapping mapping) {
    render::View view;
    view.camera = render::makeCamera({}, surface.lowest(), surface.highest(), 1);
    view.look.mapping = mapping;
    return view;
}

void reportPaperTable(const Rounds& rounds, Report& report) {
    const Spread step = rounds.milliseconds("one step"), corrected = rounds.milliseconds("frame, corrected"),
                 constant = rounds.milliseconds("frame, constant");
    const auto rate = [](double milliseconds) { return figure(1e3 / milliseconds); };
    report.heading("MS05 3.4 (GeForce 6800 Ultra, 2005) beside this machine");
    report.table(
        {"", "MS05", "here"},
        {{"a view with curvature correction, ms", "6.67", figure(corrected)},
         {"a view without, ms", "5.26", figure(constant)},
         {"a solver step, ms", "2.22", figure(step)},
         {"frames a second, 15 steps and a corrected view", "25", rate(15 * step.median + corrected.median)},
         {"frames a second, corrected view alone", "150", rate(corrected.median)},
         {"frames a second, constant view alone", "190", rate(constant.median)}});
    report.line(
        "\nViews here are whole pictures of 1024 x 1024 pixels, multisampled, with backdrop; MS05 does "
        "not give its picture size.");
}

} // namespace

Status benchMapping(const Options& options, Report& report) {
    SEROSA_ASSIGN(const sim::TriangleMesh* heart, heartSurface());
    SEROSA_ASSIGN(sim::Lattice lattice, sim::buildLattice(*heart, {}));
    const Block block(std::move(lattice), kYoung);
    SEROSA_ASSIGN(std::unique_ptr<sim::Solver> solver, fragmentSolver(block));
    const render::SurfaceBinding corrected =
        render::bindSurface(block.lattice, *heart, sim::Mapping::curvature);
    const render::SurfaceBinding constant =
        render::expressBinding(corrected, block.lattice, *heart, sim::Mapping::triangle);
    const sim::StateTextures& state = *solver->textures();
    SEROSA_ASSIGN(
        render::SurfaceRenderer renderer,
        render::SurfaceRenderer::create(block.lattice, *heart, corrected, state, kPictureSize, kPictureSize));
    ReadbackPath readback(*solver, constant);
    // A renderer each: it draws the mapping that its binding is of.
    std::vector<std::pair<render::SurfaceBinding, render::SurfaceRenderer>> others;
    for (const OtherMapping& of : kOthers) {
        render::SurfaceBinding binding = render::expressBinding(corrected, block.lattice, *heart, of.mapping);
        SEROSA_ASSIGN(render::SurfaceRenderer other,
                      render::SurfaceRenderer::create(block.lattice, *heart, binding, state, kPictureSize,
                                                      kPictureSize));
        others.emplace_back(std::move(binding), std::move(other));
    }

    Rounds rounds;
    const auto stageOf = [&](render::SurfaceRenderer& of, const char* name,
                             std::optional<sim::Mapping> mapping) {
        rounds.add(name, [&of, &state, mapping](int repeats) {
            for (int i = 0; i < repeats; ++i)
                of.drawVertexStageOnly(state, mapping);
            glFinish();
        });
    };
    const auto frame = [&](const char* name, const render::View& view) {
        rounds.add(name, [&renderer, &state, view](int repeats) {
            for (int i = 0; i < repeats; ++i)
                renderer.draw(state, view);
            glFinish();
        });
    };
    stageOf(renderer, "undeformed", std::nullopt);
    stageOf(renderer, "constant", sim::Mapping::triangle);
    stageOf(renderer, "corrected", sim::Mapping::curvature);
    for (std::size_t i = 0; i < others.size(); ++i)
        stageOf(others[i].second, kOthers[i].name, kOthers[i].mapping);
    rounds.add("readback", [&](int repeats) {
        for (int i = 0; i < repeats; ++i) {
            readback.run();
            renderer.drawVertexStageOnly(state, std::nullopt);
        }
        glFinish();
    });
    frame("frame, constant", viewOf(*heart, sim::Mapping::triangle));
    frame("frame, corrected", viewOf(*heart, sim::Mapping::curvature));
    rounds.add("one step", [&](int repeats) {
        solver->advance(repeats);
        glFinish();
    });
    rounds.measure(options.rounds, options.seconds);

    report.heading("Vertex stage, heart of " + std::to_string(heart->faces.size()) + " faces (" +
                   std::to_string(heart->positions.size()) + " vertices) on " +
                   std::to_string(block.lattice.nodeCount()) + " nodes, nothing rasterized");
    std::vector<std::vector<std::string>> rows;
    const auto row = [&](std::string what, const char* name, double bytes) {
        rows.push_back({std::move(what), bytes > 0 ? figure(bytes) : "", figure(rounds.milliseconds(name)),
                        figure(rounds.ratio(name, "undeformed"))});
    };
    row("undeformed", "undeformed", sizeof(render::StaticVertex));
    row("constant basis", "constant", constant.bytesPerVertex);
    row("corrected basis", "corrected", corrected.bytesPerVertex);
    for (std::size_t i = 0; i < others.size(); ++i)
        row(kOthers[i].name, kOthers[i].name, others[i].first.bytesPerVertex);
    row("nodes read back, mapped on one CPU thread (constant basis), uploaded, drawn", "readback", 0);
    report.table({"", "bytes a vertex", "ms", "over undeformed"}, rows);
    report.line("\nReading back and uploading takes " + figure(rounds.ratio("readback", "constant")) +
                " times as long as the vertex fetch with the same basis.");
    report.heading("Whole frame, 1024 x 1024");
    report.table({"", "ms", "over constant"},
                 {{"constant basis", figure(rounds.milliseconds("frame, constant")), "1"},
                  {"corrected basis", figure(rounds.milliseconds("frame, corrected")),
                   figure(rounds.ratio("frame, corrected", "frame, constant"))}});
    reportPaperTable(rounds, report);
    report.ratio("mapping_over_static", rounds.ratio("corrected", "undeformed"));
    for (const OtherMapping& of : kOthers)
        report.ratio(of.ratio, rounds.ratio(of.name, "undeformed"));
    report.ratio("corrected_over_constant", rounds.ratio("corrected", "constant"));
    report.ratio("corrected_over_constant_frame", rounds.ratio("frame, corrected", "frame, constant"));
    return {};
}

} // namespace serosa::bench
