#pragma once
// What the fragment and the compute solver tell their programs alike: the defines of
// shaders/solver_kernel.glsl, and the uniforms of the kernel.

#include "gpu/program.h"
#include "sim/solver.h"
#include "sim/texture_layout.h"

#include <vector>

namespace serosa::sim {

/// SRS_LAYOUT and what lattice_address.glsl needs with it, SRS_EQUATION, SRS_NORMALS, SRS_FULL_CELLS,
/// SRS_TEXEL_FETCH, and what the tissue asks for: tissueDefines, SRS_CELL_MATERIALS, SRS_FIBRES.
std::vector<gpu::ShaderDefine> kernelDefines(const SolverSetup& setup, const TextureLayout& layout,
                                             const KernelOptions& options);
/// What does not change between steps: stiffness, drag, gravity, damping, materials, in lattice units.
void setKernelUniforms(gpu::Program& program, const SolverSetup& setup);
/// N s of an impulse of 1 in mass shares times lattice units a step.
double impulseUnit(const SolverSetup& setup);

} // namespace serosa::sim
