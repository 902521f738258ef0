#pragma once
// The lattice of MS05 3.1, with one departure: a grid cell that the organ touches is material, with fill f in
// (0, 1], and its eight corners are the nodes (MS05 takes the cells themselves as nodes, which leaks at thin
// walls and is soft).
//
// Lattice units: spacing 1. Node i rests at the integer point restPosition(i) = nodes[i] - centre; metres are
// origin + spacing * q. Integers and small coordinates keep the rest state exactly at rest in float32.

#include "base/result.h"
#include "sim/triangle_mesh.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace serosa::sim {

/// Offsets of the 18 connections, in the order of shaders/shared_constants.h; direction d is opposite to d
/// ^ 1.
extern const std::array<glm::ivec3, 18> kNeighbourOffsets;

struct LatticeRequest {
    double spacing = 0; // m; 0: chosen for `nodes`
    std::size_t nodes = 20000;
    std::optional<glm::dvec3> gridPoint; // m: a point of the grid lies here; else it is centred
    std::size_t maxBytes =
        0; // memory that the lattice and its textures may take; 0: 3/4 of what the machine has free
};

struct LatticeCell {
    glm::ivec3 grid;           // lowest corner
    std::uint8_t fill;         // 1 .. 255: share of the volume inside, in 1/255
    std::uint8_t material = 0; // index into the organ's tissue (sim/material.h)
};

/// Shape, connections, fills and boundary: all that does not move. Immutable once built.
struct Lattice {
    double spacing = 0;                             // m
    glm::dvec3 origin{0};                           // m, world: where lattice coordinate 0 rests
    glm::ivec3 centre{0};                           // grid coordinate that rests at the origin
    glm::ivec3 nodeDims{0};                         // nodes of the whole grid along x, y, z
    std::vector<glm::ivec3> nodes;                  // grid coordinates, sorted z, y, x (x fastest)
    std::vector<std::uint32_t> connections;         // 18 bits a node
    std::vector<std::array<std::uint8_t, 8>> fills; // of the 8 cells around a node: cell c lies towards +x if
                                                    // c&1, +y if c&2, +z if c&4; 0: no material
    std::vector<LatticeCell> cells;                 // material cells, sorted z, y, x
    std::vector<glm::uvec3> boundary;     // triangles over nodes, outward: outer faces of material cells,
                                          // each cut along the diagonal through its lowest node index
    double exactVolume = 0;               // m3: of the surface, before fills are rounded to 8 bits
    std::vector<std::uint8_t> depthSteps; // a node: restDepth()

    std::size_t nodeCount() const { return nodes.size(); }
    glm::dvec3 restPosition(std::size_t node) const {
        return glm::dvec3(nodes[node] - centre);
    } // lattice units
    glm::dvec3 toWorld(const glm::dvec3& lattice) const { return origin + spacing * lattice; } // m
    glm::dvec3 toLattice(const glm::dvec3& world) const { return (world - origin) / spacing; }
    /// Index of the node at a grid coordinate, or -1.
    std::int64_t nodeAt(const glm::ivec3& grid) const;
    /// Neighbour of `node` in direction d, or -1 where the connection bit is clear.
    std::int64_t neighbour(std::size_t node, int d) const;
    /// Share of a full node's mass: sum of its fills / (8 * 255).
    double massShare(std::size_t node) const;
    /// How deep the node rests below the organ's surface as contact counts it (sim/node_depths.h), in
    /// spacings from -2 (outside) to 1, in steps of 1/85. Without a surface (latticeFromCells) what the share
    /// of mass says of a plane along the grid.
    double restDepth(std::size_t node) const { return depthSteps[node] / 85.0 - 2; }
    /// Spring weight w in direction d (k_ij = w k): edges sum f/4 over the cells that hold both ends,
    /// diagonals f/2. Of the shape alone, as of one material: sim/tissue_field.h knows the materials.
    double springWeight(std::size_t node, int d) const;

    std::vector<std::int32_t> nodeOfGrid; // whole grid, x fastest; -1 where no node
};

/// Builds the lattice of a closed surface given in metres. Fills are exact (the surface is clipped to each
/// cell). Errors: spacing not positive, a spacing or node count that needs more than maxBytes (says how much,
/// and the smallest spacing that fits), fewer than 8 nodes.
Result<Lattice> buildLattice(const TriangleMesh& metres, const LatticeRequest& request);

/// A lattice straight from a list of cells (tests, procedural shapes). `cells` need not be sorted; duplicates
/// are refused.
Lattice latticeFromCells(std::vector<LatticeCell> cells, double spacing, const glm::dvec3& origin);

/// Corner c of a cell lies at +x if c & 1, +y if c & 2, +z if c & 4: 0 or 1 along each axis.
glm::ivec3 cornerOffset(int corner);

/// Does the cell in octant `octant` around a node (cell c lies towards +x if c & 1, ...) hold the node's
/// neighbour in direction d, too?
bool octantHolds(int octant, int d);

/// Index of the cell in each octant around each node; -1: none. 8 a node.
std::vector<std::int32_t> cellsAround(const Lattice& lattice);

/// Summed unit vectors of eq. 3 (unnormalized) at rest, one a node: MS05 3.2. Length 0 inside, >= 0.5 where
/// well defined.
std::vector<glm::dvec3> restNormalSums(const Lattice& lattice);

} // namespace serosa::sim
