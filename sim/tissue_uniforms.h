#pragma once
// What an organ's tissue tells every program that works on it: the defines that ask for parts of the law, and
// the values of each material as uniform arrays, one material after another.

#include "gpu/program.h"
#include "sim/material.h"

#include <vector>

namespace serosa::sim {

/// SRS_MATERIALS, and where the tissue asks for it SRS_DAMPING, SRS_OWN_DAMPERS, SRS_CELL_PASS with
/// SRS_VOLUME and SRS_STIFFENING.
std::vector<gpu::ShaderDefine> tissueDefines(const Tissue& tissue);

/// Units as MaterialShares has them.
struct MaterialArrays {
    std::vector<float> springs, densities,
        dampingTimes; // nine springs a material; damping over the time step
    std::vector<float> bulks, recoveries;
    std::vector<float> youngs, bends, breakStrains, breakGains; // SRS_CURVE_BREAKS turns a material

    MaterialArrays(const Tissue& tissue, double timeStep);
    /// u_bulks, u_recoveries
    void setVolume(gpu::Program& program) const;
    /// u_youngs, u_bends, u_breakStrains, u_breakGains
    void setCurves(gpu::Program& program) const;
};

} // namespace serosa::sim
