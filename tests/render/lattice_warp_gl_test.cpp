// The inverse of a lattice's displacement against the forward map: places of cells, carried by their corners,
// come back.
#include "models/phantom.h"
#include "render/lattice_warp.h"
#include "render/raycaster.h"
#include "tests/gl_fixture.h"
#include "tests/render/shapes.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace serosa::render {
namespace {

class GlLatticeWarp : public test::GlTest {
protected:
    /// The inverse of a state, two voxels a spacing at rest.
    LatticeWarp::Read inverseOf(const sim::Lattice& lattice, const sim::LatticeState& state) {
        auto textures = sim::StateTextures::create(lattice, {});
        EXPECT_TRUE(textures.ok());
        auto warp = LatticeWarp::create(lattice, textures->layout(), 2);
        EXPECT_TRUE(warp.ok());
        textures->upload(state);
        EXPECT_TRUE(warp->update(*textures).ok());
        size_ = warp->size();
        return warp->read();
    }
    glm::ivec3 size_{0}; // of it
};

/// A block that is stretched, turned and bent.
sim::LatticeState bent(const sim::Lattice& lattice, double strength) {
    sim::LatticeState state = sim::restState(lattice);
    for (std::size_t i = 0; i < state.positions.size(); ++i) {
        const glm::dvec3 p = lattice.restPosition(i);
        const double angle = strength * 0.06 * p.x;
        state.positions[i] =
            glm::vec3(1.1 * p.x * std::cos(angle) + 3, p.y + 0.1 * p.x * std::sin(angle) + 0.05 * p.z,
                      p.z * (1 + 0.02 * strength * p.y));
    }
    return state;
}

/// D of a shown place, trilinearly; w: coverage, 0 beyond the box.
glm::dvec4 sample(const LatticeWarp::Read& read, const glm::ivec3& size, const glm::dvec3& shown) {
    const glm::dvec3 at = (shown - read.lowest) / read.step;
    if (glm::any(glm::lessThan(at, glm::dvec3(0))) || glm::any(glm::greaterThan(at, glm::dvec3(size - 1))))
        return glm::dvec4(0);
    const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(at)), glm::ivec3(0), size - 2);
    const glm::dvec3 share = at - glm::dvec3(cell);
    glm::dvec4 sum(0);
    for (int corner = 0; corner < 8; ++corner) {
        const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
        sum += (x ? share.x : 1 - share.x) * (y ? share.y : 1 - share.y) * (z ? share.z : 1 - share.z) *
               glm::dvec4(read.texels[std::size_t(cell.x + x) +
                                      std::size_t(size.x) * (std::size_t(cell.y + y) +
                                                             std::size_t(size.y) * std::size_t(cell.z + z))]);
    }
    return sum;
}

TEST_F(GlLatticeWarp, TakesWhatCellsCarryBackToRest) {
    const sim::Lattice lattice = test::blockLattice(9, 5, 6, 0.004);
    auto textures = sim::StateTextures::create(lattice, {});
    ASSERT_TRUE(textures.ok());
    for (const double resolution : {1.0, 2.0, 4.0}) {
        auto warp = LatticeWarp::create(lattice, textures->layout(), resolution);
        ASSERT_TRUE(warp.ok()) << warp.error().message;
        for (const double strength : {0.0, 1.0}) {
            const sim::LatticeState state = bent(lattice, strength);
            textures->upload(state);
            ASSERT_TRUE(warp->update(*textures).ok());
            const LatticeWarp::Read read = warp->read();
            std::mt19937 engine(3);
            const auto number = [&] { return double(engine()) / 4294967296.0; };
            double most = 0;
            for (int i = 0; i < 4000; ++i) {
                const sim::LatticeCell& cell = lattice.cells[engine() % lattice.cells.size()];
                const double x = number(), y = number(), z = number();
                const glm::dvec3 s(x, y, z);
                glm::dvec3 shown(0), rest(0);
                for (int corner = 0; corner < 8; ++corner) {
                    const glm::dvec3 toward(sim::cornerOffset(corner)), w = glm::mix(1.0 - s, s, toward);
                    const auto node = std::size_t(lattice.nodeAt(cell.grid + sim::cornerOffset(corner)));
                    shown += w.x * w.y * w.z * glm::dvec3(state.positions[node]);
                    rest += w.x * w.y * w.z * lattice.restPosition(node);
                }
                const glm::dvec4 d = sample(read, warp->size(), shown);
                ASSERT_GT(d.w, 0.999) << "covered";
                most = std::max(most, glm::distance(shown + glm::dvec3(d), rest));
            }
            // Linear fields are exact; a bent one to the second order of a voxel.
            EXPECT_LT(most, strength == 0 ? 2e-4 : 0.05 / (resolution * resolution)) << resolution;
        }
    }
}

// A slice of nodes lies so far below that the bounds' voxels would be longer than the organ.
TEST_F(GlLatticeWarp, APieceThatFellOffTakesNothingFromTheRest) {
    const sim::Lattice lattice = test::blockLattice(9, 5, 6, 0.004);
    for (const double fall : {12.0, 30.0, 300.0}) {
        sim::LatticeState state = bent(lattice, 0);
        double first = 1e9, most = 0;
        for (std::size_t i = 0; i < lattice.nodeCount(); ++i)
            first = std::min(first, lattice.restPosition(i).x);
        for (std::size_t i = 0; i < lattice.nodeCount(); ++i)
            if (lattice.restPosition(i).x < first + 1.5)
                state.positions[i].y -= fall;
        const LatticeWarp::Read read = inverseOf(lattice, state);
        EXPECT_LE(std::max({read.step.x, read.step.y, read.step.z}), 0.7501) << "spacings a voxel";
        std::size_t seen = 0;
        for (std::size_t i = 0; i < lattice.nodeCount(); ++i) {
            if (lattice.restPosition(i).x < first + 3.5) // beside the cells that are drawn out
                continue;
            const glm::dvec4 d = sample(read, size_, state.positions[i]);
            ASSERT_GT(d.w, 0.999) << fall;
            most = std::max(
                most, glm::distance(glm::dvec3(state.positions[i]) + glm::dvec3(d), lattice.restPosition(i)));
            ++seen;
        }
        EXPECT_LT(most, 1e-3) << fall << ": a linear field";
        EXPECT_EQ(seen, 6U * 6 * 7);
    }
}

// What is thin has room to turn.
TEST_F(GlLatticeWarp, ASlenderOneMayTurn) {
    const sim::Lattice lattice = test::blockLattice(30, 2, 2, 0.004);
    sim::LatticeState state = sim::restState(lattice);
    for (std::size_t i = 0; i < lattice.nodeCount(); ++i) {
        const glm::dvec3 p = lattice.restPosition(i);
        state.positions[i] = glm::dvec3(-p.y, p.x, p.z);
    }
    const LatticeWarp::Read read = inverseOf(lattice, state);
    std::size_t lost = 0;
    for (std::size_t i = 0; i < lattice.nodeCount(); ++i) {
        const glm::dvec4 d = sample(read, size_, state.positions[i]);
        lost += !(d.w > 0.999 && glm::distance(glm::dvec3(state.positions[i]) + glm::dvec3(d),
                                               lattice.restPosition(i)) < 1e-3);
    }
    EXPECT_LE(lost, lattice.nodeCount() / 10) << "its ends, where the room ends";
}

TEST_F(GlLatticeWarp, KnowsWhereThereIsNoTissue) {
    const sim::Lattice lattice = test::ballLattice(4.3, 0.004, {0.1, 0, 0});
    auto textures = sim::StateTextures::create(lattice, {});
    ASSERT_TRUE(textures.ok());
    auto warp = LatticeWarp::create(lattice, textures->layout(), 2);
    ASSERT_TRUE(warp.ok());
    ASSERT_TRUE(warp->update(*textures).ok());
    const LatticeWarp::Read read = warp->read();
    int inside = 0, outside = 0;
    for (int z = 0; z < warp->size().z; ++z)
        for (int y = 0; y < warp->size().y; ++y)
            for (int x = 0; x < warp->size().x; ++x) {
                const glm::vec4& texel =
                    read.texels[std::size_t(x) +
                                std::size_t(warp->size().x) *
                                    (std::size_t(y) + std::size_t(warp->size().y) * std::size_t(z))];
                const glm::dvec3 at = read.lowest + read.step * glm::dvec3(x, y, z);
                double near = 1e9; // from the nearest node
                for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
                    near = std::min(near, glm::distance(lattice.restPosition(node), at));
                inside += texel.w == 1;
                outside += texel.w == 0;
                if (near > 1.9) {
                    EXPECT_EQ(texel.w, 0) << "beyond the reach of every cell";
                }
                EXPECT_LT(glm::length(glm::vec3(texel)), 1e-4F) << "at rest";
            }
    EXPECT_GT(inside, 500);
    EXPECT_GT(outside, 300);
}

// A simulated ball, stretched to an ellipsoid, ray-cast through its lattice: its known outline.
TEST_F(GlLatticeWarp, ABallThatIsStretchedIsAnEllipsoid) {
    auto mesh = models::makePhantom("ball", 8000);
    ASSERT_TRUE(mesh);
    for (glm::dvec3& p : mesh->positions)
        p = 0.03 * glm::normalize(p);
    const auto lattice = sim::buildLattice(*mesh, [] {
        sim::LatticeRequest request;
        request.spacing = 0.005;
        return request;
    }());
    ASSERT_TRUE(lattice.ok());
    auto textures = sim::StateTextures::create(*lattice, {});
    ASSERT_TRUE(textures.ok());
    sim::LatticeState state = sim::restState(*lattice);
    const glm::dvec3 stretch(1.3, 0.8, 1);
    for (std::size_t i = 0; i < state.positions.size(); ++i)
        state.positions[i] = glm::vec3(stretch * lattice->restPosition(i));
    textures->upload(state);
    auto warp = LatticeWarp::create(*lattice, textures->layout(), 2);
    ASSERT_TRUE(warp.ok());
    ASSERT_TRUE(warp->update(*textures).ok());
    const auto volume =
        DistanceVolume::create(*mesh, VolumeGrid::around(mesh->lowest(), mesh->highest(), 48, 3), 0);
    ASSERT_TRUE(volume.ok());
    auto caster = Raycaster::create(*lattice, *volume);
    ASSERT_TRUE(caster.ok());
    caster->setLattice(&*warp);
    constexpr int kWidth = 120, kHeight = 90;
    sim::Camera settings;
    settings.projection = sim::Projection::orthographic;
    settings.direction = {0, 0, -1};
    settings.height = 0.09;
    settings.target = glm::dvec3(0);
    const CameraView camera =
        makeCamera(settings, glm::dvec3(-0.04), glm::dvec3(0.04), double(kWidth) / kHeight);
    const Frame frame = makeFrame(*lattice, camera, {}, {}, kWidth, kHeight);
    const auto probes = caster->probe(frame, {}, kWidth, kHeight);
    ASSERT_TRUE(probes.ok()) << probes.error().message;
    // The lattice is stretched about its own origin.
    const glm::dvec3 about = lattice->toWorld(glm::dvec3(0));
    int wrong = 0, inside = 0;
    for (std::size_t i = 0; i < probes->size(); ++i) {
        const double x = 0.09 * ((double(i % kWidth) + 0.5) / kWidth - 0.5) * kWidth / kHeight,
                     y = 0.09 * (0.5 - (double(i / kWidth) + 0.5) / kHeight);
        const double rx = about.x + (x - about.x) / stretch.x, ry = about.y + (y - about.y) / stretch.y,
                     r = std::hypot(rx, ry);
        if (std::abs(r - 0.03) < 0.0006)
            continue;
        inside += r < 0.03;
        wrong += ((*probes)[i].kind == RaycastProbe::surface) != (r < 0.03);
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(inside, 2000);
}

} // namespace
} // namespace serosa::render
