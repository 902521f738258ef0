// Group `mapping` of `serosa verify`: the figures of MS05 3.3 that are known without the program, measured on
// the GPU's vertex stage (render/mapping_measures.h).
#include "app/verify/surface_cases.h"
#include "models/phantom.h"
#include "render/mapping_measures.h"
#include "sim/lattice.h"

#include <string>

namespace serosa::app {

namespace {

using render::MappingErrors;
using sim::Mapping;

constexpr double kMillimetre = 1e-3;
constexpr glm::dvec3 kFarAway{0.08, 1.35, -0.06}; // m: organs of a body atlas lie that far from the origin

/// Does it read normals that are packed into 30 bits, and turn an offset by them?
bool readsPackedNodes(Mapping mapping) {
    return mapping == Mapping::curvature || mapping == Mapping::chosen || mapping == Mapping::normalOffset;
}

struct Case {
    std::string name;
    std::size_t faces, nodes;
};

Status measure(const Case& shape, render::NodeNormals normals, int motions, CheckList& checks) {
    SEROSA_ASSIGN(sim::TriangleMesh mesh, models::makePhantom(shape.name, shape.faces));
    for (glm::dvec3& position : mesh.positions)
        position = kMillimetre * position + kFarAway;
    sim::LatticeRequest request;
    request.nodes = shape.nodes;
    SEROSA_ASSIGN(const sim::Lattice lattice, sim::buildLattice(mesh, request));
    for (const Mapping mapping : sim::kSurfaceMappings) {
        const bool packed = readsPackedNodes(mapping);
        const std::string of = shape.name + ", " + mappingWord(mapping) + ": ";
        SEROSA_ASSIGN(const MappingErrors errors,
                      render::measureMapping(lattice, mesh, mapping, motions, normals));
        checks.equalAbs(of + "vertices return at rest", errors.rest, 0, 1e-6, "of the size");
        if (packed)
            checks.equalAbs(of + "rigid motion, beyond 1e-5 of the size", errors.rigidBeyond, 0, 3e-4,
                            "of the offset");
        else
            checks.equalAbs(of + "rigid motion", errors.rigid, 0, 1e-5, "of the size");
        checks.equalAbs(of + "rest normals turn with it", errors.normal, 0, 5e-4, "rad");
        checks.equalAbs(of + "even stretch", errors.stretch, 0, 1e-6, "of the size");
        checks.equalAbs(of + "vertex shader against its twin in double", errors.twin, 0, 1e-6, "of the size");
    }
    return {};
}

} // namespace

Status verifyMapping(const VerifyOptions& options, CheckList& checks) {
    const render::NodeNormals normals = options.inject.fault == Fault::staleNormal
                                            ? render::NodeNormals::stale
                                            : render::NodeNormals::current;
    const int motions = options.full ? 32 : 8;
    SEROSA_TRY(measure({"ball", 12000, 4000}, normals, motions, checks));
    if (options.full)
        SEROSA_TRY(measure({"heart", 50000, 20000}, normals, motions, checks));
    else
        SEROSA_TRY(measure({"beam", 4000, 1500}, normals, motions, checks));

    for (const double height : {0.25, 1.0}) {
        SEROSA_ASSIGN(const render::EdgeGaps constant,
                      render::measureBendGaps(Mapping::triangle, height, normals));
        SEROSA_ASSIGN(const render::EdgeGaps corrected,
                      render::measureBendGaps(Mapping::curvature, height, normals));
        const std::string of =
            "figure 6's bend, points " + std::string(height < 0.5 ? "1/4 h" : "1 h") + " over edges: ";
        checks.atLeast(of + "largest gap, constant", constant.largest, 0.05 * height, "h");
        checks.atMost(of + "largest gap, corrected over constant", corrected.largest / constant.largest, 0.6,
                      "1");
    }
    return {};
}

} // namespace serosa::app
