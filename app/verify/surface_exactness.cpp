// Group `surface`: what must be exact for every mapping whatever the surface, and normals that must be near.
#include "app/verify/surface_cases.h"
#include "render/mapped_stage.h"
#include "render/mapping_measures.h"
#include "render/surface_measures.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace serosa::app {

namespace {

using render::MappedStage;
using sim::Mapping;

bool readsNodeNormals(Mapping mapping) {
    return mapping == Mapping::curvature || mapping == Mapping::chosen || mapping == Mapping::normalOffset;
}

/// Rest, rigid motions and an even stretch, with the tolerances of group `mapping`. On the vertex stage's
/// twin in double (mapSurface), which group `mapping` holds equal to it: each surface on the GPU would be
/// half a second of shaders.
Status measureRandomSurfaces(const VerifyOptions& options, CheckList& checks) {
    constexpr unsigned kSurfaces = 20;
    for (const Mapping mapping : sim::kSurfaceMappings) {
        render::MappingErrors worst;
        for (unsigned number = 1; number <= kSurfaces; ++number) {
            SEROSA_ASSIGN(const SurfaceCase shape, randomSurface(number));
            const render::MappingErrors errors =
                render::measureMappingTwin(shape.lattice, shape.mesh, mapping, options.full ? 16 : 3);
            for (double render::MappingErrors::*field :
                 {&render::MappingErrors::rest, &render::MappingErrors::rigid,
                  &render::MappingErrors::rigidBeyond, &render::MappingErrors::stretch})
                if (!(errors.*field <= worst.*field)) // NaN stays
                    worst.*field = errors.*field;
        }
        const std::string of = "20 random surfaces, " + mappingWord(mapping) + ": ";
        checks.equalAbs(of + "vertices return at rest", worst.rest, 0, 1e-6, "of the size");
        if (readsNodeNormals(mapping))
            checks.equalAbs(of + "rigid motion, beyond 1e-5 of the size", worst.rigidBeyond, 0, 3e-4,
                            "of the offset");
        else
            checks.equalAbs(of + "rigid motion", worst.rigid, 0, 1e-5, "of the size");
        checks.equalAbs(of + "even stretch", worst.stretch, 0, 1e-6, "of the size");
    }
    return {};
}

/// A bar of six cells' thickness in a bend that strains its surface by 2%.
Result<SurfaceCase> bar() {
    SurfaceCase made;
    SEROSA_ASSIGN(made, surfaceCase("ball", 8000, 1000));
    for (glm::dvec3& p : made.mesh.positions)
        p *= glm::dvec3(3, 0.75, 0.75); // an ellipsoid of 240 x 60 x 60 mm
    sim::LatticeRequest request;
    request.spacing = 0.01;
    SEROSA_ASSIGN(made.lattice, sim::buildLattice(made.mesh, request));
    return made;
}

/// Normals that the mapping gives against those of the mesh that it gives.
Status measureNormals(CheckList& checks) {
    SEROSA_ASSIGN(const SurfaceCase shape, bar());
    const double thickness = 0.06 / shape.lattice.spacing, strain = 0.02;
    const auto move = [&](const glm::dvec3& q) { return render::bend(q, {}, 0.5 * thickness / strain); };
    for (const Mapping mapping : sim::kSurfaceMappings) {
        SEROSA_ASSIGN(MappedStage stage,
                      MappedStage::create(shape.lattice, shape.mesh,
                                          render::bindSurface(shape.lattice, shape.mesh, mapping)));
        stage.upload(render::deformedState(shape.lattice, move));
        sim::TriangleMesh deformed = shape.mesh;
        deformed.positions = stage.positions();
        const render::AngleSpread angles = render::anglesBetween(stage.normals(), deformed.vertexNormals());
        const bool near = mapping == Mapping::nodeFrames || mapping == Mapping::trilinear;
        const std::string of = "ellipsoid bent to 2% strain, " + mappingWord(mapping) +
                               ": normals against the deformed mesh's, ";
        checks.atMost(of + "median", angles.median, near ? 0.5 : 2, "deg");
        checks.atMost(of + "largest", angles.largest, near ? 1 : 30, "deg");
    }
    return {};
}

/// Tangent frames of the vertex stage in a strong bend: of unit length, at right angles, N x T = B (so that
/// T, N, B of MS05 are a left hand's); the lattice's axes, which node frames and trilinear turn, are a right
/// hand's.
Status measureAxes(CheckList& checks) {
    SEROSA_ASSIGN(const SurfaceCase shape, surfaceCase("dragon", 10000, 0, 0.062));
    const auto move = [&](const glm::dvec3& q) { return render::bend(q, {}, 3); };
    for (const Mapping mapping : sim::kSurfaceMappings) {
        SEROSA_ASSIGN(MappedStage stage,
                      MappedStage::create(shape.lattice, shape.mesh,
                                          render::bindSurface(shape.lattice, shape.mesh, mapping)));
        stage.upload(render::deformedState(shape.lattice, move));
        SEROSA_ASSIGN(const std::vector<glm::dmat3> axes, stage.axes());
        double worst = 0;
        for (const glm::dmat3& a : axes) {
            const glm::dmat3 rest = glm::transpose(a) * a - glm::dmat3(1);
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    if (!(std::abs(rest[i][j]) <= worst))
                        worst = std::abs(rest[i][j]);
            const bool latticeAxes = mapping == Mapping::nodeFrames || mapping == Mapping::trilinear;
            const double hand = latticeAxes ? 1 : -1;
            if (!(std::abs(glm::determinant(a) - hand) <= worst))
                worst = std::abs(glm::determinant(a) - hand);
        }
        checks.equalAbs("dragon bent to three spacings, " + mappingWord(mapping) +
                            ": tangent frames orthonormal",
                        worst, 0, 1e-4, "1");
    }
    return {};
}

} // namespace

Status verifySurfaceExactness(const VerifyOptions& options, CheckList& checks) {
    SEROSA_TRY(measureRandomSurfaces(options, checks));
    SEROSA_TRY(measureNormals(checks));
    return measureAxes(checks);
}

} // namespace serosa::app
