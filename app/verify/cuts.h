#pragma once
// Parts of the group `cuts` of `serosa verify` (app/verify/cuts.cpp).

#include "app/verify/verify.h"

namespace serosa::app {

/// All solvers with a probe and a cut: against the reference, again, and from a snapshot.
Status verifyAgreement(const VerifyOptions& options, CheckList& checks); // app/verify/agreement.cpp

} // namespace serosa::app
