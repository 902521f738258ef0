#pragma once
// What the processor knows of the sides of the blades' cuts: of each node its signed distance to the nearest
// one (CutMask::nodeSides) and what springs are left. Which places a cut parts, and how near it is.

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
    /// On which sides of a near cut the corners of a place's cell lie, and whether one of them lost a
    /// connection. \param place lattice units
    int parting(const glm::dvec3& place) const;
    /// How far a place lies from the nearest cut, as CutVertex::away: by the corners of its cell, or else by
    /// the nodes that a vertex follows.
    double away(const glm::dvec3& place, const VertexBinding& bound) const;

    /// How much a place belongs to the cuts near by: 1 in cells that they may go through, 0 about a spacing
    /// farther, without a step between.
    float nearness(const glm::dvec3& place) const;
    /// Does any of these nodes lie on this side (1, -1) of a near cut?
    bool anyOn(const glm::uvec3& nodes, int side) const;

private:
    bool isFar(std::size_t node) const;
    bool isOn(std::size_t node, int side) const;
    const sim::Lattice& lattice_;
    const std::vector<std::uint32_t>& connections_;
    const std::vector<float>& sides_;
};

} // namespace serosa::render
