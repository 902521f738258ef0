// What a ray asks of a lattice's displacement texture (render/lattice_warp.h): p = p' + D(p'), lattice units.
#include "lattice_warp_box.glsl"
uniform sampler3D t_lattice; // D, coverage

vec4 readLattice(vec3 shown) {
    return texture(t_lattice, ((shown - b_lowest.xyz) / b_step.xyz + 0.5) / vec3(textureSize(t_lattice, 0)));
}

/// Is there tissue? All samples around are covered.
bool covered(vec4 read) {
    return read.w > 0.999;
}

/// d(p' + D(p')) / dp', by central differences over a voxel.
mat3 latticeJacobian(vec3 shown) {
    mat3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        vec3 by = vec3(0.0);
        by[axis] = 0.5 * b_step[axis];
        gradient[axis] = (readLattice(shown + by).xyz - readLattice(shown - by).xyz) / b_step[axis];
    }
    return mat3(1.0) + gradient;
}
