#version 450 core
// Both ends of an axis as one layer of depth maps (render/depth_maps.h). A texel that the mesh does not cover goes on from the
// nearest one that it does: there the near end lies behind the far one, all along the column is outside. Twin: beyondRim in
// render/depth_twin.cpp.
#include "raycast_constants.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rg32f) uniform restrict writeonly image3D i_depths;
layout(r32ui) uniform restrict writeonly uimage3D i_colours;
uniform sampler2D t_near, t_far, t_nearColour, t_farColour; // depth: below -1 where there is none
uniform int u_layer, u_side;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(u_side))))
        return;
    bool covered = texelFetch(t_near, at, 0).x > -1.0;
    ivec2 from = at, reach = ivec2(covered ? 0 : SRS_DEPTH_RIM);
    float nearest = 1e9;
    for (int y = max(at.y - reach.y, 0); y <= min(at.y + reach.y, u_side - 1); ++y)
        for (int x = max(at.x - reach.x, 0); x <= min(at.x + reach.x, u_side - 1); ++x) {
            float apart = length(vec2(ivec2(x, y) - at));
            if (texelFetch(t_near, ivec2(x, y), 0).x > -1.0 && apart < nearest) {
                nearest = apart;
                from = ivec2(x, y);
            }
        }
    vec2 ends = vec2(texelFetch(t_near, from, 0).x, texelFetch(t_far, from, 0).x);
    if (nearest > 1e8) {
        ends = vec2(0.5 * float(u_side)) + float(SRS_DEPTH_RIM) * vec2(1.0, -1.0);
    } else if (!covered) {
#if RAYCAST_FIELD == SRS_FIELD_DEPTH
        float out_ = max(0.5 * (ends.y - ends.x), 1e-3) + nearest - 1.0; // zero half of a texel out
#else
        float out_ = nearest < 1.5 ? -0.5 * (ends.y - ends.x) : nearest - 1.5; // the other axes cut it off
#endif
        ends = vec2(0.5 * (ends.x + ends.y)) + out_ * vec2(1.0, -1.0);
    }
    imageStore(i_depths, ivec3(at, u_layer), vec4(ends, 0.0, 0.0));
    imageStore(i_colours, ivec3(at, 2 * u_layer), uvec4(packUnorm4x8(texelFetch(t_nearColour, from, 0))));
    imageStore(i_colours, ivec3(at, 2 * u_layer + 1), uvec4(packUnorm4x8(texelFetch(t_farColour, from, 0))));
}
