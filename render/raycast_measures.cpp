// See render/raycast_measures.h.
#include "render/raycast_measures.h"

#include "render/parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace serosa::render {

namespace {

double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)) * 180 / std::numbers::pi;
}

void add(RaycastAgreement& sum, const RaycastProbe& probe, const RaycastProbe& reference, double apart,
         double tolerance) {
    sum.object += reference.kind != RaycastProbe::nothing;
    sum.silhouettes += (reference.kind != 0) != (probe.kind != 0);
    sum.faces += reference.kind == RaycastProbe::cutFace;
    if (reference.kind == 0 || probe.kind == 0)
        return;
    ++sum.both;
    sum.deep += !(std::abs(apart) <= tolerance);
    sum.turned.push_back(degreesBetween(probe.normal, reference.normal));
}

} // namespace

sim::Lattice objectSpace(double unit) {
    sim::Lattice space;
    space.spacing = unit;
    return space;
}

RaycastView RaycastView::of(const sim::Lattice& space, const glm::dvec3& lowest, const glm::dvec3& highest,
                            const glm::dvec3& direction, sim::Projection projection, int width, int height) {
    RaycastView made;
    made.width = width;
    made.height = height;
    sim::Camera settings;
    settings.projection = projection;
    settings.direction = direction;
    made.camera = makeCamera(settings, lowest, highest, double(width) / height);
    made.frame = makeFrame(space, made.camera, {}, {}, width, height);
    return made;
}

RaycastView::Ray RaycastView::ray(std::size_t i) const {
    const std::size_t wide = std::size_t(width);
    const double x = 2 * (double(i % wide) + 0.5) / width - 1, y = 1 - 2 * (double(i / wide) + 0.5) / height;
    const glm::dmat4 worldFromClip = glm::inverse(camera.clipFromCamera * camera.cameraFromWorld);
    const auto at = [&](double depth) {
        const glm::dvec4 p = worldFromClip * glm::dvec4(x, y, depth, 1);
        return glm::dvec3(p) / p.w;
    };
    const glm::dvec3 from = at(-1);
    return {from, glm::normalize(at(1) - from)};
}

double RaycastView::footprint(const glm::dvec3& at) const {
    const double away = orthographic() ? 1 : glm::distance(at, camera.eye);
    return 2 * away / (camera.clipFromCamera[1][1] * height);
}

double RaycastView::distanceOf(const Raycaster& caster, const Ray& ray, const RaycastProbe& probe) const {
    if (!orthographic())
        return probe.t - glm::distance(camera.eye, ray.from);
    // From as far before the box's far face as its diagonal is long (shaders/raycast.frag).
    return slabOf(ray, caster.lowest(), caster.highest()).y -
           glm::distance(caster.lowest(), caster.highest()) + probe.t;
}

glm::dvec2 slabOf(const RaycastView::Ray& ray, const glm::dvec3& lowest, const glm::dvec3& highest) {
    const glm::dvec3 one = (lowest - ray.from) / ray.along, two = (highest - ray.from) / ray.along,
                     near = glm::min(one, two), far = glm::max(one, two);
    return {std::max({near.x, near.y, near.z, 0.0}), std::min({far.x, far.y, far.z})};
}

double RaycastAgreement::medianTurn() const {
    if (turned.empty())
        return 180;
    std::vector<double> sorted = turned;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
}

void addAgreement(RaycastAgreement& sum, const RaycastView& view, const Raycaster& caster,
                  const std::vector<RaycastProbe>& probes, const RaycastTwin& twin) {
    std::vector<RaycastProbe> exact(probes.size());
    parallelFor(probes.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const RaycastView::Ray ray = view.ray(i);
            const glm::dvec2 slab = slabOf(ray, caster.lowest(), caster.highest());
            if (slab.x < slab.y)
                exact[i] = twin.cast(ray.from, ray.along, slab.x, slab.y);
        }
    });
    for (std::size_t i = 0; i < probes.size(); ++i) {
        const RaycastView::Ray ray = view.ray(i);
        add(sum, probes[i], exact[i], view.distanceOf(caster, ray, probes[i]) - exact[i].t,
            0.5 * view.footprint(ray.from + exact[i].t * ray.along));
    }
}

void addAgreement(RaycastAgreement& sum, const std::vector<RaycastProbe>& probes,
                  const std::vector<RaycastProbe>& reference, double tolerance) {
    for (std::size_t i = 0; i < probes.size(); ++i)
        add(sum, probes[i], reference[i], probes[i].t - reference[i].t, tolerance);
}

} // namespace serosa::render
