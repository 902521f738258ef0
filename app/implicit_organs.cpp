// See app/implicit_organs.h.
#include "app/implicit_organs.h"

#include "base/check.h"

namespace serosa::app {

namespace {

constexpr int kMargin = 3;        // voxels around the organ
constexpr double kWarpVoxels = 2; // a spacing, of the lattice's displacement

render::DeformationMap mapOf(const sim::Deformation& deformation) {
    render::DeformationMap map;
    map.kind = deformation.kind;
    map.half = 0.5 * deformation.size;
    map.amount = deformation.amount;
    map.radius = deformation.radius;
    map.extent = deformation.extent;
    map.depth = deformation.depth;
    map.width = deformation.width;
    map.profile = deformation.narrow ? render::PullProfile::narrow : render::PullProfile::gaussian;
    return map;
}

render::TextureMapping mappingOf(const sim::Deformation& deformation) {
    render::TextureMapping mapping;
    const glm::dvec3 across = glm::cross(deformation.along, deformation.up);
    mapping.objectFromLocal = {glm::dvec4(deformation.along, 0), glm::dvec4(deformation.up, 0),
                               glm::dvec4(across, 0), glm::dvec4(deformation.at, 1)};
    mapping.cylinderRadius = deformation.wound;
    return mapping;
}

} // namespace

Result<render::DeformationTexture> ImplicitOrgans::deformationTexture(const sim::Scene& scene) {
    const sim::Deformation& deformation = *scene.deformation;
    Result<render::DeformationTexture> made =
        render::DeformationTexture::bake(mapOf(deformation), deformation.texels, render::TexelFormat::half);
    if (!made.ok())
        return Error{scene.file.string() + ":" + std::to_string(deformation.line) +
                     ": deformation: " + made.error().message};
    return made;
}

Status ImplicitOrgans::add(const sim::Scene& scene, const sim::TriangleMesh& metres,
                           const sim::Lattice& lattice, const sim::TextureLayout& layout, bool moves) {
    if (scene.deformation && !deformation_) {
        SEROSA_ASSIGN(render::DeformationTexture texture, deformationTexture(scene));
        deformation_ = std::make_unique<render::DeformationTexture>(std::move(texture));
    }
    Organ organ;
    const render::VolumeGrid grid =
        render::VolumeGrid::around(metres.lowest(), metres.highest(), scene.look.fieldSamples, kMargin);
    const double band = scene.look.interior == sim::Interior::shell ? scene.look.shell : 0;
    SEROSA_ASSIGN(render::DistanceVolume field, render::DistanceVolume::create(metres, grid, band));
    organ.field = std::make_unique<render::DistanceVolume>(std::move(field));
    SEROSA_ASSIGN(render::Raycaster caster, render::Raycaster::create(lattice, *organ.field));
    organ.caster = std::make_unique<render::Raycaster>(std::move(caster));
    if (moves) {
        SEROSA_ASSIGN(render::LatticeWarp warp, render::LatticeWarp::create(lattice, layout, kWarpVoxels));
        organ.lattice = std::make_unique<render::LatticeWarp>(std::move(warp));
        organ.caster->setLattice(organ.lattice.get());
    }
    if (deformation_)
        organ.caster->setWarp(render::Warp{deformation_.get(), mappingOf(*scene.deformation)});
    organs_.push_back(std::move(organ));
    return {};
}

std::vector<render::Raycaster*> ImplicitOrgans::casters(const std::vector<const sim::StateTextures*>& states,
                                                        const render::SurfaceRenderer& drawn) {
    std::vector<render::Raycaster*> all;
    for (std::size_t i = 0; i < organs_.size(); ++i) {
        if (organs_[i].lattice) {
            const Status updated = organs_[i].lattice->update(*states[i], drawn.cutMask(i));
            SEROSA_CHECK(updated.ok(), "the driver compiles GLSL 4.5");
        }
        all.push_back(organs_[i].caster.get());
    }
    return all;
}

} // namespace serosa::app
