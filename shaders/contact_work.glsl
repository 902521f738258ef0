// The lists that make a step's passes short: in two sets, of which a step fills one and empties the other.
struct ContactList { // groups of 64 along x, y, z for an indirect dispatch, and how many items they work on
    uint groups, one, another, count;
};
layout(std430) restrict buffer b_work { ContactList b_list[2 * SRS_CONTACT_LISTS]; };

uniform int u_set; // this step's, 0 or 1

#define LIST(kind) b_list[u_set * SRS_CONTACT_LISTS + (kind)]

uint appendTo(int kind) {
    uint at = atomicAdd(LIST(kind).count, 1u);
    atomicMax(LIST(kind).groups, at / 64u + 1u);
    return at;
}
