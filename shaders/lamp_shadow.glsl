// Shadow of the key lamp from its depth map (render/lamp_shadow.h; Williams 1978), with percentage-closer filtering (Reeves et
// al. 1987): four times four texels, weighted so that the edge is smooth between them.

uniform bool u_shadows;
uniform sampler2D t_shadow;        // depth that the lamp sees
uniform mat4 u_shadowFromLattice;  // clip space of the lamp
uniform float u_shadowTexel;       // lattice units

const float kSlack = 0.0008; // of the depth map's range

/// Share of the lamp's light that arrives. \param n unit
float lampLight(vec3 position, vec3 n) {
    vec4 clip = u_shadowFromLattice * vec4(position + n * (2.0 * u_shadowTexel), 1.0);
    vec3 at = 0.5 + 0.5 * clip.xyz;
    vec2 size = vec2(textureSize(t_shadow, 0)), place = at.xy * size - 0.5, part = fract(place);
    if (any(lessThan(at.xy, vec2(0.01))) || any(greaterThan(at.xy, vec2(0.99))))
        return 1.0;
    float lit = 0.0;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            float depth = texelFetch(t_shadow, ivec2(floor(place)) + ivec2(x, y) - 1, 0).x;
            float wx = x == 0 ? 1.0 - part.x : x == 3 ? part.x : 1.0;
            float wy = y == 0 ? 1.0 - part.y : y == 3 ? part.y : 1.0;
            lit += wx * wy * (at.z - kSlack <= depth ? 1.0 : 0.0);
        }
    return lit / 9.0;
}
