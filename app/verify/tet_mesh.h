#pragma once
// Tetrahedra of ten nodes with straight sides, made by the program `tetgen` in a child process: it is AGPL
// and crashes on bad input, so it is never linked.

#include "app/verify/plane_cut.h"
#include "base/result.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace serosa::app {

/// Nodes 0 to 3 of an element are its corners, with positive volume; 4 to 9 the middles of the edges
/// kTetEdges.
struct TetMesh {
    std::vector<glm::dvec3> nodes; // m; corners first
    std::vector<std::array<std::uint32_t, 10>> elements;
    std::size_t corners = 0;

    double volume(std::size_t element) const; // m3
    double volume() const;
    /// Mean length of the elements' edges, m.
    double meanEdge() const;
};
constexpr std::array<std::array<int, 2>, 6> kTetEdges{{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

/// Adds the nodes in the middle of the edges. An element with negative volume is turned.
TetMesh quadraticTets(std::vector<glm::dvec3> corners,
                      const std::vector<std::array<std::uint32_t, 4>>& elements);

/// Is tetgen there? What to install if not.
bool tetgenExists();
constexpr const char* kTetgenMissing =
    "needs the program tetgen, which is not in PATH: install the package tetgen";

/// Fills what lies above the plane (metres). The first nodes are the vertices of `cut.above`, and the plane
/// is made of faces. \param largestVolume of a tetrahedron, m3; a few are larger, as tetgen smooths the mesh
/// last. \param seconds that tetgen may take. Errors: tetgen is missing (exit code 2); it crashed, took too
/// long, or what it wrote is no mesh of that solid (3).
Result<TetMesh> fillWithTets(const PlaneCut& cut, double largestVolume, double seconds);

} // namespace serosa::app
