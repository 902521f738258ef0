// See sim/distance_field.h.
#include "sim/distance_field.h"

#include "base/check.h"
#include "sim/node_depths.h"
#include "sim/triangle_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace serosa::sim {

namespace {

constexpr int kMargin = 2; // samples beyond the surface on every side

/// Half of the material's thickness behind each face, along its normal; the least that nine tenths of the
/// area have. Near a sharp edge it goes to nothing, which says nothing of the whole.
double thinnestOf(const TriangleMesh& mesh, const TriangleTree& tree, double reach) {
    std::vector<std::pair<double, double>> halves; // half thickness, area
    double whole = 0;
    for (const glm::uvec3& face : mesh.faces) {
        const glm::dvec3 &a = mesh.positions[face.x], &b = mesh.positions[face.y],
                         &c = mesh.positions[face.z];
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        const double area = glm::length(normal);
        if (!(area > 0))
            continue;
        // Four points of it, so that a box of twelve faces is seen well enough.
        for (const glm::dvec3& w :
             {glm::dvec3(1, 1, 1), glm::dvec3(4, 1, 1), glm::dvec3(1, 4, 1), glm::dvec3(1, 1, 4)}) {
            const glm::dvec3 at = (w.x * a + w.y * b + w.z * c) / (w.x + w.y + w.z);
            double thick = reach;
            tree.allHits(at - normal * (1e-6 * reach / area), normal * (-reach / area), 1,
                         [&](const TriangleTree::Hit& hit) {
                             if (!hit.front)
                                 thick = std::min(thick, hit.t * reach);
                         });
            halves.emplace_back(0.5 * thick, area);
            whole += area;
        }
    }
    std::sort(halves.begin(), halves.end());
    double seen = 0;
    for (const auto& [half, area] : halves)
        if ((seen += area) >= 0.1 * whole)
            return half;
    return 0;
}

} // namespace

DistanceField::DistanceField(const TriangleMesh& metres, int samples)
    : meshLowest_(metres.lowest()), meshHighest_(metres.highest()) {
    SEROSA_CHECK(!metres.faces.empty() && samples >= 8 && samples <= kMostSamples, "a mesh, 8 to 64 samples");
    const TriangleTree tree(metres.positions, metres.faces);
    const glm::dvec3 size = meshHighest_ - meshLowest_;
    step_ = std::max({size.x, size.y, size.z}) / (samples - 1 - 2 * kMargin);
    SEROSA_CHECK(step_ > 0, "a mesh that has a size");
    for (int axis = 0; axis < 3; ++axis)
        dims_[axis] = int(std::ceil(size[axis] / step_ - 1e-9)) + 1 + 2 * kMargin;
    lowest_ = 0.5 * (meshLowest_ + meshHighest_) - 0.5 * step_ * glm::dvec3(dims_ - 1);
    values_.resize(std::size_t(dims_.x) * std::size_t(dims_.y) * std::size_t(dims_.z));
    const double reach = 2 * glm::length(step_ * glm::dvec3(dims_));
    thinnest_ = thinnestOf(metres, tree, reach);
    tbb::parallel_for(0, dims_.z, [&](int z) {
        for (int y = 0; y < dims_.y; ++y) {
            double before = 0; // of the sample before it: a neighbour that is far has the same sign
            for (int x = 0; x < dims_.x; ++x) {
                const glm::dvec3 p = lowest_ + step_ * glm::dvec3(x, y, z);
                const double apart = std::sqrt(tree.closest(p).distance2);
                const bool inside = std::abs(before) > 1.001 * step_ ? before < 0 : isInside(tree, p, reach);
                before = inside ? -apart : apart;
                values_[std::size_t(x) +
                        std::size_t(dims_.x) * (std::size_t(y) + std::size_t(dims_.y) * std::size_t(z))] =
                    float(before);
            }
        }
    });
}

ShapeSample DistanceField::sampleInGrid(const glm::dvec3& own) const {
    const glm::dvec3 at = (own - lowest_) / step_;
    glm::ivec3 cell;
    glm::dvec3 share;
    for (int axis = 0; axis < 3; ++axis) {
        cell[axis] = at[axis] > 0 ? std::min(int(std::min(at[axis], 1e3)), dims_[axis] - 2) : 0; // NaN: 0
        share[axis] = std::clamp(at[axis] - cell[axis], 0.0, 1.0);
    }
    double value = 0;
    glm::dvec3 gradient(0);
    for (int corner = 0; corner < 8; ++corner) {
        const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
        const double wx = x ? share.x : 1 - share.x, wy = y ? share.y : 1 - share.y,
                     wz = z ? share.z : 1 - share.z, v = valueAt(cell.x + x, cell.y + y, cell.z + z);
        value += wx * wy * wz * v;
        gradient += v * glm::dvec3((x ? 1 : -1) * wy * wz, wx * (y ? 1 : -1) * wz, wx * wy * (z ? 1 : -1));
    }
    return {value, gradient / step_};
}

ShapeSample DistanceField::sample(const glm::dvec3& own) const {
    const glm::dvec3 within = glm::clamp(own, lowest_, lowest_ + step_ * glm::dvec3(dims_ - 1));
    ShapeSample sample = sampleInGrid(within);
    const double length = glm::length(sample.normal);
    sample.normal = length > 1e-9 ? sample.normal / length : glm::dvec3(0, 1, 0);
    const glm::dvec3 beyond = own - within;
    const double away2 = glm::dot(beyond, beyond);
    if (away2 > 0) {
        const double near = std::max(sample.distance, 0.0);
        const glm::dvec3 fromSurface = beyond + near * sample.normal;
        sample.distance = std::max(std::sqrt(away2 + near * near), near + glm::dot(sample.normal, beyond));
        sample.normal = glm::normalize(fromSurface);
    }
    return sample;
}

double DistanceField::lowerBound(const glm::dvec3& own) const {
    const glm::dvec3 within = glm::clamp(own, lowest_, lowest_ + step_ * glm::dvec3(dims_ - 1));
    const double near = sampleInGrid(within).distance, away = glm::distance(own, within);
    return away > 0 ? std::hypot(away, std::max(near, 0.0)) : near;
}

} // namespace serosa::sim
