// See sim/contact_colliders.h.
#include "sim/contact_colliders.h"

#include "base/check.h"
#include "shaders/shared_constants.h"
#include "sim/distance_field.h"
#include "sim/shape_distance.h"

#include <algorithm>
#include <cstring>
#include <map>

namespace serosa::sim {

static_assert(int(ShapeKind::sphere) == SRS_SHAPE_SPHERE && int(ShapeKind::capsule) == SRS_SHAPE_CAPSULE &&
                  int(ShapeKind::box) == SRS_SHAPE_BOX && int(ShapeKind::hook) == SRS_SHAPE_HOOK &&
                  int(ShapeKind::halfSpace) == SRS_SHAPE_HALF_SPACE && int(ShapeKind::mesh) == SRS_SHAPE_MESH,
              "the shaders' words for shapes");

namespace {

constexpr double kEndless = 1e30; // for infinity, which shaders need not know; contact_held.comp

// As in shaders/contact_colliders.glsl, of doubles and of floats.
template <class Vec4>
struct GpuCollider {
    Vec4 from, to, turnFrom, turnTo, turnBetween, size, middle, halfSize, move;
    glm::ivec4 kind, field;
};
using ExactCollider = GpuCollider<glm::dvec4>;
using NearCollider = GpuCollider<glm::vec4>;

double finite(double value) {
    return std::min(value, kEndless);
}

glm::dvec4 toVec4(const glm::dquat& q) {
    return {q.x, q.y, q.z, q.w};
}

template <class Vec4>
GpuCollider<Vec4> gpuCollider(const ToolMotion& motion, int fieldColumn) {
    const RigidShape& shape = motion.shape;
    const bool turns = motion.turnFrom != motion.turnTo;
    const glm::dquat between =
        turns ? motion.turnTo * glm::conjugate(motion.turnFrom) : glm::dquat(1, 0, 0, 0);
    GpuCollider<Vec4> to{};
    to.from = Vec4(glm::dvec4(motion.from, motion.friction));
    to.to = Vec4(glm::dvec4(motion.to, finite(motion.grip)));
    to.turnFrom = Vec4(toVec4(motion.turnFrom));
    to.turnTo = Vec4(toVec4(motion.turnTo));
    to.turnBetween = Vec4(toVec4(between));
    to.size = Vec4(glm::dvec4(shape.radius, shape.length, shape.bend, finite(thinnestHalfWidth(shape))));
    to.middle = Vec4(glm::dvec4(shape.middle, 0));
    to.halfSize = Vec4(glm::dvec4(shape.halfSize, 0));
    to.move = Vec4(glm::dvec4(glm::distance(motion.from, motion.to),
                              2 * glm::length(glm::dvec3(between.x, between.y, between.z)), 0, 0));
    to.kind = {motion.mode, int(shape.kind), 0, 0};
    if (shape.kind == ShapeKind::mesh) {
        const glm::ivec3& dims = shape.field->dims();
        to.middle = Vec4(glm::dvec4(shape.field->lowest() * shape.fieldScale, 0));
        to.halfSize = Vec4(glm::dvec4(shape.field->step() * shape.fieldScale, shape.fieldScale, 0, 0));
        to.kind = {motion.mode, int(shape.kind), dims.x, dims.y};
        to.field = {dims.z, fieldColumn, 0, 0};
    }
    return to;
}

const RigidShape& shapeOf(const SolverSetup& setup, std::size_t collider) {
    const std::size_t tools = setup.tools.size();
    return collider < tools ? setup.tools[collider].shape : setup.bodies[collider - tools].shape;
}

} // namespace

ContactColliders::ContactColliders(const SolverSetup& setup) : setup_(setup) {
    const std::size_t count = setup.tools.size() + setup.bodies.size();
    SEROSA_CHECK(count <= SRS_MAX_COLLIDERS, "at most SRS_MAX_COLLIDERS tools and bodies");
    if (count == 0)
        return;
    const std::size_t step = gpu::uniformOffsetStep();
    const auto rounded = [step](std::size_t bytes) { return (bytes + step - 1) / step * step; };
    near_ = rounded(count * sizeof(ExactCollider));
    stride_ = near_ + rounded(count * sizeof(NearCollider));
    std::map<const DistanceField*, int> columns; // meshes may share a field
    int width = 0, height = 0;
    for (std::size_t i = 0; i < count; ++i) {
        columns_.push_back(0);
        const RigidShape& shape = shapeOf(setup, i);
        if (shape.kind != ShapeKind::mesh)
            continue;
        const glm::ivec3 dims = shape.field->dims();
        const auto [at, isNew] = columns.emplace(shape.field.get(), width);
        if (isNew) {
            width += dims.x;
            height = std::max(height, dims.y * dims.z);
        }
        columns_.back() = at->second;
    }
    if (columns.empty())
        return;
    std::vector<float> values(std::size_t(width) * std::size_t(height), 0);
    for (const auto& [field, column] : columns) {
        const glm::ivec3 dims = field->dims();
        for (int row = 0; row < dims.y * dims.z; ++row)
            std::copy_n(field->values().begin() + std::ptrdiff_t(row) * dims.x, dims.x,
                        values.begin() + std::ptrdiff_t(row) * width + column);
    }
    fields_ = gpu::Texture2D("distance fields", GL_R32F, width, height);
    fields_.upload(values.data());
}

std::vector<gpu::ShaderDefine> ContactColliders::defines() const {
    unsigned shapes = 0, pushing = 0;
    for (std::size_t i = 0; i < count(); ++i) {
        shapes |= 1u << int(shapeOf(setup_, i).kind);
        if (i >= setup_.tools.size() || setup_.tools[i].mode == ToolMode::push)
            pushing |= 1u << i;
    }
    return {{"SRS_COLLIDERS", std::to_string(count())},
            {"SRS_TOOLS", std::to_string(setup_.tools.size())},
            {"SRS_SHAPES", std::to_string(shapes)},
            {"SRS_PUSHING", std::to_string(pushing) + "u"}};
}

void ContactColliders::prepare(std::int64_t step, int count) {
    first_ = step;
    motions_.clear();
    std::vector<unsigned char> bytes(std::size_t(count) * stride_);
    for (int i = 0; i < count; ++i) {
        motions_.push_back(colliderMotions(setup_, step + i));
        std::vector<ExactCollider> exact;
        std::vector<NearCollider> near;
        for (std::size_t c = 0; c < columns_.size(); ++c) {
            exact.push_back(gpuCollider<glm::dvec4>(motions_.back()[c], columns_[c]));
            near.push_back(gpuCollider<glm::vec4>(motions_.back()[c], columns_[c]));
        }
        unsigned char* to = bytes.data() + std::size_t(i) * stride_;
        std::memcpy(to, exact.data(), exact.size() * sizeof exact[0]);
        std::memcpy(to + near_, near.data(), near.size() * sizeof near[0]);
    }
    if (!steps_ || steps_.bytes() < bytes.size())
        steps_ = gpu::Buffer("colliders", bytes.size(), bytes.data());
    else
        steps_.upload(0, bytes.size(), bytes.data());
}

const std::vector<ToolMotion>& ContactColliders::motions(std::int64_t step) const {
    return motions_.at(std::size_t(step - first_));
}

void ContactColliders::bind(gpu::Program& program, std::int64_t step, Precision precision,
                            bool shapes) const {
    const std::size_t first = std::size_t(step - first_) * stride_;
    if (precision == Precision::exact)
        program.uniforms("b_colliders", steps_, first, columns_.size() * sizeof(ExactCollider));
    else
        program.uniforms("b_colliders", steps_, first + near_, columns_.size() * sizeof(NearCollider));
    if (shapes && fields_)
        program.texture("t_fields", fields_);
}

std::size_t ContactColliders::bytes() const {
    return steps_.bytes() + (fields_ ? 4 * std::size_t(fields_.width()) * std::size_t(fields_.height()) : 0);
}

} // namespace serosa::sim
