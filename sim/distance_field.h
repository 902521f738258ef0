#pragma once
// Signed distance to a small closed surface, sampled on a regular grid that holds it with a margin and
// interpolated trilinearly, as a 3D texture does it. Samples are exact (sim/triangle_tree.h); between them
// the field bends where the surface has edges, by less than a sample's spacing.
//
// Beyond the grid stands what the nearest point c of the grid's box says. As the surface lies in the box,
// which is convex, no distance there is less than sqrt(|p - c|^2 + phi(c)^2); and of a convex surface none is
// less than phi(c) + n(c) (p - c). The field takes the larger: a node far under a small tool is kept off it
// by a spacing. Of a surface that is not convex that may be too far, by 41% at most; what must not be
// (leaving out what is far away) asks lowerBound.

#include "sim/shape_distance.h"
#include "sim/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

class DistanceField {
public:
    static constexpr int kMostSamples = 64; // along the longest side

    /// \param metres closed, wound outward, in the shape's own frame, at least one face.
    /// \param samples along the longest side, 8 to kMostSamples
    explicit DistanceField(const TriangleMesh& metres, int samples = kMostSamples);

    /// \param own m
    ShapeSample sample(const glm::dvec3& own) const;
    /// Never more than the distance, m.
    double lowerBound(const glm::dvec3& own) const;

    /// m: of nine tenths of the surface, the material behind it is at least twice as thick.
    double thinnestHalfWidth() const { return thinnest_; }
    const glm::dvec3& meshLowest() const { return meshLowest_; }
    const glm::dvec3& meshHighest() const { return meshHighest_; }

    /// The grid, for a texture: sample (x, y, z) at index x + dims.x (y + dims.y z) lies at lowest() +
    /// step() (x, y, z); m.
    const glm::ivec3& dims() const { return dims_; }
    const glm::dvec3& lowest() const { return lowest_; }
    double step() const { return step_; }
    const std::vector<float>& values() const { return values_; }

private:
    double valueAt(int x, int y, int z) const {
        return values_[std::size_t(x) +
                       std::size_t(dims_.x) * (std::size_t(y) + std::size_t(dims_.y) * std::size_t(z))];
    }
    ShapeSample sampleInGrid(const glm::dvec3& own) const; // gradient not normalized

    glm::ivec3 dims_{0};
    glm::dvec3 lowest_{0}, meshLowest_{0}, meshHighest_{0};
    double step_ = 0, thinnest_ = 0;
    std::vector<float> values_;
};

} // namespace serosa::sim
