// Constants that C++ and GLSL share: #define only, included by both.
#define SRS_MAX_TOOLS 7
#define SRS_MAX_COLLIDERS 12 // tools and bodies

// State textures (ARCHITECTURE.md, texture formats).
// Node info texel, RGBA32UI: .x = connection bits 0..17, rest depth << 18 (8 bits), flags << 26 (6 bits);
// .y, .z = fills of the 8 cells around the node, 8 bits each (cell c at corner bits x=1, y=2, z=4); .w =
// materials of these cells, 4 bits each.
#define SRS_CONNECTION_MASK 0x3ffffu
#define SRS_DEPTH_SHIFT                                                                                      \
    18 // below the surface, as contact counts it: steps of 1/85 spacing from -2 (sim/node_depths.h)
#define SRS_DEPTH_MASK 0xffu
#define SRS_FLAG_ACTIVE (1u << 26)
#define SRS_FLAG_FIXED (1u << 27)
#define SRS_HELD_SHIFT 28
#define SRS_HELD_MASK 0x7u // 0: free, else 1 + the index of the tool that holds the node
#define SRS_FLAG_SPARE (1u << 31)

// Connection order: 6 axis neighbours at h, then 12 face diagonals at sqrt(2) h. Opposite directions are
// adjacent: 0 +x, 1 -x, 2 +y, 3 -y, 4 +z, 5 -z, 6 (+,+,0), 7 (-,-,0), 8 (+,-,0), 9 (-,+,0), 10 (+,0,+), 11
// (-,0,-), 12 (+,0,-), 13 (-,0,+), 14 (0,+,+), 15 (0,-,-), 16 (0,+,-), 17 (0,-,+)
#define SRS_NEIGHBOURS 18

// The six connections that stay inside a cell from its corner c (at +x if c&1, +y if c&2, +z if c&4)
#define SRS_IN_CELL_0 0x04455u
#define SRS_IN_CELL_1 0x06216u
#define SRS_IN_CELL_2 0x20519u
#define SRS_IN_CELL_3 0x2209au
#define SRS_IN_CELL_4 0x11065u
#define SRS_IN_CELL_5 0x10a26u
#define SRS_IN_CELL_6 0x09129u
#define SRS_IN_CELL_7 0x088aau

// Texture layouts of the lattice (sim/texture_layout.h)
#define SRS_LAYOUT_GRID 0 // whole grid in strips: width nx, height ny*nz
#define SRS_LAYOUT_ROWS 1 // nodes only, row after row; eight row offsets a node

// Tools
#define SRS_TOOL_NONE 0
#define SRS_TOOL_PUSH 1
#define SRS_TOOL_GRASP 2

#define SRS_EJECTION 0.01          // spacings a step: how fast a push moves out what is inside of it already
#define SRS_SWEEP_SAMPLES 64       // most, of a step's motion against a collider
#define SRS_SWEEP_BISECTIONS 12    // of the moment of touch between two samples
#define SRS_CONTACT_ITERATIONS 3   // rounds over the boundary triangles a step
#define SRS_TRIANGLE_ITERATIONS 12 // for the deepest point of a triangle
#define SRS_WALL 0.4 // spacings: how near a tool may come, from inside, to the far side of what it presses
#define SRS_GRIP_SLACK 0.1 // spacings outside of its tool beyond which a held node that slips is let go

// Rigid shapes: ShapeKind (sim/rigid_shape.h)
#define SRS_SHAPE_SPHERE 0
#define SRS_SHAPE_CAPSULE 1
#define SRS_SHAPE_BOX 2
#define SRS_SHAPE_HOOK 3
#define SRS_SHAPE_HALF_SPACE 4
#define SRS_SHAPE_MESH 5

// Contact on the GPU (sim/contact_pass.h): lists of a step
#define SRS_LIST_NEAR 0       // nodes near a collider
#define SRS_LIST_CANDIDATES 1 // boundary triangles near one
#define SRS_LIST_AGAIN 2      // the same for later rounds: no groups where the first asked for nothing
#define SRS_LIST_MOVERS 3     // nodes that triangles ask to move, a list a round
#define SRS_CONTACT_LISTS (SRS_LIST_MOVERS + SRS_CONTACT_ITERATIONS)

#define SRS_LOAD_STRIPES 16 // copies of the sums of what colliders gave (shaders/contact_loads.glsl)

// Strokes (sim/blade.h). The last three are powers of two, exact as float and as double.
#define SRS_STROKE_BLADE 0
#define SRS_STROKE_CAUTERIZE 1
#define SRS_STROKE_TEAR 2
#define SRS_HIGHER_DIRECTIONS 0x26655u           // connections that lead to a node with a higher index
#define SRS_BLADE_ROUNDING 5.684341886080802e-14 // 2^-44: bound of all rounding, a unit of size and normal
#define SRS_BLADE_FLAT 5.9604644775390625e-8     // 2^-24 h: a strip that turns by less counts as flat
#define SRS_BLADE_MOST_TESTS 2048                // of strips, a spring

// Packed normals: octahedral, 15 bits a coordinate, bits 30 and 23 fixed so that the float is never NaN,
// infinite or denormal.
#define SRS_NORMAL_HALF_STEPS 16380.0 // of a coordinate -1..1 on either side of 0; divides by 2, 3 and 4

// The volumetric term (sim/volume_term.h)
#define SRS_VOLUME_STIFFENING 3.5 // |cof F|^2 beyond which a squeezed cell stiffens no further; at rest 3
#define SRS_COLLAPSED 0.4         // cells below this share of their volume push back, where recovery is asked
#define SRS_RECOVERY 3.0          // for; its stiffness in units of k/h

// Materials (sim/material.h)
#define SRS_MAX_MATERIALS 16 // an organ: 4 bits a cell
#define SRS_CURVE_BREAKS 8   // turns of a stress-strain curve, the strain limit's among them
#define SRS_SPRING_BEND(poisson) (1.75 * (0.45 - (poisson))) // sim/stiffening.h
#define SRS_STRAIN_ITERATIONS 4
#define SRS_LIMIT_STIFFENING 10.0 // tangent beyond a strain limit over the tangent before it

// What couples organs (sim/pair_contact.h, sim/thread_hold.h)
#define SRS_PAIR_BRANCH 16   // triangles a box, and boxes a larger one
#define SRS_PAIR_PARTS 64    // of a step, at most
#define SRS_PAIR_ROUNDS 8    // of the iteration
#define SRS_PAIR_DEEPEST 1.0 // spacings: what lies deeper in another organ is let alone
#define SRS_PAIR_AGAINST 0.1 // less than minus this is the cosine between normals that meet
#define SRS_PAIR_THIN 0.45   // of both organs' thickness: the same
#define SRS_PAIR_SLACK 0.1   // spacings: how far beside its path a node may touch
#define SRS_SELF_REACH 2.5   // spacings along the springs: nearer ones of its own organ a node does not touch
#define SRS_THREAD_SWEEPS 4  // over all threads, a step
#define SRS_THREAD_PULL 0.05 // spacings a step: how fast a thread is drawn in at most
#define SRS_THREAD_MEAN 0.005 // s: of the force that breaks a thread
#define SRS_MAX_THREADS 64
// Sums of the passes that couple organs (shaders/pair_buffers.glsl): words of the buffer, and a unit of
// impulse
#define SRS_PAIR_FASTEST 4
#define SRS_PAIR_LOADS 64
#define SRS_PAIR_FIXED 16777216.0
// Trees of boxes over an organ's boundary triangles (sim/node_tree.h)
#define SRS_TREE_LEAF 4 // triangles a leaf
#define SRS_TREE_LOG2_WIDTH 3
#define SRS_TREE_WIDTH 8       // nodes below a node
#define SRS_TREE_MOST_LEVELS 8 // of boxes: 67 million triangles
#define SRS_TREE_NONE 0xffffffffu
#define SRS_TREE_RAY 0 // queries
#define SRS_TREE_CLOSEST 1
#define SRS_TREE_IN_BOX 2
#define SRS_TREE_IN_SPHERE 3
#define SRS_TREE_CANDIDATES 64 // that a query of the last two kinds lists at most

// Level of detail (sim/lod.h)
#define SRS_LOD_LEAST_VOLUME 0.1    // of a coarse cell over its rest: below, its frame carries no detail
#define SRS_LOD_SUMS 5              // vec4 of mass, momentum and inertia
#define SRS_LOD_RUN 1024            // nodes that a group sums
#define SRS_BLEND_FRAMES 10.0       // in which the drawing of one level turns into that of the next,
#define SRS_BLEND_MOST_FRAMES 250.0 // or up to so many where it is far: a frame moves no vertex by more than
#define SRS_BLEND_STEP 0.08         // of the finest level's spacing

// The mask that strokes leave in rest space (render/cut_mask.h)
#define SRS_MASK_REACH 2.0 // spacings: how far from a cut its distance is known
#define SRS_MASK_SIDES 3.0 // and how far its side
#define SRS_MASK_WIDTH 0.9 // voxels: half the width of what a blade takes away
#define SRS_MASK_GROUP 64  // invocations that paint a cell
#define SRS_MASK_FAR 1.0e9 // a node that no blade came near
#define SRS_MASK_SURE                                                                                        \
    0.5 // spacings from a cut beyond which a vertex' nodes say its side better than voxels do
#define SRS_AWAY_STEPS 21844.0
#define SRS_MASK_PAINTED (254.0 / 255.0) // the distance's largest byte: what has none, has no side
#define SRS_MASK_KEPT 0xffffffffu

// Nodes as one side of the cuts carries them (render/side_nodes.h): alpha, spacings.
#define SRS_SIDE_REACH 2     // grid steps around a node from which its place on the other side is taken
#define SRS_SIDE_FAR 4.0     // no cut is near
#define SRS_SIDE_NONE -100.0 // the side has no place for the node
#define SRS_SIDE_ON 0.25     // a node so near to a cut is as good as on either side of it
#define SRS_SIDE_LOOSE 0.0   // of a node that is left alone between two cuts
