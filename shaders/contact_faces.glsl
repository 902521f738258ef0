// The triangles that close the organ (sim/contact_surface.h); nodes are numbers of texels.
#include "contact_depths.glsl"

struct ContactTriangle {
    uint nodes[3];
    uint depths;            // of the corners at rest, 8 bits each (SRS_DEPTH_SHIFT)
    float inverseMasses[3]; // 0: fixed
    uint spare;
};
layout(std430) readonly restrict buffer b_triangles { ContactTriangle b_triangle[]; };

real3 depthsOf(ContactTriangle triangle) {
    return real3((uvec3(triangle.depths) >> uvec3(0, 8, 16)) & 255u) * kDepthStep - 2.0;
}
