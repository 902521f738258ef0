#pragma once
// Isotropic tissue on the 18-neighbour lattice: with one spring constant k the lattice has the Lame constants
// lambda = mu = k/h, Poisson's ratio 1/4 and Young's modulus E = 2.5 k/h (ARCHITECTURE.md, material law).

namespace serosa::sim {

struct Tissue {
    double young = 5000;         // Pa
    double poisson = 0.25;       // what the springs alone give; other values need the volumetric term
    double density = 1000;       // kg/m3
    double dampingTime = 0.0005; // s; along springs: c = dampingTime * k
    double airDrag = 0;          // 1/s; of a node's velocity

    /// Spring constant in N/m for spacing h in m.
    double springConstant(double spacing) const { return 0.4 * young * spacing; }
    /// Mass in kg of a node whose eight cells are full.
    double nodeMass(double spacing) const { return density * spacing * spacing * spacing; }
    /// k/m in 1/s2.
    double stiffnessOverMass(double spacing) const { return springConstant(spacing) / nodeMass(spacing); }
};

} // namespace serosa::sim
