// The pass over the cells before a step, one invocation a cell, at the texel of its lowest corner: the volumetric term
// (sim/volume_term.h: three columns of fill dW/dF, fills 0 .. 255), and the cell's factor of stiffening
// (sim/stiffening.h). Twin of VolumeTerm::addForces and Stiffening::factors. Fragment and compute pass share it.
#include "shared_constants.h"

layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
layout(rgba32f) uniform readonly restrict image2D i_positions;
uniform float u_bulks[SRS_MATERIALS];      // (lambda - mu) h / k of each material
uniform float u_recoveries[SRS_MATERIALS]; // of collapsed cells, k/h

#include "lattice_address.glsl"
#ifdef SRS_STIFFENING
#include "cell_stiffening.glsl"
#endif

struct CellTerm {
    vec4 x, y, z; // columns; w: J, the factor, nothing
};

// The connections that stay inside the cell from its corner (directionsInCell in sim/cell_volumes.cpp).
const uint kInside[8] = uint[8](SRS_IN_CELL_0, SRS_IN_CELL_1, SRS_IN_CELL_2, SRS_IN_CELL_3, SRS_IN_CELL_4,
                                SRS_IN_CELL_5, SRS_IN_CELL_6, SRS_IN_CELL_7);

CellTerm cellTerm(ivec2 texel) {
    CellTerm term = CellTerm(vec4(0.0), vec4(0.0, 0.0, 0.0, 1.0), vec4(0.0));
    uvec4 info = imageLoad(i_nodeInfo, texel);
    float fill = float(info.z >> 24); // of the cell towards +x, +y, +z
    uint material = info.w >> 28;
    if (fill == 0.0 || (info.x & SRS_FLAG_ACTIVE) == 0u)
        return term;
    beginAddresses(texel);
    ivec2 texels[8] = ivec2[8](texel, neighbourTexel(1, 0, 0, ROW_SAME), neighbourTexel(0, 1, 0, ROW_Y),
                               neighbourTexel(1, 1, 0, ROW_Y), neighbourTexel(0, 0, 1, ROW_Z),
                               neighbourTexel(1, 0, 1, ROW_Z), neighbourTexel(0, 1, 1, ROW_YZ),
                               neighbourTexel(1, 1, 1, ROW_YZ));
    vec3 p[8];
    uint bits[8];
    bool whole = true; // does no cut run through it?
    for (int c = 0; c < 8; ++c) {
        p[c] = imageLoad(i_positions, texels[c]).xyz;
        bits[c] = imageLoad(i_nodeInfo, texels[c]).x & kInside[c];
        whole = whole && bits[c] == kInside[c];
    }
    // Differences first: they are exact, and the rest state is exactly the identity.
    vec3 a = 0.25 * ((p[1] - p[0]) + (p[3] - p[2]) + (p[5] - p[4]) + (p[7] - p[6]));
    vec3 b = 0.25 * ((p[2] - p[0]) + (p[3] - p[1]) + (p[6] - p[4]) + (p[7] - p[5]));
    vec3 c = 0.25 * ((p[4] - p[0]) + (p[5] - p[1]) + (p[6] - p[2]) + (p[7] - p[3]));
    vec3 x = cross(b, c), y = cross(c, a), z = cross(a, b);
    float J = dot(a, x);
    float size = dot(x, x) + dot(y, y) + dot(z, z), change = J - 1.0, collapse = max(0.0, SRS_COLLAPSED - J);
    float soft = min(1.0, SRS_VOLUME_STIFFENING / max(size, 1e-12)), q = soft * soft;
    float bulk = whole ? u_bulks[material] : 0.0, recovery = whole ? u_recoveries[material] : 0.0, factor = 1.0;
#ifdef SRS_STIFFENING
    if (hasCurve(material))
        factor = stiffening(material, springEnergy(material, bits, p) + 0.5 * bulk * q * change * change);
    bulk *= factor;
#endif
    float pressure = fill * q * (bulk * change - recovery * collapse);
    x *= pressure;
    y *= pressure;
    z *= pressure;
    if (soft < 1.0) { // dq/dF
        float softened = -2.0 * fill * q / size * (bulk * change * change + recovery * collapse * collapse);
        float aa = dot(a, a), bb = dot(b, b), cc = dot(c, c), ab = dot(a, b), bc = dot(b, c), ca = dot(c, a);
        x += softened * ((bb + cc) * a - ab * b - ca * c);
        y += softened * ((cc + aa) * b - bc * c - ab * a);
        z += softened * ((aa + bb) * c - ca * a - bc * b);
    }
    term.x = vec4(x, J);
    term.y = vec4(y, factor);
    term.z = vec4(z, 0.0);
    return term;
}
