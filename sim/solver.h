#pragma once
// One interface for all solvers of the spring lattice: `reference` (CPU, double: the oracle) and `fragment`
// (MS05's way).
//
// Cells: a material with Poisson's ratio above 1/4, or with recovery (Tissue::volumetric()), adds the
// volumetric term of sim/volume_term.h. A solver that implements it
//   1. takes, for each cell whose 24 connections are all left (SRS_IN_CELL_c at its corner c), from the
//      positions at the start of the step F, the mean deformation gradient of its 8 corners, cof F, J, and
//      P = f p(J, cof F) cof F in units of k/h;
//   2. adds -P g_i, g_i = (+-1, +-1, +-1)/4, to the force of each of its 8 corners before the step below: all
//      take the same P, so that the forces sum to nothing.
// VolumeTerm::addForces is the oracle, shaders/cell_terms.glsl with solver_cells.glsl the GPU's way.
//
// Several materials: m, w and b, r of the volumetric term are sums and values of the cells' own materials, in
// units of material 0 (sim/tissue_field.h). A solver that implements stiffening (sim/stiffening.h) multiplies
// each cell's shares of w and its b by the factor that the positions at the start of the step give.
//
// A step, for a node of mass share m = sum(f)/8 and spring weights w (sim/lattice.h), in lattice units:
//   F  = sum_j w_ij (L_ij/|d| - 1) d,  d = x_i - x_j                        (MS05 eq. 1 and 2, k the full
//   constant)
//      - dampingTime/dt sum_j w_ij n (n . (u_i - u_j)),  n = d/|d|          (along springs, u the increments;
//        w and damping time as they are unstretched)
//   u' = (1 - airDrag dt) u + dt^2 (k/(rho h^3) F/m + g/h)
//   x' = x + u';  then tools: x' is moved out of a pushing sphere or with a grasping one, and u' = x' - x.

#include "sim/blade.h"
#include "sim/body.h"
#include "sim/lattice.h"
#include "sim/lattice_state.h"
#include "sim/material.h"
#include "sim/tool.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace serosa::sim {

class StateTextures; // sim/state_textures.h

/// Connection bits of one node that a stroke cleared.
struct ClearedBits {
    std::uint32_t node = 0, bits = 0;
    friend bool operator==(const ClearedBits&, const ClearedBits&) = default;
};
/// What one stroke (with the parts that continue it) cleared: nodes ascending, bits not 0.
using CutLayer = std::vector<ClearedBits>;

/// How a solver steps. Implicit: one step a frame whatever the stiffness (docs/methods/implicit.md).
enum class StepMethod { explicitSteps, implicit };

/// All that a solver needs to know of one organ. Lattice and vectors are copied or kept by reference for its
/// lifetime.
struct SolverSetup {
    const Lattice* lattice = nullptr; // not null; outlives the solver
    Tissue tissue;
    glm::dvec3 gravity{0};    // m/s2
    double timeStep = 0;      // s
    std::vector<bool> fixed;  // one a node; empty: none
    std::vector<Tool> tools;  // at most SRS_MAX_TOOLS
    std::vector<Body> bodies; // with the tools at most SRS_MAX_COLLIDERS
    StepMethod method = StepMethod::explicitSteps;
};

/// What a collider gave to an organ.
struct ToolLoad {
    glm::dvec3 impulse{0}; // N s
    glm::dvec3 angular{0}; // N m s, about the collider's reference point at the end of each step
};

/// A node between two steps, lattice units: where it lies, and its last increment.
struct NodeMotion {
    glm::dvec3 position{0}, increment{0};
    bool held = false; // by a tool
};

class Solver {
public:
    virtual ~Solver() = default;
    virtual const char* name() const = 0;
    /// Takes `count` steps; tools are evaluated at the end time of each step.
    virtual void advance(int count) = 0;
    /// Reads the whole state back (the fragment solver stalls: not for drawing).
    virtual LatticeState state() const = 0;
    /// Continues from a state (sizes must match).
    virtual void setState(const LatticeState& state) = 0;
    /// What tools and bodies gave to the organ since the last call or endFrame(), one a collider. Waits for
    /// the GPU.
    virtual std::vector<ToolLoad> takeLoads() = 0;
    /// The tools' impulses of takeLoads(), which it takes: N s, one a tool.
    std::vector<glm::dvec3> takeToolImpulses();

    // Loads frame by frame, with no wait for the GPU: after each endFrame() comes one frameLoads().

    /// Ends a frame: what was given since the last takeLoads() or endFrame() is its load.
    virtual void endFrame();
    /// The loads of exactly the frame two before the one that ended last; nothing after the first two frames.
    /// Waits, if they are not there yet.
    virtual std::optional<std::vector<ToolLoad>> frameLoads();
    /// Those of the frames that ended and were not given yet (two, at the end of a run), oldest first. Waits.
    virtual std::vector<std::vector<ToolLoad>> flushFrames();

    /// The textures to draw from: the fragment solver's own (nothing is read back), or null for CPU solvers.
    virtual const StateTextures* textures() const { return nullptr; }
    /// The same, for a pass that writes another state into them (sim/lod_pass.h), of step number `step`;
    /// as after setState and forgetCuts.
    virtual StateTextures* replaceState(std::int64_t step);

    // What couples organs reads and moves nodes between two steps (sim/organ_group.h), in textures() where
    // there are any. The defaults work for every solver through state() and setState().

    /// One of `motions` a node.
    virtual void readNodes(std::span<const std::uint32_t> nodes, std::span<NodeMotion> motions) const;
    /// Adds to position and increment. \param by one a node, lattice units
    virtual void moveNodes(std::span<const std::uint32_t> nodes, std::span<const glm::dvec3> by);

    // Cuts (sim/blade.h) clear connections at the positions as they are; nothing is resized. The defaults
    // work for every solver through state() and setState(); solvers on the GPU cut in a pass, with no
    // readback (sim/cut_pass.h).

    /// Errors: of the driver, where the pass is made at the first cut.
    virtual Status cut(const Stroke& stroke);
    /// Gives back what the last stroke (with the parts that continue it) cut. False: none is left to undo.
    virtual bool undoCut();
    /// Strokes so far can no longer be undone: after a state from elsewhere was set.
    virtual void forgetCuts();
    /// What undoCut() gives back, stroke by stroke, oldest first; reads back (stalls).
    virtual std::vector<CutLayer> cutLayers() const;
    /// Replaces it, after the state that it belongs to was set. Errors: as cut.
    virtual Status setCutLayers(const std::vector<CutLayer>& layers);
    /// Labels of the pieces (sim/pieces.h), one a node; reads back. Errors: as cut.
    virtual Result<std::vector<std::uint32_t>> pieces() const;
    virtual const SolverSetup& setup() const = 0;
    const Lattice& lattice() const { return *setup().lattice; }

private:
    std::vector<std::vector<ToolLoad>> frames_;         // ended and not given yet, oldest first
    std::vector<std::vector<std::uint32_t>> cutLayers_; // bits that each stroke cleared, one word a node
};

/// Fails of energy bookkeeping: all in joules, from a state.
struct Energies {
    double kinetic = 0, elastic = 0, gravitational = 0;
};
/// Kinetic energy uses the increments: u h / dt. Gravity's zero is the rest state.
Energies energies(const SolverSetup& setup, const LatticeState& state);

/// The rest state of a lattice: integer positions, zero increments, rest normals.
LatticeState restState(const Lattice& lattice);

/// Where a run begins: at rest, with the velocity zero at t = 0. Increments are velocities half a step
/// before, so gravity's half step is taken off them: a body then falls by g t^2/2, not by g t (t + dt)/2.
LatticeState startState(const SolverSetup& setup);

std::unique_ptr<Solver> makeReferenceSolver(const SolverSetup& setup);

/// Of shaders/solver_kernel.glsl, whatever runs it.
struct KernelOptions {
    int layout = -1;               // SRS_LAYOUT_GRID, SRS_LAYOUT_ROWS, or -1: by how full the grid is
    bool normals = true;           // write eq. 3 into alpha (benchmarks switch it off)
    bool normalsEveryStep = false; // as CpuOptions: else the last step of an advance() alone writes them
    bool fills = true;             // false (benchmarks): every cell counts as full
    bool printedForm = true;    // eq. 2, with the sum of unit vectors shared; false: eq. 1, spring by spring
    bool useTexelFetch = false; // texelFetch instead of imageLoad
};

struct FragmentOptions : KernelOptions {};
/// Needs a current GL context. Errors: the lattice does not fit the context's textures (says the limit),
/// shader errors.
Result<std::unique_ptr<Solver>> makeFragmentSolver(const SolverSetup& setup,
                                                   const FragmentOptions& options = {});

/// Work groups by layout, as measured (docs/performance.md); along x, y(, z).
struct ComputeOptions : KernelOptions {
    glm::ivec2 gridGroup{16, 8};
    glm::ivec2 rowsGroup{64, 1};
    bool tiles = false; // grid layout: a group's nodes and their border in shared memory
    glm::ivec3 tileGroup{8, 4, 4};
};
/// The same kernel, state and bytes as the fragment solver's, in compute passes. Errors: as
/// makeFragmentSolver.
Result<std::unique_ptr<Solver>> makeComputeSolver(const SolverSetup& setup,
                                                  const ComputeOptions& options = {});

/// How the time step was computed, for the summary.
struct StableStep {
    // omega^2 in 1/s2: Lanczos iteration on the rest lattice with its volumetric term
    double stiffestRate2 = 0; // one isotropic material: never below formulaRate2
    double springRate2 = 0;   // of the springs alone; one isotropic material: never below 12 k/m
    double dampingRate = 0;   // 1/s: the largest of M^-1 C; dampingTime * springRate2 where that is one
    double formulaRate2 = 0;  // of the endless lattice of material 0: (12 + 4 bulkShare) k/m
    double bound = 0;         // s: stable below, damping included
    double margin = 0;        // share of the bound that is used
    int stepsPerFrame = 0;    // 1e9 at most
    double timeStep = 0;      // s: frame time / stepsPerFrame
};
/// Largest stable explicit step for a frame of `frameTime` seconds.
StableStep stableStep(const Lattice& lattice, const Tissue& tissue, double frameTime);

/// Implicit steps a frame: one, or as many (at most kMostImplicitSteps) as keep the tools that follow keys
/// from going further than half a spacing in a step. A tool that jumps through tissue puts more energy into
/// it than its force at the step's end can say.
int implicitStepsPerFrame(const std::vector<Tool>& tools, double spacing, double frameTime);
constexpr int kMostImplicitSteps = 32;
/// Of a tool that a user moves, m/s: half a spacing (m) in an implicit step of `timeStep` seconds.
double implicitToolSpeed(double spacing, double timeStep);

} // namespace serosa::sim
