// Snapshots of the solvers on the GPU, on both layouts.
#include "shaders/shared_constants.h"
#include "tests/gl_fixture.h"
#include "tests/sim/snapshot_bodies.h"

using namespace serosa;

class GlSnapshot : public test::GlTest {};

TEST_F(GlSnapshot, fragmentGivesTheSameBytesAfterARestore) {
    for (const int layout : {SRS_LAYOUT_GRID, SRS_LAYOUT_ROWS})
        test::expectSameBytesAfterARestore([layout](const sim::SolverSetup& setup) {
            sim::FragmentOptions options;
            options.layout = layout;
            return sim::makeFragmentSolver(setup, options).value();
        });
}

TEST_F(GlSnapshot, fragmentWithTheVolumetricTermToo) {
    test::expectSameBytesAfterARestore(
        [](const sim::SolverSetup& setup) { return sim::makeFragmentSolver(setup).value(); }, 0.4);
}

TEST_F(GlSnapshot, computeGivesTheSameBytesAfterARestore) {
    for (const int layout : {SRS_LAYOUT_GRID, SRS_LAYOUT_ROWS})
        test::expectSameBytesAfterARestore([layout](const sim::SolverSetup& setup) {
            sim::ComputeOptions options;
            options.layout = layout;
            return sim::makeComputeSolver(setup, options).value();
        });
}
