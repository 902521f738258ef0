// What is measured on lattice beams: see app/verify/elastic_measures.h; the statics are those of
// app/verify/lattice_statics.h.
#include "app/verify/elastic_measures.h"

#include "app/verify/lattice_statics.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <random>

namespace serosa::app {

namespace {

using Vector = Eigen::VectorXd;

glm::dvec3 localPosition(const Beam& beam, std::size_t node) {
    return glm::transpose(beam.turn) * (beam.lattice.restPosition(node) - beam.middle);
}

/// Displacements when both end sections' displacement along `direction(p)` is `amount(p)`, p local.
template <class Direction, class Amount>
Vector solveWithEnds(const Beam& beam, const sim::Tissue& tissue, Direction direction, Amount amount) {
    LatticeProblem problem(beam.lattice);
    for (std::size_t node = 0; node < beam.lattice.nodeCount(); ++node) {
        const glm::dvec3 p = localPosition(beam, node);
        if (std::abs(p.z) >= 0.5 * beam.length - 1)
            for (const glm::dvec3& along : direction(p))
                problem.prescribe(node, beam.turn * along, amount(p, along));
    }
    return problem.solve(tissue);
}

/// Force along the axis, moment about the lateral axis x and torque about the axis that the tissue carries
/// through the middle: what acts on the half beyond it, from the inner forces of its nodes.
struct SectionLoad {
    double force = 0, moment = 0, torque = 0;
};
SectionLoad sectionLoad(const Beam& beam, const sim::Tissue& tissue, const Vector& displacement) {
    const Vector inner = latticeStiffness(beam.lattice, tissue) * displacement;
    SectionLoad sum;
    for (std::size_t node = 0; node < beam.lattice.nodeCount(); ++node) {
        const glm::dvec3 p = localPosition(beam, node),
                         f = glm::transpose(beam.turn) * nodeVector(inner, node);
        if (p.z < 0)
            continue;
        sum.force += f.z;
        sum.moment += p.y * f.z;
        sum.torque += p.x * f.y - p.y * f.x;
    }
    return sum;
}

/// Least squares fit of a component of the displacement over the middle third: coefficients of 1, x, y, z, y
/// z, x z (local).
Eigen::VectorXd fit(const Beam& beam, const Vector& displacement, const glm::dvec3& direction) {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(6, 6);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(6);
    for (std::size_t node = 0; node < beam.lattice.nodeCount(); ++node) {
        const glm::dvec3 p = localPosition(beam, node);
        if (std::abs(p.z) > beam.length / 6)
            continue;
        Eigen::VectorXd row(6);
        row << 1, p.x, p.y, p.z, p.y * p.z, p.x * p.z;
        const double mass = beam.lattice.massShare(node);
        normal += mass * row * row.transpose();
        right += mass * row * glm::dot(direction, nodeVector(displacement, node));
    }
    return normal.ldlt().solve(right);
}

double materialArea(const Beam& beam) { // cells: volume over length, of the fills as the lattice has them
    double volume = 0;
    for (const sim::LatticeCell& cell : beam.lattice.cells)
        volume += cell.fill / 255.0;
    return volume / beam.length;
}

/// Tractions on the piece's true faces, spread over the nodes of the cells that they meet. `traction(axis,
/// side)` is local, in k/h, on the face across `axis` at its low (-1) or high (1) end.
template <class Traction>
void loadFaces(const Beam& piece, LatticeProblem& problem, Traction traction) {
    const glm::dvec3 half = 0.5 * glm::dvec3(piece.thickness, piece.thickness, piece.length);
    const int samples = 8; // along each unit of length
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const int nu = int(2 * half[u]) * samples, nv = int(2 * half[v]) * samples;
            const glm::dvec3 force = traction(axis, side) / double(samples * samples);
            for (int i = 0; i < nu * nv; ++i) {
                glm::dvec3 p;
                p[axis] = side * half[axis] * (1 - 1e-9);
                p[u] = half[u] * ((i % nu + 0.5) / nu * 2 - 1);
                p[v] = half[v] * ((i / nu + 0.5) / nv * 2 - 1);
                for (const TrilinearCorner& corner :
                     trilinearCorners(piece.lattice, piece.middle + piece.turn * p))
                    if (corner.node >= 0)
                        problem.push(std::size_t(corner.node), corner.weight * (piece.turn * force));
            }
        }
}

} // namespace

glm::dmat3 randomRotation(std::uint32_t seed) {
    std::mt19937 random(seed); // its output is fixed by the standard; distributions are not
    const auto uniform = [&random] { return double(random()) / 4294967296.0; };
    const double a = uniform(), b = 6.283185307179586 * uniform(), c = 6.283185307179586 * uniform();
    const double w = std::sqrt(1 - a) * std::sin(b), x = std::sqrt(1 - a) * std::cos(b);
    const double y = std::sqrt(a) * std::sin(c), z = std::sqrt(a) * std::cos(c);
    return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
            {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
            {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
}

Beam makeBeam(double thickness, double length, const glm::dmat3& turn, double spacing) {
    const glm::dvec3 half = 0.5 * spacing * glm::dvec3(thickness, thickness, length);
    sim::TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.positions.push_back(
            turn * (half * glm::dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1)));
    mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    sim::LatticeRequest request;
    request.spacing = spacing;
    Beam beam;
    beam.lattice = sim::buildLattice(mesh, request).value();
    beam.turn = turn;
    beam.middle = beam.lattice.toLattice(glm::dvec3(0));
    beam.thickness = thickness;
    beam.length = length;
    return beam;
}

BeamMeasures measureBeam(const Beam& beam, const sim::Tissue& tissue, bool torsion) {
    BeamMeasures measures;
    const double mu = 1, young = 2 * (1 + tissue.poisson) * mu; // of k/h
    const auto axial = [](const glm::dvec3&) { return std::array{glm::dvec3(0, 0, 1)}; };
    const Vector pulled =
        solveWithEnds(beam, tissue, axial, [](const glm::dvec3& p, const glm::dvec3&) { return 1e-3 * p.z; });
    const double strain = fit(beam, pulled, beam.turn[2])[3];
    const double lateral = 0.5 * (fit(beam, pulled, beam.turn[0])[1] + fit(beam, pulled, beam.turn[1])[2]);
    measures.youngShare = sectionLoad(beam, tissue, pulled).force / (materialArea(beam) * strain * young);
    measures.poisson = -lateral / strain;

    const Vector bent = solveWithEnds(
        beam, tissue, axial, [](const glm::dvec3& p, const glm::dvec3&) { return 1e-4 * p.y * p.z; });
    const double curvature = fit(beam, bent, beam.turn[2])[4];
    const double square = std::pow(beam.thickness, 4);
    measures.bendingShare = sectionLoad(beam, tissue, bent).moment / (curvature * young * square / 12);
    if (!torsion)
        return measures;

    // The ends turn about the axis, free to warp.
    const Vector twisted = solveWithEnds(
        beam, tissue,
        [](const glm::dvec3&) {
            return std::array{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)};
        },
        [](const glm::dvec3& p, const glm::dvec3& along) {
            return 1e-4 * p.z * glm::dot(along, glm::dvec3(-p.y, p.x, 0));
        });
    const double twist = 0.5 * (fit(beam, twisted, beam.turn[1])[5] - fit(beam, twisted, beam.turn[0])[4]);
    measures.torsionShare = sectionLoad(beam, tissue, twisted).torque / (twist * mu * 0.1406 * square);
    return measures;
}

double bulkModulusShare(const Beam& piece, const sim::Tissue& tissue) {
    const double pressure = 1e-3;                            // k/h
    const double modulus = 1 + tissue.bulkShare() + 2.0 / 3; // lambda + 2/3 mu
    LatticeProblem problem(piece.lattice);
    loadFaces(piece, problem, [&](int axis, double side) {
        glm::dvec3 inward(0);
        inward[axis] = -side * pressure;
        return inward;
    });
    const Vector pressed = problem.solve(tissue);
    // Of all the material: a rough surface layer, half of so small a piece, shares the load unevenly.
    double change = 0, volume = 0;
    for (const sim::LatticeCell& cell : piece.lattice.cells) {
        volume += cell.fill;
        for (int c = 0; c < 8; ++c) {
            const glm::ivec3 corner = sim::cornerOffset(c);
            const auto node = std::size_t(piece.lattice.nodeAt(cell.grid + corner));
            change += cell.fill * 0.25 * glm::dot(2.0 * glm::dvec3(corner) - 1.0, nodeVector(pressed, node));
        }
    }
    change /= volume;
    return -pressure / change / modulus;
}

double shearShare(const Beam& beam, const sim::Tissue& tissue) {
    const double stress = 1e-3; // k/h; mu is 1
    LatticeProblem problem(beam.lattice);
    loadFaces(beam, problem, [&](int axis, double side) {
        return axis == 0   ? glm::dvec3(0, side * stress, 0)
               : axis == 1 ? glm::dvec3(side * stress, 0, 0)
                           : glm::dvec3(0);
    });
    const Vector sheared = problem.solve(tissue);
    return stress / (fit(beam, sheared, beam.turn[0])[2] + fit(beam, sheared, beam.turn[1])[1]);
}

double cantileverSagShare(const Beam& beam, const sim::Tissue& tissue) {
    const double mu = 1, young = 2 * (1 + tissue.poisson) * mu, weight = 1e-6;
    LatticeProblem problem(beam.lattice);
    const auto share = [&](std::size_t node) { return beam.lattice.massShare(node); };
    const auto inSection = [&](std::size_t node, double end) {
        return std::abs(localPosition(beam, node).z - end) < 1;
    };
    double total = 0, clamped = 0;
    for (std::size_t node = 0; node < beam.lattice.nodeCount(); ++node) {
        total += share(node);
        clamped += inSection(node, -0.5 * beam.length) ? share(node) : 0;
    }
    for (std::size_t node = 0; node < beam.lattice.nodeCount(); ++node) {
        problem.push(node, -weight * share(node) * beam.turn[1]);
        if (inSection(node, -0.5 * beam.length)) {
            problem.prescribe(node, beam.turn[2], 0);
            problem.push(node, weight * total * share(node) / clamped * beam.turn[1]);
        }
    }
    const Vector moved = problem.solve(tissue);
    double sums[2] = {0, 0}, masses[2] = {0, 0}, places[2] = {0, 0};
    for (std::size_t node = 0; node < beam.lattice.nodeCount(); ++node)
        for (const int end : {0, 1})
            if (inSection(node, (end - 0.5) * beam.length)) {
                sums[end] += share(node) * glm::dot(beam.turn[1], nodeVector(moved, node));
                places[end] += share(node) * localPosition(beam, node).z;
                masses[end] += share(node);
            }
    const double sag = sums[0] / masses[0] - sums[1] / masses[1];
    // From the plane that is held, the innermost of the clamped nodes, to the free section's middle.
    double held = -0.5 * beam.length;
    for (std::size_t node = 0; node < beam.lattice.nodeCount(); ++node)
        if (inSection(node, -0.5 * beam.length))
            held = std::max(held, localPosition(beam, node).z);
    const double area = materialArea(beam), inertia = std::pow(beam.thickness, 4) / 12,
                 length = 0.5 * beam.length - held, x = places[1] / masses[1] - held, q = weight * area;
    const double bending =
        q * x * x * (6 * length * length - 4 * length * x + x * x) / (24 * young * inertia);
    const double kappa = 10 * (1 + tissue.poisson) / (12 + 11 * tissue.poisson);
    const double shear = q * (length * x - x * x / 2) / (kappa * mu * area);
    return sag / (bending + shear);
}

double linearForceMismatch(const sim::SolverSetup& setup) {
    const sim::Lattice& lattice = *setup.lattice;
    sim::LatticeState state = sim::restState(lattice);
    std::mt19937 random(7);
    Vector displacement(Eigen::Index(3 * lattice.nodeCount()));
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int axis = 0; axis < 3; ++axis) {
            const double value = 1e-7 * (double(random()) / 4294967296.0 - 0.5);
            displacement[Eigen::Index(3 * node) + axis] = value;
            state.positions[node][axis] += value;
        }
    const Vector force = latticeStiffness(lattice, setup.tissue) * displacement;
    const std::unique_ptr<sim::Solver> solver = sim::makeReferenceSolver(setup);
    solver->setState(state);
    solver->advance(1);
    const sim::LatticeState after = solver->state();
    // Expected with the nominal Young's modulus: that is what the static figures assume.
    sim::Tissue assumed;
    assumed.poisson = setup.tissue.poisson;
    const double nominal = setup.timeStep * setup.timeStep * assumed.stiffnessOverMass(lattice.spacing);
    double worst = 0, largest = 0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        const glm::dvec3 expected = -nodeVector(force, node);
        const glm::dvec3 got = after.increments[node] * lattice.massShare(node) / nominal;
        worst = std::max(worst, glm::length(got - expected));
        largest = std::max(largest, glm::length(expected));
    }
    return worst / largest;
}

double longitudinalPeriod(const Beam& beam, const sim::SolverSetup& setup, sim::Solver& solver) {
    const sim::Lattice& lattice = *setup.lattice;
    const auto along = [&](std::size_t node) {
        return glm::dot(beam.turn[2], lattice.restPosition(node) - beam.middle);
    };
    const auto shape = [&](double z) { return std::sin(3.141592653589793 * z / beam.length); };
    sim::LatticeState state = sim::restState(lattice);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        state.positions[node] += beam.turn[2] * (0.02 * shape(along(node)));
    solver.setState(state);
    const auto amplitude = [&] {
        const sim::LatticeState now = solver.state();
        double sum = 0;
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            sum += lattice.massShare(node) * shape(along(node)) *
                   glm::dot(beam.turn[2], now.positions[node] - lattice.restPosition(node));
        return sum;
    };
    // Starts at its largest: the zero crossings lie at 1/4, 3/4, 5/4 of the period (half a step earlier: the
    // start is at rest between two steps), so the time between the first and the third is one period.
    double before = amplitude();
    std::vector<double> crossings;
    for (int step = 1; crossings.size() < 3 && step < 4000; ++step) {
        solver.advance(1);
        const double now = amplitude();
        if ((before < 0) != (now < 0))
            crossings.push_back((step - 1 + before / (before - now)) * setup.timeStep);
        before = now;
    }
    return crossings.size() == 3 ? crossings[2] - crossings[0] : 0;
}

} // namespace serosa::app
