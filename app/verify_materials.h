#pragma once
// The parts of group `materials`, one a file.

#include "app/verify.h"
#include "sim/material.h"

namespace serosa::app {

/// 5 kPa or as given, stiffer by what `--inject stiffness` says.
sim::Tissue verifiedTissue(const VerifyOptions& options, double poisson, double young = 5000);

/// Two materials in one beam, fibres, stiffening (app/verify_composites.cpp).
Status verifyComposites(const VerifyOptions& options, CheckList& checks);

} // namespace serosa::app
