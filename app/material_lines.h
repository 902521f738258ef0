#pragma once
// What a lattice made of an organ's materials, for people: lines of text, notes, colours for the picture.

#include "sim/lattice.h"
#include "sim/scene.h"
#include "sim/triangle_mesh.h"

#include <string>
#include <vector>

namespace serosa::app {

/// "tissue", or the material's own name.
std::string materialName(const sim::Organ& organ, std::size_t material);

/// Has the organ one linear, isotropic tissue, so that there is nothing to say?
bool plainTissue(const sim::Organ& organ);

struct MaterialLine {
    std::string name, text; // "capsule"; "young 400 kPa, poisson 0.45, 1,234 cells, 56.7 ml, 59.8 g; ..."
};
/// One a material.
std::vector<MaterialLine> materialLines(const sim::Organ& organ, const sim::Lattice& lattice);

/// What a user might not expect: a layer that is thinner than a cell, a material that later regions
/// overwrote.
std::vector<std::string> materialNotes(const sim::Organ& organ, const sim::Lattice& lattice);

/// A colour a vertex: of the material of the cell that it lies in, else of the one whose centre is nearest.
/// \param metres the surface that the lattice was built from, m.
std::vector<glm::u8vec3> materialColours(const sim::Lattice& lattice, const sim::TriangleMesh& metres);

} // namespace serosa::app
