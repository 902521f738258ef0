#pragma once
// Node frames: a rotation a node, from what its neighbours' positions say of the deformation there. Goes
// beyond MS05, whose corrected basis (eq. 8) interpolates the normal but keeps each triangle's tangent, so
// that neighbours across an edge part.
//
// F = sum_j (x_j - x_i) g_j^T is the least-squares deformation gradient over the up to 18 neighbours that a
// node is joined to; its rotation R maximizes tr(R^T F). Exact at rest, under rigid motion and under even
// stretch, where F is the stretch whatever neighbours there are. Twin of shaders/node_frames.comp.

#include "render/control_nodes.h"
#include "sim/lattice.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cstdint>
#include <vector>

namespace serosa::render {

/// A rotation in 64 bits, within 4e-6 rad (shaders/packed_frame.glsl).
glm::uvec2 packFrame(const glm::dquat& rotation);
glm::dquat unpackFrame(const glm::uvec2& bits);

/// The rotation nearest to F, also where F is flat or inverted; no turn where F is 0.
glm::dquat rotationOf(const glm::dmat3& f);

/// What F is summed from.
struct FrameStencil {
    struct Row {
        std::uint32_t node;         // that has this frame
        std::uint32_t centre;       // x_i: the node itself, or the one whose frame it takes
        std::uint32_t begin, count; // of its terms; count 0: no turn
    };
    struct Term {
        std::uint32_t node; // x_j
        glm::vec3 gradient; // g_j, 1 / lattice unit
    };
    std::vector<Row> rows; // one a node of the triangles, rising
    std::vector<Term> terms;
    std::size_t nodes = 0; // of all
};

/// Neighbours in a plane (one-node-thin sheets) still give a rotation: that of the plane. A node whose
/// neighbours lie on a line, or that a cut left without any, takes the frame of the nearest node at rest that
/// has one (the lowest index of several).
/// \param connections 18 bits a node, what cuts left of the lattice's; empty: all of them
FrameStencil frameStencil(const sim::Lattice& lattice, const std::vector<std::uint32_t>& connections = {});

/// Of any nodes: neighbours are those that it says, each node takes its own frame (none where they lie on a
/// line). A surface's nodes follow the plane of their neighbours.
FrameStencil frameStencil(const ControlNodes& nodes);

/// Packed frames, one a node; nodes without a row are not turned.
/// \param positions of all nodes, lattice units
std::vector<glm::uvec2> nodeFrames(const FrameStencil& stencil, const std::vector<glm::dvec3>& positions);

/// The rotation of a point of a triangle: the three with its weights, each on the side of the heaviest.
glm::dquat blendFrames(const glm::dquat& a, const glm::dquat& b, const glm::dquat& c,
                       const glm::dvec3& weights);

} // namespace serosa::render
