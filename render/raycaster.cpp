// See render/raycaster.h.
#include "render/raycaster.h"

#include "base/check.h"
#include "render/raycast_skip.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <string>

namespace serosa::render {

namespace {

constexpr double kBehind = 1;       // voxels of the field, where the surface itself is drawn, too
constexpr double kCoarse = 0.5;     // of a pixel: CS07 section 6.3
constexpr double kThreshold = 0.04; // of an organ's longest side: CS07 figure 3

GLenum glFormat(TexelFormat format) {
    return format == TexelFormat::unorm8 ? GL_RGBA8 : format == TexelFormat::half ? GL_RGBA16F : GL_RGBA32F;
}

GLenum glType(TexelFormat format) {
    return format == TexelFormat::unorm8 ? GL_UNSIGNED_BYTE
           : format == TexelFormat::half ? GL_HALF_FLOAT
                                         : GL_FLOAT;
}

} // namespace

RaycastLook raycastLook(const sim::Look& look) {
    RaycastLook made;
    made.solid = look.interior == sim::Interior::hollow     ? Solid::hollow
                 : look.interior == sim::Interior::solid    ? Solid::solid
                 : look.interior == sim::Interior::combined ? Solid::combined
                                                            : Solid::shell;
    made.normals = look.normals == sim::RayNormals::warped ? Normals::warped : Normals::gradient;
    made.antialias = look.antialias;
    made.search = look.search == sim::RaySearch::linear      ? Search::linear
                  : look.search == sim::RaySearch::threshold ? Search::threshold
                                                             : Search::jacobian;
    made.step = look.searchStep;
    made.coarse = look.coarseSampling ? kCoarse : 0;
    made.threshold = kThreshold * look.fieldSamples;
    made.skipField = made.skipCut = look.skipEmpty;
    made.thickness = look.shell;
    made.closes = look.show == sim::Show::both;
    return made;
}

Result<Raycaster> Raycaster::create(const sim::Lattice& lattice, const RayField& field) {
    Raycaster made;
    made.field_ = field;
    made.origin_ = lattice.toWorld(glm::dvec3(0));
    made.unit_ = lattice.spacing;
    made.empty_ = gpu::VertexArray("deformation shader");
    made.none_ = gpu::Texture2D("no map", GL_R8, 1, 1);
    made.setWarp(std::nullopt);
    return made;
}

void Raycaster::setWarp(const std::optional<Warp>& warp) {
    const VolumeGrid& grid = field_.grid;
    // A voxel more: what a box cuts off is seen to begin.
    lowest_ = glm::max(grid.lowest, field_.blocks.bounds().lowest - grid.step);
    highest_ = glm::min(grid.highest(), field_.blocks.bounds().highest + grid.step);
    mapping_.reset();
    masked_ = false;
    beforeFromNow_ = glm::dmat4(1);
    coarse_.reset();
    if (!warp)
        return;
    const DeformationTexture& texture = *warp->texture;
    mapping_ = warp->mapping;
    masked_ = texture.cuts();
    const bool bytes = texture.format() == TexelFormat::unorm8;
    scale_ = texture.scale() * (bytes ? 255.0 / 127 : 1);
    bias_ = bytes ? 128.0 / 255 : 0;
    half_ = glm::vec3(texture.half());
    upload(texture);
    const Bounds shown = shownBounds_.of(*warp, field_.blocks);
    lowest_ = shown.lowest - grid.step;
    highest_ = shown.highest + grid.step;
}

void Raycaster::setCoarse(const CoarseWarp& coarse, int cells) {
    SEROSA_CHECK(!lattice_ && !stage_, "the vertex stage moves what is at rest and drawn whole");
    coarse_ = coarse;
    if (!proxy_.is(lowest_, highest_, cells))
        proxy_ = RayProxy(lowest_, highest_, cells);
    lowest_ = glm::dvec3(std::numeric_limits<double>::infinity());
    highest_ = -lowest_;
    for (const glm::dvec3& corner : proxy_.corners()) {
        const glm::dvec3 moved = coarse.forward(corner);
        lowest_ = glm::min(lowest_, moved);
        highest_ = glm::max(highest_, moved);
    }
}

void Raycaster::setStage(const std::optional<StageBox>& stage) {
    stage_ = stage;
    if (!stage)
        return;
    const Bounds box = stage->mapping.boundsOf(stage->half);
    lowest_ = glm::max(lowest_, box.lowest - field_.grid.step);
    highest_ = glm::min(highest_, box.highest + field_.grid.step);
}

void Raycaster::upload(const DeformationTexture& texture) {
    // A picture may move the box: what belongs to the texture alone is kept.
    if (texture.shared() == uploaded_ && mapping_->cylinderRadius == woundAround_)
        return;
    uploaded_ = texture.shared();
    woundAround_ = mapping_->cylinderRadius;
    displacement_ = gpu::Texture3D("displacement", glFormat(texture.format()), texture.size());
    displacement_.upload(GL_RGBA, glType(texture.format()), texture.stored().data());
    shownBounds_ = ShownBounds(texture);
    const RaycastSkip skip = RaycastSkip::of(texture, woundAround_);
    skipTexture_ = gpu::Texture3D("ways to go on", GL_RGBA16F, texture.size());
    skipTexture_.upload(GL_RGB, GL_FLOAT, skip.texels.data());
    skipNear_ = skip.nearReach;
    skipReach_ = skip.reach;
    maskSlope_ = skip.maskSlope;
}

Result<gpu::Program*> Raycaster::program(const Variant& variant) {
    const auto found = programs_.find(variant);
    if (found != programs_.end())
        return &found->second;
    std::vector<gpu::ShaderDefine> defines = {{"RAYCAST_SOLID", std::to_string(int(variant.solid))},
                                              {"RAYCAST_SEARCH", std::to_string(int(variant.search))},
                                              {"RAYCAST_FIELD", std::to_string(int(variant.field))}};
    if (variant.skip)
        defines.push_back({"RAYCAST_SKIP", std::to_string(variant.skip)});
    if (variant.lattice)
        defines.push_back({"RAYCAST_LATTICE", "1"});
    if (variant.cut)
        defines.push_back({"RAYCAST_CUT", "1"});
    if (variant.warped)
        defines.push_back({"RAYCAST_WARP", "1"});
    if (variant.staged)
        defines.push_back({"RAYCAST_STAGE", "1"});
    if (variant.coloured)
        defines.push_back({"RAYCAST_COLOURED", "1"});
    if (variant.masked)
        defines.push_back({"RAYCAST_MASKED", "1"});
    if (variant.wound)
        defines.push_back({"RAYCAST_WOUND", "1"});
    if (variant.within)
        defines.push_back({"RAYCAST_WITHIN", "1"});
    if (variant.normals == Normals::gradient)
        defines.push_back({"RAYCAST_GRADIENT", "1"});
    if (variant.volume)
        defines.push_back({"RAYCAST_VOLUME", std::to_string(variant.volume)});
    if (variant.samples)
        defines.push_back({"RAYCAST_SAMPLES", "1"});
    if (variant.coarse)
        defines.push_back({"RAYCAST_COARSE", "1"});
    if (variant.proxy)
        defines.push_back({"RAYCAST_PROXY", "1"});
    if (variant.probe)
        defines.push_back({"RAYCAST_PROBE", "1"});
    const std::vector<std::string> stages =
        variant.proxy ? std::vector<std::string>{"raycast_proxy.vert", "raycast_proxy.geom", "raycast.frag"}
                      : std::vector<std::string>{"raycast.vert", "raycast.frag"};
    SEROSA_ASSIGN(gpu::Program made, gpu::Program::create(gpu::ShaderLibrary(), stages, defines));
    return &programs_.emplace(variant, std::move(made)).first->second;
}

bool Raycaster::isWithin() const {
    if (!mapping_ || mapping_->cylinderRadius > 0 || lattice_ || coarse_)
        return false;
    const glm::dmat4 localFromObject = glm::inverse(mapping_->objectFromLocal);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at = glm::mix(lowest_, highest_, glm::dvec3(sim::cornerOffset(corner)));
        if (glm::any(glm::greaterThan(glm::abs(glm::dvec3(localFromObject * glm::dvec4(at, 1))),
                                      glm::dvec3(half_))))
            return false;
    }
    return true;
}

bool Raycaster::mayBeCoarse(const RaycastLook& look, const glm::vec4& pixel) const {
    if (lattice_ || beforeFromNow_ != glm::dmat4(1))
        return true;
    double widest = 0; // linear in the place: in a corner
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at = glm::mix(lowest_, highest_, glm::dvec3(sim::cornerOffset(corner)));
        widest = std::max(widest, double(glm::dot(pixel, glm::vec4((at - origin_) / unit_, 1))));
    }
    return look.coarse * widest > look.step * field_.grid.step / unit_;
}

Status Raycaster::drawBox(const Frame& frame, const RaycastLook& look, bool probe) {
    const bool wound = mapping_ && mapping_->cylinderRadius > 0;
    const bool skipField = look.skipField && field_.kind == FieldKind::distance; // depths are no distances
    glm::dmat4 objectFromWorld(1 / unit_);
    objectFromWorld[3] = glm::dvec4(-origin_ / unit_, 1);
    const glm::mat4 rows = glm::transpose(frame.clipFromLattice);
    const glm::vec4 pixel =
        2 / (frame.size.y * glm::length(glm::vec3(rows[1]))) * rows[3]; // its width at a place
    const bool coarse = look.coarse > 0 && mayBeCoarse(look, pixel);
    const int volume = cutVolume_ && !probe ? cutVolume_->kind() : 0;
    SEROSA_ASSIGN(gpu::Program* const made,
                  program({look.solid, look.search, look.normals, field_.kind,
                           int(skipField) + 2 * int(look.skipCut && masked_), volume, lattice_ != nullptr,
                           lattice_ && lattice_->isCut(), mapping_.has_value(), masked_, wound, isWithin(),
                           stage_.has_value(), field_.colours != nullptr && !probe, look.antialias && !probe,
                           coarse, coarse_.has_value(), probe}));
    gpu::Program& program = *made;
    const VolumeGrid& grid = field_.grid;
    const auto toObject = [this](const glm::dvec3& world) { return (world - origin_) / unit_; };
    program.set("u_clipFromLattice", frame.clipFromLattice);
    if (lattice_)
        lattice_->bind(program);
    else
        program.set("u_boxLowest", glm::vec3(toObject(lowest_)))
            .set("u_boxHighest", glm::vec3(toObject(highest_)));
    program.set("u_boxSize", float(glm::distance(lowest_, highest_) / unit_));
    const double voxel = grid.step / unit_;
    program.set("u_fieldLowest", glm::vec3(toObject(grid.lowest))).set("u_fieldStep", float(voxel));
    if (field_.kind == FieldKind::distance)
        program.texture("t_field", *field_.values);
    else
        program.texture("t_depths", *field_.values).set("u_gridMost", glm::vec3(grid.size - 1));
    if (field_.kind == FieldKind::depth)
        program.set("u_depthAxis", field_.axis);
    program.set("u_step", float(look.step * voxel)).set("u_threshold", float(look.threshold * voxel));
    program.set("u_thickness", float(look.thickness / unit_));
    program.set("u_behind", float(look.closes ? kBehind * voxel : 0));
    if (coarse || coarse_)
        program.set("u_pixel", pixel);
    if (coarse)
        program.set("u_coarse", float(look.coarse))
            .set("u_beforeFromNow",
                 glm::mat4(objectFromWorld * beforeFromNow_ * glm::inverse(objectFromWorld)));
    if (mapping_) {
        const glm::dmat4 objectFromLocal = objectFromWorld * mapping_->objectFromLocal;
        program.set("u_objectFromLocal", glm::mat4(objectFromLocal));
        program.set("u_localFromObject", glm::mat4(glm::inverse(objectFromLocal)));
        program.set("u_cylinder", float(mapping_->cylinderRadius))
            .set("u_half", half_)
            .set("u_perSize", 0.5F / half_);
        glm::dmat4 unitFromLocal(1), localFromTexel(scale_);
        for (int axis = 0; axis < 3; ++axis) {
            unitFromLocal[axis][axis] = 0.5 / half_[axis];
            unitFromLocal[3][axis] = 0.5;
            localFromTexel[3][axis] = -scale_ * bias_;
        }
        localFromTexel[3][3] = 0; // a way, no place
        program.set("u_unitFromObject", glm::mat4(unitFromLocal * glm::inverse(objectFromLocal)));
        program.set("u_wayFromTexel", glm::mat4(objectFromLocal * localFromTexel));
        program.set("u_still", float(bias_));
        program.set("u_scale", float(scale_)).set("u_offset", float(-scale_ * bias_));
        program.texture("t_displacement", displacement_).texture("t_skip", skipTexture_);
        glm::vec3 inner = half_; // a wound box meets itself
        if (wound)
            inner.z = std::min(inner.z, float(std::numbers::pi * mapping_->cylinderRadius));
        const glm::dmat3 affine(objectFromLocal);
        program.set("u_skipHalf", inner)
            .set("u_skipNear", float(skipNear_))
            .set("u_skipReach", float(skipReach_));
        const double least = leastStretch(affine);
        program.set("u_maskSlope", float(maskSlope_)).set("u_leastStretch", float(least));
        program.set("u_shareStretch", float(largestStretch(affine) / least));
    }
    if (coarse_) {
        coarse_->set(program, coarseMaps_, origin_, unit_);
        proxy_.set(program, origin_, unit_);
        program.set("u_coarseBy", float(0.5 * voxel)).set("u_planeSize", frame.size);
        const glm::dmat4 objectFromClip = glm::inverse(glm::dmat4(frame.clipFromLattice));
        const auto seenAt = [&objectFromClip](double x, double y) {
            const glm::dvec4 at = objectFromClip * glm::dvec4(x, y, 0, 1);
            return glm::dvec3(at) / at.w;
        };
        const glm::dvec3 middle = seenAt(0, 0);
        program.set("u_planeMiddle", glm::vec3(middle));
        program.set("u_planeRight", glm::vec3(seenAt(1, 0) - middle));
        program.set("u_planeUp", glm::vec3(seenAt(0, 1) - middle));
    }
    if (stage_) {
        stage_->set(program, origin_, unit_);
        program.set("u_seamLift", float(voxel));
    }
    if (probe) {
        program.set("u_eye", frame.eye);
    } else {
        frame.setTissueLight(program, none_);
        program.set("u_inner", look.inner).set("u_flesh", look.flesh);
        if (volume) {
            glm::dmat4 worldFromObject(unit_);
            worldFromObject[3] = glm::dvec4(origin_, 1);
            cutVolume_->set(program, worldFromObject);
        }
        if (field_.colours)
            program.texture("t_colours", *field_.colours);
        else
            program.set("u_skin", look.skin);
    }
    program.use();
    drawFaces(look, stage_ && !probe);
    return {};
}

void Raycaster::drawFaces(const RaycastLook& look, bool blended) const {
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT);     // the far faces: a camera may be inside
    glEnable(GL_DEPTH_CLAMP); // also where they lie beyond what the camera sees
    if (blended) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    }
    if (coarse_) {
        // A ray a pixel is of the tetrahedra around the pixel's middle, which cover it as a whole.
        const bool sampled = glIsEnabled(GL_MULTISAMPLE);
        if (!look.antialias)
            glDisable(GL_MULTISAMPLE);
        proxy_.draw();
        if (sampled)
            glEnable(GL_MULTISAMPLE);
    } else {
        glBindVertexArray(empty_.id());
        glDrawArrays(GL_TRIANGLES, 0, 36);
    }
    if (blended)
        glDisable(GL_BLEND);
    glDisable(GL_DEPTH_CLAMP);
    glCullFace(GL_BACK);
}

Status Raycaster::draw(const Frame& frame, const RaycastLook& look) {
    return drawBox(frame, look, false);
}

Result<std::vector<RaycastProbe>> Raycaster::probe(const Frame& frame, const RaycastLook& look, int width,
                                                   int height) {
    gpu::Texture2D normals("probe: normals", GL_RGBA32F, width, height),
        rests("probe: rest", GL_RGBA32F, width, height),
        depth("probe: depth", GL_DEPTH_COMPONENT32F, width, height);
    gpu::Framebuffer target("probe");
    target.attach(GL_COLOR_ATTACHMENT0, normals);
    target.attach(GL_COLOR_ATTACHMENT1, rests);
    target.attach(GL_DEPTH_ATTACHMENT, depth);
    target.setDrawBuffers(2);
    normals.clear(glm::vec4(0));
    rests.clear(glm::vec4(0));
    target.bind(width, height);
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    const Status drawn = drawBox(frame, look, true);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    SEROSA_TRY(drawn);
    std::vector<glm::vec4> n(std::size_t(width) * std::size_t(height)), r(n.size());
    normals.download(n.data(), n.size() * sizeof(glm::vec4));
    rests.download(r.data(), r.size() * sizeof(glm::vec4));
    std::vector<RaycastProbe> probes(n.size());
    for (std::size_t i = 0; i < n.size(); ++i) {
        const std::size_t row = std::size_t(height) - 1 - i / std::size_t(width),
                          from = row * std::size_t(width) + i % std::size_t(width);
        RaycastProbe& one = probes[i];
        one.kind = int(r[from].w) % 4;
        one.samples = int(r[from].w) / 4;
        one.t = unit_ * n[from].w;
        one.normal = glm::dvec3(n[from]);
        one.rest = origin_ + unit_ * glm::dvec3(r[from]);
    }
    return probes;
}

} // namespace serosa::render
