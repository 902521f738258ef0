// See render/thread_renderer.h.
#include "render/thread_renderer.h"

#include "gpu/gl.h"
#include "render/tool_meshes.h"

#include <cstddef>

namespace serosa::render {

namespace {

constexpr glm::vec3 kThreadColour{0.03F, 0.09F, 0.45F}; // linear: blue, as no tissue is

} // namespace

Result<gpu::Program> ThreadRenderer::compile(const gpu::ShaderLibrary& library) {
    return gpu::Program::create(library, {"thread.vert", "tool.frag"});
}

Result<ThreadRenderer> ThreadRenderer::create() {
    ThreadRenderer renderer;
    SEROSA_ASSIGN(renderer.program_, compile(gpu::ShaderLibrary()));
    sim::RigidShape rod;
    rod.kind = sim::ShapeKind::capsule;
    rod.length = 1;
    const ToolMesh mesh = toolMesh(rod);
    renderer.vertices_ = gpu::Buffer("thread", std::span<const ToolVertex>(mesh.vertices));
    renderer.indices_ = gpu::Buffer("thread indices", std::span<const std::uint32_t>(mesh.indices));
    renderer.array_ = gpu::VertexArray("thread");
    renderer.array_.attribute(0, renderer.vertices_, 3, GL_FLOAT, false, sizeof(ToolVertex),
                              offsetof(ToolVertex, core));
    renderer.array_.attribute(1, renderer.vertices_, 3, GL_FLOAT, false, sizeof(ToolVertex),
                              offsetof(ToolVertex, normal));
    renderer.array_.indices(renderer.indices_);
    renderer.indexCount_ = int(mesh.indices.size());
    return renderer;
}

void ThreadRenderer::draw(const Frame& frame, const std::vector<const sim::Lattice*>& placements,
                          const std::vector<const sim::StateTextures*>& states,
                          const std::vector<DrawnThread>& threads) {
    if (threads.empty())
        return;
    const sim::Lattice& first = *placements.front();
    frame.setLight(program_);
    program_.set("u_clipFromLattice", frame.clipFromLattice);
    for (const DrawnThread& thread : threads) {
        for (std::size_t e = 0; e < 2; ++e) {
            const DrawnThread::End& end = thread.ends[e];
            const sim::Lattice& own = *placements.at(end.organ);
            const sim::StateTextures& state = *states.at(end.organ);
            std::array<glm::vec4, 8> nodes;
            for (std::size_t i = 0; i < nodes.size(); ++i)
                nodes[i] = glm::vec4(glm::vec2(state.layout().texelOfNode.at(end.nodes[i])),
                                     float(end.weights[i]), 0);
            const std::string name = e == 0 ? "first" : "second";
            program_.texture("t_" + name, state.positions());
            program_.set("u_" + name, std::span<const glm::vec4>(nodes));
            program_.set("u_" + name + "Place", glm::vec4(glm::vec3(first.toLattice(own.origin)),
                                                          float(own.spacing / first.spacing)));
        }
        program_.set("u_radius", float(thread.radius / first.spacing));
        program_.set("u_matte", thread.clip ? glm::vec4(0) : glm::vec4(kThreadColour, 1));
        program_.use();
        glBindVertexArray(array_.id());
        glDrawElements(GL_TRIANGLES, indexCount_, GL_UNSIGNED_INT, nullptr);
    }
}

} // namespace serosa::render
