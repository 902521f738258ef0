// The mass that each tool holds, as whole numbers of 1/2040 of a full node's (one cell's fill, where there is one
// material), so that the sum is the same whatever the order. Three sets: this step's, the next one's, and one to empty.
layout(std430) restrict buffer b_heldMasses { uint b_heldMass[3 * 8]; };

uniform int u_now; // this step's set

void countHeld(int set, uint holder, float mass) {
    atomicAdd(b_heldMass[set * 8 + int(holder)], uint(mass * 2040.0 + 0.5));
}
float heldMass(uint holder) { return float(b_heldMass[u_now * 8 + int(holder)]) / 2040.0; }
