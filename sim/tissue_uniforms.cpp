// See sim/tissue_uniforms.h.
#include "sim/tissue_uniforms.h"

#include "shaders/shared_constants.h"

#include <span>

namespace serosa::sim {

std::vector<gpu::ShaderDefine> tissueDefines(const Tissue& tissue) {
    std::vector<gpu::ShaderDefine> defines = {{"SRS_MATERIALS", std::to_string(tissue.materialCount())}};
    if (tissue.damped())
        defines.push_back({"SRS_DAMPING", "1"});
    if (tissue.ownDampers())
        defines.push_back({"SRS_OWN_DAMPERS", "1"});
    if (tissue.needsCellPass())
        defines.push_back({"SRS_CELL_PASS", "1"});
    if (tissue.volumetric())
        defines.push_back({"SRS_VOLUME", "1"});
    if (tissue.stiffens())
        defines.push_back({"SRS_STIFFENING", "1"});
    return defines;
}

MaterialArrays::MaterialArrays(const Tissue& tissue, double timeStep) {
    for (const MaterialShares& material : materialShares(tissue)) {
        springs.insert(springs.end(), material.spring.begin(), material.spring.end());
        densities.push_back(float(material.density));
        dampingTimes.push_back(float(material.dampingTime / timeStep));
        bulks.push_back(float(material.bulk));
        recoveries.push_back(float(material.recovery));
        youngs.push_back(float(material.young));
        bends.push_back(float(material.bend));
        for (std::size_t i = 0; i < SRS_CURVE_BREAKS; ++i) {
            const CurveBreak turn = i < material.breaks.size() ? material.breaks[i] : CurveBreak{};
            breakStrains.push_back(float(turn.strain));
            breakGains.push_back(float(turn.gain));
        }
    }
}

void MaterialArrays::setVolume(gpu::Program& program) const {
    program.set("u_bulks", std::span<const float>(bulks));
    program.set("u_recoveries", std::span<const float>(recoveries));
}

void MaterialArrays::setCurves(gpu::Program& program) const {
    program.set("u_youngs", std::span<const float>(youngs));
    program.set("u_bends", std::span<const float>(bends));
    program.set("u_breakStrains", std::span<const float>(breakStrains));
    program.set("u_breakGains", std::span<const float>(breakGains));
}

} // namespace serosa::sim
