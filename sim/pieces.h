#pragma once
// What cuts left: the pieces of an organ, and the faces that they laid bare.
//
// A piece is a set of nodes that connections join. A cell is whole while its 24 connections (12 edges, 12
// face diagonals) are all there; a broken cell holds no more pressure (sim/volume_term.h) and is not drawn. A
// freed face is one between a whole cell and a broken one, seen from outside the whole cell. The freed faces
// and the lattice's own outer faces of whole cells together close the surface of all that is whole.

#include "sim/lattice.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

/// One label a node: the least index of a node of its piece. Flood fill. \param connections 18 bits a node.
std::vector<std::uint32_t> pieceLabels(const Lattice& lattice, const std::vector<std::uint32_t>& connections);

struct PieceCount {
    std::size_t pieces = 0; // of two nodes or more
    std::size_t loose = 0;  // nodes without any connection
};
PieceCount countPieces(const std::vector<std::uint32_t>& labels);

/// Springs that are gone: connections of the lattice that `connections` lacks, each counted once.
std::size_t springsCut(const Lattice& lattice, const std::vector<std::uint32_t>& connections);

/// One flag a cell of the lattice.
std::vector<bool> wholeCells(const Lattice& lattice, const std::vector<std::uint32_t>& connections);

/// Triangles over nodes, outward of the whole cell: cut along the diagonal through the lowest node index, as
/// Lattice::boundary.
std::vector<glm::uvec3> freedFaces(const Lattice& lattice, const std::vector<bool>& whole);

/// Triangles over nodes, outward: the surface of the cells that are flagged, one flag a cell of the lattice.
std::vector<glm::uvec3> boundaryOf(const Lattice& lattice, const std::vector<bool>& flags);

/// Triangles over nodes that close what cuts left: the outer faces of whole cells, and freed faces.
/// Lattice::boundary where nothing is cut.
std::vector<glm::uvec3> boundaryLeft(const Lattice& lattice, const std::vector<std::uint32_t>& connections);

} // namespace serosa::sim
