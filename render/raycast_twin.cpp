// See render/raycast_twin.h.
#include "render/raycast_twin.h"

#include <algorithm>
#include <cmath>

namespace serosa::render {

namespace {

constexpr int kBisections = 40;

/// Trilinear between voxels, and beyond the grid the way to it more.
struct SampledField {
    std::vector<float> values;
    VolumeGrid grid;

    double operator()(const glm::dvec3& rest) const {
        const glm::dvec3 at = (rest - grid.lowest) / grid.step,
                         within = glm::clamp(at, glm::dvec3(0), glm::dvec3(grid.size - 1));
        const glm::ivec3 cell = glm::min(glm::ivec3(within), grid.size - 2);
        const glm::dvec3 share = within - glm::dvec3(cell);
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
            const std::size_t index =
                std::size_t(cell.x + x) +
                std::size_t(grid.size.x) *
                    (std::size_t(cell.y + y) + std::size_t(grid.size.y) * std::size_t(cell.z + z));
            sum += (x ? share.x : 1 - share.x) * (y ? share.y : 1 - share.y) * (z ? share.z : 1 - share.z) *
                   values[index];
        }
        return sum + grid.step * glm::distance(at, within);
    }
};

} // namespace

RaycastTwin::RaycastTwin(std::vector<float> field, const VolumeGrid& grid, const Warp& warp, Solid solid,
                         double thickness, double step)
    : RaycastTwin(SampledField{std::move(field), grid}, grid.step, warp, solid, thickness, step) {}

RaycastTwin::RaycastTwin(std::function<double(const glm::dvec3& rest)> field, double voxel, const Warp& warp,
                         Solid solid, double thickness, double step)
    : field_(std::move(field)), voxel_(voxel), warp_(warp), solid_(solid), thickness_(thickness),
      step_(step) {}

glm::dvec3 RaycastTwin::fieldGradient(const glm::dvec3& rest) const {
    glm::dvec3 gradient(0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 by(0);
        by[axis] = voxel_;
        gradient[axis] = (field(rest + by) - field(rest - by)) / (2 * voxel_);
    }
    return gradient;
}

RaycastTwin::Place RaycastTwin::at(const glm::dvec3& shown) const {
    const Warp::Point warped = warp_.at(coarse_ ? coarse_->back(shown) : shown);
    Place place;
    place.rest = warped.rest;
    place.mask = warped.mask;
    place.distance = place.body = field(warped.rest);
    if (solid_ == Solid::shell)
        place.body = std::max(place.distance, -thickness_ - place.distance);
    return place;
}

glm::dvec3 RaycastTwin::normal(const glm::dvec3& shown, const glm::dvec3& rest, bool face) const {
    const glm::dvec3 at = coarse_ ? coarse_->back(shown) : shown;
    const glm::dvec3 outward =
        face ? -warp_.maskGradient(at) : glm::transpose(warp_.jacobian(at)) * fieldGradient(rest);
    return coarse_ ? glm::transpose(coarse_->backJacobian(shown)) * outward : outward;
}

RaycastProbe RaycastTwin::cast(const glm::dvec3& from, const glm::dvec3& along, double start,
                               double end) const {
    RaycastProbe hit;
    Place before = at(from + start * along);
    for (double t = start; t < end; t += step_) {
        const double next = std::min(t + step_, end);
        const Place now = at(from + next * along);
        const bool crossed =
            solid_ == Solid::hollow ? (before.body < 0) != (now.body < 0) : !before.matter() && now.matter();
        if (crossed) {
            double low = t, high = next;
            Place outer = before, inner = now;
            for (int i = 0; i < kBisections; ++i) {
                const double middle = 0.5 * (low + high);
                const Place place = at(from + middle * along);
                const bool beyond =
                    solid_ == Solid::hollow ? (place.body < 0) == (now.body < 0) : place.matter();
                (beyond ? high : low) = middle;
                (beyond ? inner : outer) = place;
            }
            if (solid_ != Solid::hollow || inner.mask >= 0.5) {
                const bool face = solid_ != Solid::hollow && outer.body < 0,
                           back = solid_ == Solid::hollow
                                      ? now.body >= 0
                                      : solid_ == Solid::shell && !face && inner.distance < -0.5 * thickness_;
                const glm::dvec3 shown = from + high * along;
                hit.kind = face   ? RaycastProbe::cutFace
                           : back ? RaycastProbe::innerSide
                                  : RaycastProbe::surface;
                hit.t = high;
                hit.rest = inner.rest;
                const glm::dvec3 outward = normal(shown, inner.rest, face);
                hit.normal = glm::normalize(back ? -outward : outward);
                return hit;
            }
        }
        before = now;
    }
    return hit;
}

} // namespace serosa::render
