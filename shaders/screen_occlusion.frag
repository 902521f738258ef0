#version 450 core
// Ambient occlusion of a pixel from the depths around it (McGuire et al. 2011, eq. 10): what stands above the tangent plane
// within a radius, sampled on a spiral that is turned from pixel to pixel.
#include "screen_occlusion.glsl"

uniform mat4 u_clipFromCamera;

out float o_light;

const int kSamples = 16, kTurns = 7;
const float kStrength = 1.1;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    o_light = 1.0;
    if (isEmpty(pixel))
        return;
    vec3 c = placeOf(pixel);
    vec3 right = placeOf(pixel + ivec2(1, 0)) - c, left = c - placeOf(pixel - ivec2(1, 0));
    vec3 up = placeOf(pixel + ivec2(0, 1)) - c, down = c - placeOf(pixel - ivec2(0, 1));
    vec3 n = normalize(cross(abs(right.z) < abs(left.z) ? right : left, abs(up.z) < abs(down.z) ? up : down));
    vec2 size = vec2(textureSize(t_depth, 0));
    float w = u_clipFromCamera[2][3] * c.z + u_clipFromCamera[3][3]; // of clip space: 1, or the distance
    vec2 reach = 0.5 * size * vec2(u_clipFromCamera[0][0], u_clipFromCamera[1][1]) * u_radius / w;
    float turn = 6.2832 * fract(52.9829189 * fract(dot(vec2(pixel), vec2(0.06711056, 0.00583715))));
    float sum = 0.0;
    for (int i = 0; i < kSamples; ++i) {
        float share = (float(i) + 0.5) / float(kSamples), angle = turn + 6.2832 * float(kTurns) * share;
        vec3 to = placeOf(pixel + ivec2(share * reach * vec2(cos(angle), sin(angle)))) - c;
        float d2 = dot(to, to), fall = max(1.0 - d2 / (u_radius * u_radius), 0.0);
        sum += fall * max(dot(to, n) - 0.03 * u_radius, 0.0) / (sqrt(d2) + 0.02 * u_radius);
    }
    o_light = max(1.0 - kStrength * 2.0 * sum / float(kSamples), 0.0);
}
