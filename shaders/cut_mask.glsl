// What a fragment asks of the mask that strokes left in rest space (render/cut_mask.h).
#include "shared_constants.h"

uniform sampler3D t_cutMask; // a: 1 kept, 0 cut; b: distance to the nearest cut over SRS_MASK_REACH; g: the same with its side
uniform vec3 u_maskFrom, u_maskScale; // texture coordinate = scale * (rest - from)

vec4 cutMask(vec3 rest) {
    return texture(t_cutMask, u_maskScale * (rest - u_maskFrom));
}

/// \param side of the cut that the triangle follows: 1, -1; 0: both
bool isCut(vec4 mask, float side) {
    return mask.a < 0.5 || (mask.g - 0.5) * side < 0.0;
}
