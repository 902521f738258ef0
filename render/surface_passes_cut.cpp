// The surface along cuts: what render/cut_surface.h says of faces and vertices, in the buffers that draw
// them.
#include "gpu/gl.h"
#include "render/basis_choice.h"
#include "render/surface_passes.h"
#include "shaders/mapping_constants.h"
#include "shaders/shared_constants.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace serosa::render {

Status SurfacePasses::openMask(const sim::Lattice& lattice, const sim::TextureLayout& layout) {
    SEROSA_ASSIGN(CutMask mask, CutMask::create(lattice, layout));
    mask_.emplace(std::move(mask));
    SEROSA_ASSIGN(SideNodes nodes, SideNodes::create(lattice, layout));
    sideNodes_.emplace(std::move(nodes));
    setCarried(std::vector<std::uint32_t>(vertexCount()), {}, {}, layout);
    anyConstant_ = true; // vertices of cut nodes ride in the constant basis
    return recompile();
}

Status SurfacePasses::openBox(const StageBox& box, const sim::Lattice& lattice,
                              const sim::TriangleMesh& metres, const std::vector<SurfaceBinding>& bindings) {
    const bool had = usesRest();
    box_ = box;
    origin_ = lattice.toWorld(glm::dvec3(0));
    unit_ = lattice.spacing;
    if (!had) {
        const RestNormals rest(lattice);
        for (const SurfaceBinding& one : bindings)
            createRest(one, lattice, metres, rest);
        createStaticRest(lattice, metres);
    }
    return recompile();
}

Status SurfacePasses::show(const CutSurface& cut, const sim::Lattice& lattice,
                           const sim::TriangleMesh& metres, const std::vector<SurfaceBinding>& bindings,
                           const std::vector<glm::uvec3>& boundary, const sim::TextureLayout& layout,
                           const std::vector<std::uint32_t>& connections) {
    const std::size_t drawn = drawn_.origin.size();
    std::vector<std::uint32_t> indices;
    for (std::size_t f = 0; f < drawn_.faces.size(); ++f)
        for (int i = 0; i < 3 && cut.whole[f]; ++i)
            indices.push_back(newIndex_[drawn_.faces[f][i]]);
    // A copy for each side, and along seams of the texture for each of its coordinates.
    copies_.clear();
    copyAway_.clear();
    std::vector<VertexCopy> copied;
    std::vector<float> shares;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    for (std::size_t f = 0; f < cut.copies.size(); ++f)
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t copy = cut.copies[f][i], of = drawn_.faces[cut.copied[f]][i];
            const auto [found, fresh] = known.try_emplace({copy, of}, std::uint32_t(drawn + copies_.size()));
            if (fresh) {
                const CutVertex& vertex = cut.vertices[copy];
                copies_.push_back({vertex.vertex, vertex.side, of,
                                   vertex.follows ? std::int64_t(vertex.follows->triangle) : -1});
                copyAway_.push_back(vertex.away);
                copied.push_back({vertex.vertex, vertex.follows});
                shares.push_back(vertex.share);
            }
            indices.push_back(found->second);
        }
    blendStage_.reset();
    bool anyConstant = anyConstant_;
    std::optional<RestNormals> rest;
    if (usesRest())
        rest.emplace(lattice);
    for (const SurfaceBinding& binding : bindings) {
        const SurfaceBinding all = withCopies(binding, copied, lattice, metres, connections);
        SEROSA_TRY(createMapped(all, layout));
        if (rest)
            createRest(all, lattice, metres, *rest);
        anyConstant =
            anyConstant || (binding.mapping == sim::Mapping::curvature && binding.constantVertices > 0);
    }
    if (mask_)
        createCarried(cut, shares, lattice, metres, layout);
    if (mask_ && !geometry_.at(SurfaceStage::undeformed).rest)
        createStaticRest(lattice, metres);
    if (!drawn_.textures.empty() && textures_) {
        std::vector<TextureVertex> uvs(drawn);
        for (std::size_t i = 0; i < drawn; ++i)
            uvs[newIndex_[i]] = drawn_.textures[i];
        for (const Copy& copy : copies_)
            uvs.push_back(drawn_.textures[copy.drawn]);
        uvs_ = gpu::Buffer("texture coordinates", std::span<const TextureVertex>(uvs));
        attachUvs();
    }
    setIndices(indices);
    createNodes(boundary, layout);
    if (!std::exchange(anyConstant_, anyConstant) && anyConstant) // the first to need it
        return recompile();
    return {};
}

void SurfacePasses::createCarried(const CutSurface& cut, const std::vector<float>& copyShares,
                                  const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                  const sim::TextureLayout& layout) {
    std::vector<std::uint32_t> carriedOf(vertexCount());
    std::vector<glm::dvec3> places;
    std::vector<float> shares;
    const auto add = [&](std::size_t vertex, float share, std::uint32_t& at) {
        if (share <= 0)
            return;
        places.push_back(lattice.toLattice(metres.positions[vertex]));
        shares.push_back(share);
        at = std::uint32_t(places.size());
    };
    const std::size_t drawn = newIndex_.size();
    for (std::size_t i = 0; i < drawn && !cut.shares.empty(); ++i)
        add(drawn_.origin[i], cut.shares[drawn_.origin[i]], carriedOf[newIndex_[i]]);
    for (std::size_t i = 0; i < copies_.size(); ++i)
        add(copies_[i].vertex, copyShares[i], carriedOf[drawn + i]);
    setCarried(carriedOf, bindToCells(lattice, places), shares, layout);
}

void SurfacePasses::setCarried(const std::vector<std::uint32_t>& of, const CellBinding& cells,
                               const std::vector<float>& shares, const sim::TextureLayout& layout) {
    const std::vector<glm::uvec4> texels = carriedTexels(cells, shares, layout);
    carried_ = gpu::Texture2D("vertices in cells", GL_RGBA32UI, SRS_TABLE_WIDTH,
                              int(texels.size() / SRS_TABLE_WIDTH));
    carried_.upload(texels.data());
    carriedOf_ = gpu::Buffer("which vertices ride in cells", std::span<const std::uint32_t>(of));
    for (const SurfaceStage stage : mappedStages())
        geometry_.at(stage).array.integerAttribute(12, carriedOf_, 1, GL_UNSIGNED_INT, sizeof(std::uint32_t),
                                                   0);
}

gpu::Buffer SurfacePasses::shownAfter(const gpu::Buffer& shown, const std::vector<Copy>& copiesBefore) const {
    struct Item {
        float values[6]; // position, normal
    };
    const std::size_t drawn = newIndex_.size();
    std::vector<Item> before(drawn + copiesBefore.size()), after;
    shown.download(0, before.size() * sizeof(Item), before.data());
    std::map<Copy, std::size_t> places;
    for (std::size_t i = 0; i < copiesBefore.size(); ++i)
        places.emplace(copiesBefore[i], drawn + i);
    after.assign(before.begin(), before.begin() + std::ptrdiff_t(drawn));
    for (const Copy& copy : copies_) {
        const auto found = places.find(copy);
        after.push_back(before[found != places.end() ? found->second : newIndex_[copy.drawn]]);
    }
    return gpu::Buffer("shown before a cut", std::span<const Item>(after));
}

} // namespace serosa::render
