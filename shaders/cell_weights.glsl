// What the eight cells around a node give to its springs and its mass (sim/tissue_field.h), and the sums over the cells
// that hold a spring. Each sum is taken in the same order from both ends of its spring: over x, then y, then z.
//
// Fills 0 .. 255 times the cells' stiffness in units of material 0: a spring of k sums to 1020. One isotropic material
// needs no factors, and its sums are whole numbers.
struct Cells { // components: the cells towards (-x-y, +x-y, -x+y, +x+y)
    vec4 below; // towards -z
    vec4 above; // towards +z
};

Cells fillsAround(uvec4 info) {
#ifdef SRS_FULL_CELLS // for benchmarks: as if every cell were full
    return Cells(vec4(255.0), vec4(255.0));
#endif
    return Cells(vec4((info.yyyy >> uvec4(0, 8, 16, 24)) & 255u), vec4((info.zzzz >> uvec4(0, 8, 16, 24)) & 255u));
}

float sumAll(Cells c) { // every cell: the mass
    return ((c.below.x + c.below.y) + (c.below.z + c.below.w)) + ((c.above.x + c.above.y) + (c.above.z + c.above.w));
}

// Springs along x, y, z from the node towards + and -, and diagonals named by where they lead.
float sumPx(Cells c) { return (c.below.y + c.below.w) + (c.above.y + c.above.w); }
float sumNx(Cells c) { return (c.below.x + c.below.z) + (c.above.x + c.above.z); }
float sumPy(Cells c) { return (c.below.z + c.below.w) + (c.above.z + c.above.w); }
float sumNy(Cells c) { return (c.below.x + c.below.y) + (c.above.x + c.above.y); }
float sumPz(Cells c) { return (c.above.x + c.above.y) + (c.above.z + c.above.w); }
float sumNz(Cells c) { return (c.below.x + c.below.y) + (c.below.z + c.below.w); }
float sumPxPy(Cells c) { return 2.0 * (c.below.w + c.above.w); }
float sumNxNy(Cells c) { return 2.0 * (c.below.x + c.above.x); }
float sumPxNy(Cells c) { return 2.0 * (c.below.y + c.above.y); }
float sumNxPy(Cells c) { return 2.0 * (c.below.z + c.above.z); }
float sumPxPz(Cells c) { return 2.0 * (c.above.y + c.above.w); }
float sumNxNz(Cells c) { return 2.0 * (c.below.x + c.below.z); }
float sumPxNz(Cells c) { return 2.0 * (c.below.y + c.below.w); }
float sumNxPz(Cells c) { return 2.0 * (c.above.x + c.above.z); }
float sumPyPz(Cells c) { return 2.0 * (c.above.z + c.above.w); }
float sumNyNz(Cells c) { return 2.0 * (c.below.x + c.below.y); }
float sumPyNz(Cells c) { return 2.0 * (c.below.z + c.below.w); }
float sumNyPz(Cells c) { return 2.0 * (c.above.x + c.above.y); }

#ifdef SRS_CELL_MATERIALS
uniform float u_springs[SRS_MATERIALS * 9]; // by material and direction pair: MaterialShares::spring
uniform float u_densities[SRS_MATERIALS];
uniform float u_dampingTimes[SRS_MATERIALS]; // over dt

uvec4 g_materialsBelow, g_materialsAbove;
void beginMaterials(uvec4 info) {
    g_materialsBelow = (info.wwww >> uvec4(0, 4, 8, 12)) & 15u;
    g_materialsAbove = (info.wwww >> uvec4(16, 20, 24, 28)) & 15u;
}
vec4 springsOf(uvec4 m, int pair) {
    return vec4(u_springs[m.x * 9u + uint(pair)], u_springs[m.y * 9u + uint(pair)], u_springs[m.z * 9u + uint(pair)],
                u_springs[m.w * 9u + uint(pair)]);
}
Cells timesSprings(Cells c, int pair) {
    return Cells(c.below * springsOf(g_materialsBelow, pair), c.above * springsOf(g_materialsAbove, pair));
}
#define OF_MATERIALS(values, m) vec4(values[m.x], values[m.y], values[m.z], values[m.w])
Cells timesDensities(Cells c) {
    return Cells(c.below * OF_MATERIALS(u_densities, g_materialsBelow),
                 c.above * OF_MATERIALS(u_densities, g_materialsAbove));
}
Cells timesDampingTimes(Cells c) {
    return Cells(c.below * OF_MATERIALS(u_dampingTimes, g_materialsBelow),
                 c.above * OF_MATERIALS(u_dampingTimes, g_materialsAbove));
}
#else
void beginMaterials(uvec4 info) {}
Cells timesSprings(Cells c, int pair) { return c; }
Cells timesDensities(Cells c) { return c; }
#endif
