// The lists that make a step's passes over triangles short.

// Groups of 64 along x, y, z for an indirect dispatch, and how many items they work on.
struct ContactList {
    uint groups, one, another, count;
};
layout(std430) restrict buffer b_work {
    ContactList b_candidates; // b_candidate: triangles that may touch
    ContactList b_again;      // the same for the second round; 0 groups where the first asked for nothing
    ContactList b_movers[2];  // b_mover: nodes that triangles ask to move, round by round
};
