// Jump flooding of render/distance_volume.h: each voxel knows a voxel of the band, packed x | y << 10 | z << 20, and takes the
// nearest that its neighbours `u_stride` away know. FLOOD_BEGIN: those of the band know themselves.
#version 450 core
layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;

#ifdef FLOOD_BEGIN
layout(r32ui) uniform restrict readonly uimage3D i_owner;
#else
layout(r32ui) uniform restrict readonly uimage3D i_seeds;
uniform int u_stride;
#endif
layout(r32ui) uniform restrict writeonly uimage3D i_next;
uniform ivec3 u_size;

const uint kNone = 0xffffffffu;

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at, u_size)))
        return;
#ifdef FLOOD_BEGIN
    bool band = imageLoad(i_owner, at).x != kNone;
    imageStore(i_next, at, uvec4(band ? uint(at.x | at.y << 10 | at.z << 20) : kNone));
#else
    uint best = kNone;
    int least = 0x7fffffff;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                ivec3 from = at + u_stride * ivec3(x, y, z);
                if (any(lessThan(from, ivec3(0))) || any(greaterThanEqual(from, u_size)))
                    continue;
                uint seed = imageLoad(i_seeds, from).x;
                ivec3 away = ivec3(seed & 1023u, seed >> 10 & 1023u, seed >> 20 & 1023u) - at;
                int far = away.x * away.x + away.y * away.y + away.z * away.z;
                if (seed != kNone && (far < least || (far == least && seed < best))) {
                    least = far;
                    best = seed;
                }
            }
    imageStore(i_next, at, uvec4(best));
#endif
}
