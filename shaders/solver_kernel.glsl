// One step of one node: MS05 section 3.1, eq. 2 (or eq. 1 with SRS_EQUATION 1) and eq. 3, for the cell lattice of
// sim/lattice.h. Twin of sim/reference_solver.cpp; what a step does stands in sim/solver.h. Unrolled: loops over
// neighbours are twice slower on llvmpipe.
//
// Departures from MS05: k is the full constant, not a half; each spring's weight comes from the cells that hold it
// (cell_weights.glsl); the increment is stored instead of the last position.
#include "lattice_address.glsl"
#include "packed_normal.glsl"
#include "cell_weights.glsl"

uniform float u_acceleration; // dt^2 k / (rho h^3)
uniform float u_damping;      // damping time / dt, where all materials have the same
uniform float u_drag;         // 1 - air drag dt
uniform vec3 u_gravity;       // dt^2 g / h

// Sums over the springs; weights are in units of k/1020.
vec3 g_position, g_increment, g_force, g_normal;

/// \param damping weight times damping time / dt
void addSpring(float weight, float damping, float rest, float rest2, ivec2 texel) {
#ifdef SRS_TEXEL_FETCH
    if (weight == 0.0) // outside of the texture a fetch is undefined
        texel = ivec2(0);
#endif
    vec3 d = g_position - loadPosition(texel);
#if SRS_EQUATION == 2
    // Scaled so that the square root is of 1 at rest: the rest state then has no force at all in float32.
    float stretch = inversesqrt(max(dot(d, d) * (1.0 / rest2), 1e-12)); // rest length over length
    float pull = weight * (stretch - 1.0);
#else
    float len = max(length(d), 1e-6);
    float stretch = rest / len;
    float pull = weight * (rest - len) / len;
#endif
#ifdef SRS_DAMPING
    pull -= damping * (1.0 / rest2) * (stretch * stretch) * dot(d, g_increment - loadIncrement(texel));
#endif
    g_force += pull * d;
#ifdef SRS_NORMALS
    g_normal += (weight > 0.0 ? stretch * (1.0 / rest) : 0.0) * d; // eq. 3
#endif
}

#ifdef SRS_CELL_PASS
#include "solver_cells.glsl"
#endif

float connected(uint bits, int d) { return float((bits >> d) & 1u); }

// Springs of one direction pair: weights from `c`, damping from `damped` where dampers have weights of their own.
#ifdef SRS_OWN_DAMPERS
#define DAMPING(sum) sum(damped)
#else
#define DAMPING(sum) sum(c) * u_damping
#endif
#define ADD_SPRING(d, sum, rest, rest2, texel)                                                                         \
    addSpring(connected(bits, d) * sum(c), connected(bits, d) * DAMPING(sum), rest, rest2, texel)
#ifdef SRS_FIBRES
#define PAIR(p)                                                                                                        \
    springs = timesSprings(fills, p);                                                                                  \
    WEIGH
#else
#define PAIR(p)
#endif
#ifdef SRS_STIFFENING
#define STRETCHED(cells) timesFactors(cells)
#else
#define STRETCHED(cells) cells
#endif
#ifdef SRS_OWN_DAMPERS
#define WEIGH                                                                                                          \
    c = STRETCHED(springs);                                                                                            \
    damped = timesDampingTimes(springs);
#else
#define WEIGH c = STRETCHED(springs);
#endif

/// Force in units of k h / 1020, and the sum of unit vectors; returns the node's mass in units of rho h^3 / 2040.
float sumSprings(uvec4 info, vec3 position, vec3 increment) {
    const float diagonal = 1.41421356;
    g_position = position;
    g_increment = increment;
    g_force = vec3(0.0);
    g_normal = vec3(0.0);
    uint bits = info.x;
    Cells fills = fillsAround(info);
    beginMaterials(info);
#ifdef SRS_CELL_PASS
    gatherCells(info);
#endif
    Cells springs = timesSprings(fills, 0), c, damped;
    WEIGH
    ADD_SPRING(0, sumPx, 1.0, 1.0, neighbourTexel(1, 0, 0, ROW_SAME));
    ADD_SPRING(1, sumNx, 1.0, 1.0, neighbourTexel(-1, 0, 0, ROW_SAME));
    PAIR(1)
    ADD_SPRING(2, sumPy, 1.0, 1.0, neighbourTexel(0, 1, 0, ROW_Y));
    ADD_SPRING(3, sumNy, 1.0, 1.0, neighbourTexel(0, -1, 0, ROW_y));
    PAIR(2)
    ADD_SPRING(4, sumPz, 1.0, 1.0, neighbourTexel(0, 0, 1, ROW_Z));
    ADD_SPRING(5, sumNz, 1.0, 1.0, neighbourTexel(0, 0, -1, ROW_z));
    PAIR(3)
    ADD_SPRING(6, sumPxPy, diagonal, 2.0, neighbourTexel(1, 1, 0, ROW_Y));
    ADD_SPRING(7, sumNxNy, diagonal, 2.0, neighbourTexel(-1, -1, 0, ROW_y));
    PAIR(4)
    ADD_SPRING(8, sumPxNy, diagonal, 2.0, neighbourTexel(1, -1, 0, ROW_y));
    ADD_SPRING(9, sumNxPy, diagonal, 2.0, neighbourTexel(-1, 1, 0, ROW_Y));
    PAIR(5)
    ADD_SPRING(10, sumPxPz, diagonal, 2.0, neighbourTexel(1, 0, 1, ROW_Z));
    ADD_SPRING(11, sumNxNz, diagonal, 2.0, neighbourTexel(-1, 0, -1, ROW_z));
    PAIR(6)
    ADD_SPRING(12, sumPxNz, diagonal, 2.0, neighbourTexel(1, 0, -1, ROW_z));
    ADD_SPRING(13, sumNxPz, diagonal, 2.0, neighbourTexel(-1, 0, 1, ROW_Z));
    PAIR(7)
    ADD_SPRING(14, sumPyPz, diagonal, 2.0, neighbourTexel(0, 1, 1, ROW_YZ));
    ADD_SPRING(15, sumNyNz, diagonal, 2.0, neighbourTexel(0, -1, -1, ROW_yz));
    PAIR(8)
    ADD_SPRING(16, sumPyNz, diagonal, 2.0, neighbourTexel(0, 1, -1, ROW_Yz));
    ADD_SPRING(17, sumNyPz, diagonal, 2.0, neighbourTexel(0, -1, 1, ROW_yZ));
    return sumAll(timesDensities(fills));
}
