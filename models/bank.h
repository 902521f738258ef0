#pragma once
// The piggy bank that CSC06 peels and cuts (figures 1 and 4): a hollow pig of glazed earthenware.

#include "models/solid.h"

namespace serosa::models {

constexpr double kBankWall = 4.0; // mm, wherever nothing is put onto the body

/// Signed distance: negative in the earthenware, positive in the cavity, which the coin slot opens.
double bankDistance(const Point& p);

/// Signed distance of the cavity, negative inside it, as if the slot were shut.
double bankCavityDistance(const Point& p);

/// A hollow pig, head towards -x. One shell: the slot joins the outside and the cavity.
const Solid& bankSolid();
Result<sim::TriangleMesh> makeBank(std::size_t faces);

} // namespace serosa::models
