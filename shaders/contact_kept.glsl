// Implicit steps: a grasp without limit has its nodes where it wants them, and no contact moves them. Twin of
// ContactStage::keep.
bool kept(uint info) {
    uint holder = (info >> SRS_HELD_SHIFT) & SRS_HELD_MASK;
    return holder != 0u && holder <= uint(SRS_TOOLS) && holdsEndlessly(int(holder) - 1);
}
