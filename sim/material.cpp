// See sim/material.h.
#include "sim/material.h"

#include "base/check.h"
#include "shaders/shared_constants.h"
#include "sim/fibre_springs.h"

#include <algorithm>
#include <cmath>

namespace serosa::sim {

namespace {

std::vector<CurveBreak> breaksOf(const Material& material) {
    std::vector<CurveBreak> breaks;
    double slope = 1; // of the stretch before, in units of the first
    for (std::size_t i = 1; i < material.curve.size(); ++i) {
        const CurvePoint &a = material.curve[i - 1], &b = material.curve[i];
        const double next = (b.stress - a.stress) / (b.strain - a.strain) / material.young;
        breaks.push_back({a.strain, next - slope});
        slope = next;
    }
    if (material.strainLimit > 0)
        breaks.push_back({material.strainLimit, (SRS_LIMIT_STIFFENING - 1) * slope});
    SEROSA_CHECK(breaks.size() <= SRS_CURVE_BREAKS, "a curve of at most SRS_CURVE_BREAKS turns");
    return breaks;
}

} // namespace

double MaterialShares::tensionStrain(double energy) const {
    double strain = std::sqrt(energy); // Newton's method on strain^2 (1 + bend strain) = energy
    for (int i = 0; i < SRS_STRAIN_ITERATIONS; ++i)
        strain -= (strain * strain * (1 + bend * strain) - energy) /
                  std::max(strain * (2 + 3 * bend * strain), 1e-30);
    return strain;
}

double MaterialShares::stiffening(double strain) const {
    if (breaks.empty())
        return 1;
    double factor = 1;
    for (const CurveBreak& turn : breaks)
        if (strain > turn.strain)
            factor += turn.gain * (1 - turn.strain / strain);
    return factor / (1 + 1.5 * bend * strain);
}

double MaterialShares::largestTangent() const {
    double slope = 1, largest = 1;
    for (const CurveBreak& turn : breaks) {
        slope += turn.gain;
        largest = std::max(largest, slope);
    }
    return largest;
}

std::vector<MaterialShares> materialShares(const Tissue& tissue) {
    SEROSA_CHECK(tissue.materialCount() <= SRS_MAX_MATERIALS, "at most SRS_MAX_MATERIALS materials");
    std::vector<MaterialShares> all;
    for (std::size_t i = 0; i < tissue.materialCount(); ++i) {
        const Material& material = tissue.material(i);
        MaterialShares shares;
        // Exactly 1 for material 0.
        shares.stiffness = material.shearModulus() / tissue.shearModulus();
        shares.density = material.density / tissue.density;
        shares.bulk = shares.stiffness * material.bulkShare();
        shares.young = 2 * (1 + material.poisson) * shares.stiffness;
        shares.recovery = tissue.recovery ? SRS_RECOVERY * shares.stiffness : 0;
        shares.dampingTime = material.dampingTime;
        shares.spring.fill(shares.stiffness);
        if (material.fibrous()) {
            const std::array<double, 9> fibres =
                fibreSprings(material.fibre, material.young, material.poisson, material.fibreYoung);
            for (std::size_t p = 0; p < 9; ++p)
                shares.spring[p] += fibres[p] / tissue.shearModulus();
        }
        shares.breaks = breaksOf(material);
        shares.bend = std::max(0.0, SRS_SPRING_BEND(material.poisson));
        all.push_back(shares);
    }
    return all;
}

} // namespace serosa::sim
