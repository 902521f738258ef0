#pragma once
// What the phantoms' tests measure on a mesh, written apart from the code that makes or checks meshes
// elsewhere.

#include "sim/triangle_mesh.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace serosa::test {

struct Shell {
    std::size_t faces;
    double volume; // mm^3, negative for a cavity
    int genus;
};

/// Empty if each edge joins two faces that agree on its direction and the faces of each vertex form one fan.
std::string manifoldFault(const sim::TriangleMesh& mesh);

/// Connected components, largest volume first.
std::vector<Shell> shellsOf(const sim::TriangleMesh& mesh);

/// Smallest angle of any face, degrees.
double leastAngle(const sim::TriangleMesh& mesh);

/// Pairs of faces that meet anywhere but in their shared vertices and edges (within 1e-9 of the size of a
/// face), or that share an edge and fold back onto each other (by less than 5 degrees).
std::size_t contacts(const sim::TriangleMesh& mesh);

/// Distance along the unit `direction` to the nearest face farther than `beyond`.
std::optional<double> rayHit(const sim::TriangleMesh& mesh, const glm::dvec3& from,
                             const glm::dvec3& direction, double beyond);

/// Signed volume by the divergence theorem.
double volumeOf(const sim::TriangleMesh& mesh);

/// Lowest and highest corner of the box that holds the mesh.
struct Extents {
    glm::dvec3 lowest, highest;
    glm::dvec3 size() const { return highest - lowest; }
};
Extents extentsOf(const sim::TriangleMesh& mesh);

/// The phantom of that name at its default face count, made once in a run of the tests.
const sim::TriangleMesh& defaultPhantom(const std::string& name);

} // namespace serosa::test
