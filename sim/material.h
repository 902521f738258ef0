#pragma once
// Tissue on the 18-neighbour lattice. With one spring constant k the springs have the Lame constants
// lambda = mu = k/h, which is Poisson's ratio 1/4 and Young's modulus E = 2.5 k/h. A volumetric term
// (sim/volume_term.h) adds what is missing to the wanted lambda (ARCHITECTURE.md, material law).
//
// An organ has one or several materials; each cell carries the index of its own. Material 0 is the tissue
// itself, whose spring constant and density are the units of the state's law (sim/solver.h); the others are
// given in shares of these (MaterialShares).

#include <glm/glm.hpp>

#include <array>
#include <string>
#include <vector>

namespace serosa::sim {

/// A point of a tension curve: nominal stress (force over the area at rest) at a nominal strain.
struct CurvePoint {
    double strain = 0; // 1; above 0
    double stress = 0; // Pa; above 0
};

/// What one cell is made of. Isotropic unless it has fibres, linear unless it has a curve or a strain limit.
struct Material {
    std::string name;            // empty for the organ's tissue
    double young = 5000;         // Pa; of the curve's first stretch, across the fibres
    double poisson = 0.25;       // 0.25 (springs alone) to below 0.5 (with the volumetric term)
    double density = 1000;       // kg/m3
    double dampingTime = 0.0005; // s; along springs: c = dampingTime * k

    /// Stress over strain under tension, straight between points and beyond the last, from (0, 0): the first
    /// point lies on young. Strains and stresses rise. Empty: a straight line. How it holds for deformations
    /// other than tension: sim/stiffening.h.
    std::vector<CurvePoint> curve;
    double strainLimit = 0; // from this strain on SRS_LIMIT_STIFFENING times as stiff; 0: none

    glm::dvec3 fibre{0};   // direction, any length; 0: no fibres
    double fibreYoung = 0; // Pa, along the fibres; at least young (how near the springs come:
                           // sim/fibre_springs.h)

    /// mu = E / (2 (1 + nu)), Pa.
    double shearModulus() const {
        return 0.4 * young * (1.25 / (1 + poisson)); // exactly 0.4 E at 1/4
    }
    /// Spring constant in N/m for spacing h in m: mu h.
    double springConstant(double spacing) const { return shearModulus() * spacing; }
    /// (lambda - mu) / mu, not negative: what the volumetric term adds to lambda, in units of k/h.
    double bulkShare() const { return 2 * poisson / (1 - 2 * poisson) - 1; }
    bool stiffens() const { return !curve.empty() || strainLimit > 0; }
    bool fibrous() const { return fibreYoung > young && fibre != glm::dvec3(0); }
};

/// Of a whole organ. As a Material it is the one of the cells that no region gives another.
struct Tissue : Material {
    double airDrag = 0;           // 1/s; of a node's velocity
    bool recovery = false;        // cells below 40% of their volume push back (sim/volume_term.h)
    std::vector<Material> others; // materials 1, 2, ...; at most SRS_MAX_MATERIALS - 1

    std::size_t materialCount() const { return 1 + others.size(); }
    const Material& material(std::size_t index) const { return index == 0 ? *this : others[index - 1]; }

    /// Mass in kg of a node whose eight cells are full of material 0.
    double nodeMass(double spacing) const { return density * spacing * spacing * spacing; }
    /// k/m in 1/s2, of material 0.
    double stiffnessOverMass(double spacing) const { return springConstant(spacing) / nodeMass(spacing); }

    /// Does a step need the volumetric term?
    bool volumetric() const {
        return recovery || any([](const Material& m) { return m.poisson > 0.25; });
    }
    /// Does any material have a curve or a strain limit?
    bool stiffens() const {
        return any([](const Material& m) { return m.stiffens(); });
    }
    bool fibrous() const {
        return any([](const Material& m) { return m.fibrous(); });
    }
    /// Does a step need a pass over the cells?
    bool needsCellPass() const { return volumetric() || stiffens(); }
    /// Damping along springs anywhere?
    bool damped() const {
        return any([](const Material& m) { return m.dampingTime > 0; });
    }
    /// Do damping times differ between materials?
    bool dampingVaries() const {
        return any([this](const Material& m) { return m.dampingTime != dampingTime; });
    }
    /// Is damping no one multiple of the springs' weights? Stiffened springs keep the damping of their rest.
    bool ownDampers() const { return damped() && (stiffens() || dampingVaries()); }

private:
    template <class Predicate>
    bool any(Predicate predicate) const {
        for (std::size_t i = 0; i < materialCount(); ++i)
            if (predicate(material(i)))
                return true;
        return false;
    }
};

/// Where a stress-strain curve turns: its slope grows by `gain` (in units of its first slope) at `strain`.
struct CurveBreak {
    double strain = 0, gain = 0;
};

/// One material in units of material 0: spring constant k, density, Pa as k/h.
struct MaterialShares {
    double stiffness = 1;           // k_m / k
    std::array<double, 9> spring{}; // constant of the springs along direction pair d/2, fibres included
    double density = 1;             // rho_m / rho
    double bulk = 0;                // (lambda_m - mu_m) h / k
    double young = 2.5;             // E_m h / k
    double recovery = 0;            // of collapsed cells, k/h (sim/volume_term.h)
    double dampingTime = 0;         // s
    std::vector<CurveBreak> breaks; // rising strains; at most SRS_CURVE_BREAKS

    double bend = 0; // of the springs' own curve: SRS_SPRING_BEND by Poisson's ratio (sim/stiffening.h)

    /// The tension strain at which springs without a curve store `energy`, in units of E/2 of the material.
    double tensionStrain(double energy) const;
    /// How many times as stiff as without a curve at that strain: 1 where there is none.
    double stiffening(double strain) const;
    /// Largest tangent of the curve over its first slope: no deformation is stiffer.
    double largestTangent() const;
};

/// One a material, material 0 first.
std::vector<MaterialShares> materialShares(const Tissue& tissue);

} // namespace serosa::sim
