// Where a pixel lies, from the picture's depth.
uniform sampler2D t_depth;
uniform mat4 u_cameraFromClip;
uniform float u_radius; // m

/// Metres, camera axes; z is negative in front.
vec3 placeOf(ivec2 pixel) {
    vec2 size = vec2(textureSize(t_depth, 0));
    float depth = texelFetch(t_depth, clamp(pixel, ivec2(0), ivec2(size) - 1), 0).x;
    vec4 place = u_cameraFromClip * vec4(2.0 * (vec2(pixel) + 0.5) / size - 1.0, 2.0 * depth - 1.0, 1.0);
    return place.xyz / place.w;
}
bool isEmpty(ivec2 pixel) { return texelFetch(t_depth, pixel, 0).x >= 1.0; }
