// See sim/solver_program.h.
#include "sim/solver_program.h"

#include "sim/tissue_uniforms.h"

#include <bit>
#include <span>

namespace serosa::sim {

std::vector<gpu::ShaderDefine> kernelDefines(const SolverSetup& setup, const TextureLayout& layout,
                                             const KernelOptions& options) {
    std::vector<gpu::ShaderDefine> defines = {
        {"SRS_LAYOUT", std::to_string(layout.kind)},
        {"SRS_GRID_NY", std::to_string(layout.gridStride.z)},
        {"SRS_ROW_LOG2", std::to_string(std::countr_zero(unsigned(layout.width)))},
        {"SRS_EQUATION", options.printedForm ? "2" : "1"}};
    const Tissue& tissue = setup.tissue;
    const std::vector<gpu::ShaderDefine> asked = tissueDefines(tissue);
    defines.insert(defines.end(), asked.begin(), asked.end());
    if (tissue.materialCount() > 1 || tissue.fibrous() || tissue.stiffens())
        defines.push_back({"SRS_CELL_MATERIALS", "1"});
    if (tissue.fibrous())
        defines.push_back({"SRS_FIBRES", "1"});
    if (options.normals)
        defines.push_back({"SRS_NORMALS", "1"});
    if (!options.fills)
        defines.push_back({"SRS_FULL_CELLS", "1"});
    if (options.useTexelFetch)
        defines.push_back({"SRS_TEXEL_FETCH", "1"});
    return defines;
}

void setKernelUniforms(gpu::Program& program, const SolverSetup& setup) {
    const double h = setup.lattice->spacing, dt = setup.timeStep;
    program.set("u_acceleration", float(dt * dt * setup.tissue.stiffnessOverMass(h)));
    program.set("u_drag", float(1 - setup.tissue.airDrag * dt));
    program.set("u_gravity", glm::vec3(setup.gravity * (dt * dt / h)));
    program.set("u_damping", float(setup.tissue.dampingTime / dt));
    const MaterialArrays materials(setup.tissue, dt);
    program.set("u_springs", std::span<const float>(materials.springs));
    program.set("u_densities", std::span<const float>(materials.densities));
    program.set("u_dampingTimes", std::span<const float>(materials.dampingTimes));
}

double impulseUnit(const SolverSetup& setup) {
    return setup.tissue.nodeMass(setup.lattice->spacing) * setup.lattice->spacing / setup.timeStep;
}

} // namespace serosa::sim
