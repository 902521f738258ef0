// Which triangles of the surface are drawn: by how large the organ is in the picture, and by what can be
// seen.
#include "gpu/gl.h"
#include "render/surface_lods.h"
#include "render/surface_passes.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <map>

namespace serosa::render {

namespace {

/// Triangles that lie together one after another, each cluster in the order that suits the vertex cache.
std::vector<std::uint32_t> inClusters(const std::vector<std::uint32_t>& indices,
                                      const std::vector<glm::vec3>& positions) {
    std::vector<std::uint32_t> sorted(indices.size());
    meshopt_spatialSortTriangles(sorted.data(), indices.data(), indices.size(), &positions[0].x,
                                 positions.size(), sizeof(glm::vec3));
    std::vector<std::uint32_t> run, ordered;
    for (std::size_t begin = 0; begin < sorted.size(); begin += 3 * kClusterTriangles) {
        const std::size_t end = std::min(begin + 3 * kClusterTriangles, sorted.size());
        std::map<std::uint32_t, std::uint32_t>
            local; // the optimizer counts all vertices: a cluster's own only
        std::vector<std::uint32_t> global;
        run.clear();
        for (std::size_t i = begin; i < end; ++i) {
            const auto [found, fresh] = local.try_emplace(sorted[i], std::uint32_t(global.size()));
            if (fresh)
                global.push_back(sorted[i]);
            run.push_back(found->second);
        }
        ordered.resize(run.size());
        meshopt_optimizeVertexCache(ordered.data(), run.data(), run.size(), global.size());
        for (std::size_t i = begin; i < end; ++i)
            sorted[i] = global[ordered[i - begin]];
    }
    return sorted;
}

} // namespace

void SurfacePasses::createLevels(const sim::Lattice& lattice, const sim::TriangleMesh& metres) {
    std::vector<glm::dvec3> positions;
    for (const std::uint32_t v : drawn_.origin)
        positions.push_back(metres.positions[v]);
    for (const SurfaceLod& lod : surfaceLods(positions, drawn_.faces)) {
        std::vector<std::uint32_t> fewer, ordered(3 * lod.faces.size());
        for (const glm::uvec3& face : lod.faces)
            for (int i = 0; i < 3; ++i)
                fewer.push_back(newIndex_[face[i]]);
        meshopt_optimizeVertexCache(ordered.data(), fewer.data(), fewer.size(), newIndex_.size());
        levels_.push_back({gpu::Buffer("surface indices", std::span<const std::uint32_t>(ordered)),
                           int(ordered.size()),
                           lod.error / lattice.spacing,
                           {},
                           {}});
    }
}

Status SurfacePasses::prepareSkipping(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                      const SurfaceBinding& binding, const sim::TextureLayout& layout) {
    std::vector<std::uint32_t> meshVertex(newIndex_.size());
    std::vector<glm::vec3> bufferPositions(newIndex_.size());
    for (std::size_t i = 0; i < newIndex_.size(); ++i) {
        meshVertex[newIndex_[i]] = drawn_.origin[i];
        bufferPositions[newIndex_[i]] = glm::vec3(lattice.toLattice(metres.positions[drawn_.origin[i]]));
    }
    for (Level& level : levels_) {
        std::vector<std::uint32_t> own(std::size_t(level.count));
        level.indices.download(0, own.size() * sizeof own[0], own.data());
        own = inClusters(own, bufferPositions);
        level.clusterIndices = gpu::Buffer("surface indices", std::span<const std::uint32_t>(own));
        std::vector<glm::uvec3> faces;
        for (std::size_t i = 0; i < own.size(); i += 3)
            faces.emplace_back(meshVertex[own[i]], meshVertex[own[i + 1]], meshVertex[own[i + 2]]);
        SEROSA_ASSIGN(SurfaceClusters clusters,
                      SurfaceClusters::create(lattice, layout, binding, metres.positions, faces));
        level.clusters.emplace(std::move(clusters));
    }
    return {};
}

/// The coarsest that is off by no more than the frame allows, where the organ is nearest to the eye.
std::size_t SurfacePasses::levelFor(const Frame& frame) const {
    const glm::mat4& m = frame.clipFromLattice;
    const glm::vec3 across(m[0][1], m[1][1], m[2][1]), deep(m[0][3], m[1][3], m[2][3]);
    const float middle = glm::dot(deep, bounds_.from + 0.5F * bounds_.extent) + m[3][3];
    const float nearest = middle - glm::length(deep) * 0.5F * glm::length(bounds_.extent);
    std::size_t level = 0;
    for (std::size_t i = 1; i < levels_.size() && nearest > 0; ++i) {
        const double pixels = levels_[i].error * 0.5 * double(frame.size.y * glm::length(across) / nearest);
        if (pixels <= double(frame.mostError))
            level = i;
    }
    return level;
}

void SurfacePasses::drawClusters(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage,
                                 std::size_t level, const gpu::Program& program) {
    Level& drawn = levels_[level];
    drawn.clusters->cull(state, frame);
    program.use();
    gpu::VertexArray& array = geometry_.at(stage).array;
    array.indices(drawn.clusterIndices);
    glBindVertexArray(array.id());
    drawn.clusters->draw();
    lastCulled_ = level;
}

std::size_t SurfacePasses::trianglesDrawn() const {
    return lastCulled_ ? levels_[*lastCulled_].clusters->trianglesLeft()
                       : std::size_t(levels_[lastLevel_].count) / 3;
}

} // namespace serosa::render
