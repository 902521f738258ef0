// Depths of nodes below the organ's surface at rest, as contact counts them (sim/node_depths.h): 8 bits of a state's word.
const double kDepthStep = 1.0lf / 85.0lf;
const float kDeepest = 1.0;

double depthOf(uint info) { return double((info >> SRS_DEPTH_SHIFT) & SRS_DEPTH_MASK) * kDepthStep - 2.0; }
