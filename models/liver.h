#pragma once
// The liver phantom, seen from the front: right lobe at -x, diaphragm above, viscera below and behind.

#include "models/solid.h"

namespace serosa::models {

/// Signed distance of the liver's tissue alone: both lobes, without gallbladder, vessels and ligament.
double liverTissueDistance(const Point& p);

/// Signed distance of the gallbladder with its neck and cystic duct.
double gallbladderDistance(const Point& p);

/// Both, with the stumps of portal vein, hepatic artery, bile duct and vena cava, in one solid.
const Solid& liverSolid();
Result<sim::TriangleMesh> makeLiver(std::size_t faces);

} // namespace serosa::models
