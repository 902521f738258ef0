// The state that a solver step reads: what solver_kernel.glsl asks for as loadPosition and loadIncrement, for the
// entry points that read every neighbour from the textures themselves.
layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
#ifdef SRS_TEXEL_FETCH
uniform sampler2D t_positions;
uniform sampler2D t_increments;
vec3 fetchPosition(ivec2 texel) { return texelFetch(t_positions, texel, 0).xyz; }
vec3 fetchIncrement(ivec2 texel) { return texelFetch(t_increments, texel, 0).xyz; }
#else
layout(rgba32f) uniform readonly restrict image2D i_positions;
layout(rgba32f) uniform readonly restrict image2D i_increments;
vec3 fetchPosition(ivec2 texel) { return imageLoad(i_positions, texel).xyz; }
vec3 fetchIncrement(ivec2 texel) { return imageLoad(i_increments, texel).xyz; }
#endif
