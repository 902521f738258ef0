#pragma once
// The picture of an error on an organ's surface, with a bar that says which colour is how much.

#include "base/result.h"
#include "render/image.h"
#include "sim/lattice.h"
#include "sim/triangle_mesh.h"

#include <string>
#include <vector>

namespace serosa::app {

/// \param surface m, closed. \param shares of each vertex, 0 to 1 of `most`; negative: grey, not compared.
/// \param barText of the bar, ASCII; its ends say 0 and `most` in percent. Needs a current GL context.
Result<render::Image> errorPicture(const sim::TriangleMesh& surface, const sim::Lattice& lattice,
                                   const std::vector<double>& shares, double most,
                                   const std::string& barText);

} // namespace serosa::app
