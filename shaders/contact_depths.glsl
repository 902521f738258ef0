// Depths of nodes below the organ's surface at rest, as contact counts them (sim/node_depths.h): 8 bits of a state's word.
const real kDepthStep = real(1.0) / real(85.0);
const float kDeepest = 1.0;
const float kNearBy = 0.25; // spacings: so near, a thing may touch once others have moved it

real depthOf(uint info) { return real((info >> SRS_DEPTH_SHIFT) & SRS_DEPTH_MASK) * kDepthStep - 2.0; }
