// What the passes share that couple organs (sim/pair_contact_pass.h): organs, nodes and triangles of the group, in group
// units, as sim/pair_contact_skin.h has them. Sums are integers, so that their order changes nothing.
#include "shared_constants.h"

struct PairOrgan {
    vec4 place;    // group units = xyz + w * lattice units
    uvec4 range;   // first node, nodes of the skin, first triangle, triangles
    uvec4 boxes;   // first leaf, leaves, first top box, top boxes, in b_boxes
    uvec4 touches; // x: others, y: itself; z: nodes
};
layout(std430) restrict readonly buffer b_organs { PairOrgan b_organ[]; };

struct PairNode {
    vec4 rest;    // normal, depth
    vec4 kind;    // thickness, flatness, 1/mass
    ivec4 beside; // nodes at +x, -x, +y, -y; -1: none
    ivec4 more;   // +z, -z; organ; texel, x + (y << 16)
};
layout(std430) restrict readonly buffer b_nodes { PairNode b_node[]; };

struct PairMotion {
    vec4 start;     // where the step began; w: 1/mass, 0 where fixed or held
    vec4 increment; // of the step so far
    vec4 original;  // as the solver left it
    vec4 before;    // the increment of the round before
};
layout(std430) restrict buffer b_motions { PairMotion b_motion[]; };

struct PairSkin {
    vec4 point;  // where the step began
    vec4 normal; // times flatness; w: thickness
};
layout(std430) restrict buffer b_skins { PairSkin b_skin[]; };

struct PairBox {
    vec4 low, high;
};
layout(std430) restrict buffer b_boxes { PairBox b_box[]; }; // of triangles, leaves, top boxes

// Corners of triangles, three each; then, from u_nearFirst on, the first of each node's near ones; then those.
layout(std430) restrict readonly buffer b_lists { uint b_list[]; };

struct PairTouch {
    uvec4 who;       // node; corners of the triangle
    vec4 weights;    // of the corners; w: organs of node and triangle, 8 bits each, as bits
    vec4 normal;     // w: what is missing beside the motion along it, below 0
    vec4 impulse;    // friction; w: normal
    vec4 last;       // the same, a round before
};
layout(std430) restrict buffer b_touches { PairTouch b_touch[]; };

// [0]: number of touches; from SRS_PAIR_FASTEST on the longest increment of each organ, as bits; from SRS_PAIR_LOADS on
// loads, eight words each; from u_given on, four words a node: impulse of a round, number of touches.
layout(std430) restrict buffer b_sums { uint b_sum[]; };

uvec3 cornersOf(uint triangle) { return uvec3(b_list[3u * triangle], b_list[3u * triangle + 1u], b_list[3u * triangle + 2u]); }
