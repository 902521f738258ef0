// The part of group `raycast` about what is known in closed form: a ball at rest, sheared, scaled and bent;
// the cap that a plane cuts off; the wall of a shell.
#include "app/verify/raycast.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

namespace serosa::app {

namespace {

using render::RaycastLook;
using render::RaycastProbe;
using render::RaycastView;
using render::Solid;

constexpr double kPi = std::numbers::pi;
constexpr double kHalf = 0.075;  // m: of the box of a texture, more than what any ball here reaches
constexpr double kEdge = 0.0006; // m: nearer to a silhouette a pixel does not count: the mesh is a polyhedron

/// A texture of a map that is given in closed form: rest place of a shown point, and what is kept.
Result<render::DeformationTexture> textureOf(const glm::ivec3& size,
                                             const std::function<glm::dvec3(const glm::dvec3&)>& rest,
                                             const std::function<double(const glm::dvec3&)>& kept) {
    std::vector<glm::dvec4> texels;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const glm::dvec3 q = 2 * kHalf * (glm::dvec3(x, y, z) + 0.5) / glm::dvec3(size) - kHalf;
                texels.emplace_back(rest(q) - q, std::clamp(kept(q), 0.0, 1.0));
            }
    return render::DeformationTexture::create(size, glm::dvec3(kHalf), render::TexelFormat::single, texels);
}

double all(const glm::dvec3& /*q*/) {
    return 1;
}

/// How near to the ball, at rest, the ray comes: its radius there less the ball's.
double nearest(const RaycastView::Ray& ray, double length,
               const std::function<glm::dvec3(const glm::dvec3&)>& rest) {
    const auto at = [&](double t) { return glm::length(rest(ray.from + t * ray.along)) - kBallRadius; };
    constexpr int kSteps = 400;
    int best = 0;
    for (int i = 0; i <= kSteps; ++i)
        best = at(length * i / kSteps) < at(length * best / kSteps) ? i : best;
    double low = length * (best - 1) / kSteps, high = length * (best + 1) / kSteps; // golden section
    for (int i = 0; i < 40; ++i) {
        const double a = high - (high - low) / std::numbers::phi, b = low + (high - low) / std::numbers::phi;
        (at(a) < at(b) ? high : low) = at(a) < at(b) ? b : a;
    }
    return at(0.5 * (low + high));
}

Status checkAtRest(const RaycastModel& ball, int size, CheckList& checks) {
    SEROSA_ASSIGN(const render::DeformationTexture still,
                  textureOf(
                      glm::ivec3(8), [](const glm::dvec3& q) { return q; }, all));
    SEROSA_ASSIGN(render::Raycaster caster, ball.caster(render::Warp{&still, {}}));
    for (const auto projection : {sim::Projection::perspective, sim::Projection::orthographic}) {
        const RaycastView view = ball.view({0.3, -0.4, -1}, projection, size, size);
        SEROSA_ASSIGN(const std::vector<RaycastProbe> probes, caster.probe(view.frame, {}, size, size));
        int wrong = 0, hits = 0;
        double off = 0;
        std::vector<double> turned;
        for (std::size_t i = 0; i < probes.size(); ++i) {
            const RaycastView::Ray ray = view.ray(i);
            const double middle = -glm::dot(ray.from, ray.along),
                         miss = glm::length(ray.from + middle * ray.along);
            if (std::abs(miss - kBallRadius) < kEdge)
                continue;
            wrong += (probes[i].kind == RaycastProbe::surface) != (miss < kBallRadius);
            if (probes[i].kind != RaycastProbe::surface || miss > 0.95 * kBallRadius)
                continue;
            ++hits;
            const double exact = middle - std::sqrt(kBallRadius * kBallRadius - miss * miss);
            off = std::max(off, std::abs(view.distanceOf(caster, ray, probes[i]) - exact));
            const glm::dvec3 normal = glm::normalize(ray.from + exact * ray.along);
            turned.push_back(std::acos(std::min(glm::dot(normal, probes[i].normal), 1.0)) * 180 / kPi);
        }
        std::sort(turned.begin(), turned.end());
        const std::string of =
            std::string("ball at rest, ") + (view.orthographic() ? "orthographic: " : "perspective: ");
        checks.atLeast(of + "pixels on it", hits, 0.1 * size * size, "1");
        checks.equalAbs(of + "silhouette, pixels that differ", wrong, 0, 0, "1");
        checks.atMost(of + "depth, largest error", off / ball.field.grid().step, 0.25, "voxels");
        checks.atMost(of + "normals, median", turned[turned.size() / 2], 0.5, "deg");
    }
    return {};
}

/// A deformation whose inverse is known: the shader's silhouette against it.
Status checkSilhouette(const RaycastModel& ball, const std::string& name, const glm::ivec3& texels,
                       const std::function<glm::dvec3(const glm::dvec3&)>& rest, int size,
                       CheckList& checks) {
    SEROSA_ASSIGN(const render::DeformationTexture texture, textureOf(texels, rest, all));
    SEROSA_ASSIGN(render::Raycaster caster, ball.caster(render::Warp{&texture, {}}));
    int wrong = 0, inside = 0;
    for (const glm::dvec3& direction : {glm::dvec3(0, 0, -1), glm::dvec3(0.7, -0.3, -0.6)}) {
        const RaycastView view = ball.view(direction, sim::Projection::orthographic, size, size, 1.7);
        SEROSA_ASSIGN(const std::vector<RaycastProbe> probes, caster.probe(view.frame, {}, size, size));
        for (std::size_t i = 0; i < probes.size(); ++i) {
            const RaycastView::Ray ray = view.ray(i);
            const glm::dvec2 slab = slabOf(ray, glm::dvec3(-kHalf), glm::dvec3(kHalf));
            const double near =
                slab.x < slab.y ? nearest({ray.from + slab.x * ray.along, ray.along}, slab.y - slab.x, rest)
                                : kHalf;
            if (std::abs(near) < kEdge)
                continue;
            inside += near < 0;
            wrong += (probes[i].kind == RaycastProbe::surface) != (near < 0);
        }
    }
    checks.atLeast(name + " ball: pixels on it", inside, 0.1 * size * size, "1");
    checks.equalAbs(name + " ball: silhouette, pixels that differ", wrong, 0, 0, "1");
    return {};
}

/// What a plane y = height leaves of the ball below it, seen from above (front) and below, orthographic.
Status checkCap(const RaycastModel& ball, double height, int size, CheckList& checks) {
    const double slope = 1 / (render::kMaskBand * 2 * kHalf / 64);
    SEROSA_ASSIGN(const render::DeformationTexture texture,
                  textureOf(
                      {1, 64, 1}, [](const glm::dvec3& q) { return q; },
                      [&](const glm::dvec3& q) { return 0.5 + slope * (height - q.y); }));
    SEROSA_ASSIGN(render::Raycaster caster, ball.caster(render::Warp{&texture, {}}));
    double volume = 0, faceArea = 0, wallArea = 0;
    RaycastLook look;
    for (const double side : {1.0, -1.0}) {
        // Not quite along the axis: `up` must not be.
        const RaycastView view = ball.view({0, -side, 1e-7}, sim::Projection::orthographic, size, size);
        look.solid = Solid::solid;
        SEROSA_ASSIGN(const std::vector<RaycastProbe> probes, caster.probe(view.frame, look, size, size));
        const double pixel = std::pow(view.footprint({}), 2);
        for (const RaycastProbe& probe : probes)
            if (probe.kind != RaycastProbe::nothing) {
                volume += pixel * side * probe.rest.y; // D is 0: what is shown lies at rest
                faceArea += probe.kind == RaycastProbe::cutFace ? pixel : 0;
            }
        if (side < 0)
            continue;
        look.solid = Solid::shell;
        look.thickness = 0.3 * kBallRadius;
        SEROSA_ASSIGN(const std::vector<RaycastProbe> wall, caster.probe(view.frame, look, size, size));
        for (const RaycastProbe& probe : wall)
            wallArea += probe.kind == RaycastProbe::cutFace ? pixel : 0;
    }
    const double r = kBallRadius, tall = r - height, cap = kPi * tall * tall * (3 * r - tall) / 3,
                 disc = r * r - height * height;
    const std::string of =
        "ball, cut by a plane at " + std::to_string(int(std::lround(100 * height / r))) + "% of its radius: ";
    checks.equalRel(of + "volume of the cap", 4 * kPi * r * r * r / 3 - volume, cap, 0.015, "m3");
    checks.equalRel(of + "area of the cut face", faceArea, kPi * disc, 0.01, "m2");
    // A ring from sqrt(disc) inward to where the inner ball begins.
    const double inner = std::sqrt(std::max(disc - wallArea / kPi, 0.0)),
                 thickness = r - std::sqrt(inner * inner + height * height);
    checks.equalAbs(of + "thickness of a shell's wall", thickness / ball.field.grid().step,
                    look.thickness / ball.field.grid().step, 1, "voxels");
    return {};
}

} // namespace

Status verifyRaycastKnown(const VerifyOptions& options, CheckList& checks) {
    SEROSA_ASSIGN(const RaycastModel ball, raycastBall(64));
    const int size = options.full ? 320 : 128;
    SEROSA_TRY(checkAtRest(ball, size, checks));
    SEROSA_TRY(checkSilhouette(
        ball, "sheared", {1, 48, 1},
        [](const glm::dvec3& q) { return glm::dvec3(q.x - 0.4 * q.y, q.y, q.z); }, size, checks));
    SEROSA_TRY(checkSilhouette(
        ball, "scaled", {16, 16, 16}, [](const glm::dvec3& q) { return q / glm::dvec3(1.4, 0.8, 1.1); }, size,
        checks));
    render::DeformationMap bend;
    bend.kind = render::MapKind::bend;
    bend.half = glm::dvec3(kHalf);
    bend.amount = 0.8;
    bend.extent = 0.06;
    SEROSA_TRY(checkSilhouette(
        ball, "bent", glm::ivec3(64),
        [bend](const glm::dvec3& q) { return q + render::inverseDisplacement(bend, q); }, size, checks));
    for (const double share : {0.0, 0.4})
        SEROSA_TRY(checkCap(ball, share * kBallRadius, size, checks));
    return {};
}

} // namespace serosa::app
