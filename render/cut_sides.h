#pragma once
// Sides of a cut, by what connections it left: which nodes still belong together, and which triangle a vertex
// follows once its own is cut through.

#include "render/surface_binding.h"
#include "sim/lattice.h"
#include "sim/triangle_tree.h"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace serosa::render {

class CutSides {
public:
    /// Both outlive this. \param connections 18 bits a node
    CutSides(const sim::Lattice& lattice, const std::vector<std::uint32_t>& connections);

    /// Does the cut reach within two springs of the node?
    bool isNear(std::uint32_t node) const { return near_[node]; }
    /// Is the node joined to nothing any more?
    bool isLoose(std::uint32_t node) const { return connections_[node] == 0; }
    /// Were two nodes joined before the cut, and are they no longer?
    bool parted(std::uint32_t a, std::uint32_t b) const;
    /// Are no two of a triangle's nodes parted?
    bool isWhole(const glm::uvec3& nodes) const;
    /// Are two nodes joined through at most four springs that are left? Around the end of a cut, where it
    /// gapes little, its sides are.
    bool together(std::uint32_t a, std::uint32_t b);
    /// Are all of a triangle's nodes joined to something, and no two of them parted?
    bool isHeld(const glm::uvec3& nodes) const;
    /// Has each of a triangle's nodes half of its springs left? Others hang on strands.
    bool isFirm(const glm::uvec3& nodes) const;
    /// The node with the largest weight, of those that are joined to anything.
    std::optional<std::uint32_t> nearestHeld(const VertexBinding& bound) const;
    /// Were two nodes together before the cut, and are they no longer? The corners of a face that is larger
    /// than four springs never were.
    bool separated(std::uint32_t a, std::uint32_t b);

private:
    /// By node: those within four springs of it, sorted.
    using Around = std::map<std::uint32_t, std::vector<std::uint32_t>>;
    bool joined(Around& around, const std::vector<std::uint32_t>& connections, std::uint32_t a,
                std::uint32_t b) const;

    const sim::Lattice& lattice_;
    const std::vector<std::uint32_t>& connections_;
    std::vector<bool> near_;
    Around around_, aroundBefore_;
};

/// The boundary's triangles, to follow another one on the same side. Built when first asked.
class WholeTriangles {
public:
    /// Both outlive this.
    WholeTriangles(const sim::Lattice& lattice, CutSides& sides);
    /// The closest whole triangle within three spacings that faces as `before` does and goes with a node;
    /// kNone where there is none. With `firm`, of firm nodes alone. \param place lattice units
    sim::TriangleTree::Closest closest(const glm::dvec3& place, std::uint32_t before, std::uint32_t node,
                                       bool firm = false);
    const ControlNodes& nodes() const { return nodes_; }

private:
    glm::dvec3 normalOf(std::uint32_t triangle) const;

    const sim::Lattice& lattice_;
    CutSides& sides_;
    ControlNodes nodes_;
    std::optional<sim::TriangleTree> tree_;
};

/// Vertices whose triangle is cut through follow from now on the closest whole triangle that faces the same
/// way and goes with the node which they lay nearest to: triangle, nodes and weights; all else is to be
/// expressed anew. Where there is none within three spacings they stay as they are (and their faces are not
/// drawn: render/cut_faces.h). \param positions of the vertices at rest, lattice units
void followOwnSides(SurfaceBinding& binding, const sim::Lattice& lattice,
                    const std::vector<glm::dvec3>& positions, CutSides& sides);

} // namespace serosa::render
