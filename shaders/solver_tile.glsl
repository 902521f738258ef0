// Shared-memory tiles for the grid layout: a work group's nodes with a border one node wide, positions and (with damping)
// increments, in place of lattice_address.glsl.
const ivec3 kTile = ivec3(SRS_GROUP_X + 2, SRS_GROUP_Y + 2, SRS_GROUP_Z + 2);
const int kTileNodes = (SRS_GROUP_X + 2) * (SRS_GROUP_Y + 2) * (SRS_GROUP_Z + 2);
shared vec3 s_positions[kTileNodes];
#ifdef SRS_DAMPING
shared vec3 s_increments[kTileNodes];
#endif

void fillTile() {
    ivec3 first = ivec3(gl_WorkGroupID * gl_WorkGroupSize) - 1;
    for (int i = int(gl_LocalInvocationIndex); i < kTileNodes; i += SRS_GROUP_X * SRS_GROUP_Y * SRS_GROUP_Z) {
        ivec3 at = first + ivec3(i % kTile.x, i / kTile.x % kTile.y, i / (kTile.x * kTile.y));
        ivec2 texel = ivec2(at.x, at.y + SRS_GRID_NY * at.z);
#ifdef SRS_TEXEL_FETCH
        texel = clamp(texel, ivec2(0), ivec2(u_items.x, u_items.y * u_items.z) - 1); // outside a fetch is undefined
#endif
        s_positions[i] = fetchPosition(texel);
#ifdef SRS_DAMPING
        s_increments[i] = fetchIncrement(texel);
#endif
    }
    barrier();
}

// Addresses are places in the tile (x only); a node's own texel is read from the textures.
int g_inTile;
ivec2 g_texel;
void beginAddresses(ivec2 texel) {
    g_texel = texel;
    ivec3 local = ivec3(gl_LocalInvocationID) + 1;
    g_inTile = (local.z * kTile.y + local.y) * kTile.x + local.x;
}
#define neighbourTexel(dx, dy, dz, row) ivec2(g_inTile + (dx) + kTile.x * ((dy) + kTile.y * (dz)), 0)
#define cellTexel(dx, dy, dz, row) (g_texel + ivec2(dx, (dy) + SRS_GRID_NY * (dz)))
vec3 loadPosition(ivec2 place) { return s_positions[place.x]; }
#ifdef SRS_DAMPING
vec3 loadIncrement(ivec2 place) { return s_increments[place.x]; }
#endif
