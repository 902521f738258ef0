// Constants that C++ and GLSL share, of the implicit step alone: #define only, included by both.

// The implicit step (sim/implicit_system.h, shaders/implicit_common.glsl)
#define SRS_IMPLICIT_GROUP 128    // invocations of a work group
#define SRS_IMPLICIT_COARSEST 28  // nodes of the last level, at most: its matrix fits shared memory
#define SRS_IMPLICIT_TAIL 1200    // nodes of the levels that one work group takes care of, at most
#define SRS_IMPLICIT_REGULAR 1e-6 // added to diagonals before they are inverted, as a share
#define SRS_IMPLICIT_ARMIJO 1e-4  // of the fall that the gradient promises
// Arrays of one vec4 a node in b_vector
#define SRS_VEC_X 0   // x at the step's start; w: mass
#define SRS_VEC_V 1   // v; w: c, 0 for a held node
#define SRS_VEC_U 2   // u'
#define SRS_VEC_T 3   // u' where the search begins; where a held node must go
#define SRS_VEC_G 4   // gradient
#define SRS_VEC_S 5   // Newton's step so far
#define SRS_VEC_R 6   // residual
#define SRS_VEC_P 7   // direction of conjugate gradients
#define SRS_VEC_Q 8   // matrix times direction
#define SRS_VEC_Z 9   // preconditioned residual
#define SRS_VEC_DA 10 // inverse diagonal block: xx, yy, zz
#define SRS_VEC_DB 11 // xy, yz, zx
#define SRS_VECS 12
// More of them where there are tools or bodies (implicit_support.comp)
#define SRS_VEC_F 12  // what contact gives, linearized: force; w: collider, counted from 1
#define SRS_VEC_KA 13 // its stiffness: xx, yy, zz; w: pressure
#define SRS_VEC_KB 14 // xy, yz, zx
#define SRS_VEC_N 15  // normal; w: 1 where it touches
#define SRS_VEC_A 16  // where to it slides; w: 1 if it does
#define SRS_VEC_W 17  // what contact gave after the last round; w: stiffness of the penalty
#define SRS_CONTACT_VECS 18
#define SRS_SUPPORTED_ACCURACY 0.1 // times ImplicitLimits::accuracy, where anything touches
// Arrays of one vec4 a cell in b_cell
#define SRS_CELL_LOAD 0   // three columns of a f dW/dF / 4
#define SRS_CELL_ROOT 3   // of cof F / 4 times the root of its stiffness; w: free corners, pull
#define SRS_CELL_FACTOR 6 // of stiffening, and its tangent
#define SRS_CELLS 7
// Sums over all nodes, one vec4 a work group, in b_sum
#define SRS_SUM_CURVATURE 0 // p . H p
#define SRS_SUM_RESIDUAL 1  // r . z, of even and (2) odd iterations
#define SRS_SUM_CHANGES 3   // of Phi, four shares
#define SRS_SUM_PROMISE 4   // gradient . step
#define SRS_SUMS 5
// A level's header in b_table, SRS_LEVEL_INTS each
#define SRS_LEVEL_NODES 0
#define SRS_LEVEL_CELLS 1
#define SRS_LEVEL_AROUND 2  // place in b_table: the cell in each octant around a node, 8 times nodes
#define SRS_LEVEL_CORNERS 3 // the corners of a cell, 8 times cells
#define SRS_LEVEL_COARSER 4 // 8 times nodes
#define SRS_LEVEL_FINER 5   // 27 times nodes
#define SRS_LEVEL_PARTS 6   // the cells in the octants of a cell, 8 times cells
#define SRS_LEVEL_VECTORS                                                                                    \
    7 // place in b_level: residuals, corrections, inverse blocks (2), anchored blocks (2)
#define SRS_LEVEL_QUADRATURE 8 // place in b_quadrature: SRS_QUADRATURE a cell
#define SRS_LEVEL_BLOCKS 9     // place in b_quadrature: two vec4 a corner of a cell
#define SRS_LEVEL_INTS 10
#define SRS_QUADRATURE 15 // six symmetric matrices (2 vec4 each), the volumetric term's root (3 columns)
