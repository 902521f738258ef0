// What a ray asks of a lattice's displacement texture (render/lattice_warp.h): p = p' + D(p'), lattice units.
// RAYCAST_CUT: blades cut the lattice. There is a texture a side, and what the finer mask says at p' + D(p') of each says whose
// tissue p' is; in an opened cut it is of neither side. A cut's faces are where the mask ends.
#include "lattice_warp_box.glsl"
uniform sampler3D t_lattice; // D, coverage
#ifdef RAYCAST_CUT
#include "cut_mask.glsl"
uniform sampler3D t_latticeBelow;
#endif

struct Moved {
    vec3 rest;    // p
    float kept;   // of the blades' mask there
    bool covered; // there can be tissue
    float side;   // of the cuts: 1, -1
    float cut;    // to the nearest of them
};

/// All samples around hold tissue.
bool isCovered(vec4 read) {
    return read.w > 0.999;
}

vec4 readLattice(vec3 shown, float side) {
    vec3 at = ((shown - b_lowest.xyz) / b_step.xyz + 0.5) / vec3(textureSize(t_lattice, 0));
#ifdef RAYCAST_CUT
    if (side < 0.0)
        return texture(t_latticeBelow, at);
#endif
    return texture(t_lattice, at);
}

Moved movedBy(vec3 shown, float side) {
    vec4 read = readLattice(shown, side);
    Moved moved = Moved(shown + read.xyz, 0.0, isCovered(read), side, 1e9);
    if (!moved.covered)
        return moved;
    moved.kept = 1.0;
#ifdef RAYCAST_CUT
    vec4 mask = cutMask(moved.rest);
    moved.cut = hasSides(mask) ? SRS_MASK_REACH * mask.b : 1e9;
    moved.kept = hasSides(mask) && side * sideOf(mask) < 0.0 ? 0.0 : mask.a;
#endif
    return moved;
}

/// By the side whose tissue is there.
Moved moveBack(vec3 shown) {
    Moved moved = movedBy(shown, 1.0);
#ifdef RAYCAST_CUT
    if (moved.kept >= 0.5)
        return moved;
    Moved below = movedBy(shown, -1.0);
    if (below.kept >= 0.5 || !moved.covered)
        return below;
    moved.cut = min(moved.cut, below.cut);
#endif
    return moved;
}

/// d(p' + D(p')) / dp' of a side, by central differences over a voxel; where a side's tissue ends, by one-sided ones.
mat3 latticeJacobian(vec3 shown, float side) {
    mat3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        vec3 by = vec3(0.0);
        by[axis] = 0.5 * b_step[axis];
        vec4 more = readLattice(shown + by, side), less = readLattice(shown - by, side);
        float over = b_step[axis];
        // A software renderer runs through what a branch holds, but not through a loop.
        bool before = isCovered(less), after = isCovered(more);
        for (int i = 0; i < int(!(before && after)); ++i) {
            vec4 here = readLattice(shown, side);
            over *= before || after ? 0.5 : 1.0;
            less = before ? less : here;
            more = after ? more : here;
        }
        gradient[axis] = (more.xyz - less.xyz) / over;
    }
    return mat3(1.0) + gradient;
}

#ifdef RAYCAST_CUT
/// Of how far a place at rest lies on its side of the nearest cut; of what was burnt away, of the mask.
vec3 bladeGradient(vec3 rest, float side) {
    vec3 gradient;
    bool sides = hasSides(cutMask(rest));
    vec3 voxel = 1.0 / (u_maskScale * vec3(textureSize(t_cutMask, 0)));
    for (int axis = 0; axis < 3; ++axis) {
        vec3 by = vec3(0.0);
        by[axis] = 2.0 * voxel[axis];
        vec4 more = cutMask(rest + by), less = cutMask(rest - by);
        gradient[axis] = sides ? side * (sideOf(more) - sideOf(less)) : more.a - less.a;
    }
    return gradient;
}
#endif
