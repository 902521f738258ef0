// Shared by C++ and GLSL: the deformation shader (render/raycaster.h) and its distance volume.
#ifndef SRS_RAYCAST_CONSTANTS_H
#define SRS_RAYCAST_CONSTANTS_H

#define SRS_SPLAT_SLICES 8 // of the voxels around a triangle, a work item each

// What a ray meets.
#define SRS_SOLID_HOLLOW 0
#define SRS_SOLID_SOLID 1
#define SRS_SOLID_SHELL 2
#define SRS_SOLID_COMBINED 3 // hollow, by one implicit of object and mask: for comparison

// What colours the faces of cuts (render/cut_volume.h): RAYCAST_VOLUME; 0 nothing.
#define SRS_VOLUME_GREY 1
#define SRS_VOLUME_LABELS 2
#define SRS_VOLUME_COLOURS 3

// What the undeformed body is (render/ray_field.h).
#define SRS_FIELD_DISTANCE 0
#define SRS_FIELD_DEPTH 1
#define SRS_FIELD_DEPTH_CUBE 2
#define SRS_DEPTH_RIM 6 // texels around what a depth map sees, to which it goes on

// How it is searched.
#define SRS_SEARCH_LINEAR 0
#define SRS_SEARCH_THRESHOLD 1
#define SRS_SEARCH_JACOBIAN 2

#define SRS_REFINEMENTS 30       // of an interval in which a ray meets something, at most,
#define SRS_EXACT 0.004          // and until it is so short, of the step: where space was skipped it is long
#define SRS_MOST_SAMPLES 2048.0  // of a ray, or
#define SRS_SAMPLES_A_STEP 4.0   // so many for each step of its way, before it adapts,
#define SRS_MOST_OF_ALL 131072.0 // but no more than this
#define SRS_LEAST_STEP 0.05      // of the step: adaptive ones are never shorter
#define SRS_MOST_STEP 2.0        // and never longer

#define SRS_AHEAD 1.25 // of what is clear around a place: so far ahead a ray looks

#define SRS_MOST_COARSE 4.0 // of the step: what is small on the screen or fast has no longer one

#define SRS_LIP_STEP 0.1 // of the step: at the lip of a blade's cut they are no shorter

// Deformations that the vertex stage does (render/coarse_warp.h).
#define SRS_COARSE_MAPS 4
#define SRS_COARSE_TWIST 0
#define SRS_COARSE_BEND 1
#define SRS_COARSE_PULL 2
#define SRS_COARSE_WAVE 3
#define SRS_COARSE_STEPS 20  // Newton's, of a pull or a wave
#define SRS_PROXY_SLACK 0.02 // of a pixel: so far a way goes on beyond a tetrahedron

// The lattice's displacement texture (render/lattice_warp.h).
#define SRS_WARP_MOST_CELLS 1048575 // an owner is a cell in 20 bits, below how far outside it is
#define SRS_WARP_REACH 0.75         // cells: so far beside itself a cell says where tissue would be
#define SRS_WARP_ACROSS 1.1         // spacings: so far beyond a cut its side goes on
#define SRS_WARP_BESIDE 1.75        // spacings: as far as a cell that a cut crosses reaches from it
#define SRS_WARP_BINS 512           // parts of the nodes' bounds along an axis
#define SRS_WARP_GAP 3.0            // spacings without a node: a piece fell off
#define SRS_WARP_STEPS 8            // Newton's
#define SRS_WARP_GROUP 32
#define SRS_WAY_UNITS 2048.0 // a lattice unit, of the nodes' ways in a step, which are summed

#endif
