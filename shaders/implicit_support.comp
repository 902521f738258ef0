// Before each of Newton's rounds, last pass: the force and the stiffness that contact, friction and finite grips give to each
// node. Twin of ImplicitContact::support (sim/implicit_contact.h says what they are), but for tools
// that come in parts and what is held in the last round.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "implicit_symmetric.glsl"
#include "contact_colliders.glsl"
#ifdef SRS_FINITE_GRIPS
#include "contact_grasp.glsl"
#endif

layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
layout(rgba32f) uniform readonly restrict image2D i_increments; // what contact made of the way (contact_ends.glsl)
uniform int u_round;

const float kCreeps = 1e-4; // spacings a step: what was slower sticks

struct Touch {
    vec3 normal, gave; // gave: along the surface
    bool known, begins, slides; // begins: in the first round
    vec3 along;
};

void classify(inout Touch touch, vec3 way, float most) {
    float far = length(way), gave = length(touch.gave);
    if (!touch.known || touch.begins) {
        touch.slides = touch.slides || far > kCreeps;
        touch.along = touch.slides && far > 0.0 ? way / far : vec3(0.0);
    } else if (!touch.slides && gave > most) {
        touch.slides = true;
        touch.along = touch.gave / -gave;
    } else if (touch.slides) {
        touch.slides = dot(way, touch.along) > 0.0;
        touch.along = touch.slides ? way / far : vec3(0.0);
    }
}

void resist(inout vec3 force, inout Symmetric stiff, inout Touch touch, vec3 way, float most, float stiffness) {
    Symmetric plane = scaled(-1.0, dyad(touch.normal));
    plane.d += 1.0;
    classify(touch, way, most);
    if (!touch.slides) {
        force += (touch.known ? touch.gave : vec3(0.0)) - stiffness * way;
        addTo(stiff, scaled(stiffness, plane));
        return;
    }
    addTo(plane, scaled(-1.0, dyad(touch.along)));
    force -= touch.along * most;
    addTo(stiff, scaled(min(stiffness, most / max(length(way), 1e-12)), plane));
}

/// How far the node goes further than what it touches carries it. In double: the places are large.
vec3 slipOf(int c, vec3 x, vec3 u) { return vec3(real3(x) + real3(u) - carried(c, real3(x))); }

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= u_nodes)
        return;
    ivec2 texel = texelOf(i);
    vec4 after = imageLoad(i_increments, texel), gave = VECTOR(SRS_VEC_W, i), x = VECTOR(SRS_VEC_X, i);
    vec3 push = after.xyz - VECTOR(SRS_VEC_Z, i).xyz, u = VECTOR(SRS_VEC_U, i).xyz, force = vec3(0.0);
    float pressure = VECTOR(SRS_VEC_KA, i).w, r = gave.w;
    Symmetric stiff = Symmetric(vec3(0.0), vec3(0.0));
    Touch touch;
    touch.known = VECTOR(SRS_VEC_N, i).w > 0.0;
    touch.begins = false;
    touch.slides = VECTOR(SRS_VEC_A, i).w > 0.0;
    touch.along = VECTOR(SRS_VEC_A, i).xyz;
    touch.normal = vec3(0.0);
    touch.gave = gave.xyz;
    int c = -1;
#ifdef SRS_FINITE_GRIPS
    uint holder = (imageLoad(i_nodeInfo, texel).x >> SRS_HELD_SHIFT) & SRS_HELD_MASK;
    if (holder != 0u && !holdsEndlessly(int(holder) - 1)) {
        c = int(holder) - 1;
        float most = float(b_collider[c].to.w) * x.w / max(heldMass(holder), 1e-9);
        resist(force, stiff, touch, slipOf(c, x.xyz, u), most, r);
    } else
#endif
    if (push != vec3(0.0) && !isHeld(i)) {
        c = int(after.w) - 1;
        vec3 n = normalize(push);
        touch.normal = n;
        touch.begins = u_round == 0;
        if (u_round == 0)
            pressure = max(0.0, dot(gave.xyz, n));
        force = r * push;
        stiff = scaled(r, dyad(n));
        float friction = float(b_collider[c].from.w);
        if (friction > 0.0) {
            vec3 slip = slipOf(c, x.xyz, u);
            touch.gave -= n * dot(n, touch.gave);
            resist(force, stiff, touch, slip - n * dot(n, slip), touch.known ? friction * pressure : 0.0, r);
        }
    }
    VECTOR(SRS_VEC_F, i) = vec4(force, float(c + 1));
    VECTOR(SRS_VEC_KA, i) = vec4(stiff.d, pressure);
    VECTOR(SRS_VEC_KB, i) = vec4(stiff.o, 0.0);
    VECTOR(SRS_VEC_N, i) = vec4(touch.normal, c >= 0 ? 1.0 : 0.0);
    VECTOR(SRS_VEC_A, i) = vec4(touch.along, touch.slides ? 1.0 : 0.0);
}
