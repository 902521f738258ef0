// The colliders of one step (tools, then bodies) and their own frames: twin of ToolMotion (sim/tool_motion.h). Lengths in
// lattice units; the program defines SRS_COLLIDERS, their number.
//
// What is near a collider is worked out in double precision, as on the CPU: which point of a triangle is the deepest, and
// which triangle moves a node the most, are choices, and float32's rounding would choose otherwise every few steps. Few
// nodes are near; what is far is told in single precision, by programs that define SRS_SINGLE.
#include "shared_constants.h"

#ifdef SRS_SINGLE
#define real float
#define real2 vec2
#define real3 vec3
#define real4 vec4
#else
#define real double
#define real2 dvec2
#define real3 dvec3
#define real4 dvec4
#endif

struct Collider {
    real4 from;        // reference point at the step's start; w: Coulomb's coefficient
    real4 to;          // at its end; w: what a grasp can give in a step, mass shares times lattice units
    real4 turnFrom;    // quaternions (x, y, z, w), world from own frame: at the start
    real4 turnTo;      // at the end
    real4 turnBetween; // turnTo after the inverse of turnFrom
    real4 size;        // radius, length, bend, thinnest half-width
    real4 middle;      // box: its middle; mesh: place of the field's first sample
    real4 halfSize;    // box: half its size; mesh: distance of the samples, lattice units a metre, nothing
    real4 move;        // length of to - from; how far the turn moves what is 1 from the reference point
    ivec4 kind;        // SRS_TOOL_..., SRS_SHAPE_..., mesh: samples along x and y
    ivec4 field;       // mesh: samples along z, column of t_fields
};
layout(std140) uniform b_colliders { Collider b_collider[SRS_COLLIDERS]; };

real3 turned(real4 q, real3 v) { return v + real(2.0) * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
real3 turnedBack(real4 q, real3 v) { return v + real(2.0) * cross(q.xyz, cross(q.xyz, v) - q.w * v); }

int modeOf(int c) { return b_collider[c].kind.x; }
int shapeOf(int c) { return b_collider[c].kind.y; }
/// Does a grasp hold whatever pulls?
bool holdsEndlessly(int c) { return b_collider[c].to.w >= real(1e29); } // sim/contact_colliders.cpp
real thinOf(int c) { return b_collider[c].size.w; }
real3 ownAtStart(int c, real3 x) { return turnedBack(b_collider[c].turnFrom, x - b_collider[c].from.xyz); }
real3 ownAtEnd(int c, real3 x) { return turnedBack(b_collider[c].turnTo, x - b_collider[c].to.xyz); }

/// Where the collider's motion carries what is at x at the step's start.
real3 carried(int c, real3 x) {
    return b_collider[c].to.xyz + turned(b_collider[c].turnBetween, x - b_collider[c].from.xyz);
}

/// How far at most a point goes against the collider that ends at `end` after it moved by `path`.
real relativePath(int c, real3 end, real path) {
    real along = b_collider[c].move.x;
    return path + along + b_collider[c].move.y * (distance(end, b_collider[c].to.xyz) + path + along);
}
