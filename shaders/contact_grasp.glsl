// The nodes that tools hold, in a list that is made anew when a grasp opens or closes, and the mass that each tool holds, as
// whole numbers of 1/2040 of a full node's (one cell's fill, where there is one material), so that the sum is the same
// whatever the order. Three sets of masses: this step's, the next one's, and one to empty.
layout(std430) restrict buffer b_held {
    uint b_heldGroups, b_heldOne, b_heldAnother, b_heldCount; // as ContactList
    uint b_heldMass[3 * 8];
    uint b_heldNode[];
};

uniform int u_now; // this step's set of masses

void countHeld(int set, uint holder, float mass) {
    atomicAdd(b_heldMass[set * 8 + int(holder)], uint(mass * 2040.0 + 0.5));
}
float heldMass(uint holder) { return float(b_heldMass[u_now * 8 + int(holder)]) / 2040.0; }
