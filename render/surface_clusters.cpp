// See render/surface_clusters.h.
#include "render/surface_clusters.h"

#include "gpu/gl.h"
#include "sim/packed_normal.h"
#include "sim/solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace serosa::render {

namespace {

constexpr double kLeastMean = 0.3; // length of the mean of unit normals that still says where a cluster faces
constexpr double kMargin = 0.35;   // rad: what deformation may add to the lean of a triangle
constexpr std::size_t kCommandWords = 5; // of DrawElementsIndirectCommand

} // namespace

Result<SurfaceClusters> SurfaceClusters::create(const sim::Lattice& lattice, const sim::TextureLayout& layout,
                                                const SurfaceBinding& binding,
                                                const std::vector<glm::dvec3>& positions,
                                                const std::vector<glm::uvec3>& faces) {
    SurfaceClusters made;
    SEROSA_ASSIGN(made.program_, gpu::Program::create(gpu::ShaderLibrary(), {"surface_cull.comp"}));
    const std::vector<std::uint32_t> packed = sim::restState(lattice).normals;
    std::vector<std::uint32_t> texels;
    for (std::size_t begin = 0; begin < faces.size(); begin += kClusterTriangles) {
        const std::size_t end = std::min(begin + kClusterTriangles, faces.size());
        std::set<std::uint32_t> nodes;
        double reach = 0;
        for (std::size_t f = begin; f < end; ++f)
            for (int i = 0; i < 3; ++i) {
                const VertexBinding& vertex = binding.vertices[faces[f][i]];
                reach = std::max(reach, double(glm::length(vertex.offset)));
                nodes.insert({vertex.nodes.x, vertex.nodes.y, vertex.nodes.z});
            }
        glm::dvec3 mean(0); // of the nodes' normals, each step of the lattice's stairs against the next
        for (const std::uint32_t node : nodes) {
            texels.push_back(layout.texelOfNode[node].y << 16 | layout.texelOfNode[node].x);
            mean += glm::dvec3(sim::unpackNormal(packed[node]));
        }
        double lean = glm::length(mean) > kLeastMean * double(nodes.size()) ? 1 : -1; // cosine
        for (std::size_t f = begin; f < end; ++f) {
            const glm::dvec3 cross = glm::cross(positions[faces[f].y] - positions[faces[f].x],
                                                positions[faces[f].z] - positions[faces[f].x]);
            if (const double size = glm::length(cross) * glm::length(mean); size > 0)
                lean = std::min(lean, glm::dot(cross, mean) / size);
        }
        const double most = std::acos(std::clamp(lean, -1.0, 1.0)) + kMargin;
        made.clusters_.push_back({std::uint32_t(3 * begin), std::uint32_t(3 * (end - begin)),
                                  std::uint32_t(texels.size() - nodes.size()), std::uint32_t(nodes.size()),
                                  float(reach), most < 1.5 ? float(-std::sin(most)) : -2.0F});
    }
    made.clusterBuffer_ = gpu::Buffer("surface clusters", std::span<const SurfaceCluster>(made.clusters_));
    made.nodes_ = gpu::Buffer("nodes of surface clusters", std::span<const std::uint32_t>(texels));
    made.commands_ =
        gpu::Buffer("draws of surface clusters", 4 * kCommandWords * made.clusters_.size(), nullptr);
    return made;
}

void SurfaceClusters::cull(const sim::StateTextures& state, const Frame& frame) {
    program_.texture("t_positions", state.positions());
    program_.buffer("b_clusters", clusterBuffer_).buffer("b_nodes", nodes_).buffer("b_draws", commands_);
    program_.set("u_clipFromLattice", frame.clipFromLattice).set("u_eye", frame.eye);
    program_.set("u_clusters", int(clusters_.size()));
    glMemoryBarrier(GL_ALL_BARRIER_BITS); // of whatever wrote the state
    program_.dispatch({int(clusters_.size()), 1, 1});
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

void SurfaceClusters::draw() const {
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.id());
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, GLsizei(clusters_.size()), 0);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
}

std::size_t SurfaceClusters::trianglesLeft() const {
    std::vector<std::uint32_t> words(kCommandWords * clusters_.size());
    commands_.download(0, 4 * words.size(), words.data());
    std::size_t left = 0;
    for (std::size_t i = 0; i < words.size(); i += kCommandWords)
        left += words[i] / 3;
    return left;
}

} // namespace serosa::render
