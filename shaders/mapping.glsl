// How a vertex follows its nodes: one mapping a program (MAPPING, mapping_constants.h). Twin of mapSurface in
// render/map_surface.cpp. Each file declares the attributes that it needs and defines mapOwn(); beside cuts the vertex rides in
// its cell instead (mapping_carried.glsl).
#include "mapping_constants.h"
#include "node_texel.glsl"

struct Mapped {
    vec3 position;
    vec3 normal;        // of the surface, along it
    vec3 dynamicNormal; // of the nodes
    mat3 axes;          // orthonormal: what is given in them turns with the tissue
    mat3 turn;          // of tangents, which tissue also stretches: the axes, or the Jacobian of a cell
};

layout(location = 3) in uint a_normal; // packed, in the axes ; bit 30: the basis is the corrected one

#if MAPPING == SRS_MAP_FRAMES
#include "mapping_frames.glsl"
#elif MAPPING == SRS_MAP_CELLS
#include "cell_map.glsl"
#include "mapping_cell.glsl"
#else
#include "mapping_triangle.glsl"
#endif

#if defined(SURFACE_CUT) && MAPPING != SRS_MAP_CELLS
#include "mapping_carried.glsl"
#else
Mapped mapVertex() {
    return mapOwn();
}

/// A tangent at rest, given in what the mapping turns, carried along.
vec3 carryTangent(Mapped mapped, vec3 own, vec3 rest) {
    return mapped.turn * own;
}
#endif
