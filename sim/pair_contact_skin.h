#pragma once
// The skins of organs that may touch each other, in one list of nodes and triangles, and in one unit.
//
// What touches is the organ's surface, not its lattice: a node of the lattice's boundary rests `depth` below
// it (sim/node_depths.h), or outside of it. So the skin is a boundary of the lattice with each node moved by
// its depth along the surface's normal there: p = q + depth n. Of a ball it comes within 0.02 spacings of the
// sphere, with normals within 6 degrees, where the boundary itself is a flight of stairs. The normal follows
// the tissue: n is that at rest, N, times the cofactors of the node's deformation gradient, whose columns are
// the differences of its neighbours along the axes. The depth keeps its length: what lies between a node and
// the skin is not squeezed.
//
// The boundary is that of the cells which are at least half as full as any around them. Those that the organ
// barely touches are too light and too weak to carry a contact: pressed by heavy tissue they are crushed
// while what lies below them passes through. They follow their springs.
//
// Group units: lengths in the largest spacing of the group, masses in its largest mass of a full node, times
// in steps. The origin is that of the first organ.

#include "sim/solver.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace serosa::sim {

/// An organ that is to be coupled.
struct CoupledMember {
    const SolverSetup* setup = nullptr;     // not null
    std::vector<std::uint32_t> connections; // what cuts left, 18 bits a node; empty: all
    bool touches = false, touchesItself = false;
    std::vector<std::uint32_t> others; // nodes beside those of the skin that something acts on; ascending
};

/// Its part of the lists, all in one run: first the nodes of the skin, then others.
struct CoupledOrgan {
    const Lattice* lattice = nullptr;
    double scale = 1; // group units a lattice unit
    glm::dvec3 shift{0};
    bool touches = false, touchesItself = false;
    std::uint32_t firstNode = 0, skinNodes = 0, nodes = 0, firstTriangle = 0, triangles = 0;

    glm::dvec3 toGroup(const glm::dvec3& latticePoint) const { return shift + scale * latticePoint; }
};

struct CoupledGroup {
    double length = 1, mass = 1; // m, kg: the units
    std::vector<CoupledOrgan> organs;

    // One a node. What follows `inverseMass` is of the skin's nodes, and 0 of others.
    std::vector<std::uint32_t> latticeNode;
    std::vector<std::uint32_t> organOf;
    std::vector<double> inverseMass; // 0 where fixed
    std::vector<glm::dvec3> restNormal;
    std::vector<double> depth;     // below the skin
    std::vector<double> thickness; // of the organ below the skin at rest; at most 4 spacings
    std::vector<double> flatness;  // weight: 1e4 where the skin is flat at rest, 14 on a right edge
    std::vector<std::array<std::int32_t, 6>> beside; // nodes at +x, -x, +y, -y, +z, -z; -1: none

    std::vector<glm::uvec3> triangles; // over nodes, outward; near ones one after another
    // Nodes of the skin that lie within SRS_SELF_REACH spacings along the springs, ascending: a node's are
    // near[nearFirst[node]] .. near[nearFirst[node + 1] - 1]. Of organs that touch themselves.
    std::vector<std::uint32_t> nearFirst, near;

    std::size_t nodeCount() const { return latticeNode.size(); }
    /// Number of the node of an organ's lattice, or -1.
    std::int64_t find(std::size_t organ, std::uint32_t node) const;
};

/// \param members at least one; what they point at outlives the result.
CoupledGroup coupleOrgans(const std::vector<CoupledMember>& members);

/// The skin as nodes lie at `positions` (one a node, group units): offsets p - q = depth n and normals n of
/// the skin's nodes, 0 of others.
void placeSkin(const CoupledGroup& group, const std::vector<glm::dvec3>& positions,
               std::vector<glm::dvec3>& offsets, std::vector<glm::dvec3>& normals);

} // namespace serosa::sim
