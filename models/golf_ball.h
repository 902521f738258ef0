#pragma once
// The golf ball, for the deformations of CS07's figure 3.

#include "models/solid.h"

namespace serosa::models {

constexpr double kGolfBallRadius = 21.35; // mm, between the dimples
constexpr int kDimples = 336;
constexpr double kDimpleRadius = 1.9; // mm, of the rim
constexpr double kDimpleDepth = 0.26; // mm, below the ball's surface

/// Unit vectors to the middles of the dimples.
const std::vector<Point>& dimpleDirections();

const Solid& golfBallSolid();
Result<sim::TriangleMesh> makeGolfBall(std::size_t faces);

} // namespace serosa::models
