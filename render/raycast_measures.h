#pragma once
// What pictures of the deformation shader are measured by: the rays of their pixels, their agreement with the
// twin that casts the same rays with dense samples (render/raycast_twin.h), and of two pictures with each
// other. `serosa verify raycast` and the tests call these.

#include "render/camera.h"
#include "render/frame.h"
#include "render/raycast_twin.h"
#include "render/raycaster.h"

#include <vector>

namespace serosa::render {

/// A lattice that only says what object space is: m times 1 / unit, about the origin.
sim::Lattice objectSpace(double unit);

struct RaycastView {
    int width = 0, height = 0;
    CameraView camera;
    Frame frame;

    /// Frames a box; m.
    static RaycastView of(const sim::Lattice& space, const glm::dvec3& lowest, const glm::dvec3& highest,
                          const glm::dvec3& direction, sim::Projection projection, int width, int height);
    struct Ray {
        glm::dvec3 from{0}, along{0}; // m, from the near plane; unit
    };
    /// Of pixel i of a probe, top row first.
    Ray ray(std::size_t i) const;
    /// Width of a pixel at a place, m.
    double footprint(const glm::dvec3& at) const;
    bool orthographic() const { return camera.clipFromCamera[2][3] == 0; }
    /// How far along its ray a pixel's hit lies, m, from Ray::from.
    double distanceOf(const Raycaster& caster, const Ray& ray, const RaycastProbe& probe) const;
};

/// Where a ray is in a box: x >= y is not at all.
glm::dvec2 slabOf(const RaycastView::Ray& ray, const glm::dvec3& lowest, const glm::dvec3& highest);

/// Sums over pictures.
struct RaycastAgreement {
    int object = 0;             // pixels in which the reference meets something
    int silhouettes = 0;        // in which one meets something and the other does not
    int both = 0, deep = 0;     // in which both do; of these, off by more than half a pixel's footprint
    int faces = 0;              // of a cut, in the reference
    std::vector<double> turned; // degrees between normals

    double silhouetteShare() const { return double(silhouettes) / std::max(object, 1); }
    double deepShare() const { return double(deep) / std::max(both, 1); }
    double medianTurn() const;
};

/// Adds a picture, the twin's rays being the reference.
void addAgreement(RaycastAgreement& sum, const RaycastView& view, const Raycaster& caster,
                  const std::vector<RaycastProbe>& probes, const RaycastTwin& twin);
/// Adds a picture with another of the same view as the reference. \param tolerance m, instead of a footprint
void addAgreement(RaycastAgreement& sum, const std::vector<RaycastProbe>& probes,
                  const std::vector<RaycastProbe>& reference, double tolerance);

} // namespace serosa::render
