// See render/coarse_warp.h.
#include "render/coarse_warp.h"

#include "shaders/raycast_constants.h"

#include <algorithm>
#include <array>

namespace serosa::render {

namespace {

constexpr double kDifference = 1e-4; // of a box's height: central differences of a Jacobian

/// As shaders/coarse_map.glsl has it (std140).
struct StoredMap {
    glm::mat4 localFromObject, objectFromLocal;
    glm::vec4 half;    // m; w: SRS_COARSE_*
    glm::vec4 numbers; // amount, radius, extent, 1 for a narrow pull
};
static_assert(sizeof(StoredMap) == 160);

int codeOf(MapKind kind) {
    switch (kind) {
    case MapKind::twist:
        return SRS_COARSE_TWIST;
    case MapKind::bend:
        return SRS_COARSE_BEND;
    case MapKind::pull:
        return SRS_COARSE_PULL;
    case MapKind::wave:
        return SRS_COARSE_WAVE;
    default:
        return -1;
    }
}

} // namespace

bool CoarseWarp::knows(MapKind kind) {
    return codeOf(kind) >= 0;
}

Result<CoarseWarp> CoarseWarp::create(std::vector<CoarseMap> maps) {
    if (maps.empty() || maps.size() > SRS_COARSE_MAPS)
        return Error{std::to_string(maps.size()) + " deformations by vertices: take 1 to " +
                     std::to_string(SRS_COARSE_MAPS)};
    for (const CoarseMap& one : maps) {
        const std::string name = std::string("a ") + nameOf(one.map.kind) + " by vertices: ";
        if (!knows(one.map.kind))
            return Error{name + "only twist, bend, pull and wave can be; leave it to the pixels"};
        if (one.mapping.cylinderRadius > 0)
            return Error{name + "its box cannot be wound: leave it to the pixels"};
        if (const std::string problem = problemOf(one.map); !problem.empty())
            return Error{name + problem};
    }
    CoarseWarp made;
    made.maps_ = std::move(maps);
    return made;
}

glm::dvec3 CoarseWarp::forward(const glm::dvec3& rest) const {
    glm::dvec3 at = rest;
    for (const CoarseMap& one : maps_)
        at = one.mapping.toObject(render::forward(one.map, one.mapping.toTexture(at)));
    return at;
}

glm::dmat3 CoarseWarp::jacobian(const glm::dvec3& rest) const {
    const double step = kDifference * 2 * maps_.front().map.half.y;
    glm::dmat3 slope;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 by(0);
        by[axis] = step;
        slope[axis] = (forward(rest + by) - forward(rest - by)) / (2 * step);
    }
    return slope;
}

glm::dvec3 CoarseWarp::back(const glm::dvec3& shown) const {
    glm::dvec3 at = shown;
    for (auto one = maps_.rbegin(); one != maps_.rend(); ++one) {
        const glm::dvec3 q = one->mapping.toTexture(at);
        at = one->mapping.toObject(q + inverseDisplacement(one->map, q));
    }
    return at;
}

glm::dmat3 CoarseWarp::backJacobian(const glm::dvec3& shown) const {
    glm::dvec3 at = shown;
    glm::dmat3 whole(1);
    for (auto one = maps_.rbegin(); one != maps_.rend(); ++one) {
        const glm::dvec3 q = one->mapping.toTexture(at), rest = q + inverseDisplacement(one->map, q);
        whole = one->mapping.jacobian(rest) * inverseJacobian(one->map, q) *
                glm::inverse(one->mapping.jacobian(q)) * whole;
        at = one->mapping.toObject(rest);
    }
    return whole;
}

std::optional<glm::dvec3> CoarseWarp::foldsAt(const std::vector<glm::dvec3>& body) const {
    for (const glm::dvec3& at : body)
        if (!(glm::determinant(jacobian(at)) > 0))
            return at;
    return std::nullopt;
}

void CoarseWarp::set(gpu::Program& program, gpu::Buffer& buffer, const glm::dvec3& origin,
                     double unit) const {
    std::array<StoredMap, SRS_COARSE_MAPS> stored{};
    glm::dmat4 worldFromObject(unit);
    worldFromObject[3] = glm::dvec4(origin, 1);
    for (std::size_t i = 0; i < maps_.size(); ++i) {
        const DeformationMap& map = maps_[i].map;
        const glm::dmat4 localFromObject = glm::inverse(maps_[i].mapping.objectFromLocal) * worldFromObject;
        stored[i] = {glm::mat4(localFromObject), glm::mat4(glm::inverse(localFromObject)),
                     glm::vec4(glm::vec3(map.half), float(codeOf(map.kind))),
                     glm::vec4(map.amount, map.radius, map.extent, map.profile == PullProfile::narrow)};
    }
    if (!buffer)
        buffer = gpu::Buffer("deformations by vertices", sizeof(stored), nullptr);
    buffer.upload(0, sizeof(stored), stored.data());
    program.set("u_coarseMaps", int(maps_.size()));
    program.uniforms("b_coarse", buffer, 0, sizeof(stored));
}

} // namespace serosa::render
