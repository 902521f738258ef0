// Boxes around the step of each triangle and of 16 of them (SRS_LEAVES), or of 16 leaves: as SkinBoxes in
// sim/pair_contact_boxes.h.
#version 450 core
#include "pair_buffers.glsl"
layout(local_size_x = 16) in;

uniform uint u_boxes;  // leaves or top boxes of the whole group
uniform uint u_organs;
uniform uint u_leaf;   // the first leaf in b_boxes
uniform uint u_top;    // the first top box

void main() {
    uint at = gl_GlobalInvocationID.x;
    if (at >= u_boxes)
        return;
#ifdef SRS_LEAVES
    uint own = u_leaf + at;
#else
    uint own = u_top + at;
#endif
    // Its organ: boxes of one lie together.
    PairOrgan organ;
    for (uint o = 0u; o < u_organs; ++o) {
        organ = b_organ[o];
#ifdef SRS_LEAVES
        if (own < organ.boxes.x + organ.boxes.y)
            break;
#else
        if (own < organ.boxes.z + organ.boxes.w)
            break;
#endif
    }
#ifdef SRS_LEAVES
    uint first = uint(SRS_PAIR_BRANCH) * (own - organ.boxes.x), count = organ.range.w, base = organ.range.z;
#else
    uint first = uint(SRS_PAIR_BRANCH) * (own - organ.boxes.z), count = organ.boxes.y, base = organ.boxes.x;
#endif
    uint last = min(first + uint(SRS_PAIR_BRANCH), count);
    vec3 low = vec3(3e38), high = vec3(-3e38);
    for (uint i = first; i < last; ++i) {
#ifdef SRS_LEAVES
        uvec3 corners = cornersOf(base + i);
        vec3 a = b_skin[corners.x].point.xyz, b = b_skin[corners.y].point.xyz, c = b_skin[corners.z].point.xyz;
        vec3 u = b_motion[corners.x].increment.xyz, v = b_motion[corners.y].increment.xyz,
             w = b_motion[corners.z].increment.xyz;
        vec3 least = min(min(min(a, a + u), min(b, b + v)), min(c, c + w));
        vec3 most = max(max(max(a, a + u), max(b, b + v)), max(c, c + w));
        b_box[base + i].low = vec4(least, 0.0);
        b_box[base + i].high = vec4(most, 0.0);
#else
        vec3 least = b_box[base + i].low.xyz, most = b_box[base + i].high.xyz;
#endif
        low = min(low, least);
        high = max(high, most);
    }
    b_box[own].low = vec4(low, 0.0);
    b_box[own].high = vec4(high, 0.0);
}
