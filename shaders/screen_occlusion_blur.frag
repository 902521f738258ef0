#version 450 core
// Averages the occlusion along one direction, over what lies about as deep.
#include "screen_occlusion.glsl"

uniform sampler2D t_light;
uniform ivec2 u_step;

out float o_light;

const int kReach = 3; // pixels

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = textureSize(t_light, 0) - 1;
    float depth = placeOf(pixel).z, sum = 0.0, weights = 0.0;
    for (int i = -kReach; i <= kReach; ++i) {
        ivec2 at = clamp(pixel + i * u_step, ivec2(0), last);
        float weight = exp(-0.15 * float(i * i)) * max(1.0 - abs(placeOf(at).z - depth) / (0.4 * u_radius), 0.0);
        sum += weight * texelFetch(t_light, at, 0).x;
        weights += weight;
    }
    o_light = weights > 0.0 ? sum / weights : 1.0;
}
