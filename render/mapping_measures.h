#pragma once
// What is known of the mappings without them: a surface that rests, moves rigidly or is stretched evenly, and
// two points on either side of an edge that should stay together (MS05 3.3, figures 5 and 6). Measured on the
// vertex stage of the GPU through transform feedback; `serosa verify mapping` and the tests call these.

#include "base/result.h"
#include "render/surface_binding.h"
#include "render/surface_renderer.h"
#include "sim/lattice_state.h"

#include <functional>

namespace serosa::render {

/// current: eq. 3 from the deformed positions, as the solver writes them. stale: those of the rest state (a
/// fault to find).
enum class NodeNormals { current, stale };

/// A lattice whose nodes follow `move` (lattice units to lattice units), with packed normals.
sim::LatticeState deformedState(const sim::Lattice& lattice,
                                const std::function<glm::dvec3(const glm::dvec3&)>& move,
                                NodeNormals normals = NodeNormals::current);

/// A bend about the z axis: x becomes the arc length along a centre line through `middle` of this radius,
/// which starts level. Lattice units.
glm::dvec3 bend(const glm::dvec3& q, const glm::dvec3& middle, double radius);

struct MappingErrors {
    double rest = 0;        // largest distance at rest, of the surface's size
    double rigid = 0;       // largest distance from the rigidly moved vertex, of the surface's size
    double rigidBeyond = 0; // largest (distance - 1e-5 of the size) / offset, at least 0
    double normal = 0;      // largest angle between mapped and rigidly turned rest normals, rad
    // Largest distance from what an even stretch S makes of a surface, of the size: of the reference points,
    // S r, for every mapping; of the vertices, S r + o, for node frames, whose rotations an even stretch
    // along the axes leaves alone; of the vertices, S v, for trilinear.
    double stretch = 0;
    double twin =
        0; // largest distance from mapSurface (double) under the rigid motions and a bend, of the size
};

/// Binds `metres` to `lattice` and measures. Needs a current context.
/// \param motions random rigid motions of a fixed seed, each with a translation up to 8 spacings.
Result<MappingErrors> measureMapping(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                     sim::Mapping mapping, int motions,
                                     NodeNormals normals = NodeNormals::current);

/// The same of the CPU's twin of the vertex stage (mapSurface): rest, rigid, rigidBeyond and stretch. Needs
/// no context.
MappingErrors measureMappingTwin(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                 sim::Mapping mapping, int motions);

struct EdgeGaps {
    double largest = 0, rms = 0; // lattice units
    std::size_t edges = 0;
};

/// Points over the middle of every edge that two boundary triangles share, `height` spacings along the mean
/// of their normals, are bound to either triangle; the gap is the distance between the two images when the
/// lattice of 3x3x2 nodes is bent to a radius of 3 spacings. Along the normal, points lie on eq. 8's normal
/// over the edge instead: what is followed there goes from one triangle to the other. In cells, points on
/// either side of the plane between two cells that the edge lies in are bound. Needs a current context.
Result<EdgeGaps> measureBendGaps(sim::Mapping mapping, double height,
                                 NodeNormals normals = NodeNormals::current);

} // namespace serosa::render
