#version 450 core
// Depth alone of the surface, for the lamp's map and for occlusion; what is cut away is none.
#include "shared_constants.h"
#ifdef SURFACE_CUT
#include "cut_mask.glsl"
in vec3 v_rest;
flat in float v_side;
in float v_away;
#endif

void main() {
#ifdef SURFACE_CUT
    if (isCut(cutMask(v_rest), v_side, v_away))
        discard;
#endif
}
