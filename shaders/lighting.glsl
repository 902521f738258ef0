// Light for all drawing passes: a key lamp, a soft surround, a lamp behind, and the same as a studio that wet tissue and steel
// reflect. Colours are linear, directions in world axes.

uniform vec3 u_toKey;     // unit
uniform vec3 u_toBack;    // unit
uniform float u_key;      // of the scene's light: 1 is normal
uniform float u_ambient;
uniform vec4 u_eye;       // lattice units, w = 1; or the direction to the eye, w = 0 (orthographic)

const vec3 kKeyColour = vec3(1.00, 0.96, 0.90);
const vec3 kBackColour = vec3(0.62, 0.78, 1.00);
const vec3 kSky = vec3(0.52, 0.56, 0.62);
const vec3 kGround = vec3(0.27, 0.20, 0.18); // light that the room throws back from below

vec3 toEye(vec3 position) {
    return normalize(u_eye.xyz - position * u_eye.w);
}

vec3 surround(vec3 direction) {
    return mix(kGround, kSky, 0.5 + 0.5 * direction.y) * u_ambient;
}

/// What a mirror sees towards `direction`; `blur` widens the edges of the lamps (0 sharp to 1).
vec3 studio(vec3 direction, float blur) {
    vec3 light = surround(direction) * 0.75;
    float soft = 0.02 + 0.2 * blur;
    light += kKeyColour * (5.0 * u_key * smoothstep(0.93 - soft, 0.95 + soft, dot(direction, u_toKey)));
    light += kBackColour * (1.1 * u_key * smoothstep(0.80 - soft, 0.86 + soft, dot(direction, u_toBack)));
    return light;
}

float fresnel(float f0, float cosine) {
    float c = 1.0 - clamp(cosine, 0.0, 1.0);
    float c2 = c * c;
    return f0 + (1.0 - f0) * c2 * c2 * c;
}

/// GGX distribution times the usual visibility approximation, for a lamp. alpha = roughness squared.
float ggx(float alpha, float ndh, float ldh) {
    float a2 = alpha * alpha, d = ndh * ndh * (a2 - 1.0) + 1.0;
    return a2 / (12.566 * d * d * max(ldh * ldh, 0.1) * (alpha + 0.5));
}

/// Narkowicz' fit of the ACES curve, linear out (the target encodes sRGB).
vec3 toneMap(vec3 c) {
    return clamp(c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14), 0.0, 1.0);
}
