// What a fragment asks of the mask that strokes left in rest space (render/cut_mask.h).
#include "shared_constants.h"

uniform sampler3D t_cutMask; // a: 1 kept, 0 cut; b: distance to the nearest cut over SRS_MASK_REACH; g: the same with its side, r: that finer
uniform vec3 u_maskFrom, u_maskScale; // texture coordinate = scale * (rest - from)

vec4 cutMask(vec3 rest) {
    return texture(t_cutMask, u_maskScale * (rest - u_maskFrom));
}

/// \param side of the cut that the triangle follows: 1, -1; 0: both. \param away from the cut by the nodes (vertexAway): where
/// that is far, it decides: voxels beside the lattice's cells know no side.
bool isCut(vec4 mask, float side, float away) {
    float own = abs(away) > SRS_MASK_SURE ? away : mask.b < 0.5 + 0.5 * SRS_MASK_PAINTED ? mask.g - 0.5 : 0.0;
    return mask.a < 0.5 || own * side < 0.0;
}

/// Of the nearest cut, spacings: positive on its one side, negative on the other. Only where a cut is near.
float sideOf(vec4 mask) {
    return ((256.0 * mask.g + mask.r) * (255.0 / 65535.0) - 0.5) * (2.0 * SRS_MASK_REACH);
}

/// Is a cut so near that its sides are known between voxels, too?
bool hasSides(vec4 mask) {
    return mask.b < 0.85;
}
