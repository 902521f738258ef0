// What contact passes know of nodes beside the state, by their number.
#include "contact_texels.glsl"

struct ContactNode {
    uint firstCorner; // of b_corner: the corners of boundary triangles that are this node
    uint corners;     // how many
    float mass;       // share of a full node's
    uint spare;
};
layout(std430) readonly restrict buffer b_nodes { ContactNode b_node[]; };
