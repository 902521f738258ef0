// The colliders of one step (tools, then bodies) and their own frames: twin of ToolMotion (sim/tool_motion.h). Lengths in
// lattice units; the program defines SRS_COLLIDERS, their number.
//
// What is near a collider is worked out in double precision, as on the CPU: which point of a triangle is the deepest, and
// which triangle moves a node the most, are choices, and float32's rounding would choose otherwise a few times a second.
// Few nodes are near; that nothing is near is decided in single precision.
#include "shared_constants.h"

struct Collider {
    dvec4 from;        // reference point at the step's start; w: Coulomb's coefficient
    dvec4 to;          // at its end; w: what a grasp can give in a step, mass shares times lattice units
    dvec4 turnFrom;    // quaternions (x, y, z, w), world from own frame: at the start
    dvec4 turnTo;      // at the end
    dvec4 turnBetween; // turnTo after the inverse of turnFrom
    dvec4 size;        // radius, length, bend, thinnest half-width
    dvec4 middle;      // box: its middle; mesh: place of the field's first sample
    dvec4 halfSize;    // box: half its size; mesh: distance of the samples, lattice units a metre, nothing
    vec4 ball;         // holds the shape at the step's end: centre (the reference point), radius
    vec4 move;         // to - from; w: how far the turn moves what is 1 from the reference point
    ivec4 kind;        // SRS_TOOL_..., SRS_SHAPE_..., mesh: samples along x and y
    ivec4 field;       // mesh: samples along z, column of t_fields
};
layout(std140) uniform b_colliders { Collider b_collider[SRS_COLLIDERS]; };

dvec3 turned(dvec4 q, dvec3 v) { return v + 2.0lf * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
dvec3 turnedBack(dvec4 q, dvec3 v) { return v + 2.0lf * cross(q.xyz, cross(q.xyz, v) - q.w * v); }

int modeOf(int c) { return b_collider[c].kind.x; }
int shapeOf(int c) { return b_collider[c].kind.y; }
double thinOf(int c) { return b_collider[c].size.w; }
dvec3 ownAtStart(int c, dvec3 x) { return turnedBack(b_collider[c].turnFrom, x - b_collider[c].from.xyz); }
dvec3 ownAtEnd(int c, dvec3 x) { return turnedBack(b_collider[c].turnTo, x - b_collider[c].to.xyz); }

/// Where the collider's motion carries what is at x at the step's start.
dvec3 carried(int c, dvec3 x) {
    return b_collider[c].to.xyz + turned(b_collider[c].turnBetween, x - b_collider[c].from.xyz);
}

/// Is the point at `end` after it moved by `path` at most further than `reach` from the collider, all of the way? In
/// single precision: `reach` is to hold some rounding.
bool isFar(int c, vec3 end, float path, float reach) {
    vec4 ball = b_collider[c].ball, move = b_collider[c].move;
    float apart = distance(end, ball.xyz), along = length(move.xyz);
    return apart > ball.w + reach + path + along + move.w * (apart + path + along);
}
