// Contact passes number nodes by their texels: x + width y.
uniform int u_width; // of the state textures

ivec2 texelAt(uint number) { return ivec2(int(number) % u_width, int(number) / u_width); }
uint numberOf(ivec2 texel) { return uint(texel.x + u_width * texel.y); }
