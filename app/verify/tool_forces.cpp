// Group `materials`: pascals go in, newtons come out at the tools of a stepped solver. A bar pulled by
// forceps gives back its Young's modulus; a layer resists a sphere as Hertz and Dimitriadis et al. 2002 say.
#include "app/verify/material_checks.h"
#include "app/verify/tool_measures.h"
#include "sim/cpu_solver.h"

namespace serosa::app {

namespace {

constexpr double kSpacing = 0.003; // m

/// Plain springs on the CPU, tissue with a volumetric term on the GPU: both are measured.
SolverMaker solverFor(const sim::Tissue& tissue) {
    if (!tissue.volumetric())
        return [](const sim::SolverSetup& setup) -> Result<std::unique_ptr<sim::Solver>> {
            return sim::makeCpuSolver(setup);
        };
    return [](const sim::SolverSetup& setup) { return sim::makeFragmentSolver(setup); };
}

Status pulledBars(const VerifyOptions& options, CheckList& checks) {
    for (std::uint32_t turn = 0; turn < (options.full ? 4 : 2); ++turn) {
        const Beam beam = makeBeam(10, 30, turn == 0 ? glm::dmat3(1) : randomRotation(turn), kSpacing);
        for (const double poisson : {0.25, 0.35, 0.45, 0.49})
            for (const auto& [young, density] : {std::pair(5000.0, 1000.0), std::pair(20000.0, 1060.0)}) {
                if (!options.full && poisson > 0.25)
                    continue;
                const sim::Tissue tissue = tissueOf(options, poisson, young, density);
                SEROSA_ASSIGN(const double measured,
                              measurePulledBar(beam, tissue, 0.005, solverFor(tissue)));
                checks.equalRel("bar pulled by forceps, " +
                                    (turn == 0 ? "aligned" : "turn " + std::to_string(turn)) + ", " +
                                    nameOf(poisson) + ", E " + shortNumber(1e-3 * young) +
                                    " kPa: force / area / strain",
                                measured, young, 0.03, "Pa");
            }
    }
    return {};
}

Status indent(const Indentation& piece, const std::string& what, double poisson, const VerifyOptions& options,
              CheckList& checks) {
    const sim::Tissue tissue = tissueOf(options, poisson);
    SEROSA_ASSIGN(const IndentationForce force,
                  measureIndentation(piece, tissue, kSpacing, solverFor(tissue)));
    const std::string name = "indentation, " + what + ", " + nameOf(poisson);
    checks.equalRel(name + ": force, Hertz with finite layer", force.normal,
                    layerForce(tissueOf({}, poisson), piece.radius * kSpacing, piece.depth * kSpacing,
                               piece.thickness * kSpacing),
                    0.1, "N");
    checks.atMost(name + ": still changing at rest by", force.change, 1e-3, "1");
    return {};
}

Status indentations(const VerifyOptions& options, CheckList& checks) {
    const Indentation plain; // contact radius 4 h, thickness 16 h, width 40 h
    Indentation turned = plain, flat = plain, thin = plain, between = plain, wide;
    turned.turn = randomRotation(1);
    flat.radius = 80;
    flat.depth = 0.2; // the strain goes to nothing, where Hertz is exact
    thin.thickness = 12;
    between.thickness = 16.5; // faces within cells
    between.width = 40.5;
    wide.radius = 36;
    wide.depth = 1;
    wide.thickness = 20;
    wide.width = 60;
    SEROSA_TRY(indent(plain, "contact radius 4 h", 0.25, options, checks));
    SEROSA_TRY(indent(flat, "contact radius 4 h, a quarter as deep", 0.25, options, checks));
    SEROSA_TRY(indent(turned, "contact radius 4 h, turned", 0.25, options, checks));
    if (!options.full)
        return {};
    SEROSA_TRY(indent(thin, "contact radius 4 h, layer 12 h", 0.25, options, checks));
    SEROSA_TRY(indent(between, "contact radius 4 h, faces within cells", 0.25, options, checks));
    SEROSA_TRY(indent(wide, "contact radius 6 h", 0.25, options, checks));
    for (const double poisson : {0.35, 0.45, 0.49}) {
        SEROSA_TRY(indent(plain, "contact radius 4 h", poisson, options, checks));
        SEROSA_TRY(indent(turned, "contact radius 4 h, turned", poisson, options, checks));
    }
    return indent(flat, "contact radius 4 h, a quarter as deep", 0.49, options, checks);
}

} // namespace

Status verifyToolForces(const VerifyOptions& options, CheckList& checks) {
    SEROSA_TRY(pulledBars(options, checks));
    return indentations(options, checks);
}

} // namespace serosa::app
