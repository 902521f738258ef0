#pragma once
// What the processor knows of the sides of the blades' cuts: of each node its signed distance to the nearest
// one (CutMask::nodeSides) and what springs are left. Which vertices a cut parts, and which nodes
// render/side_nodes.h finds a place for on a side.

#include "render/surface_binding.h"
#include "sim/lattice.h"

#include <cstdint>
#include <vector>

namespace serosa::render {

class NodeSides {
public:
    /// All outlive this. \param connections 18 bits a node. \param sides spacings
    NodeSides(const sim::Lattice& lattice, const std::vector<std::uint32_t>& connections,
              const std::vector<float>& sides)
        : lattice_(lattice), connections_(connections), sides_(sides) {}

    /// Bits of parting(): all of them where a cut goes through.
    static constexpr int kBelow = 1, kAbove = 2, kLost = 4, kParted = kBelow | kAbove | kLost;
    /// On which sides of a near cut the corners of a place's cell lie and, unless null, the nodes that a
    /// vertex follows; and whether one of them lost a connection. \param place lattice units
    int parting(const glm::dvec3& place, const glm::uvec3* nodes) const;
    /// How far a place lies from the nearest cut, as CutVertex::away: by the corners of its cell, or else by
    /// the nodes that a vertex follows.
    double away(const glm::dvec3& place, const VertexBinding& bound) const;

    /// Are all nodes held, near a cut, and on this side (1, -1) of it?
    bool areOn(const glm::uvec3& nodes, int side) const;
    /// Are all nodes held, and none on the other side of a near cut?
    bool goWith(const glm::uvec3& nodes, int side) const;
    /// Has the side a place for each of the nodes? What shaders/side_nodes.comp decides.
    bool havePlaces(const glm::uvec3& nodes, int side) const;

private:
    bool isFar(std::size_t node) const;
    bool isOn(std::size_t node, int side) const;
    bool isLoose(std::size_t node) const { return connections_[node] == 0; }
    /// Had a node springs to the side?
    bool touches(std::size_t node, int side) const;
    bool hasPlace(std::size_t node, int side) const;

    const sim::Lattice& lattice_;
    const std::vector<std::uint32_t>& connections_;
    const std::vector<float>& sides_;
};

} // namespace serosa::render
