// Group `surface`: MS05 eq. 3 against true normals, where it fails (3.5), and the choice per vertex (3.6).
#include "app/verify/surface_cases.h"
#include "render/basis_choice.h"
#include "render/mapping_measures.h"
#include "render/surface_binding.h"
#include "render/surface_measures.h"
#include "sim/packed_normal.h"
#include "sim/solver.h"

#include <algorithm>
#include <cmath>

namespace serosa::app {

namespace {

using render::AngleSpread;
using sim::Mapping;

std::vector<bool> boundaryNodes(const sim::Lattice& lattice) {
    std::vector<bool> on(lattice.nodeCount());
    for (const glm::uvec3& t : lattice.boundary)
        for (int i = 0; i < 3; ++i)
            on[t[i]] = true;
    return on;
}

/// Eq. 3 on the steps of a ball: against the radius.
Status measureBall(CheckList& checks) {
    SEROSA_ASSIGN(const SurfaceCase ball, surfaceCase("ball", 8000, 8000));
    const render::RestNormals rest(ball.lattice);
    const std::vector<bool> onBoundary = boundaryNodes(ball.lattice);
    std::vector<glm::dvec3> eq3, radial;
    std::size_t undefined = 0, all = 0;
    for (std::uint32_t node = 0; node < ball.lattice.nodeCount(); ++node) {
        all += onBoundary[node];
        undefined += onBoundary[node] && rest.length(node) < 0.5;
        if (onBoundary[node] && rest.length(node) >= 0.5) {
            eq3.push_back(rest.normal(node));
            radial.push_back(
                glm::normalize(ball.lattice.restPosition(node) - ball.lattice.toLattice(glm::dvec3(0))));
        }
    }
    const AngleSpread angles = render::anglesBetween(eq3, radial);
    checks.atMost("eq. 3 on a ball's steps against the radius, median", angles.median, 20, "deg");
    checks.atMost("eq. 3 on a ball's steps against the radius, largest", angles.largest, 50, "deg");
    checks.atMost("eq. 3 on a ball: nodes at inner corners, where it is not defined",
                  double(undefined) / double(all), 0.25, "of all");
    return {};
}

/// Eq. 3 on the flat sides of a beam along the grid, bent: against the bend's own normals.
Status measureBeam(const VerifyOptions& options, CheckList& checks) {
    std::vector<sim::LatticeCell> cells;
    const glm::ivec3 size(24, 6, 6);
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                cells.push_back({{x, y, z}, 255});
    const sim::Lattice beam = sim::latticeFromCells(cells, 1, glm::dvec3(0));
    constexpr double kRadius = 20; // spacings
    const sim::LatticeState bent = render::deformedState(
        beam, [](const glm::dvec3& q) { return render::bend(q, {}, kRadius); },
        options.inject.fault == Fault::staleNormal ? render::NodeNormals::stale
                                                   : render::NodeNormals::current);
    std::vector<glm::dvec3> eq3, exact;
    for (std::size_t node = 0; node < beam.nodeCount(); ++node) {
        const glm::ivec3 at = beam.nodes[node];
        if ((at.y != 0 && at.y != size.y) || std::min(at.x, size.x - at.x) < 1 ||
            std::min(at.z, size.z - at.z) < 1)
            continue; // inside, or at an edge
        const double angle = beam.restPosition(node).x / kRadius, side = at.y == 0 ? -1 : 1;
        eq3.emplace_back(sim::unpackNormal(bent.normals[node]));
        exact.emplace_back(side * std::sin(angle), side * std::cos(angle), 0);
    }
    const AngleSpread angles = render::anglesBetween(eq3, exact);
    checks.atMost("eq. 3 on a bent beam's sides against the true normal, median", angles.median, 1, "deg");
    checks.atMost("eq. 3 on a bent beam's sides against the true normal, largest", angles.largest, 1, "deg");
    return {};
}

/// A sheet of one node: cut free on both sides out of a slab. Eq. 3 has no sum there; the choice must take
/// the constant basis, and the surface return at rest.
Status measureSheet(CheckList& checks) {
    std::vector<sim::LatticeCell> cells;
    for (int z = 0; z < 10; ++z)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 10; ++x)
                cells.push_back({{x, y, z}, 255});
    const sim::Lattice slab = sim::latticeFromCells(cells, 1, glm::dvec3(0));
    std::vector<std::uint32_t> connections = slab.connections;
    for (std::size_t node = 0; node < slab.nodeCount(); ++node)
        for (std::size_t d = 0; d < 18; ++d)
            if (slab.nodes[node].y == 2 || slab.nodes[node].y + sim::kNeighbourOffsets[d].y == 2)
                if (sim::kNeighbourOffsets[d].y != 0)
                    connections[node] &= ~(1U << d); // the upper layer: in-plane springs only
    const render::RestNormals rest(slab, connections);
    double longest = 0;
    for (std::uint32_t node = 0; node < slab.nodeCount(); ++node)
        if (slab.nodes[node].y == 2 && slab.nodes[node].x % 10 != 0 && slab.nodes[node].z % 10 != 0)
            longest = std::max(longest, rest.length(node));
    checks.equalAbs("eq. 3 in a sheet of one node, length of the sum", longest, 0, 1e-12, "1");

    sim::TriangleMesh above; // a wavy surface half a spacing above the sheet
    const int n = 40;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
            const glm::dvec3 p(1 + 8.0 * i / n, 2.3 + 0.2 * std::sin(0.7 * i) * std::sin(0.5 * j),
                               1 + 8.0 * j / n);
            above.positions.push_back(slab.toWorld(p - glm::dvec3(slab.centre)));
        }
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const auto a = std::uint32_t(i * (n + 1) + j), b = a + n + 1;
            above.faces.emplace_back(a, a + 1, b);
            above.faces.emplace_back(a + 1, b + 1, b);
        }
    const render::SurfaceBinding whole = render::bindSurface(slab, above, Mapping::chosen);
    const auto corrected = [](const render::SurfaceBinding& binding) {
        double most = 0;
        for (const render::VertexBinding& vertex : binding.vertices)
            most = std::max(most, double(vertex.correctedShare));
        return most;
    };
    checks.atLeast("the choice on the slab before, largest share of the corrected basis", corrected(whole), 1,
                   "1");
    sim::LatticeState state = sim::restState(slab); // normals as the solver writes them after the cut
    for (std::uint32_t node = 0; node < slab.nodeCount(); ++node)
        state.normals[node] = sim::packNormal(glm::vec3(rest.normal(node)));
    for (const Mapping mapping : {Mapping::curvature, Mapping::chosen, Mapping::normalOffset}) {
        const render::SurfaceBinding binding =
            render::expressBinding(whole, slab, above, mapping, connections);
        checks.equalAbs("the choice on a sheet of one node, " + mappingWord(mapping) +
                            ": largest share of the corrected basis",
                        corrected(binding), 0, 0, "1");
        const auto drawn = render::mapSurface(binding, state.positions, state.normals);
        double away = 0;
        for (std::size_t v = 0; v < drawn.size(); ++v)
            away = std::max(away, glm::distance(drawn[v], slab.toLattice(above.positions[v])));
        checks.equalAbs("a sheet of one node, " + mappingWord(mapping) + ": vertices return at rest", away, 0,
                        1e-5, "h");
    }
    return {};
}

/// What the correction is worth: how far it moves a vertex under figure 6's bend, by its offset and by how
/// near its reference point lies to a node. `chosen` leaves it out below its thresholds (MS05 3.5: "If the
/// offset vector [...] is sufficiently short [...] or if the reference point is close to a node").
Status measureWorth(CheckList& checks) {
    SEROSA_ASSIGN(const SurfaceCase dragon, surfaceCase("dragon", 10000, 0, 0.062));
    const sim::LatticeState bent =
        render::deformedState(dragon.lattice, [](const glm::dvec3& q) { return render::bend(q, {}, 3); });
    const render::SurfaceBinding binding =
        render::bindSurface(dragon.lattice, dragon.mesh, Mapping::curvature);
    const auto corrected = render::mapSurface(binding, bent.positions, bent.normals);
    const auto constant =
        render::mapSurface(render::expressBinding(binding, dragon.lattice, dragon.mesh, Mapping::triangle),
                           bent.positions, bent.normals);
    double perOffset = 0;
    std::vector<double> near, far;
    for (std::size_t v = 0; v < corrected.size(); ++v) {
        const render::VertexBinding& bound = binding.vertices[v];
        const double offset = glm::length(bound.offset), moved = glm::distance(corrected[v], constant[v]);
        if (bound.correctedShare == 0 || offset < 1e-3)
            continue;
        perOffset = std::max(perOffset, moved / offset);
        const float heaviest = std::max({bound.weights.x, bound.weights.y, bound.weights.z});
        (heaviest > 0.8F ? near : far).push_back(moved / offset);
    }
    checks.atMost("what the correction moves a vertex by, over its offset, largest", perOffset, 1, "1");
    checks.atMost("the same at the offset below which it is left out (0.03 h)", 0.03 * perOffset, 0.02, "h");
    checks.atMost("the same, median, reference points far from nodes", render::quantile(far, 0.5), 1, "1");
    checks.atMost("the same, median, reference points near a node", render::quantile(near, 0.5), 1, "1");
    return {};
}

} // namespace

Status verifySurfaceNormals(const VerifyOptions& options, CheckList& checks) {
    SEROSA_TRY(measureBall(checks));
    SEROSA_TRY(measureBeam(options, checks));
    SEROSA_TRY(measureSheet(checks));
    return measureWorth(checks);
}

} // namespace serosa::app
