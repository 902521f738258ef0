// Weights of springs and dampers, times a (ImplicitSystem). Without stiffening they are constants; with it sums over the
// cells that hold a spring, as they have stiffened.
layout(std430) readonly buffer b_weights { float b_weight[]; }; // SRS_NEIGHBOURS times nodes; then the dampers
#ifdef SRS_STIFFENING
// The octants, a bit each, whose cells hold the connection.
const uint kOctantsOf[SRS_NEIGHBOURS] = uint[SRS_NEIGHBOURS](0xaau, 0x55u, 0xccu, 0x33u, 0xf0u, 0x0fu, 0x88u, 0x11u,
                                                             0x22u, 0x44u, 0xa0u, 0x05u, 0x0au, 0x50u, 0xc0u, 0x03u,
                                                             0x0cu, 0x30u);
float weightOf(int node, int d, out float tangent) {
    float weight = 0.0;
    tangent = 0.0;
    for (int octant = 0; octant < 8; ++octant) {
        int cell = ((kOctantsOf[d] >> octant) & 1u) != 0u ? cellAround(0, node, octant) : -1;
        if (cell < 0)
            continue;
        float constant = shareOf(cell) * u_springs[int(materialOf(cell)) * 9 + d / 2] * (d < 6 ? 0.25 : 0.5);
        vec4 factors = CELL(SRS_CELL_FACTOR, cell);
        weight += constant * factors.x;
        tangent += constant * factors.y;
    }
    return weight;
}
#else
float weightOf(int node, int d, out float tangent) { return tangent = b_weight[d * u_nodes + node]; }
#endif

float damperOf(int node, int d, float damping) {
#ifndef SRS_DAMPING
    return 0.0;
#elif defined SRS_OWN_DAMPERS
    return b_weight[(SRS_NEIGHBOURS + d) * u_nodes + node];
#else
    return damping * b_weight[d * u_nodes + node];
#endif
}
