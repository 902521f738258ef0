// The colliders of one step (tools, then bodies) and their own frames: twin of ToolMotion (sim/tool_motion.h). Lengths in
// lattice units; the program defines SRS_COLLIDERS, their number.
#include "shared_constants.h"

struct Collider {
    vec4 from;        // reference point at the step's start; w: SRS_TOOL_...
    vec4 to;          // at its end; w: Coulomb's coefficient
    vec4 turnFrom;    // quaternions (x, y, z, w), world from own frame: at the start
    vec4 turnTo;      // at the end
    vec4 turnBetween; // turnTo after the inverse of turnFrom
    vec4 move;        // to - from; w: what a grasp can give in a step, mass shares times lattice units
    vec4 size;        // radius, length, bend, thinnest half-width
    vec4 middle;      // box: its middle; mesh: place of the field's first sample; w: SRS_SHAPE_...
    vec4 halfSize;    // box: half its size; mesh: samples along x, y, z; w: radius of the sphere that holds it
    vec4 field;       // mesh: column of t_fields, distance of its samples, lattice units a metre
};
layout(std140) uniform b_colliders { Collider b_collider[SRS_COLLIDERS]; };

vec3 turned(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
vec3 turnedBack(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) - q.w * v); }

int modeOf(int c) { return int(b_collider[c].from.w); }
int shapeOf(int c) { return int(b_collider[c].middle.w); }
float thinOf(int c) { return b_collider[c].size.w; }
vec3 ownAtStart(int c, vec3 x) { return turnedBack(b_collider[c].turnFrom, x - b_collider[c].from.xyz); }
vec3 ownAtEnd(int c, vec3 x) { return turnedBack(b_collider[c].turnTo, x - b_collider[c].to.xyz); }

/// How far the collider's motion carries what is at x at the step's start. As a difference: float32 keeps it.
vec3 carriedBy(int c, vec3 x) {
    vec4 q = b_collider[c].turnBetween;
    vec3 d = x - b_collider[c].from.xyz;
    return b_collider[c].move.xyz + 2.0 * cross(q.xyz, cross(q.xyz, d) + q.w * d);
}

/// At least as far as anything within `far` of the reference point goes against the collider, if it moves by `path`.
float relativePath(int c, float path, float far) {
    return path + length(b_collider[c].move.xyz) + 2.0 * length(b_collider[c].turnBetween.xyz) * far;
}
