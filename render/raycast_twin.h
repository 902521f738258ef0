#pragma once
// The deformation shader on the processor, in double and with dense samples: what shaders/raycast_*.glsl is
// tested against. Reads the same textures (the field as DistanceVolume::read gives it, the displacement as
// DeformationTexture holds it).

#include "render/coarse_warp.h"
#include "render/deformation_texture.h"
#include "render/raycaster.h"

#include <functional>
#include <vector>

namespace serosa::render {

class RaycastTwin {
public:
    /// \param field m, one a voxel of the grid. \param step between samples, m
    RaycastTwin(std::vector<float> field, const VolumeGrid& grid, const Warp& warp, Solid solid,
                double thickness, double step);
    /// The same of another body. \param field m, negative inside. \param voxel m: its gradient is taken over
    /// two
    RaycastTwin(std::function<double(const glm::dvec3& rest)> field, double voxel, const Warp& warp,
                Solid solid, double thickness, double step);

    /// Moves all of it by these maps, too, by their closed-form inverse; null: by none. \param coarse
    /// outlives this
    void setCoarse(const CoarseWarp* coarse) { coarse_ = coarse; }

    /// The first thing that a ray meets between two distances along it, m. Probe::t from `from` on.
    RaycastProbe cast(const glm::dvec3& from, const glm::dvec3& along, double start, double end) const;
    /// Of the body at rest, m; negative inside.
    double field(const glm::dvec3& rest) const { return field_(rest); }

private:
    struct Place {
        double distance = 0, body = 0, mask = 1;
        glm::dvec3 rest{0};
        bool matter() const { return body < 0 && mask >= 0.5; }
    };
    Place at(const glm::dvec3& shown) const;
    glm::dvec3 fieldGradient(const glm::dvec3& rest) const;
    glm::dvec3 normal(const glm::dvec3& shown, const glm::dvec3& rest, bool face) const;

    std::function<double(const glm::dvec3&)> field_;
    double voxel_; // m
    Warp warp_;
    const CoarseWarp* coarse_ = nullptr;
    Solid solid_;
    double thickness_, step_;
};

} // namespace serosa::render
