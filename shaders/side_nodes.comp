// Nodes as each side of the blades' cuts carries them (render/side_nodes.h).
#version 450 core
#include "side_nodes.glsl"
layout(local_size_x = 64) in;

uniform sampler2D t_positions;
layout(rgba32f) uniform restrict writeonly image2D i_above, i_below;
uniform ivec3 u_centre; // point of the grid that rests at the origin

const float kEven = 0.002;   // how much an even displacement is preferred to a slope that nodes do not show

/// Is a node that a cut is near on this side of it?
bool isOn(int node, float side) {
    return !isFar(node) && b_side[node] != SRS_SIDE_LOOSE && (b_side[node] >= 0.0) == (side > 0.0);
}

/// Springs from a node to the side at rest, and those that are left.
void countAcross(int node, float side, inout int before, inout int left) {
    uint rest = b_node[node].z, now = connectionsOf(node);
    for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
        if ((rest >> d & 1u) == 0u)
            continue;
        int other = nodeAt(gridOf(node) + offset(d));
        if (other < 0 || !isOn(other, side))
            continue;
        ++before;
        left += int(now >> d & 1u);
    }
}

/// How much of what joined a node to the side is left, 0 to 1; -1: the side is far from it.
float joined(int node, float side) {
    int before = 0, left = 0;
    countAcross(node, side, before, left);
    for (int d = 0; d < 6 && before == 0; ++d) { // none of its own: those of its neighbours along the axes
        int other = nodeAt(gridOf(node) + offset(d));
        if (other >= 0 && isOn(other, -side))
            countAcross(other, side, before, left);
    }
    return before == 0 ? -1.0 : float(left) / float(before);
}

/// Can a node say where its side is? One that no cut is near may lie far behind the other.
bool speaks(int node, float side) {
    return node >= 0 && isOn(node, side) && connectionsOf(node) != 0u;
}

/// Offset to the nearest node of the side; 0: there is none within reach.
ivec3 nearestOf(ivec3 grid, float side) {
    ivec3 nearest = ivec3(0);
    int least = 4 * SRS_SIDE_REACH * SRS_SIDE_REACH;
    for (int z = -SRS_SIDE_REACH; z <= SRS_SIDE_REACH; ++z)
        for (int y = -SRS_SIDE_REACH; y <= SRS_SIDE_REACH; ++y)
            for (int x = -SRS_SIDE_REACH; x <= SRS_SIDE_REACH; ++x) {
                int away = x * x + y * y + z * z;
                if (away > 0 && away < least && speaks(nodeAt(grid + ivec3(x, y, z)), side)) {
                    least = away;
                    nearest = ivec3(x, y, z);
                }
            }
    return nearest;
}

/// Where the side's nodes would have a node: weighted least squares of an affine displacement around its nearest one, which has
/// neighbours into the tissue on all sides but the cut. w: 0 if there are none.
vec4 carriedBy(int node, float side) {
    ivec3 away = nearestOf(gridOf(node), side), grid = gridOf(node) + away;
    if (away == ivec3(0))
        return vec4(0.0);
    mat4 normal = mat4(0.0);
    mat4x3 right = mat4x3(0.0); // columns: of 1, x, y, z
    float weights = 0.0;
    for (int z = -SRS_SIDE_REACH; z <= SRS_SIDE_REACH; ++z)
        for (int y = -SRS_SIDE_REACH; y <= SRS_SIDE_REACH; ++y)
            for (int x = -SRS_SIDE_REACH; x <= SRS_SIDE_REACH; ++x) {
                int other = nodeAt(grid + ivec3(x, y, z));
                if (!speaks(other, side))
                    continue;
                vec4 r = vec4(1.0, x, y, z);
                float w = 1.0 / (1.0 + float(x * x + y * y + z * z));
                vec3 moved = texelFetch(t_positions, texelOf(other), 0).xyz - vec3(gridOf(other) - u_centre);
                normal += w * outerProduct(r, r);
                right += w * outerProduct(moved, r);
                weights += w;
            }
    for (int i = 1; i < 4; ++i)
        normal[i][i] += kEven * weights;
    vec3 moved = right * (inverse(normal) * vec4(1.0, vec3(-away)));
    return vec4(vec3(gridOf(node) - u_centre) + moved, 1.0);
}

/// xyz: the place; w: how far on this side the node lies, as SRS_SIDE_... say.
vec4 carried(int node, float side) {
    vec3 own = texelFetch(t_positions, texelOf(node), 0).xyz;
    bool loose = b_side[node] == SRS_SIDE_LOOSE || connectionsOf(node) == 0u && b_node[node].z != 0u;
    if (isFar(node) && !loose)
        return vec4(own, SRS_SIDE_FAR);
    float on = isFar(node) ? SRS_SIDE_FAR : side * b_side[node];
    if (isOn(node, side) && !loose)
        return vec4(own, max(on, 0.0));
    float share = loose ? 0.0 : joined(node, side);
    if (share >= 1.0)
        return vec4(own, on);
    vec4 place = share >= 0.0 ? carriedBy(node, side) : vec4(0.0);
    return place.w == 0.0 ? vec4(own, SRS_SIDE_NONE) : vec4(mix(place.xyz, own, share), on);
}

void main() {
    int node = int(gl_GlobalInvocationID.x);
    if (node >= u_nodeCount)
        return;
    imageStore(i_above, texelOf(node), carried(node, 1.0));
    imageStore(i_below, texelOf(node), carried(node, -1.0));
}
