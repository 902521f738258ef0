// The rest state that cuts and textures ask of a vertex (render/surface_vertices.h: RestVertex).
#include "shared_constants.h"
layout(location = 7) in vec4 a_rest; // position at rest in its box; w: RestVertex::side, in 1/65535

/// Of a cut that the vertex follows: -1, 1; 0: both.
float vertexSide() {
    return float(int(round(a_rest.w * 65535.0)) % 3) - 1.0;
}

/// How far the vertex lies from the nearest cut by its nodes, spacings; the sign is the side.
float vertexAway() {
    return float(int(round(a_rest.w * 65535.0)) / 3) * (2.0 * SRS_MASK_SIDES / SRS_AWAY_STEPS) - SRS_MASK_SIDES;
}
