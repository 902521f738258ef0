// Where a node lies now.
uniform sampler2D t_positions; // of the nodes, lattice units

vec3 nodePosition(uint texel) {
    return texelFetch(t_positions, ivec2(texel & 0xffffu, texel >> 16), 0).xyz;
}
