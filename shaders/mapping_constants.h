// Constants of the surface mappings that C++ and GLSL share: #define only, included by both.

// What a drawing program does (MAPPING)
#define SRS_MAP_CONSTANT 0  // one basis a triangle, MS05 eq. 6
#define SRS_MAP_CORRECTED 1 // the basis turned by the nodes' normals, eq. 8
#define SRS_MAP_EITHER 2    // one of the two, as each vertex says
#define SRS_MAP_BLENDED 3   // a share of both, as each vertex says (3.6)
#define SRS_MAP_NORMAL 4    // along the normal of eq. 6 or 8 alone (3.5)
#define SRS_MAP_FRAMES 5    // a rotation a node
#define SRS_MAP_CELLS 6     // trilinear in a cell of the lattice

#define SRS_WEIGHT_STEPS 65535.0 // of a vertex' weights w1, w2
#define SRS_SHARE_STEPS 255.0    // of its shares (MAPPING == SRS_MAP_BLENDED)

#define SRS_TABLE_WIDTH 4096 // texels: of tables in textures (cells, two texels each; terms of node frames)

// Node frames (shaders/packed_frame.glsl)
#define SRS_FRAME_HALF_STEPS 1048575.0 // 2^20 - 1, of a coordinate -1..1
#define SRS_FRAME_SQUARINGS 8          // of the quaternion matrix: its 256th power
#define SRS_FRAME_GROUP 64             // nodes a work group
