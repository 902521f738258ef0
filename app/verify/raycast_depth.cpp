// The part of group `raycast` about what a body is taken from (CS07 section 6.1): a distance field and depth
// maps of a heart, against the first triangle that each ray meets.
#include "app/verify/raycast.h"
#include "models/phantom.h"
#include "render/depth_maps.h"
#include "sim/triangle_tree.h"

#include <string>

namespace serosa::app {

namespace {

constexpr std::size_t kFaces = 20'000;
constexpr int kSamples = 96, kSize = 160; // of the fields, of the picture: the one as fine as the other
constexpr double kLength = 10;            // m: longer than any ray

struct FieldCase {
    const char* name;
    render::FieldKind kind;
    double silhouettes, deep; // %, at most
};
// Walls of two millimetres are little more than a voxel; what else depth maps miss is the shape's: hollows
// that no side sees into, and depths where two of its parts overlap within a texel.
constexpr FieldCase kFields[] = {{"distance field", render::FieldKind::distance, 1.2, 2},
                                 {"depth-map cube", render::FieldKind::depthCube, 2.5, 14},
                                 {"depth map along z", render::FieldKind::depth, 4, 18}};

} // namespace

Status verifyRaycastDepth(const VerifyOptions& options, CheckList& checks) {
    const int finer = options.full ? 2 : 1;
    SEROSA_ASSIGN(sim::TriangleMesh mesh, models::phantomInMetres("heart", kFaces));
    SEROSA_ASSIGN(const RaycastModel heart, RaycastModel::of(std::move(mesh), finer * kSamples, 0));
    const sim::TriangleTree tree(heart.mesh.positions, heart.mesh.faces);
    const int size = finer * kSize;
    for (const FieldCase& tested : kFields) {
        std::optional<render::DepthMaps> maps;
        render::RayField field = render::RayField::of(heart.field);
        if (tested.kind != render::FieldKind::distance) {
            SEROSA_ASSIGN(render::DepthMaps made,
                          render::DepthMaps::create(heart.mesh, heart.field.grid(), {tested.kind, 2}));
            maps.emplace(std::move(made));
            field = maps->field();
        }
        SEROSA_ASSIGN(render::Raycaster caster, render::Raycaster::create(heart.space, field));
        render::RaycastAgreement sum;
        for (const glm::dvec3& direction :
             {glm::dvec3(-0.25, -0.15, -1), glm::dvec3(1, -0.4, -0.3), glm::dvec3(-0.4, -1, 0.5)}) {
            const render::RaycastView view = heart.view(direction, sim::Projection::perspective, size, size);
            SEROSA_ASSIGN(const std::vector<render::RaycastProbe> probes,
                          caster.probe(view.frame, {}, size, size));
            for (std::size_t i = 0; i < probes.size(); ++i) {
                const render::RaycastView::Ray ray = view.ray(i);
                const auto hit = tree.firstHit(ray.from, kLength * ray.along, 1);
                const bool shown = probes[i].kind != render::RaycastProbe::nothing;
                sum.object += hit.has_value();
                sum.silhouettes += hit.has_value() != shown;
                if (!hit || !shown)
                    continue;
                ++sum.both;
                const double exact = kLength * hit->t;
                sum.deep += std::abs(view.distanceOf(caster, ray, probes[i]) - exact) >
                            0.5 * view.footprint(ray.from + exact * ray.along);
            }
        }
        const std::string of = std::string("heart from a ") + tested.name + ", " +
                               std::to_string(sum.object) + " pixels against its triangles: ";
        checks.atLeast(of + "pixels on it", sum.object, 0.1 * 3 * size * size, "1");
        checks.atMost(of + "silhouettes differ in", 100 * sum.silhouetteShare(), tested.silhouettes, "%");
        checks.atMost(of + "depth off by half a pixel's footprint in", 100 * sum.deepShare(), tested.deep,
                      "%");
    }
    return {};
}

} // namespace serosa::app
