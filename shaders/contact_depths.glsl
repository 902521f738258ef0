// Depths of nodes below the organ's surface at rest, as contact counts them (sim/node_depths.h): 8 bits of a state's word.
const float kDepthStep = 1.0 / 85.0, kDeepest = 1.0;

float depthOf(uint info) { return float((info >> SRS_DEPTH_SHIFT) & SRS_DEPTH_MASK) * kDepthStep - 2.0; }
