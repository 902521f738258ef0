// What theory says of an indented layer, and that the forces on tools follow the tissue.
#include "app/verify/tool_measures.h"
#include "sim/cpu_solver.h"

#include <gtest/gtest.h>

#include <cmath>

namespace serosa::app {
namespace {

sim::Tissue tissueWith(double poisson, double young = 5000) {
    sim::Tissue tissue;
    tissue.poisson = poisson;
    tissue.young = young;
    return tissue;
}

Result<std::unique_ptr<sim::Solver>> cpuSolver(const sim::SolverSetup& setup) {
    return sim::makeCpuSolver(setup);
}

TEST(LayerForce, IsHertzOnAThickLayer) {
    const double radius = 0.06, depth = 1e-4;
    for (const double poisson : {0.25, 0.35, 0.45, 0.49}) {
        const double hertz =
            4.0 / 3 * 5000 / (1 - poisson * poisson) * std::sqrt(radius) * std::pow(depth, 1.5);
        EXPECT_NEAR(layerForce(tissueWith(poisson), radius, depth, 1e4) / hertz, 1, 1e-5);
        EXPECT_GT(layerForce(tissueWith(poisson), radius, depth, 0.02), 1.1 * hertz) << "the base is near";
    }
}

// Dimitriadis et al. 2002 give nu = 1/2 as a formula of its own, with rounded coefficients.
TEST(LayerForce, BecomesThePrintedFormulaOfAnIncompressibleLayer) {
    const double radius = 0.06, depth = 1e-3;
    for (const double chi : {0.05, 0.1, 0.2, 1.0 / 3}) {
        const double thickness = std::sqrt(radius * depth) / chi;
        const double printed = 16.0 / 9 * 5000 * std::sqrt(radius) * std::pow(depth, 1.5) *
                               (1 + 1.133 * chi + 1.283 * chi * chi + 0.769 * std::pow(chi, 3));
        // Of 0.0975 chi^4 the paper's two formulas have different signs.
        EXPECT_NEAR(layerForce(tissueWith(0.5 - 1e-9), radius, depth, thickness) / printed, 1,
                    0.0975 * std::pow(chi, 4) + 5e-4 * chi);
    }
}

TEST(MeasurePulledBar, GivesThePascalsThatWentIn) {
    const Beam beam = makeBeam(4, 20, glm::dmat3(1), 0.003);
    for (const double young : {5000.0, 20000.0}) {
        const Result<double> measured = measurePulledBar(beam, tissueWith(0.25, young), 0.005, cpuSolver);
        ASSERT_TRUE(measured.ok());
        EXPECT_NEAR(*measured / young, 1, 0.02);
    }
}

// A contact of 2 h: coarser than what is verified, but force must follow stiffness and depth^1.5.
TEST(MeasureIndentation, FollowsStiffnessAndIsFrictionless) {
    Indentation piece;
    piece.radius = 20;
    piece.depth = 0.2;
    piece.thickness = 8;
    piece.width = 20;
    const Result<IndentationForce> soft = measureIndentation(piece, tissueWith(0.25), 0.003, cpuSolver);
    const Result<IndentationForce> stiff =
        measureIndentation(piece, tissueWith(0.25, 10000), 0.003, cpuSolver);
    ASSERT_TRUE(soft.ok() && stiff.ok());
    EXPECT_NEAR(stiff->normal / soft->normal, 2, 1e-3);
    // Straight into the middle, but the faces of cells are cut along one diagonal: what triangles ask of
    // their corners is not quite even.
    EXPECT_LT(soft->tangential, 0.03 * soft->normal);
    EXPECT_LT(soft->change, 1e-4);
    const double theory = layerForce(tissueWith(0.25), 0.06, 0.0006, 0.024);
    EXPECT_NEAR(soft->normal / theory, 1, 0.2);
}

TEST(ShearShare, IsOneHoweverTheBeamLies) {
    for (const glm::dmat3& turn : {glm::dmat3(1), randomRotation(5)})
        for (const double poisson : {0.25, 0.49})
            EXPECT_NEAR(shearShare(makeBeam(6, 12, turn, 0.003), tissueWith(poisson)), 1, 0.03);
}

} // namespace
} // namespace serosa::app
