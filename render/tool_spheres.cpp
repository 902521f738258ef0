#include "render/tool_spheres.h"

#include "gpu/gl.h"

#include <cmath>
#include <numbers>

namespace serosa::render {

namespace {
constexpr int kAround = 72, kDown = 36;
}

Result<gpu::Program> ToolSpheres::compile(const gpu::ShaderLibrary& library) {
    return gpu::Program::create(library, {"tool.vert", "tool.frag"});
}

Result<ToolSpheres> ToolSpheres::create() {
    ToolSpheres spheres;
    SEROSA_ASSIGN(spheres.program_, compile(gpu::ShaderLibrary()));
    std::vector<glm::vec3> vertices;
    std::vector<std::uint32_t> indices;
    for (int i = 0; i <= kDown; ++i)
        for (int j = 0; j <= kAround; ++j) {
            const double polar = std::numbers::pi * i / kDown, around = 2 * std::numbers::pi * j / kAround;
            vertices.emplace_back(std::sin(polar) * std::sin(around), std::cos(polar),
                                  std::sin(polar) * std::cos(around));
            if (i < kDown && j < kAround) {
                const auto a = std::uint32_t(i * (kAround + 1) + j), b = a + kAround + 1;
                indices.insert(indices.end(), {a, b, a + 1, a + 1, b, b + 1});
            }
        }
    spheres.vertices_ = gpu::Buffer("tool sphere", std::span<const glm::vec3>(vertices));
    spheres.indices_ = gpu::Buffer("tool sphere indices", std::span<const std::uint32_t>(indices));
    spheres.array_ = gpu::VertexArray("tool sphere");
    spheres.array_.attribute(0, spheres.vertices_, 3, GL_FLOAT, false, sizeof(glm::vec3), 0);
    spheres.array_.indices(spheres.indices_);
    spheres.indexCount_ = int(indices.size());
    return spheres;
}

void ToolSpheres::draw(const Frame& frame) {
    if (frame.tools.empty())
        return;
    frame.setLight(program_);
    program_.set("u_clipFromLattice", frame.clipFromLattice);
    for (const glm::vec4& sphere : frame.tools) {
        program_.set("u_sphere", sphere);
        program_.use();
        glBindVertexArray(array_.id());
        glDrawElements(GL_TRIANGLES, indexCount_, GL_UNSIGNED_INT, nullptr);
    }
}

} // namespace serosa::render
