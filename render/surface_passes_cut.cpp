// The surface along cuts: what render/cut_surface.h says of faces and vertices, in the buffers that draw
// them.
#include "gpu/gl.h"
#include "render/basis_choice.h"
#include "render/surface_passes.h"
#include "shaders/shared_constants.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace serosa::render {

Status SurfacePasses::openMask(const sim::Lattice& lattice, const sim::TextureLayout& layout) {
    SEROSA_ASSIGN(CutMask mask, CutMask::create(lattice, layout));
    mask_.emplace(std::move(mask));
    const std::vector<SurfaceStage> stages = mappedStages();
    if (std::any_of(stages.begin(), stages.end(), readsSideNodes)) {
        SEROSA_ASSIGN(SideNodes nodes, SideNodes::create(lattice, layout));
        sideNodes_.emplace(std::move(nodes));
    }
    anyConstant_ = true; // vertices along cuts ride in the constant basis
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
                           const std::vector<glm::uvec3>& boundary, const sim::TextureLayout& layout) {
    const std::size_t drawn = drawn_.origin.size();
    std::vector<std::uint32_t> indices;
    for (std::size_t f = 0; f < drawn_.faces.size(); ++f)
        for (int i = 0; i < 3 && cut.whole[f]; ++i)
            indices.push_back(newIndex_[drawn_.faces[f][i]]);
    // A copy for each side, and along seams of the texture for each of its coordinates.
    copies_.clear();
    copyAway_.clear();
    std::vector<VertexCopy> bound;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    for (std::size_t f = 0; f < cut.copies.size(); ++f)
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t copied = cut.copies[f][i], of = drawn_.faces[cut.copied[f]][i];
            const auto [found, fresh] =
                known.try_emplace({copied, of}, std::uint32_t(drawn + copies_.size()));
            if (fresh) {
                const CutVertex& vertex = cut.vertices[copied];
                copies_.push_back({vertex.vertex, vertex.side, of});
                copyAway_.push_back(vertex.away);
                bound.push_back({vertex.vertex, vertex.binding});
            }
            indices.push_back(found->second);
        }
    blendStage_.reset();
    bool anyConstant = anyConstant_;
    std::optional<RestNormals> rest;
    if (usesRest())
        rest.emplace(lattice);
    for (const SurfaceBinding& binding : bindings) {
        const SurfaceBinding all = withCopies(binding, bound, lattice);
        SEROSA_TRY(createMapped(all, layout));
        if (rest)
            createRest(all, lattice, metres, *rest);
        anyConstant =
            anyConstant || (binding.mapping == sim::Mapping::curvature && binding.constantVertices > 0);
    }
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
