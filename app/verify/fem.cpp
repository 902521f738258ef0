// Group `fem`: an organ on the lattice against a finite-element solution with quadratic tetrahedra
// (app/verify/fem_comparison.h). The liver stands on its lowest sixth and is pulled down and sideways; half a
// ball, whose surface both methods resolve well, shows the order in h and what the tetrahedra themselves are
// off by.
#include "app/verify/fem_comparison.h"
#include "app/verify/fem_picture.h"
#include "app/verify/material_checks.h"
#include "app/verify/verify.h"
#include "models/phantom.h"
#include "sim/cpu_solver.h"

#include <algorithm>
#include <cmath>
#include <future>

namespace serosa::app {

namespace {

using sim::Lattice;
using sim::SolverSetup;

constexpr double kStrain = 0.01; // the largest of the finite-element solution
constexpr double kPoisson = 0.25;
constexpr double kLimit = 0.05; // mean displacement error over mean displacement

struct Organ {
    std::string name;
    PlaneCut cut;
    double low = 0, tall = 0; // m
};

Result<Organ> makeOrgan(const std::string& name, std::size_t faces, double heldShare) {
    SEROSA_ASSIGN(const sim::TriangleMesh closed, models::phantomInMetres(name, faces));
    Organ organ{name, {}, closed.lowest().y, closed.highest().y - closed.lowest().y};
    SEROSA_ASSIGN(organ.cut, cutAbove(closed, organ.low + heldShare * organ.tall));
    return organ;
}

/// Of the tissue without an injected fault. \param edge of the largest regular tetrahedron, m
Result<FemModel> elementsOf(const Organ& organ, double edge) {
    const sim::Tissue tissue = tissueOf({}, kPoisson);
    return makeFemModel(organ.cut, {tissue.young, tissue.poisson}, tissue.density,
                        std::pow(edge, 3) / (6 * std::sqrt(2.0)));
}

/// A lattice with `layers` cells over the organ's height: the plane below which it is held is one of nodes.
Result<Lattice> latticeOf(const Organ& organ, int layers) {
    sim::LatticeRequest request;
    request.spacing = organ.tall / layers;
    return sim::buildLattice(organ.cut.whole, request);
}

SolverSetup setupOf(const Organ& organ, const Lattice& lattice, const VerifyOptions& options,
                    const glm::dvec3& acceleration) {
    SolverSetup setup;
    setup.lattice = &lattice;
    setup.tissue = tissueOf(options, kPoisson);
    setup.gravity = acceleration;
    setup.fixed = nodesBelow(lattice, organ.cut.height);
    return setup;
}

LatticeField scaled(LatticeField field, double factor) {
    for (glm::dvec3& u : field.displacements)
        u *= factor;
    return field;
}

/// Two solutions of the finite elements, at the surface's vertices, which both have as nodes.
double apartAtVertices(const Organ& organ, const FemRest& a, const FemRest& b) {
    double apart = 0, size = 0;
    for (std::size_t v = 0; v < organ.cut.above.positions.size(); ++v) {
        const auto first = Eigen::Index(3 * v);
        apart += (a.displacements.segment<3>(first) - b.displacements.segment<3>(first)).norm();
        size += a.displacements.segment<3>(first).norm();
    }
    return apart / size;
}

Status draw(const Organ& organ, const Lattice& lattice, const LatticeField& field, const FemRest& rest,
            double meanSize, CheckList& checks) {
    std::vector<double> shares(organ.cut.whole.positions.size(), -1);
    const double most = 2 * kLimit;
    for (std::size_t v = 0; v < organ.cut.sources.size(); ++v)
        if (organ.cut.sources[v] >= 0) {
            const Eigen::Vector3d u = rest.displacements.segment<3>(Eigen::Index(3 * v));
            const double apart = glm::distance(field.at(organ.cut.above.positions[v]), {u[0], u[1], u[2]});
            shares[std::size_t(organ.cut.sources[v])] = std::min(1.0, apart / meanSize / most);
        }
    const std::string text = "displacement error / mean displacement";
    SEROSA_ASSIGN(render::Image image, errorPicture(organ.cut.whole, lattice, shares, most, text));
    checks.picture({"fem_error", std::move(image),
                    "The " + organ.name + " on " + grouped(lattice.nodeCount()) +
                        " nodes against quadratic tetrahedra, from the front and from behind: " + text +
                        "; what is grey is held"});
    return {};
}

struct Load {
    std::string name;
    glm::dvec3 direction;
};
/// What is asked of an organ.
struct Study {
    std::vector<int> layers; // of the lattices, rising
    double limit = kLimit;   // of the finest lattice's mean error
    double order = 0;        // at least; 0: not asked
    int settledLayers = 0;   // the lattice that a solver brings to rest; 0: none
    bool picture = false;
};

/// One load on all lattices; `unit` and the lattices' fields are under its direction as acceleration.
Status study(const Organ& organ, const FemModel& model, const FemRest& unit, const Load& load,
             const Study& how, const std::vector<std::pair<Lattice, LatticeField>>& lattices,
             const VerifyOptions& options, CheckList& checks) {
    const FemRest rest = scaledToStrain(model, unit, kStrain);
    const double factor = glm::length(rest.acceleration) / glm::length(unit.acceleration);
    const std::string of = organ.name + ", pulled " + load.name;
    std::vector<double> errors;
    for (std::size_t i = 0; i < lattices.size(); ++i) {
        const auto& [lattice, unitField] = lattices[i];
        const LatticeField field = scaled({&lattice, unitField.displacements}, factor);
        const FieldDifference difference = compareFields(model, rest, field);
        errors.push_back(difference.mean);
        const std::string piece = of + ", " + grouped(lattice.nodeCount()) + " nodes: ";
        if (i + 1 == lattices.size()) {
            checks.atMost(piece + "mean error / mean displacement", difference.mean, how.limit, "1");
            checks.atMost(piece + "largest error / mean displacement", difference.largest, 3 * how.limit,
                          "1");
            if (how.picture)
                SEROSA_TRY(draw(organ, lattice, field, rest, difference.meanSize, checks));
        }
        if (how.layers[i] != how.settledLayers)
            continue;
        const SettledLattice settled =
            settleLattice(setupOf(organ, lattice, options, rest.acceleration), field,
                          [](const SolverSetup& setup) { return sim::makeCpuSolver(setup); });
        checks.atMost(piece + "cpu solver, change in its last tenth", settled.unrest, 0.01, "1");
        checks.atMost(piece + "cpu solver at rest, mean error / mean displacement",
                      compareFields(model, rest, settled.field).mean, how.limit, "1");
    }
    if (how.order > 0)
        checks.atLeast(of + ": order in h that the mean error falls with",
                       std::log(errors.front() / errors.back()) /
                           std::log(double(how.layers.back()) / how.layers.front()),
                       how.order, "1");
    return {};
}

/// \param edge of the tetrahedra, m. \param fineEdge of others that the elements are compared with, or 0
Status compareOrgan(const Organ& organ, double edge, double fineEdge, const std::vector<Load>& loads,
                    Study how, const VerifyOptions& options, CheckList& checks) {
    // Both are linear: they can be solved at once, and scaled afterwards.
    auto elements =
        std::async(std::launch::async, [&]() -> Result<std::pair<FemModel, std::vector<FemRest>>> {
            SEROSA_ASSIGN(FemModel model, elementsOf(organ, edge));
            std::vector<FemRest> rests;
            for (const Load& load : loads) {
                SEROSA_ASSIGN(FemRest rest, femUnder(model, load.direction));
                rests.push_back(std::move(rest));
            }
            return std::pair{std::move(model), std::move(rests)};
        });
    std::vector<std::vector<std::pair<Lattice, LatticeField>>> lattices(loads.size());
    for (const int layers : how.layers) {
        SEROSA_ASSIGN(const Lattice lattice, latticeOf(organ, layers));
        for (std::size_t i = 0; i < loads.size(); ++i)
            lattices[i].emplace_back(lattice,
                                     latticeStatics(setupOf(organ, lattice, options, loads[i].direction)));
    }
    SEROSA_ASSIGN(const auto solved, elements.get());
    const auto& [model, rests] = solved;
    if (fineEdge > 0) {
        SEROSA_ASSIGN(const FemModel fine, elementsOf(organ, fineEdge));
        SEROSA_ASSIGN(const FemRest rest, femUnder(fine, loads[0].direction));
        checks.atMost(organ.name + ": " + grouped(model.mesh.elements.size()) + " tetrahedra against " +
                          grouped(fine.mesh.elements.size()) + ", mean difference / mean displacement",
                      apartAtVertices(organ, rests[0], rest), kLimit / 5, "1");
    }
    for (std::size_t i = 0; i < loads.size(); ++i) {
        SEROSA_TRY(study(organ, model, rests[i], loads[i], how, lattices[i], options, checks));
        how.picture = false;
        how.settledLayers = 0;
    }
    return {};
}

} // namespace

Status verifyFem(const VerifyOptions& options, CheckList& checks) {
    if (!tetgenExists()) {
        checks.skip("lattice against quadratic tetrahedra", kTetgenMissing);
        return {};
    }
    const Load down{"down", {0, -1, 0}}, sideways{"sideways", {1, 0, 0}};
    SEROSA_ASSIGN(const Organ ball, makeOrgan("ball", 1280, 0.5));
    SEROSA_TRY(
        compareOrgan(ball, 0.015, 0.008, {down, sideways}, {{12, 24}, 0.02, 1.5, 24}, options, checks));
    SEROSA_ASSIGN(const Organ liver, makeOrgan("liver", 8000, 1.0 / 6));
    if (!options.full)
        return compareOrgan(liver, 0.02, 0, {down}, {{54}, kLimit, 0, 0, true}, options, checks);
    return compareOrgan(liver, 0.02, 0.009, {down, sideways}, {{30, 42, 54}, kLimit, 1, 54, true}, options,
                        checks);
}

} // namespace serosa::app
