// What touches in a step: twin of PairContacts::touch in sim/pair_contact.cpp, which says how. One invocation a node of a
// skin; what it finds is appended, in any order.
#version 450 core
#include "pair_buffers.glsl"
#include "pair_closest.glsl"
layout(local_size_x = 64) in;

uniform uint u_nodes, u_organs;
uniform uint u_near;  // first of the near lists' offsets in b_lists
uniform uint u_given;

bool isNear(uint node, uvec3 corners) {
    uint first = b_list[u_near + node], last = b_list[u_near + node + 1u];
    for (uint i = first; i < last; ++i) {
        uint other = b_list[i];
        if (other == corners.x || other == corners.y || other == corners.z)
            return true;
    }
    return false;
}

float boxDistance2(uint box, vec3 point) {
    vec3 apart = max(max(b_box[box].low.xyz - point, point - b_box[box].high.xyz), vec3(0.0));
    return dot(apart, apart);
}

// The best so far of one part of the step.
float g_distance2;
bool g_found;
uvec3 g_corners;
vec3 g_weights, g_normal, g_apart;

void tryTriangle(uint node, vec3 point, vec3 normal, float s, uvec3 corners, bool itself) {
    vec3 faces = vec3(dot(b_skin[corners.x].normal.xyz, normal), dot(b_skin[corners.y].normal.xyz, normal),
                      dot(b_skin[corners.z].normal.xyz, normal));
    if (all(greaterThanEqual(faces, vec3(0.0))))
        return; // no point of it is against the node's normal
    vec3 a = b_skin[corners.x].point.xyz + s * b_motion[corners.x].increment.xyz - point,
         b = b_skin[corners.y].point.xyz + s * b_motion[corners.y].increment.xyz - point,
         c = b_skin[corners.z].point.xyz + s * b_motion[corners.z].increment.xyz - point;
    vec3 weights = closestWeights(a, b, c);
    vec3 apart = -(weights.x * a + weights.y * b + weights.z * c);
    if (!(dot(apart, apart) < g_distance2))
        return;
    vec3 there = weights.x * b_skin[corners.x].normal.xyz + weights.y * b_skin[corners.y].normal.xyz +
                 weights.z * b_skin[corners.z].normal.xyz;
    float most = -SRS_PAIR_AGAINST * length(there) * length(normal);
    if (!(dot(there, normal) < most) || (itself && isNear(node, corners)))
        return;
    g_found = true;
    g_distance2 = dot(apart, apart);
    g_corners = corners;
    g_weights = weights;
    g_normal = normalize(there - normal);
    g_apart = apart;
}

void search(uint node, vec3 point, vec3 normal, float s, PairOrgan other, bool itself) {
    for (uint top = 0u; top < other.boxes.w; ++top) {
        if (!(boxDistance2(other.boxes.z + top, point) < g_distance2))
            continue;
        uint leafEnd = min(SRS_PAIR_BRANCH * (top + 1u), other.boxes.y);
        for (uint leaf = SRS_PAIR_BRANCH * top; leaf < leafEnd; ++leaf) {
            if (!(boxDistance2(other.boxes.x + leaf, point) < g_distance2))
                continue;
            uint end = min(SRS_PAIR_BRANCH * (leaf + 1u), other.range.w);
            for (uint i = SRS_PAIR_BRANCH * leaf; i < end; ++i)
                if (boxDistance2(other.range.z + i, point) < g_distance2)
                    tryTriangle(node, point, normal, s, cornersOf(other.range.z + i), itself);
        }
    }
}

void append(uint node, uint own, uint organ, float missing, float motionAlong) {
    uint at = atomicAdd(b_sum[0], 1u);
    b_touch[at].who = uvec4(node, g_corners);
    b_touch[at].weights = vec4(g_weights, uintBitsToFloat(1u << 23 | own << 8 | organ)); // a float of its own bits
    b_touch[at].normal = vec4(g_normal, missing - motionAlong);
    b_touch[at].impulse = vec4(0.0);
    b_touch[at].last = vec4(0.0);
    for (int i = 0; i < 4; ++i)
        atomicAdd(b_sum[u_given + 4u * b_touch[at].who[i] + 3u], 1u);
}

void touch(uint node, uint ownOrgan, uint organ) {
    PairOrgan other = b_organ[organ];
    float scale = other.place.w, deepest = SRS_PAIR_DEEPEST * max(scale, b_organ[ownOrgan].place.w);
    vec3 start = b_skin[node].point.xyz, normal = b_skin[node].normal.xyz, move = b_motion[node].increment.xyz;
    float longest = length(move) + sqrt(uintBitsToFloat(b_sum[SRS_PAIR_FASTEST + organ]));
    if (!(longest < 1e6)) // or no number
        return;
    float parts = clamp(ceil(longest / (0.5 * scale)), 1.0, float(SRS_PAIR_PARTS));
    float reach = max(deepest, longest / parts);
    for (float part = 0.0; part < parts; part += 1.0) {
        float s = part / parts;
        g_distance2 = reach * reach;
        g_found = false;
        vec3 point = start + s * move;
        search(node, point, normal, s, other, organ == ownOrgan);
        if (!g_found)
            continue;
        vec3 against = move - (g_weights.x * b_motion[g_corners.x].increment.xyz +
                               g_weights.y * b_motion[g_corners.y].increment.xyz +
                               g_weights.z * b_motion[g_corners.z].increment.xyz);
        float closing = dot(g_normal, against), gap = dot(g_normal, g_apart), far = sqrt(g_distance2);
        float thickness = dot(g_weights, vec3(b_skin[g_corners.x].normal.w, b_skin[g_corners.y].normal.w,
                                              b_skin[g_corners.z].normal.w));
        float slack = SRS_PAIR_SLACK * scale;
        float farthest = gap < 0.0 ? min(deepest, SRS_PAIR_THIN * (b_skin[node].normal.w + thickness))
                                   : length(against) / parts + slack;
        bool aside = far > slack && abs(gap) < 0.7 * far;
        if (!(far <= farthest) || aside || !(gap + closing / parts < 0.0))
            continue;
        float missing = gap + (1.0 - s) * closing - min(0.0, gap + SRS_EJECTION * scale);
        if (!(missing < 0.0))
            continue;
        append(node, ownOrgan, organ, missing, closing);
        return;
    }
}

void main() {
    uint node = gl_GlobalInvocationID.x;
    if (node >= u_nodes)
        return;
    uint own = uint(b_node[node].more.z);
    if (node >= b_organ[own].range.x + b_organ[own].range.y)
        return; // not of the skin
    for (uint organ = 0u; organ < u_organs; ++organ)
        if (organ == own ? b_organ[own].touches.y != 0u : b_organ[own].touches.x != 0u && b_organ[organ].touches.x != 0u)
            touch(node, own, organ);
}
