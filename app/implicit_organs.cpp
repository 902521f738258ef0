// See app/implicit_organs.h.
#include "app/implicit_organs.h"

#include "app/vector_image.h"
#include "base/check.h"
#include "gpu/sampled_texture.h"
#include "render/vertex_colours.h"

namespace serosa::app {

namespace {

constexpr int kMargin = 3;        // voxels around the organ
constexpr double kWarpVoxels = 2; // a spacing, of the lattice's displacement
constexpr double kMillimetre = 1e-3;
constexpr double kSeam = 4; // voxels of the field, between mesh and box

} // namespace

Status ImplicitOrgans::add(const sim::Scene& scene, const sim::TriangleMesh& metres,
                           const sim::Lattice& lattice, const sim::TextureLayout& layout, bool moves) {
    if (!scene.deformations.empty() && !deformation_) {
        SEROSA_ASSIGN(SceneDeformation made, SceneDeformation::create(scene));
        deformation_ = std::make_unique<SceneDeformation>(std::move(made));
    }
    if (deformation_) {
        SEROSA_TRY(deformation_->check(organs_.size(), metres));
        if (const auto byVertices = deformation_->firstByVertices(organs_.size()); byVertices && moves)
            return deformation_->errorOf(
                *byVertices, "is by vertices, which move an organ at rest only, and this one can move: "
                             "say by = \"pixels\", or leave out gravity, tools, bodies and its pose");
    }
    proxyCells_ = scene.look.proxyCells;
    stage_ = scene.look.stage;
    if (scene.look.cutVolume && !cutVolume_) {
        const std::string at = scene.file.string() + ":" + std::to_string(scene.look.cutVolume->line) + ": ";
        if (const Status read = readCutVolume(*scene.look.cutVolume); !read.ok())
            return Error{at + read.error().message};
        cutVolumeUnmet_ = at + "look.cut_volume: has no effect: it lies outside of every organ: look at `at` "
                               "and `up_axis`";
    }
    if (cutVolume_ && cutVolume_->meets(metres.lowest(), metres.highest()))
        cutVolumeUnmet_.clear();
    frameTime_ = 1 / scene.frameRate;
    Organ organ;
    organ.grid =
        render::VolumeGrid::around(metres.lowest(), metres.highest(), scene.look.fieldSamples, kMargin);
    SEROSA_ASSIGN(const render::RayField field, makeField(scene.look, metres, organ));
    SEROSA_ASSIGN(render::Raycaster caster, render::Raycaster::create(lattice, field));
    organ.caster = std::make_unique<render::Raycaster>(std::move(caster));
    organ.caster->setCutVolume(cutVolume_.get());
    if (moves) {
        SEROSA_ASSIGN(render::LatticeWarp warp, render::LatticeWarp::create(lattice, layout, kWarpVoxels));
        organ.lattice = std::make_unique<render::LatticeWarp>(std::move(warp));
        organ.caster->setLattice(organ.lattice.get());
    }
    organs_.push_back(std::move(organ));
    return {};
}

Status ImplicitOrgans::readCutVolume(const sim::CutVolume& wanted) {
    SEROSA_ASSIGN(VoxelVolume read, readVoxelVolume(wanted.file));
    glm::dmat4 worldFromPlace(0); // of mm
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 along(0);
        along[axis] = kMillimetre;
        worldFromPlace[axis] = glm::dvec4(sim::worldFromFile(wanted.upAxis, along), 0);
    }
    worldFromPlace[3] = glm::dvec4(wanted.at, 1);
    const render::VoxelValues voxels{read.size, worldFromPlace * read.placeFromVoxel, std::move(read.values)};
    const bool colours = read.components == 3;
    if (colours && (wanted.windowed || !wanted.labels.empty()))
        return Error{wanted.file.string() +
                     ": has colours, three numbers a voxel, on which the level, width and "
                     "labels of look.cut_volume have no effect: remove them"};
    Result<render::CutVolume> made = colours ? render::CutVolume::colours(voxels)
                                     : wanted.labels.empty()
                                         ? render::CutVolume::grey(voxels, wanted.level, wanted.width)
                                         : render::CutVolume::labels(voxels, wanted.labels);
    if (!made.ok())
        return Error{wanted.file.string() + ": " + made.error().message};
    cutVolume_ = std::make_unique<render::CutVolume>(std::move(*made));
    return {};
}

Result<render::RayField> ImplicitOrgans::makeField(const sim::Look& look, const sim::TriangleMesh& metres,
                                                   Organ& organ) {
    const std::vector<glm::u8vec4> colours = render::vertexColours(metres, nullptr);
    if (look.field != sim::Field::distance) {
        const render::DepthPlan plan{look.field == sim::Field::depth ? render::FieldKind::depth
                                                                     : render::FieldKind::depthCube,
                                     int(look.depthAxis)};
        SEROSA_ASSIGN(render::DepthMaps made, render::DepthMaps::create(metres, organ.grid, plan, colours));
        organ.depths = std::make_unique<render::DepthMaps>(std::move(made));
        return organ.depths->field();
    }
    const double band = look.interior == sim::Interior::shell ? look.shell : 0;
    SEROSA_ASSIGN(render::DistanceVolume made,
                  render::DistanceVolume::create(metres, organ.grid, band, colours));
    organ.field = std::make_unique<render::DistanceVolume>(std::move(made));
    return render::RayField::of(*organ.field);
}

Status ImplicitOrgans::open(render::SurfaceRenderer& renderer, const std::vector<OpenedSurface>& surfaces) {
    if (!cutVolumeUnmet_.empty())
        return Error{cutVolumeUnmet_};
    if (!deformation_)
        return {};
    SEROSA_TRY(deformation_->checkMet());
    SEROSA_TRY(deformation_->checkSizes(gpu::Texture3D::mostTexels()));
    SEROSA_TRY(place(0));
    for (std::size_t i = 0; i < organs_.size() && stage_ != sim::Stage::whole; ++i)
        SEROSA_TRY(renderer.openBox(i, surfaceBox(i, 0), *surfaces[i].lattice, *surfaces[i].metres,
                                    *surfaces[i].binding));
    return {};
}

render::StageBox ImplicitOrgans::surfaceBox(std::size_t organ, double time) const {
    return deformation_->stageBox(time,
                                  stage_ == sim::Stage::composite ? kSeam * organs_[organ].grid.step : 0);
}

Status ImplicitOrgans::place(double time) {
    if (!isStale())
        return {};
    placed_ = deformation_->version(); // also where it fails: it is said once
    for (std::size_t i = 0; i < organs_.size(); ++i) {
        SEROSA_ASSIGN(const std::optional<render::Warp> warp, deformation_->at(i, time));
        SEROSA_ASSIGN(const std::optional<render::CoarseWarp> coarse, deformation_->coarseAt(i, time));
        organs_[i].caster->setWarp(warp);
        if (coarse)
            organs_[i].caster->setCoarse(*coarse, proxyCells_);
        organs_[i].caster->setMotion(deformation_->motionAt(i, time, frameTime_));
        if (stage_ != sim::Stage::whole)
            organs_[i].caster->setStage(surfaceBox(i, time));
    }
    return {};
}

Status ImplicitOrgans::moveTo(double time, render::SurfaceRenderer& renderer) {
    if (!isStale())
        return {};
    SEROSA_TRY(place(time));
    for (std::size_t i = 0; i < organs_.size() && stage_ != sim::Stage::whole; ++i)
        renderer.setBox(i, surfaceBox(i, time));
    return {};
}

std::vector<render::Raycaster*> ImplicitOrgans::casters(const std::vector<const sim::StateTextures*>& states,
                                                        const render::SurfaceRenderer& drawn) {
    std::vector<render::Raycaster*> all;
    for (std::size_t i = 0; i < organs_.size(); ++i) {
        if (organs_[i].lattice) {
            const Status updated = organs_[i].lattice->update(*states[i], drawn.cutMask(i), organs_[i].steps);
            SEROSA_CHECK(updated.ok(), "the driver compiles GLSL 4.5: " + updated.error().message);
        }
        all.push_back(organs_[i].caster.get());
    }
    return all;
}

} // namespace serosa::app
