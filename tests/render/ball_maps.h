#pragma once
// A map of each kind, on a box around a ball of 40 mm.

#include "render/deformation_map.h"

namespace serosa::render {

inline DeformationMap ballMap(MapKind kind) {
    DeformationMap map;
    map.kind = kind;
    map.half = glm::dvec3(0.055);
    map.amount = kind == MapKind::twist || kind == MapKind::bend ? 0.9
                 : kind == MapKind::peel                         ? -0.01
                 : kind == MapKind::pull                         ? 0.04
                                                                 : 0.008;
    map.radius = kind == MapKind::peel ? 0.035 : 0.015;
    map.extent = kind == MapKind::wave ? 0.04 : 0.07;
    map.depth = kind == MapKind::peel ? 0.08 : 0.06;
    map.width = 0.06;
    return map;
}

} // namespace serosa::render
