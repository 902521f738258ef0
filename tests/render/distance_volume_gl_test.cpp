// The signed distance that the GPU makes, against exact distances in double.
#include "models/phantom.h"
#include "render/distance_volume.h"
#include "tests/gl_fixture.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace serosa::render {
namespace {

class GlDistanceVolume : public test::GlTest {};

struct Compared {
    double inBand = 0, beyond = 0; // largest error, voxels
    int wrongSide = 0;
};

Compared compare(const sim::TriangleMesh& mesh, const VolumeGrid& grid, double band) {
    Compared compared;
    const auto made = DistanceVolume::create(mesh, grid, band);
    EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message);
    if (!made.ok())
        return compared;
    const std::vector<float> values = made->read();
    const std::vector<double> exact = distanceOnGrid(mesh, grid);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double error = std::abs(values[i] - exact[i]) / grid.step;
        compared.wrongSide += std::abs(exact[i]) > 1e-3 * grid.step && (values[i] < 0) != (exact[i] < 0);
        double& most = std::abs(exact[i]) <= band ? compared.inBand : compared.beyond;
        most = std::max(most, error);
    }
    return compared;
}

TEST_F(GlDistanceVolume, IsExactInItsBandAndHasTheRightSignEverywhere) {
    for (const char* name : {"ball", "heart", "dragon"}) {
        auto mesh = models::makePhantom(name, 12000);
        ASSERT_TRUE(mesh);
        const VolumeGrid grid = VolumeGrid::around(mesh->lowest(), mesh->highest(), 30, 4);
        const Compared compared = compare(*mesh, grid, 3 * grid.step);
        EXPECT_LT(compared.inBand, 3e-3) << name << ": half floats of up to 3 voxels";
        EXPECT_LT(compared.beyond, 1) << name << ": half of a voxel's diagonal, and what flooding misses";
        EXPECT_EQ(compared.wrongSide, 0) << name;
    }
    // A wide band, as a shell needs it: beyond the narrow band, nearest triangles come from the tree.
    for (const char* name : {"heart", "dragon"}) {
        auto mesh = models::makePhantom(name, 12000);
        ASSERT_TRUE(mesh);
        const VolumeGrid grid = VolumeGrid::around(mesh->lowest(), mesh->highest(), 32, 6);
        const Compared compared = compare(*mesh, grid, 8 * grid.step);
        EXPECT_LT(compared.inBand, 5e-3) << name << ": half floats of up to 8 voxels";
        EXPECT_EQ(compared.wrongSide, 0) << name;
    }
    // Few large faces, sharp corners: a box seen from its own corners; and a part of one.
    const sim::TriangleMesh box = test::boxMesh({-1, -2, -1}, {1, 2, 1.5});
    const VolumeGrid whole = VolumeGrid::around({-1, -2, -1}, {1, 2, 1.5}, 33, 5);
    const Compared compared = compare(box, whole, 3 * whole.step);
    EXPECT_LT(compared.inBand, 3e-3);
    EXPECT_LT(compared.beyond, 0.05);
    EXPECT_EQ(compared.wrongSide, 0);
    const VolumeGrid part = VolumeGrid::around({0.2, 1, 0.4}, {1.5, 2.5, 2}, 24, 2);
    const Compared some = compare(box, part, 2 * part.step);
    EXPECT_LT(some.inBand, 3e-3);
    EXPECT_EQ(some.wrongSide, 0);
}

TEST_F(GlDistanceVolume, RefusesWhatHasNoInside) {
    sim::TriangleMesh open = test::boxMesh({-1, -1, -1}, {1, 1, 1});
    open.faces.pop_back();
    const VolumeGrid grid = VolumeGrid::around({-1, -1, -1}, {1, 1, 1}, 16, 2);
    const auto made = DistanceVolume::create(open, grid, 0.1);
    ASSERT_FALSE(made.ok());
    EXPECT_NE(made.error().message.find("open"), std::string::npos);
    EXPECT_FALSE(DistanceVolume::create({}, grid, 0.1).ok());
    EXPECT_FALSE(
        DistanceVolume::create(open, VolumeGrid::around({-1, -1, -1}, {1, 1, 1}, 2000, 2), 0.1).ok());
}

} // namespace
} // namespace serosa::render
