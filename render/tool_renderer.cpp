// See render/tool_renderer.h. A shape's triangles are kept on the GPU from its first picture on.
#include "render/tool_renderer.h"

#include "gpu/gl.h"
#include "render/tool_meshes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace serosa::render {

namespace {

constexpr std::size_t kMostModels = 64; // kept; beyond, all are made again

constexpr glm::vec3 kBodyColour{0.36F, 0.35F, 0.31F}; // linear: bone

/// The same triangles.
bool alike(const sim::RigidShape& a, const sim::RigidShape& b) {
    return a.kind == b.kind && a.length == b.length && a.bend == b.bend && a.middle == b.middle &&
           a.halfSize == b.halfSize && a.surface == b.surface;
}

/// Lines of a floor lie 1, 2 or 5 times a power of ten metres apart, about `extent` / 10.
double gridStep(double extent) {
    const double wanted = extent / 10, power = std::pow(10.0, std::floor(std::log10(wanted)));
    return power * (wanted < 2 * power ? 1 : wanted < 5 * power ? 2 : 5);
}

} // namespace

Result<ToolRenderer::Programs> ToolRenderer::compile(const gpu::ShaderLibrary& library) {
    Programs programs;
    SEROSA_ASSIGN(programs.tool, gpu::Program::create(library, {"tool.vert", "tool.frag"}));
    SEROSA_ASSIGN(programs.floor, gpu::Program::create(library, {"tool.vert", "tool_floor.frag"}));
    return programs;
}

Result<ToolRenderer> ToolRenderer::create() {
    ToolRenderer renderer;
    SEROSA_ASSIGN(renderer.programs_, compile(gpu::ShaderLibrary()));
    return renderer;
}

const ToolRenderer::Model& ToolRenderer::modelOf(const sim::RigidShape& shape) {
    for (const Model& model : models_)
        if (alike(model.shape, shape))
            return model;
    if (models_.size() >= kMostModels)
        models_.clear();
    const ToolMesh mesh = shape.kind == sim::ShapeKind::halfSpace ? floorPatch() : toolMesh(shape);
    Model model;
    model.shape = shape;
    model.vertices = gpu::Buffer("tool", std::span<const ToolVertex>(mesh.vertices));
    model.indices = gpu::Buffer("tool indices", std::span<const std::uint32_t>(mesh.indices));
    model.array = gpu::VertexArray("tool");
    model.array.attribute(0, model.vertices, 3, GL_FLOAT, false, sizeof(ToolVertex),
                          offsetof(ToolVertex, core));
    model.array.attribute(1, model.vertices, 3, GL_FLOAT, false, sizeof(ToolVertex),
                          offsetof(ToolVertex, normal));
    model.array.indices(model.indices);
    model.indexCount = int(mesh.indices.size());
    models_.push_back(std::move(model));
    return models_.back();
}

void ToolRenderer::drawOne(gpu::Program& program, const sim::Lattice& placement, const DrawnShape& drawn) {
    const bool floor = drawn.finish == Finish::floor;
    program.set("u_at", glm::vec3(placement.toLattice(drawn.pose.at)));
    program.set("u_turn", glm::mat3(glm::mat3_cast(drawn.pose.turn)));
    program.set("u_scale", float((floor ? drawn.extent : 1) / placement.spacing));
    program.set("u_radius", float(floor ? 0 : drawn.shape.radius / placement.spacing));
    const Model& model = modelOf(drawn.shape);
    program.use();
    glBindVertexArray(model.array.id());
    glDrawElements(GL_TRIANGLES, model.indexCount, GL_UNSIGNED_INT, nullptr);
}

void ToolRenderer::draw(const Frame& frame, const sim::Lattice& placement,
                        const std::vector<DrawnShape>& shapes) {
    if (shapes.empty())
        return;
    for (gpu::Program* program : {&programs_.tool, &programs_.floor}) {
        frame.setLight(*program);
        program->set("u_clipFromLattice", frame.clipFromLattice);
    }
    for (const DrawnShape& drawn : shapes)
        if (drawn.finish != Finish::floor) {
            programs_.tool.set("u_matte",
                               drawn.finish == Finish::matte ? glm::vec4(kBodyColour, 1) : glm::vec4(0));
            drawOne(programs_.tool, placement, drawn);
        }
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    for (const DrawnShape& drawn : shapes)
        if (drawn.finish == Finish::floor) {
            programs_.floor.set("u_lines", float(drawn.extent / gridStep(drawn.extent)));
            drawOne(programs_.floor, placement, drawn);
        }
    glDisable(GL_BLEND);
}

} // namespace serosa::render
