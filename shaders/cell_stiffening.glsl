// A cell's energy and its factor of stiffening: twin of Stiffening::factors (sim/stiffening.h). Included by
// cell_terms.glsl where SRS_STIFFENING is defined.
uniform float u_springs[SRS_MATERIALS * 9]; // MaterialShares::spring, by material and direction pair
uniform float u_youngs[SRS_MATERIALS];          // E h / k
uniform float u_bends[SRS_MATERIALS];           // MaterialShares::bend
// Turns of the stress-strain curves, SRS_CURVE_BREAKS a material: strains, and what the slope gains there (0: none).
uniform float u_breakStrains[SRS_MATERIALS * SRS_CURVE_BREAKS];
uniform float u_breakGains[SRS_MATERIALS * SRS_CURVE_BREAKS];

/// Energy of one spring's share of the cell in units of k h^2 / 8; an edge has f k/4, a diagonal (rest2 = 2) f k/2.
float springTerm(uint bits, int d, vec3 a, vec3 b, float rest2) {
    vec3 apart = a - b;
    // sqrt(q) - 1, without the loss of digits near 1
    float q = dot(apart, apart) / rest2, stretch = (q - 1.0) / (sqrt(q) + 1.0);
    return float((bits >> d) & 1u) * rest2 * rest2 * stretch * stretch;
}

/// Of the cell's springs that are left, over its fill, in units of k h^2. \param bits of each corner's connections
/// inside the cell.
float springEnergy(uint material, uint bits[8], vec3 p[8]) {
    float energy = 0.0;
    int first = int(material) * 9;
#define SPRING(pair, d, from, to, rest2)                                                                               \
    energy += u_springs[first + pair] * springTerm(bits[from], d, p[from], p[to], rest2);
    SPRING(0, 0, 0, 1, 1.0) SPRING(0, 0, 2, 3, 1.0) SPRING(0, 0, 4, 5, 1.0) SPRING(0, 0, 6, 7, 1.0)
    SPRING(1, 2, 0, 2, 1.0) SPRING(1, 2, 1, 3, 1.0) SPRING(1, 2, 4, 6, 1.0) SPRING(1, 2, 5, 7, 1.0)
    SPRING(2, 4, 0, 4, 1.0) SPRING(2, 4, 1, 5, 1.0) SPRING(2, 4, 2, 6, 1.0) SPRING(2, 4, 3, 7, 1.0)
    SPRING(3, 6, 0, 3, 2.0) SPRING(3, 6, 4, 7, 2.0)
    SPRING(4, 8, 2, 1, 2.0) SPRING(4, 8, 6, 5, 2.0)
    SPRING(5, 10, 0, 5, 2.0) SPRING(5, 10, 2, 7, 2.0)
    SPRING(6, 12, 4, 1, 2.0) SPRING(6, 12, 6, 3, 2.0)
    SPRING(7, 14, 0, 6, 2.0) SPRING(7, 14, 1, 7, 2.0)
    SPRING(8, 16, 4, 2, 2.0) SPRING(8, 16, 5, 3, 2.0)
#undef SPRING
    return 0.125 * energy;
}

bool hasCurve(uint material) { return u_breakGains[int(material) * SRS_CURVE_BREAKS] != 0.0; }

/// The tension strain at which springs alone store that. \param energy of the cell over its fill, in units of k h^2
float tensionStrain(uint material, float energy) {
    energy *= 2.0 / u_youngs[material];
    float strain = sqrt(energy), bend = u_bends[material];
    for (int i = 0; i < SRS_STRAIN_ITERATIONS; ++i) // MaterialShares::tensionStrain
        strain -= (strain * strain * (1.0 + bend * strain) - energy) / max(strain * (2.0 + 3.0 * bend * strain), 1e-30);
    return strain;
}

/// Stress of the material's curve over that of the springs alone.
float stiffeningAt(uint material, float strain) {
    float factor = 1.0;
    for (int i = 0; i < SRS_CURVE_BREAKS; ++i) {
        int at = int(material) * SRS_CURVE_BREAKS + i;
        if (strain > u_breakStrains[at])
            factor += u_breakGains[at] * (1.0 - u_breakStrains[at] / max(strain, 1e-20));
    }
    return factor / (1.0 + 1.5 * u_bends[material] * strain);
}

/// Slope of the curve over its first one.
float tangentAt(uint material, float strain) {
    float tangent = 1.0;
    for (int i = 0; i < SRS_CURVE_BREAKS; ++i) {
        int at = int(material) * SRS_CURVE_BREAKS + i;
        if (strain > u_breakStrains[at])
            tangent += u_breakGains[at];
    }
    return tangent;
}

/// \param energy of the cell over its fill, in units of k h^2
float stiffening(uint material, float energy) { return stiffeningAt(material, tensionStrain(material, energy)); }

/// What a cell stores in all, over its fill, in units of k h^2 (Stiffening::energy). \param energy as above
float stiffenedEnergy(uint material, float energy) {
    if (!hasCurve(material))
        return energy;
    float strain = tensionStrain(material, energy), psi = 0.5 * strain * strain;
    for (int i = 0; i < SRS_CURVE_BREAKS; ++i) {
        int at = int(material) * SRS_CURVE_BREAKS + i;
        float beyond = max(0.0, strain - u_breakStrains[at]);
        psi += 0.5 * u_breakGains[at] * beyond * beyond;
    }
    return u_youngs[material] * psi;
}
