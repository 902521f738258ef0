// The rest state that cuts and textures ask of a vertex (render/surface_vertices.h: RestVertex).
#include "shared_constants.h"
layout(location = 7) in vec4 a_rest; // position at rest in its box; w: RestVertex::side, in 1/65535
layout(location = 8) in uvec2 a_frame; // rest normal in lattice axes; a tangent to it, in the basis; packed

/// RestVertex::side. Until a cut is shown the attribute is not given, and (0, 0, 0, 1) as GL has it: no side.
int restSide() {
    int side = int(round(a_rest.w * 65535.0));
    return side == 65535 ? 3 * int(0.5 * SRS_AWAY_STEPS) + 1 : side;
}

/// Of a cut that the vertex follows: -1, 1; 0: both.
float vertexSide() {
    return float(restSide() % 3) - 1.0;
}

/// How far the vertex lies from the nearest cut by its nodes, spacings; the sign is the side.
float vertexAway() {
    return float(restSide() / 3) * (2.0 * SRS_MASK_SIDES / SRS_AWAY_STEPS) - SRS_MASK_SIDES;
}
