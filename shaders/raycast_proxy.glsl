// A ray's way through one of the tetrahedra that the vertex stage has moved (CS07 section 6.3; render/ray_proxy.h). There
// rest is an affine map of what is shown: the way is straight at rest, too, and the pixel searches it as it searches a ray.
//
// Neighbours have one face, and a ray leaves one where it enters the other. What is met is what a ray through all of them
// would meet first: a sign that changes does so within one of them, and the depth buffer keeps the nearest. A way goes on
// beyond the faces by a small part of a pixel, so that no place lies between two of them; what both meet there is the same.
#include "coarse_map.glsl"

flat in vec3 v_corner, v_restCorner;
flat in mat3 v_shares, v_restEdges;

uniform float u_coarseBy; // object space: differences of the coarse map's Jacobian

uniform vec3 u_planeMiddle, u_planeRight, u_planeUp; // object space: what the picture shows in a plane across its view
uniform vec2 u_planeSize;                            // of the picture, pixels

/// Where that plane is seen in the pixel, or in its sample: the same for all tetrahedra, to the last bit.
vec3 pixelPlace() {
#ifdef RAYCAST_SAMPLES
    vec2 at = floor(gl_FragCoord.xy) + gl_SamplePosition;
#else
    vec2 at = floor(gl_FragCoord.xy) + 0.5;
#endif
    at = 2.0 * at / u_planeSize - 1.0;
    return u_planeMiddle + at.x * u_planeRight + at.y * u_planeUp;
}

struct Way {
    vec3 from, along; // at rest; along: unit
    float start;      // shown: from `position` on
    float end;        // at rest
    float stretch;    // at rest, of one shown
};

/// \param position of the ray, near the tetrahedron; object space. \param behind not further towards the eye
Way wayThrough(vec3 position, vec3 along, float behind) {
    wayPixel = dot(u_pixel, vec4(position, 1.0));
    vec3 shares = v_shares * (position - v_corner), rates = v_shares * along;
    vec4 share = vec4(1.0 - shares.x - shares.y - shares.z, shares);
    vec4 rate = vec4(-rates.x - rates.y - rates.z, rates);
    mat3 slopes = transpose(v_shares);
    vec4 slope = vec4(length(slopes[0] + slopes[1] + slopes[2]), length(slopes[0]), length(slopes[1]), length(slopes[2]));
    vec4 least = -SRS_PROXY_SLACK * wayPixel * slope;
    float start = -behind, end = 1e30;
    for (int i = 0; i < 4; ++i) {
        if (rate[i] > 1e-12)
            start = max(start, (least[i] - share[i]) / rate[i]);
        else if (rate[i] < -1e-12)
            end = min(end, (least[i] - share[i]) / rate[i]);
    }
    vec3 way = v_restEdges * rates;
    wayStretch = length(way);
    return Way(v_restCorner + v_restEdges * (shares + start * rates), way / wayStretch, start, (end - start) * wayStretch,
               wayStretch);
}

/// What is normal at rest is so shown, by the smooth map's Jacobian: that of the tetrahedron would show its faces.
vec3 normalShown(vec3 normal, vec3 rest) {
    return normalize(transpose(inverse(coarseJacobian(rest, u_coarseBy))) * normal);
}
