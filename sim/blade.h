#pragma once
// What a stroke cuts. A blade is an edge; between two poses it sweeps the bilinear patch
//   S(u, v) = (1-v) ((1-u) a0 + u b0) + v ((1-u) a1 + u b1),  u along the edge, v along the sweep,
// planar or twisted, and a spring that touches the patch is cut. Cauterizing cuts what touches a ball,
// tearing what is stretched beyond a limit.
//
// A blade meets the organ as it lies now, so the decision is about current positions, as float32 in lattice
// units: the numbers that the state textures hold. It is made in double from a spring's ends ordered by node
// index, with additions, subtractions and multiplications only, so that both ends, the CPU and the GPU
// (shaders/blade.glsl) decide the same from the same positions.
//
// A spring is kept only where a plane is found that separates it from the patch by more than all rounding:
// the patch is halved along v into strips until that is so for each, or until a strip is flat within
// kStripTolerance, or after kMostStripTests. What is not shown to be apart is crossed: ties count as crossed,
// and no spring that crosses is ever kept.

#include "sim/lattice.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace serosa::sim {

enum class StrokeKind { blade, cauterize, tear };

/// One motion of a cutting tool, in metres, world.
struct Stroke {
    StrokeKind kind = StrokeKind::blade;
    std::array<glm::dvec3, 2>
        from{}; // blade: the edge's ends at the start; cauterize: [0] is the ball's centre
    std::array<glm::dvec3, 2> to{}; // blade: the same ends when the sweep is over
    double radius = 0;              // cauterize, m
    double strain = 0;              // tear: springs longer than (1 + strain) times their rest length
    bool continues = false;         // a part of the stroke before it: both are undone together
};

/// A stroke in one lattice's units, rounded to float32: what CPU and GPU decide from.
struct LatticeStroke {
    StrokeKind kind = StrokeKind::blade;
    std::array<glm::vec3, 4> corners{}; // a0, b0, a1, b1
    float size = 0;                     // radius, or (1 + strain)^2
};
LatticeStroke toLattice(const Stroke& stroke, const Lattice& lattice);

/// Whether a stroke cuts the spring between two positions (lattice units), the end with the lower node index
/// first. \param rest2 square of its rest length: 1 or 2.
bool strokeCuts(const LatticeStroke& stroke, const glm::vec3& lower, const glm::vec3& higher, int rest2);

/// Whether direction d (sim/lattice.h) leads to a node with a higher index.
bool leadsToHigherIndex(int d);

/// Clears the bits of all springs that the stroke cuts, at both ends. \param positions and \param connections
/// one a node. Returns the bits that it cleared, one word a node.
std::vector<std::uint32_t> cutConnections(const Lattice& lattice, const std::vector<glm::dvec3>& positions,
                                          const LatticeStroke& stroke,
                                          std::vector<std::uint32_t>& connections);

} // namespace serosa::sim
