// What is drawn of an organ that was cut: nothing spans the gap, nothing else is missing.
#include "render/basis_choice.h"
#include "render/cut_faces.h"
#include "render/cut_surface.h"
#include "sim/blade.h"
#include "sim/packed_normal.h"
#include "sim/pieces.h"
#include "sim/solver.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

using namespace serosa;

namespace {

/// An ellipsoid, and a blade across x that comes down to lowestY, m.
struct CutEllipsoid {
    sim::TriangleMesh mesh;
    sim::Lattice lattice;
    render::SurfaceBinding binding;
    std::vector<std::uint32_t> connections;

    double x = 0.0004; // m: of the blade

    /// \param inPlane the blade lies in a plane of nodes, which it frees from all springs
    explicit CutEllipsoid(double lowestY, int subdivisions = 4, bool inPlane = false) {
        mesh = test::ballMesh(1, subdivisions);
        for (glm::dvec3& p : mesh.positions)
            p *= glm::dvec3(0.018, 0.006, 0.006);
        sim::LatticeRequest request;
        request.spacing = 0.0015;
        lattice = sim::buildLattice(mesh, request).value();
        binding = render::bindSurface(lattice, mesh, sim::Mapping::triangle);
        connections = lattice.connections;
        sim::Stroke stroke;
        if (inPlane)
            x = lattice.toWorld(glm::dvec3(0)).x;
        stroke.from = {glm::dvec3(x, 0.02, -0.02), glm::dvec3(x, 0.02, 0.02)};
        stroke.to = {glm::dvec3(x, lowestY, -0.02), glm::dvec3(x, lowestY, 0.02)};
        std::vector<glm::dvec3> rest;
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            rest.push_back(lattice.restPosition(node));
        sim::cutConnections(lattice, rest, sim::toLattice(stroke, lattice), connections);
    }
};

} // namespace

TEST(CutFacesDrawn, allFacesWhereNothingIsCut) {
    const CutEllipsoid body(0.02);
    EXPECT_EQ(body.connections, body.lattice.connections);
    const std::vector<bool> left =
        render::facesLeft(body.lattice, body.mesh.faces, body.binding, body.connections);
    EXPECT_EQ(std::count(left.begin(), left.end(), false), 0);
    EXPECT_EQ(sim::boundaryLeft(body.lattice, body.connections), body.lattice.boundary);
}

TEST(CutFacesDrawn, VerticesFollowTheirOwnSideAndNoFaceIsStretched) {
    const CutEllipsoid body(-0.02, 5); // all through
    const sim::LatticeState rest = sim::restState(body.lattice);
    std::vector<glm::dvec3> apart = rest.positions;
    for (glm::dvec3& p : apart) // both halves go their way
        p.x += body.lattice.toWorld(p).x > 0.0004 ? 2.5 : -2.5;
    for (const auto mapping : {sim::Mapping::triangle, sim::Mapping::nodeFrames}) {
        const render::SurfaceBinding whole =
            render::expressBinding(body.binding, body.lattice, body.mesh, mapping);
        const render::SurfaceBinding rebound =
            render::expressBinding(whole, body.lattice, body.mesh, mapping, body.connections);
        const auto dropped = [&](const render::SurfaceBinding& binding) {
            const std::vector<bool> left =
                render::facesLeft(body.lattice, body.mesh.faces, binding, body.connections);
            return std::count(left.begin(), left.end(), false);
        };
        EXPECT_GT(dropped(rebound), 0);
        EXPECT_LT(double(dropped(rebound)), 0.6 * double(dropped(whole)));
        const auto atRest = render::mapSurface(rebound, rest.positions, rest.normals);
        const auto moved = render::mapSurface(rebound, apart, rest.normals);
        const std::vector<bool> left =
            render::facesLeft(body.lattice, body.mesh.faces, rebound, body.connections);
        for (std::size_t v = 0; v < atRest.size(); ++v)
            ASSERT_LE(glm::distance(atRest[v], body.lattice.toLattice(body.mesh.positions[v])), 1e-5);
        for (std::size_t f = 0; f < left.size(); ++f)
            for (int i = 0; i < 3 && left[f]; ++i) {
                const std::uint32_t a = body.mesh.faces[f][i], b = body.mesh.faces[f][(i + 1) % 3];
                ASSERT_NEAR(glm::distance(moved[a], moved[b]), glm::distance(atRest[a], atRest[b]), 1e-4);
            }
    }
}

TEST(CutFacesDrawn, NoFaceIsStretchedOverACutThatGapes) {
    for (const bool inPlane : {false, true}) {
        const CutEllipsoid body(-0.003, 5, inPlane); // not through: both sides are one piece
        const sim::LatticeState rest = sim::restState(body.lattice);
        const double tip = body.lattice.toLattice({0, -0.003, 0}).y;
        const auto sideOf = [&](const glm::dvec3& p) {
            return body.lattice.toWorld(p).x > body.x ? 1.0 : -1.0;
        };
        std::vector<glm::dvec3> open = rest.positions;
        for (glm::dvec3& p : open)
            p.x += sideOf(p) * 0.25 * std::max(0.0, p.y - tip);
        const render::SurfaceBinding rebound = render::expressBinding(
            body.binding, body.lattice, body.mesh, sim::Mapping::nodeFrames, body.connections);
        const auto atRest = render::mapSurface(rebound, rest.positions, rest.normals);
        const auto moved = render::mapSurface(rebound, open, rest.normals);
        const std::vector<bool> left =
            render::facesLeft(body.lattice, body.mesh.faces, rebound, body.connections);
        std::size_t beside = 0;
        for (std::size_t f = 0; f < left.size(); ++f)
            for (int i = 0; i < 3 && left[f]; ++i) {
                const std::uint32_t a = body.mesh.faces[f][i], b = body.mesh.faces[f][(i + 1) % 3];
                if (std::min(atRest[a].y, atRest[b].y) < tip + 2.5) // around its end it gapes little
                    continue;
                beside += std::abs(atRest[a].x) < 1.5;
                ASSERT_LE(std::abs(glm::distance(moved[a], moved[b]) - glm::distance(atRest[a], atRest[b])),
                          0.6)
                    << f;
            }
        EXPECT_GT(beside, 100U); // faces are drawn up to it
    }
}

TEST(CutFacesDrawn, facesLargerThanTheLatticeStayBesideACut) {
    const CutEllipsoid body(-0.02, 1); // corners of a face are up to eight springs from each other
    const std::vector<bool> left =
        render::facesLeft(body.lattice, body.mesh.faces, body.binding, body.connections);
    std::size_t beside = 0;
    for (std::size_t f = 0; f < left.size(); ++f) {
        double low = 1, high = -1;
        for (int i = 0; i < 3; ++i) {
            low = std::min(low, body.mesh.positions[body.mesh.faces[f][i]].x);
            high = std::max(high, body.mesh.positions[body.mesh.faces[f][i]].x);
        }
        const double h = body.lattice.spacing;
        if (low < body.x - h / 2 && high > body.x + h / 2) {
            EXPECT_FALSE(left[f]) << f;
        } else if (low > body.x + 1.5 * h || high < body.x - 1.5 * h) {
            EXPECT_TRUE(left[f]) << f;
            ++beside;
        }
    }
    EXPECT_GT(beside, 4U);
}

TEST(CutFacesDrawn, noFaceSpansACut) {
    for (const double lowestY : {-0.02, 0.0}) { // all through, and half
        const CutEllipsoid body(lowestY);
        const std::vector<bool> left =
            render::facesLeft(body.lattice, body.mesh.faces, body.binding, body.connections);
        for (std::size_t f = 0; f < left.size(); ++f) {
            glm::dvec3 low(1), high(-1);
            for (int i = 0; i < 3; ++i) {
                low = glm::min(low, body.mesh.positions[body.mesh.faces[f][i]]);
                high = glm::max(high, body.mesh.positions[body.mesh.faces[f][i]]);
            }
            const double h = body.lattice.spacing;
            if (low.x < 0.0004 && high.x > 0.0004 && low.y > lowestY + h) {
                EXPECT_FALSE(left[f]) << f;
            } else if (low.x > 3 * h || high.x < -2 * h || high.y < lowestY - 2 * h) {
                EXPECT_TRUE(left[f]) << f;
            }
        }
        // One-to-one: every edge of the drawn triangles is shared by as many in each direction (closed).
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
        for (const glm::uvec3& t : sim::boundaryLeft(body.lattice, body.connections))
            for (int i = 0; i < 3; ++i) {
                ++edges[{t[i], t[(i + 1) % 3]}];
                --edges[{t[(i + 1) % 3], t[i]}];
            }
        EXPECT_GT(edges.size(), 500u);
        for (const auto& [edge, balance] : edges)
            EXPECT_EQ(balance, 0);
    }
}

// Springs that tore leave no sides in space: each of their faces is drawn whole for both sides of the tear,
// and moves with it.
TEST(CutFacesDrawn, BothSidesOfATearHaveAllOfItsFaces) {
    const CutEllipsoid body(-0.02, 5); // all through
    const sim::LatticeState rest = sim::restState(body.lattice);
    constexpr double kApart = 2.5; // lattice units, each half to its own side
    std::vector<glm::dvec3> apart = rest.positions;
    for (glm::dvec3& p : apart)
        p.x += body.lattice.toWorld(p).x > body.x ? kApart : -kApart;
    for (const auto mapping : {sim::Mapping::triangle, sim::Mapping::curvature, sim::Mapping::chosen,
                               sim::Mapping::normalOffset, sim::Mapping::nodeFrames}) {
        SCOPED_TRACE(int(mapping));
        const render::SurfaceBinding whole =
            render::expressBinding(body.binding, body.lattice, body.mesh, mapping);
        const render::SurfaceBinding rebound =
            render::expressBinding(whole, body.lattice, body.mesh, mapping, body.connections);
        const render::CutSurface surface =
            render::cutSurface(body.lattice, body.mesh, whole, rebound, body.connections, {});
        std::vector<render::VertexCopy> copies;
        for (const render::CutVertex& vertex : surface.vertices)
            copies.push_back({vertex.vertex, vertex.follows});
        const render::SurfaceBinding all =
            render::withCopies(rebound, copies, body.lattice, body.mesh, body.connections);
        const std::size_t first = rebound.vertices.size();
        const render::RestNormals normals(body.lattice, body.connections); // as the solver writes them
        std::vector<std::uint32_t> packed;
        for (std::uint32_t node = 0; node < body.lattice.nodeCount(); ++node)
            packed.push_back(sim::packNormal(glm::vec3(normals.normal(node))));
        const auto still = render::mapSurface(all, rest.positions, packed);
        const auto moved = render::mapSurface(all, apart, packed);
        std::map<std::uint32_t, std::pair<int, int>>
            sidesOf; // of a torn face: copies to the left, to the right
        for (std::size_t c = 0; c < surface.copies.size(); ++c) {
            int left = 0, right = 0;
            for (int i = 0; i < 3; ++i) {
                const std::size_t v = first + surface.copies[c][i];
                const glm::dvec3 place =
                    body.lattice.toLattice(body.mesh.positions[copies[surface.copies[c][i]].vertex]);
                EXPECT_LT(glm::distance(still[v], place), 1e-4);
                left += glm::distance(moved[v], place - glm::dvec3(kApart, 0, 0)) < 1e-3;
                right += glm::distance(moved[v], place + glm::dvec3(kApart, 0, 0)) < 1e-3;
            }
            EXPECT_TRUE(left == 3 || right == 3) << left << " " << right;
            sidesOf[surface.copied[c]].first += left == 3;
            sidesOf[surface.copied[c]].second += right == 3;
        }
        std::size_t torn = 0, both = 0, none = 0;
        for (std::uint32_t f = 0; f < surface.whole.size(); ++f) {
            if (surface.whole[f])
                continue;
            ++torn;
            const auto [left, right] = sidesOf[f];
            EXPECT_LE(left, 1);
            EXPECT_LE(right, 1);
            both += left == 1 && right == 1;
            none += left + right == 0;
        }
        EXPECT_GT(torn, 50U);
        EXPECT_EQ(none, 0U);
        EXPECT_GT(double(both), 0.9 * double(torn));
    }
}
