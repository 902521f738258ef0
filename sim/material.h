#pragma once
// Isotropic tissue on the 18-neighbour lattice: with one spring constant k the springs have the Lame
// constants lambda = mu = k/h, which is Poisson's ratio 1/4 and Young's modulus E = 2.5 k/h. A volumetric
// term (sim/volume_term.h) adds what is missing to the wanted lambda (ARCHITECTURE.md, material law).

namespace serosa::sim {

struct Tissue {
    double young = 5000;         // Pa
    double poisson = 0.25;       // 0.25 (springs alone) to below 0.5 (with the volumetric term)
    double density = 1000;       // kg/m3
    double dampingTime = 0.0005; // s; along springs: c = dampingTime * k
    double airDrag = 0;          // 1/s; of a node's velocity
    bool recovery = false;       // cells below a third of their volume push back (sim/volume_term.h)

    /// Spring constant in N/m for spacing h in m: mu h, and mu = E / (2 (1 + nu)).
    double springConstant(double spacing) const {
        return 0.4 * young * spacing * (1.25 / (1 + poisson)); // exactly 0.4 E h at 1/4
    }
    /// Mass in kg of a node whose eight cells are full.
    double nodeMass(double spacing) const { return density * spacing * spacing * spacing; }
    /// k/m in 1/s2.
    double stiffnessOverMass(double spacing) const { return springConstant(spacing) / nodeMass(spacing); }

    /// (lambda - mu) / mu, not negative: what the volumetric term adds to lambda, in units of k/h.
    double bulkShare() const { return 2 * poisson / (1 - 2 * poisson) - 1; }
    /// Does a step need the volumetric term?
    bool volumetric() const { return poisson > 0.25 || recovery; }
};

} // namespace serosa::sim
