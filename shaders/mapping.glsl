// How a vertex follows its nodes: one mapping a program (MAPPING, mapping_constants.h). Twin of mapSurface in
// render/map_surface.cpp. Each file declares the attributes that it needs and defines mapVertex().
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
#include "mapping_cell.glsl"
#else
#include "mapping_triangle.glsl"
#endif
