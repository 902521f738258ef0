#pragma once
// A patch of skin on its muscle, 80 x 80 mm and 20 mm thick, with its layers told by their colour on the
// sides. The layers are functions of the place, so that volumes and materials can use them.

#include "models/solid.h"

namespace serosa::models {

enum class SkinLayer { epidermis, dermis, fat, muscle };
const char* skinLayerName(SkinLayer layer);

constexpr double kSkinSide = 80, kSkinThickness = 20; // mm; thickness in the middle
constexpr double kSkinBottom = -10;                   // y of the flat bottom, mm

/// Height of the skin's surface above (x, z), mm: a gentle dome with fine furrows.
double skinTop(double x, double z);

/// Depth under the surface above (x, z), mm, at which `layer` ends and the next begins; for muscle, the
/// bottom. Epidermis ends at 1.2, dermis at 4.5, fat at 12.5 on average (the epidermis is drawn ten times as
/// thick as it is, to be seen).
double skinInterface(SkinLayer layer, double x, double z);

/// The layer at p, which is taken for a point of the patch.
SkinLayer skinLayerAt(const Point& p);

const Solid& skinSolid();
Result<sim::TriangleMesh> makeSkin(std::size_t faces);

} // namespace serosa::models
