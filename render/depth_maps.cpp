// See render/depth_maps.h.
#include "render/depth_maps.h"

#include "gpu/program.h"

#include <algorithm>

namespace serosa::render {

namespace {

struct Vertex {
    glm::vec3 position; // voxels
    glm::u8vec4 colour;
};
static_assert(sizeof(Vertex) == 16);

/// What a drawing from one end of an axis leaves.
struct End {
    gpu::Texture2D depth, colour;
    gpu::Framebuffer target;

    End(int side, const gpu::Texture2D& order)
        : depth("depth of a map", GL_R32F, side, side), colour("colours of a map", GL_RGBA8, side, side),
          target("depth map") {
        target.attach(GL_COLOR_ATTACHMENT0, depth);
        target.attach(GL_COLOR_ATTACHMENT1, colour);
        target.attach(GL_DEPTH_ATTACHMENT, order);
        target.setDrawBuffers(2);
    }
};

} // namespace

Result<DepthMaps> DepthMaps::create(const sim::TriangleMesh& mesh, const VolumeGrid& grid,
                                    const DepthPlan& plan, const std::vector<glm::u8vec4>& colours) {
    if (mesh.faces.empty())
        return Error{"depth maps of a mesh without faces"};
    const glm::dvec3 low = (mesh.lowest() - grid.lowest) / grid.step,
                     high = (mesh.highest() - grid.lowest) / grid.step;
    if (glm::any(glm::lessThan(low, glm::dvec3(-0.5))) ||
        glm::any(glm::greaterThan(high, glm::dvec3(grid.size) - 0.5)))
        return Error{"depth maps of a mesh that reaches beyond their grid: they need all of it"};
    const int side = std::max({grid.size.x, grid.size.y, grid.size.z});
    const int most = gpu::Texture3D::mostTexels();
    if (side > most)
        return Error{"depth maps of " + std::to_string(side) +
                     " texels along a side: the context has at most " + std::to_string(most)};

    std::vector<Vertex> vertices;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        vertices.push_back({glm::vec3((mesh.positions[v] - grid.lowest) / grid.step),
                            colours.empty() ? glm::u8vec4(255) : colours[v]});
    const gpu::Buffer vertexBuffer("vertices of depth maps", std::span<const Vertex>(vertices)),
        indexBuffer("triangles of depth maps", std::span<const glm::uvec3>(mesh.faces));
    gpu::VertexArray array("depth maps");
    array.attribute(0, vertexBuffer, 3, GL_FLOAT, false, sizeof(Vertex), offsetof(Vertex, position));
    array.attribute(1, vertexBuffer, 4, GL_UNSIGNED_BYTE, true, sizeof(Vertex), offsetof(Vertex, colour));
    array.indices(indexBuffer);

    DepthMaps made;
    made.plan_ = plan;
    made.grid_ = grid;
    made.depths_ = gpu::Texture3D("depth maps", GL_RG32F, {side, side, plan.layers()});
    made.colours_.emplace("colours of depth maps", glm::ivec3(side, side, 2 * plan.layers()));
    const gpu::ShaderLibrary library;
    SEROSA_ASSIGN(gpu::Program draw, gpu::Program::create(library, {"depth_map.vert", "depth_map.frag"}));
    SEROSA_ASSIGN(gpu::Program finish,
                  gpu::Program::create(library, {"depth_map_finish.comp"},
                                       {{"RAYCAST_FIELD", std::to_string(int(plan.kind))}}));
    const gpu::Texture2D order("order of depth maps", GL_DEPTH_COMPONENT32F, side, side);
    const End near(side, order), far(side, order);
    const GLboolean culled = glIsEnabled(GL_CULL_FACE), tested = glIsEnabled(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    for (int layer = 0; layer < plan.layers(); ++layer) {
        draw.set("u_axis", plan.axisOf(layer)).set("u_side", float(side));
        for (const End* end : {&near, &far}) {
            end->target.bind(side, side);
            const glm::vec4 none(-1e9F, 0, 0, 0), black(0);
            glClearNamedFramebufferfv(end->target.id(), GL_COLOR, 0, &none.x);
            glClearNamedFramebufferfv(end->target.id(), GL_COLOR, 1, &black.x);
            const float begin = end == &near ? 1 : 0;
            glClearNamedFramebufferfv(end->target.id(), GL_DEPTH, 0, &begin);
            glDepthFunc(end == &near ? GL_LESS : GL_GREATER);
            draw.use();
            glBindVertexArray(array.id());
            glDrawElements(GL_TRIANGLES, GLsizei(3 * mesh.faces.size()), GL_UNSIGNED_INT, nullptr);
        }
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
        finish.set("u_layer", layer).set("u_side", side);
        finish.texture("t_near", near.depth).texture("t_far", far.depth);
        finish.texture("t_nearColour", near.colour).texture("t_farColour", far.colour);
        finish.image("i_depths", made.depths_, GL_WRITE_ONLY);
        finish.image("i_colours", *made.colours_, GL_WRITE_ONLY);
        finish.dispatch({side, side, 1});
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                        GL_FRAMEBUFFER_BARRIER_BIT);
    }
    glDepthFunc(GL_LESS);
    (culled ? glEnable : glDisable)(GL_CULL_FACE);
    (tested ? glEnable : glDisable)(GL_DEPTH_TEST);
    glFinish(); // the buffers die here
    if (colours.empty())
        made.colours_.reset();
    return made;
}

DepthLayers DepthMaps::read() const {
    DepthLayers read{depths_.size().x, {}};
    const std::size_t texels = std::size_t(read.side) * std::size_t(read.side);
    std::vector<glm::vec2> all(texels * std::size_t(plan_.layers()));
    depths_.download(GL_RG, GL_FLOAT, all.size() * sizeof(glm::vec2), all.data());
    for (std::size_t layer = 0; layer < std::size_t(plan_.layers()); ++layer)
        read.layers.emplace_back(all.begin() + std::ptrdiff_t(layer * texels),
                                 all.begin() + std::ptrdiff_t((layer + 1) * texels));
    return read;
}

} // namespace serosa::render
