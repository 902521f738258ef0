// The last pass of an implicit step with contact: what the last push alone touched goes on as touched.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"

layout(rgba32f) uniform readonly restrict image2D i_increments;
layout(rgba32f) uniform restrict image2D i_earlier;

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= u_nodes)
        return;
    ivec2 texel = texelOf(i);
    if (imageLoad(i_earlier, texel).w > 0.0 && imageLoad(i_increments, texel).xyz != VECTOR(SRS_VEC_U, i).xyz)
        imageStore(i_earlier, texel, vec4(0.0, 0.0, 0.0, -1.0));
}
