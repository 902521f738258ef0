#pragma once
// Parts of the group `materials` of `serosa verify` (app/verify/materials.cpp).

#include "app/organ_setup.h"
#include "app/verify/verify.h"
#include "sim/material.h"

#include <string>

namespace serosa::app {

/// With the fault that `--inject stiffness` asks for.
inline sim::Tissue tissueOf(const VerifyOptions& options, double poisson, double young = 5000,
                            double density = 1000) {
    sim::Tissue tissue;
    tissue.poisson = poisson;
    tissue.young = young;
    tissue.density = density;
    if (options.inject.fault == Fault::stiffness)
        tissue.young *= options.inject.factor;
    return tissue;
}

inline std::string nameOf(double poisson) {
    return "nu " + shortNumber(poisson);
}

/// Two materials in one beam, fibres, stiffening.
Status verifyComposites(const VerifyOptions& options, CheckList& checks); // app/verify/composites.cpp
/// Forces on tools, in newtons: bars pulled by forceps, layers indented by a sphere.
Status verifyToolForces(const VerifyOptions& options, CheckList& checks); // app/verify/tool_forces.cpp
/// Volume of what two large spheres squeeze at Poisson's ratio 0.49.
Status verifySqueeze(const VerifyOptions& options, CheckList& checks); // app/verify/squeeze.cpp

} // namespace serosa::app
