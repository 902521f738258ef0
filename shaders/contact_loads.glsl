// What colliders give to nodes: the impulse m dx, and its moment about the collider's reference point at the step's end.
// Sums in fixed point, 64 bits in units of 2^-40 (mass shares times lattice units; moments times lattice units more), by
// integer atomics: the same whatever the order. They are spread over stripes so that few meet; the CPU adds these
// (sim/tool_loads.h).
layout(std430) restrict buffer b_loads { uint b_load[]; }; // ((stripe * colliders + collider) * 6 + component) * 2: low, high

void addFixedPoint(uint slot, float value) {
    if (value == 0.0 || !(abs(value) < 4e6))
        return;
    float scaled = abs(value) * 256.0, whole = floor(scaled);
    uint low = uint((scaled - whole) * 4294967296.0), high = uint(whole);
    if (value < 0.0) {
        low = 0u - low;
        high = ~high + uint(low == 0u);
    }
    uint before = low == 0u ? 0u : atomicAdd(b_load[slot], low);
    high += uint(low != 0u && before + low < before);
    if (high != 0u)
        atomicAdd(b_load[slot + 1u], high);
}

/// \param x the node at the step's start \param by what moved it
void addLoad(int collider, float mass, vec3 x, vec3 by) {
    vec3 impulse = mass * by, moment = cross(x - vec3(b_collider[collider].to.xyz), impulse);
    uint stripe = (gl_WorkGroupID.x + 3u * gl_WorkGroupID.y) % uint(SRS_LOAD_STRIPES);
    uint slot = (stripe * uint(SRS_COLLIDERS) + uint(collider)) * 12u;
    for (uint i = 0u; i < 3u; ++i) {
        addFixedPoint(slot + 2u * i, impulse[i]);
        addFixedPoint(slot + 6u + 2u * i, moment[i]);
    }
}
