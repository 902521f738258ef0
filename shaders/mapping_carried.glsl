// Vertices beside a cut ride in the cell that they rest in, as their side of the cut has it, whatever the mapping: a lip that is
// bent hard stays as smooth as its cells, where triangles of cut nodes turn away from each other. Farther from the cut the
// mapping takes over (render/cut_surface.h).
#include "cell_map.glsl"
#include "surface_rest.glsl"

layout(location = 12) in uint a_carried; // 1 + its place in t_carried; 0: as the mapping has it

uniform usampler2D t_carried; // three texels a vertex: node texels of its cell's corners; where it lies there, and its share (floats)

float cellShare = 0.0; // of the cell in where the vertex lies
mat3 cellTurn;         // the cell's Jacobian there

uvec4 carriedTexel(uint at) {
    return texelFetch(t_carried, ivec2(at & (SRS_TABLE_WIDTH - 1u), at / SRS_TABLE_WIDTH), 0);
}

Mapped mapVertex() {
    if (a_carried == 0u)
        return mapOwn();
    uint at = 3u * (a_carried - 1u);
    vec4 place = uintBitsToFloat(carriedTexel(at + 2u));
    Mapped cell = mapInCell(carriedTexel(at), carriedTexel(at + 1u), place.xyz, unpackNormal(a_frame.x));
    cellShare = place.w;
    cellTurn = cell.turn;
    if (cellShare >= 1.0)
        return cell;
    Mapped mapped = mapOwn();
    mapped.position = mix(mapped.position, cell.position, cellShare);
    mapped.normal = normalize(mix(mapped.normal, cell.normal, cellShare));
    mapped.dynamicNormal = mix(mapped.dynamicNormal, cell.dynamicNormal, cellShare);
    mapped.axes = cell.axes; // what fades is given in them from its start
    return mapped;
}

/// A tangent at rest, given in what the mapping turns and in the lattice's axes, carried along.
vec3 carryTangent(Mapped mapped, vec3 own, vec3 rest) {
    if (cellShare >= 1.0)
        return cellTurn * rest;
    vec3 turned = mapped.turn * own;
    return cellShare > 0.0 ? mix(turned, cellTurn * rest, cellShare) : turned;
}
