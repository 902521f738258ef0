// The surface along cuts: what render/cut_surface.h says of faces and vertices, in the buffers that draw
// them.
#include "gpu/gl.h"
#include "render/surface_passes.h"
#include "shaders/shared_constants.h"

namespace serosa::render {

Status SurfacePasses::openMask(const sim::Lattice& lattice, const sim::TextureLayout& layout) {
    SEROSA_ASSIGN(CutMask mask, CutMask::create(lattice, layout));
    mask_.emplace(std::move(mask));
    anyConstant_ = true; // vertices along cuts ride in the constant basis
    const gpu::ShaderLibrary library;
    SEROSA_ASSIGN(programs_, compile(library));
    depthPrograms_.clear();
    blendDepthPrograms_.clear();
    captures_.clear();
    SEROSA_TRY(createCaptures());
    if (blendStarts_.empty())
        return {};
    blendStarts_.clear();
    blendCaptures_.clear();
    return prepareBlend();
}

void SurfacePasses::show(const CutSurface& cut, const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                         const SurfaceBinding& binding, const std::vector<glm::uvec3>& boundary,
                         const sim::TextureLayout& layout) {
    const std::size_t drawn = drawn_.origin.size();
    std::vector<std::uint32_t> indices;
    for (std::size_t f = 0; f < drawn_.faces.size(); ++f)
        for (int i = 0; i < 3 && cut.whole[f]; ++i)
            indices.push_back(newIndex_[drawn_.faces[f][i]]);
    // A copy for each side, and along seams of the texture for each of its coordinates.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> extras; // of cut.vertices, and the drawn vertex
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    for (std::size_t f = 0; f < cut.copies.size(); ++f)
        for (int i = 0; i < 3; ++i) {
            const std::pair key(cut.copies[f][i], drawn_.faces[cut.copied[f]][i]);
            const auto [found, fresh] = known.try_emplace(key, std::uint32_t(drawn + extras.size()));
            if (fresh)
                extras.push_back(key);
            indices.push_back(found->second);
        }
    if (mask_)
        fillCut(cut, extras, lattice, metres, binding, layout);
    setIndices(indices);
    createNodes(boundary, layout);
}

void SurfacePasses::fillCut(const CutSurface& cut,
                            const std::vector<std::pair<std::uint32_t, std::uint32_t>>& extras,
                            const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                            const SurfaceBinding& binding, const sim::TextureLayout& layout) {
    const bool given = binding.mapping == sim::Mapping::triangle;
    const SurfaceBinding other =
        expressBinding(binding, lattice, metres, given ? sim::Mapping::curvature : sim::Mapping::triangle);
    const SurfaceBinding& constant = given ? binding : other;
    SurfaceBinding corrected = given ? other : binding;
    for (const std::uint32_t v : cut.touched) // eq. 3 along a cut leans into it: not well defined
        corrected.vertices[v] = constant.vertices[v];
    const std::vector<glm::dvec3> normals = metres.vertexNormals();
    const RestBases bases(lattice);
    restBox_ = restBox(lattice, metres);
    const auto fill = [&](SurfaceStage stage, const SurfaceBinding& bound) {
        std::vector<MappedVertex> mapped = inBuffers(mappedVertices(bound, layout, colours_));
        std::vector<RestVertex> rest = inBuffers(restVertices(lattice, restBox_, metres, &bound));
        for (const auto& [copied, drawnVertex] : extras) {
            const CutVertex& copy = cut.vertices[copied];
            const VertexBinding& to = copy.binding ? *copy.binding : bound.vertices[copy.vertex];
            mapped.push_back(mappedVertex(to, layout, colours_[copy.vertex]));
            rest.push_back(restVertex(restBox_, lattice.toLattice(metres.positions[copy.vertex]),
                                      normals[copy.vertex], bases.of(to), copy.side));
        }
        setMapped(stage, mapped);
        setRest(stage, rest);
    };
    fill(SurfaceStage::constant, constant);
    fill(SurfaceStage::corrected, corrected);
    setRest(SurfaceStage::undeformed, inBuffers(restVertices(lattice, restBox_, metres, nullptr)));
    if (!drawn_.textures.empty() && textures_) {
        std::vector<TextureVertex> uvs(drawn_.origin.size());
        for (std::size_t i = 0; i < uvs.size(); ++i)
            uvs[newIndex_[i]] = drawn_.textures[i];
        for (const auto& [copied, drawnVertex] : extras)
            uvs.push_back(drawn_.textures[drawnVertex]);
        uvs_ = gpu::Buffer("texture coordinates", std::span<const TextureVertex>(uvs));
        attachUvs();
    }
    blendStage_.reset(); // its buffer has no copies: what still faded is gone
}

} // namespace serosa::render
