#pragma once
// What a solver's own tools measure on a test piece, in newtons: a bonded layer indented by a sphere, beside
// what theory says, and a bar pulled by forceps.

#include "app/verify/elastic_measures.h"

#include <functional>
#include <memory>

namespace serosa::app {

using SolverMaker = std::function<Result<std::unique_ptr<sim::Solver>>(const sim::SolverSetup&)>;

/// Force of a rigid, frictionless sphere pressed into an elastic layer that is bonded to a rigid base: Hertz
/// times the finite-layer correction of Dimitriadis et al. 2002, in chi = sqrt(radius depth) / thickness.
/// \param radius, depth, thickness m. Returns N.
double layerForce(const sim::Tissue& tissue, double radius, double depth, double thickness);

/// Lengths in spacings of the lattice.
struct Indentation {
    double radius = 20, depth = 0.8; // of the sphere; how far it goes below the surface
    double thickness = 16, width = 40;
    glm::dmat3 turn{1}; // columns: the two directions along the layer and the one out of it
    double contactRadius() const;
};

struct IndentationForce {
    double normal = 0;     // N, on the layer, into it
    double tangential = 0; // N, along the layer
    double change = 0;     // share by which the force changed over the last tenth of the hold
    std::size_t nodes = 0;
};

/// Presses slowly, holds until all is at rest, and takes the tool's impulse over time. Errors: of `make`.
Result<IndentationForce> measureIndentation(const Indentation& piece, const sim::Tissue& tissue,
                                            double spacing, const SolverMaker& make);

/// Young's modulus, Pa: one end of the beam is fixed, forceps pull the other by `strain` of its length; force
/// over area and the strain of the middle third, at rest. Errors: of `make`.
Result<double> measurePulledBar(const Beam& beam, const sim::Tissue& tissue, double strain,
                                const SolverMaker& make);

} // namespace serosa::app
