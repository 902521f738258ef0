#pragma once
// The coins in CSC06's piggy bank (figure 1): a heap, fused into one solid where the coins touch.

#include "models/solid.h"

#include <vector>

namespace serosa::models {

constexpr double kCoinRadius = 13.0, kCoinThickness = 3.0; // mm

struct Coin {
    Point at, axis; // middle, unit normal of the side that shows
    int metal;      // 0 gold, 1 silver, 2 copper
};

/// Where each coin lies, in the frame of makePhantom("bank"): each was put where its middle comes lowest
/// without cutting deeper than a little into the coins before it or into the bank.
const std::vector<Coin>& coinHeap();

/// Signed distance of the heap, in the frame of makePhantom("bank").
double coinsDistance(const Point& p);

/// One solid of many handles (each ring of touching coins is one).
const Solid& coinsSolid();
Result<sim::TriangleMesh> makeCoins(std::size_t faces);

} // namespace serosa::models
