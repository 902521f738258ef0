// Group `surface`: the numbers behind MS05 figures 1, 2, 5 and 6, for every mapping, on the GPU's vertex
// stage.
#include "app/verify/surface_cases.h"
#include "render/mapped_stage.h"
#include "render/mapping_measures.h"
#include "render/surface_measures.h"

#include <algorithm>

namespace serosa::app {

namespace {

using render::MappedStage;
using sim::Mapping;

using Move = std::function<glm::dvec3(const glm::dvec3&)>;

std::vector<glm::dvec3> inLattice(const SurfaceCase& shape) {
    std::vector<glm::dvec3> q;
    for (const glm::dvec3& p : shape.mesh.positions)
        q.push_back(shape.lattice.toLattice(p));
    return q;
}

std::vector<glm::dvec3> moved(std::vector<glm::dvec3> points, const Move& move) {
    for (glm::dvec3& p : points)
        p = move(p);
    return points;
}

Result<std::vector<glm::dvec3>> mapped(const SurfaceCase& shape, Mapping mapping, const Move& move) {
    SEROSA_ASSIGN(MappedStage stage,
                  MappedStage::create(shape.lattice, shape.mesh,
                                      render::bindSurface(shape.lattice, shape.mesh, mapping)));
    stage.upload(render::deformedState(shape.lattice, move));
    return stage.positions();
}

glm::dvec3 middleOf(const sim::Lattice& lattice) {
    return 0.5 * (lattice.restPosition(0) + lattice.restPosition(lattice.nodeCount() - 1));
}

/// Figures 1 and 2: an outline that follows the lattice's steps, or the surface.
Status measureSilhouettes(CheckList& checks) {
    constexpr double kWindow = 3; // spacings: steps are at most that long on these shapes
    for (const char* phantom : {"ball", "kidney"}) {
        SEROSA_ASSIGN(const SurfaceCase shape, surfaceCase(phantom, phantom[0] == 'b' ? 8000 : 20000, 4000));
        const double size =
            double(std::max({shape.lattice.nodeDims.x, shape.lattice.nodeDims.y, shape.lattice.nodeDims.z}));
        const Move move = [&](const glm::dvec3& q) {
            return render::bend(q, middleOf(shape.lattice), 1.5 * size);
        };
        const auto nodes = render::deformedState(shape.lattice, move).positions;
        const double steps = render::silhouetteJaggedness(nodes, shape.lattice.boundary, 2, kWindow);
        const double smooth =
            render::silhouetteJaggedness(moved(inLattice(shape), move), shape.mesh.faces, 2, kWindow);
        const std::string of = "figure 2, " + std::string(phantom) + ", jagged outline, ";
        checks.atLeast(of + "one-to-one", steps, 0.1, "h");
        for (const Mapping mapping : sim::kSurfaceMappings) {
            SEROSA_ASSIGN(const auto surface, mapped(shape, mapping, move));
            const double jagged = render::silhouetteJaggedness(surface, shape.mesh.faces, 2, kWindow);
            checks.atMost(of + mappingWord(mapping) + ", beyond the bent surface's own, over one-to-one",
                          std::max(0.0, jagged - smooth) / steps, 0.15, "1");
        }
    }
    return {};
}

/// Figures 5 and 6: the dragon on 18 nodes, bent to a radius of three spacings.
Status measureDamage(CheckList& checks) {
    SEROSA_ASSIGN(const SurfaceCase dragon, surfaceCase("dragon", 10000, 0, 0.062));
    const Move move = [&](const glm::dvec3& q) { return render::bend(q, middleOf(dragon.lattice), 3); };
    const std::vector<glm::dvec3> rest = inLattice(dragon), bent = moved(rest, move);
    render::SurfaceDamage constant;
    for (const Mapping mapping : sim::kSurfaceMappings) {
        SEROSA_ASSIGN(const auto surface, mapped(dragon, mapping, move));
        const render::SurfaceDamage damage = render::surfaceDamage(surface, bent, dragon.mesh.faces);
        if (mapping == Mapping::triangle)
            constant = damage;
        const std::string of = "figures 5 and 6, dragon on 18 nodes, " + mappingWord(mapping) + ": ";
        const double faces = double(dragon.mesh.faces.size());
        if (mapping == Mapping::triangle) {
            checks.atLeast(of + "largest stretch of an edge", damage.largestStretch, 5, "1");
            checks.atLeast(of + "flipped faces", double(damage.flipped) / faces, 1e-3, "of all");
            continue;
        }
        // Without the part of the offset that lies beside the normal, reference points are far from even.
        checks.atMost(of + "largest stretch of an edge, over constant's",
                      damage.largestStretch / constant.largestStretch,
                      mapping == Mapping::normalOffset ? 2 : 1, "1");
        checks.atMost(of + "flipped faces, over constant's",
                      double(damage.flipped) / std::max(1.0, double(constant.flipped)), 1, "1");
    }
    return {};
}

/// The gap between the images of a point on either side of a shared edge of triangles.
Status measureGaps(const VerifyOptions& options, CheckList& checks) {
    const auto normals = options.inject.fault == Fault::staleNormal ? render::NodeNormals::stale
                                                                    : render::NodeNormals::current;
    for (const double height : {0.25, 1.0}) {
        const std::string of = "figure 5, points " + std::string(height < 0.5 ? "1/4 h" : "1 h") +
                               " over edges of the bent 18 nodes, largest gap: ";
        SEROSA_ASSIGN(const render::EdgeGaps constant,
                      render::measureBendGaps(Mapping::triangle, height, normals));
        checks.atLeast(of + "triangle", constant.largest, 0.05 * height, "h");
        for (const Mapping mapping : {Mapping::curvature, Mapping::chosen, Mapping::normalOffset,
                                      Mapping::trilinear, Mapping::nodeFrames}) {
            SEROSA_ASSIGN(const render::EdgeGaps gaps, render::measureBendGaps(mapping, height, normals));
            if (mapping == Mapping::curvature || mapping == Mapping::chosen)
                checks.atMost(of + mappingWord(mapping) + ", over constant", gaps.largest / constant.largest,
                              0.6, "1");
            else // continuous: along the normal where eq. 8's is followed, in cells also above them
                checks.atMost(of + mappingWord(mapping), gaps.largest, 1e-5, "h");
            if (mapping == Mapping::trilinear)
                checks.atLeast(of + "trilinear, edges between two cells", double(gaps.edges), 8, "1");
        }
    }
    return {};
}

} // namespace

Status verifySurfaceFigures(const VerifyOptions& options, CheckList& checks) {
    SEROSA_TRY(measureSilhouettes(checks));
    SEROSA_TRY(measureDamage(checks));
    return measureGaps(options, checks);
}

} // namespace serosa::app
