#pragma once
// Which basis a vertex takes: the constant one of its triangle (MS05 eq. 6), the one corrected by the nodes'
// normals (eq. 8), or a share of both. MS05 3.5 says where eq. 3's normals are no normals (one-node-thin
// sheets), and where the correction is not needed; 3.6 proposes the choice per vertex.

#include "render/control_nodes.h"
#include "sim/lattice.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace serosa::render {

/// Eq. 3 at rest, with the connections that are left, as the GPU has it, and how well it is defined.
class RestNormals {
public:
    /// \param connections 18 bits a node; empty: those of the lattice
    explicit RestNormals(const sim::Lattice& lattice, const std::vector<std::uint32_t>& connections = {});
    /// Of any nodes. Where normals are those of triangles, the length says how far these agree: 3.8 if all
    /// do.
    explicit RestNormals(const ControlNodes& nodes);

    /// Unit, as packed.
    const glm::dvec3& normal(std::uint32_t node) const { return normals_[node]; }
    /// Length of eq. 3's sum: 3.8 on a flat face, 0 in a sheet of one node.
    double length(std::uint32_t node) const { return lengths_[node]; }
    /// Did a cut take connections from it? Its normal turns towards the cut then.
    bool isCut(std::uint32_t node) const { return !cut_.empty() && cut_[node]; }
    /// How well its normal is defined, 0 to 1: by the length, and not at all where it is cut.
    double trust(std::uint32_t node) const;

private:
    std::vector<glm::dvec3> normals_;
    std::vector<double> lengths_;
    std::vector<bool> cut_;
};

/// What a vertex is bound to, at rest in lattice units.
struct BoundPoint {
    glm::uvec3 nodes;
    glm::dvec3 corners[3]; // the nodes' positions
    glm::dvec3 weights;    // of eq. 4
    glm::dvec3 vertex;
    glm::dvec3 counts{1}; // how much each node's normal counts

    glm::dvec3 reference() const {
        return weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2];
    }
    /// Eq. 8's N_c before it is normalized.
    glm::dvec3 mean(const RestNormals& rest) const {
        const glm::dvec3 w = weights * counts;
        return w.x * rest.normal(nodes.x) + w.y * rest.normal(nodes.y) + w.z * rest.normal(nodes.z);
    }
};

/// Mapping `curvature`: may the vertex take the corrected basis? It must be well defined: no node is cut,
/// every eq. 3 sums to 0.5 at least, N_c is not shorter than 0.35 (normals that oppose), nor within 0.3
/// (sine) of the first edge.
bool correctedIsDefined(const RestNormals& rest, const BoundPoint& point);

/// Mapping `chosen`: the share of the corrected basis, 0 to 1, without a jump over the surface. 0 near nodes
/// whose normal is not well defined or that are cut, where normals oppose, and where the correction is
/// not needed: offsets short against the spacing (docs/methods/mappings.md has the measurement).
/// \param point its counts are the trust in each node
double correctedShare(const RestNormals& rest, const BoundPoint& point);

} // namespace serosa::render
