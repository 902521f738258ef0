// Vertex buffers of a surface: one layout a mapping (render/surface_vertices.h), the surface's vertices
// first, then the copies along cuts.
#include "gpu/gl.h"
#include "render/basis_choice.h"
#include "render/surface_passes.h"
#include "render/surface_vertices.h"
#include "shaders/mapping_constants.h"

#include <cstddef>
#include <type_traits>

namespace serosa::render {

namespace {

/// Attributes 3 and 4, which all have.
template <class Vertex, class Base = Vertex>
void commonAttributes(gpu::VertexArray& array, const gpu::Buffer& buffer) {
    array.integerAttribute(3, buffer, 1, GL_UNSIGNED_INT, sizeof(Vertex), offsetof(Base, normal));
    array.attribute(4, buffer, 4, GL_UNSIGNED_BYTE, true, sizeof(Vertex), offsetof(Base, colour));
}

} // namespace

Status SurfacePasses::createMapped(const SurfaceBinding& binding, const sim::TextureLayout& layout) {
    const SurfaceStage stage = stageOf(binding.mapping);
    Geometry& geometry = geometry_[stage];
    geometry.array = gpu::VertexArray("mapped surface");
    std::vector<glm::u8vec4> colours = colours_;
    for (const Copy& copy : copies_)
        colours.push_back(colours_[copy.vertex]);
    const auto upload = [&](const auto& vertices) {
        using Vertex = typename std::decay_t<decltype(vertices)>::value_type;
        const std::vector<Vertex> ordered = inBuffers(vertices);
        geometry.vertices = gpu::Buffer("mapped surface", std::span<const Vertex>(ordered));
        using Base = std::conditional_t<std::is_same_v<Vertex, ChosenVertex>, MappedVertex, Vertex>;
        commonAttributes<Vertex, Base>(geometry.array, geometry.vertices);
    };
    if (stage == SurfaceStage::inCells) {
        upload(cellVertices(binding, colours));
        constexpr int kStride = sizeof(CellVertex);
        geometry.array.integerAttribute(0, geometry.vertices, 1, GL_UNSIGNED_INT, kStride,
                                        offsetof(CellVertex, cell));
        geometry.array.attribute(2, geometry.vertices, 3, GL_FLOAT, false, kStride, offsetof(CellVertex, at));
        const std::vector<glm::uvec4> texels = cellTexels(binding.cells, layout);
        cells_ = gpu::Texture2D("cells", GL_RGBA32UI, SRS_TABLE_WIDTH, int(texels.size() / SRS_TABLE_WIDTH));
        cells_.upload(texels.data());
    } else if (stage == SurfaceStage::alongNormal) {
        upload(normalVertices(binding, layout, colours));
        constexpr int kStride = sizeof(NormalVertex);
        geometry.array.integerAttribute(0, geometry.vertices, 3, GL_UNSIGNED_INT, kStride,
                                        offsetof(NormalVertex, texels));
        geometry.array.attribute(1, geometry.vertices, 2, GL_FLOAT, false, kStride,
                                 offsetof(NormalVertex, weights));
        geometry.array.attribute(2, geometry.vertices, 1, GL_FLOAT, false, kStride,
                                 offsetof(NormalVertex, distance));
    } else {
        const bool chosen = stage == SurfaceStage::chosen;
        const int stride = chosen ? sizeof(ChosenVertex) : sizeof(MappedVertex);
        if (chosen)
            upload(chosenVertices(binding, layout, colours));
        else
            upload(mappedVertices(binding, layout, colours));
        geometry.array.integerAttribute(0, geometry.vertices, 3, GL_UNSIGNED_INT, stride,
                                        offsetof(MappedVertex, texels));
        geometry.array.attribute(1, geometry.vertices, 2, GL_UNSIGNED_SHORT, true, stride,
                                 offsetof(MappedVertex, weights));
        geometry.array.attribute(2, geometry.vertices, 3, GL_FLOAT, false, stride,
                                 offsetof(MappedVertex, offset));
        if (chosen)
            geometry.array.attribute(11, geometry.vertices, 4, GL_UNSIGNED_BYTE, true, stride,
                                     sizeof(MappedVertex));
    }
    if (stage == SurfaceStage::nodeFrames && frames_) {
        frames_->update(binding.frames, layout);
    } else if (stage == SurfaceStage::nodeFrames) {
        SEROSA_ASSIGN(FramePass pass, FramePass::create(binding.frames, layout));
        frames_.emplace(std::move(pass));
    }
    return {};
}

void SurfacePasses::createStatic(const sim::Lattice& lattice, const sim::TriangleMesh& metres) {
    const std::vector<StaticVertex> still = inBuffers(staticVertices(lattice, metres, colours_));
    Geometry& geometry = geometry_[SurfaceStage::undeformed];
    geometry.vertices = gpu::Buffer("undeformed surface", std::span<const StaticVertex>(still));
    geometry.array = gpu::VertexArray("undeformed surface");
    geometry.array.attribute(2, geometry.vertices, 3, GL_FLOAT, false, sizeof(StaticVertex),
                             offsetof(StaticVertex, position));
    commonAttributes<StaticVertex>(geometry.array, geometry.vertices);
    if (textures_)
        createStaticRest(lattice, metres);
}

void SurfacePasses::setRest(SurfaceStage stage, const std::vector<RestVertex>& vertices) {
    Geometry& geometry = geometry_.at(stage);
    const std::vector<RestVertex> ordered = inBuffers(vertices);
    geometry.rest = gpu::Buffer("surface at rest", std::span<const RestVertex>(ordered));
    geometry.array.attribute(7, geometry.rest, 4, GL_UNSIGNED_SHORT, true, sizeof(RestVertex),
                             offsetof(RestVertex, position));
    geometry.array.integerAttribute(8, geometry.rest, 2, GL_UNSIGNED_INT, sizeof(RestVertex),
                                    offsetof(RestVertex, normal));
}

void SurfacePasses::createRest(const SurfaceBinding& binding, const sim::Lattice& lattice,
                               const sim::TriangleMesh& metres, const RestNormals& rest) {
    const std::vector<glm::dvec3> normals = metres.vertexNormals();
    std::vector<RestVertex> vertices;
    vertices.reserve(binding.vertices.size());
    for (std::size_t i = 0; i < binding.vertices.size(); ++i) {
        const Copy* const copy = i < meshVertices_ ? nullptr : &copies_[i - meshVertices_];
        const std::size_t v = copy ? copy->vertex : i;
        vertices.push_back(restVertex(restBox_, lattice.toLattice(metres.positions[v]), normals[v],
                                      restAxes(binding, i, lattice, rest), copy ? copy->side : 0,
                                      copy ? copyAway_[i - meshVertices_] : 0));
    }
    setRest(stageOf(binding.mapping), vertices);
}

void SurfacePasses::createStaticRest(const sim::Lattice& lattice, const sim::TriangleMesh& metres) {
    const std::vector<glm::dvec3> normals = metres.vertexNormals();
    const TriangleBasis still{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::vector<RestVertex> vertices;
    for (std::size_t v = 0; v < normals.size(); ++v)
        vertices.push_back(restVertex(restBox_, lattice.toLattice(metres.positions[v]), normals[v], still));
    setRest(SurfaceStage::undeformed, vertices);
}

} // namespace serosa::render
