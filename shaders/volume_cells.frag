// The volumetric term's first pass: one fragment a cell, at the texel of its lowest corner. Writes the three columns of
// fill p cof(F), fills 0 .. 255; what they are stands in sim/volume_term.h. Twin of VolumeTerm::addForces.
#version 450 core
#include "shared_constants.h"

layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
layout(rgba32f) uniform readonly restrict image2D i_positions;
uniform float u_bulk;     // (lambda - mu) / mu
uniform float u_recovery; // SRS_RECOVERY or 0

#include "lattice_address.glsl"

layout(location = 0) out vec4 o_x; // w: J
layout(location = 1) out vec4 o_y;
layout(location = 2) out vec4 o_z;

vec3 position(ivec2 texel) { return imageLoad(i_positions, texel).xyz; }
bool whole(ivec2 texel, uint needed) { return (imageLoad(i_nodeInfo, texel).x & needed) == needed; }

// The connections that stay inside the cell from its corner (directionsInCell in sim/volume_term.cpp).
const uint kInside[8] = uint[8](SRS_IN_CELL_0, SRS_IN_CELL_1, SRS_IN_CELL_2, SRS_IN_CELL_3, SRS_IN_CELL_4,
                                SRS_IN_CELL_5, SRS_IN_CELL_6, SRS_IN_CELL_7);

void main() {
    o_x = o_y = o_z = vec4(0.0);
    ivec2 texel = ivec2(gl_FragCoord.xy);
    uvec4 info = imageLoad(i_nodeInfo, texel);
    float fill = float(info.z >> 24); // of the cell towards +x, +y, +z
    if (fill == 0.0 || (info.x & SRS_FLAG_ACTIVE) == 0u)
        return;
    beginAddresses(texel);
    ivec2 t1 = neighbourTexel(1, 0, 0, ROW_SAME), t2 = neighbourTexel(0, 1, 0, ROW_Y);
    ivec2 t3 = neighbourTexel(1, 1, 0, ROW_Y), t4 = neighbourTexel(0, 0, 1, ROW_Z);
    ivec2 t5 = neighbourTexel(1, 0, 1, ROW_Z), t6 = neighbourTexel(0, 1, 1, ROW_YZ);
    ivec2 t7 = neighbourTexel(1, 1, 1, ROW_YZ);
    if (!((info.x & kInside[0]) == kInside[0] && whole(t1, kInside[1]) && whole(t2, kInside[2]) &&
          whole(t3, kInside[3]) && whole(t4, kInside[4]) && whole(t5, kInside[5]) && whole(t6, kInside[6]) &&
          whole(t7, kInside[7])))
        return; // a cut runs through the cell
    vec3 p0 = position(texel), p1 = position(t1), p2 = position(t2), p3 = position(t3);
    vec3 p4 = position(t4), p5 = position(t5), p6 = position(t6), p7 = position(t7);
    // Differences first: they are exact, and the rest state is exactly the identity.
    vec3 a = 0.25 * ((p1 - p0) + (p3 - p2) + (p5 - p4) + (p7 - p6));
    vec3 b = 0.25 * ((p2 - p0) + (p3 - p1) + (p6 - p4) + (p7 - p5));
    vec3 c = 0.25 * ((p4 - p0) + (p5 - p1) + (p6 - p2) + (p7 - p3));
    vec3 x = cross(b, c), y = cross(c, a), z = cross(a, b);
    float J = dot(a, x);
    float soft = min(1.0, SRS_VOLUME_STIFFENING / max(dot(x, x) + dot(y, y) + dot(z, z), 1e-12));
    float pressure = u_bulk * (J - 1.0) * soft * soft - u_recovery * max(0.0, SRS_COLLAPSED - J);
    o_x = vec4(fill * pressure * x, J);
    o_y = vec4(fill * pressure * y, 0.0);
    o_z = vec4(fill * pressure * z, 0.0);
}
