// The textures of a surface, and what its vertices need for them.
#include "gpu/gl.h"
#include "render/surface_passes.h"

#include <cstddef>

namespace serosa::render {

void SurfacePasses::createTextures(const SurfaceDetail& detail, const sim::Lattice& lattice) {
    const TissueMaps& maps = detail.maps;
    Textures& textures = textures_.emplace();
    textures.albedo =
        gpu::TiledTexture("tissue colour", GL_SRGB8_ALPHA8, maps.width, maps.height, maps.albedo);
    textures.relief = gpu::TiledTexture("tissue relief", GL_RGBA8, maps.width, maps.height, maps.relief);
    textures.albedoScale = 1.0F / glm::max(maps.mean, glm::vec3(1e-3F));
    textures.shift = glm::vec3(glm::fract(lattice.origin / detail.tile));
    textures.tiles = float(lattice.spacing / detail.tile);
    textures.relief_ = float(detail.relief / lattice.spacing);
}

void SurfacePasses::createUvs() {
    if (drawn_.textures.empty())
        return;
    std::vector<TextureVertex> ordered(drawn_.textures.size());
    for (std::size_t i = 0; i < ordered.size(); ++i)
        ordered[newIndex_[i]] = drawn_.textures[i];
    uvs_ = gpu::Buffer("texture coordinates", std::span<const TextureVertex>(ordered));
    attachUvs();
}

void SurfacePasses::attachUvs() {
    for (auto& [stage, geometry] : geometry_) {
        if (stage == SurfaceStage::nodes)
            continue;
        gpu::VertexArray& array = geometry.array;
        array.attribute(9, uvs_, 2, GL_FLOAT, false, sizeof(TextureVertex), offsetof(TextureVertex, uv));
        array.attribute(10, uvs_, 4, GL_FLOAT, false, sizeof(TextureVertex),
                        offsetof(TextureVertex, tangent));
    }
}

} // namespace serosa::render
