// Statics of the lattice with small displacements: stiffness matrix w_ij n n^T from the lattice's springs (k
// = h = 1).
#include "app/elastic_measures.h"

#include <Eigen/Dense>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/Sparse>
#include <cmath>
#include <random>

namespace serosa::app {

namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double>;

glm::dvec3 at(const Vector& v, std::size_t node) {
    return {v[Eigen::Index(3 * node)], v[Eigen::Index(3 * node + 1)], v[Eigen::Index(3 * node + 2)]};
}

template <class Visit> // visit(first, second, direction from first to second, weight, rest length)
void forEachSpring(const sim::Lattice& lattice, Visit visit) {
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < 18; d += 2)
            if (const std::int64_t other = lattice.neighbour(node, d); other >= 0) {
                const glm::dvec3 offset(sim::kNeighbourOffsets[std::size_t(d)]);
                visit(node, std::size_t(other), glm::normalize(offset), lattice.springWeight(node, d),
                      glm::length(offset));
            }
}

Matrix stiffnessMatrix(const sim::Lattice& lattice, const std::vector<Eigen::Triplet<double>>& extra) {
    std::vector<Eigen::Triplet<double>> entries = extra;
    forEachSpring(lattice, [&entries](std::size_t a, std::size_t b, const glm::dvec3& n, double w, double) {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const double value = w * n[i] * n[j];
                const int ai = int(3 * a) + i, aj = int(3 * a) + j, bi = int(3 * b) + i, bj = int(3 * b) + j;
                entries.emplace_back(ai, aj, value);
                entries.emplace_back(bi, bj, value);
                entries.emplace_back(ai, bj, -value);
                entries.emplace_back(bi, aj, -value);
            }
    });
    const auto size = Eigen::Index(3 * lattice.nodeCount());
    Matrix matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

/// Displacements when the end sections' axial displacement is `axial(local position)`, by stiff springs along
/// the axis.
template <class Axial>
Vector solveWithEnds(const Beam& beam, Axial axial) {
    const double grip = 1e3; // of k
    const glm::dvec3 axis = beam.turn[2];
    std::vector<Eigen::Triplet<double>> extra;
    Vector load = Vector::Zero(Eigen::Index(3 * beam.lattice.nodeCount()));
    for (std::size_t node = 0; node < beam.lattice.nodeCount(); ++node) {
        const glm::dvec3 local = glm::transpose(beam.turn) * (beam.lattice.restPosition(node) - beam.middle);
        // A light hold against rigid drift sideways: far below any force that is measured.
        for (int i = 0; i < 3; ++i)
            extra.emplace_back(int(3 * node) + i, int(3 * node) + i, 1e-10);
        if (std::abs(local.z) < 0.5 * beam.length - 1)
            continue;
        for (int i = 0; i < 3; ++i) {
            load[Eigen::Index(3 * node) + i] += grip * axis[i] * axial(local);
            for (int j = 0; j < 3; ++j)
                extra.emplace_back(int(3 * node) + i, int(3 * node) + j, grip * axis[i] * axis[j]);
        }
    }
    const Matrix matrix = stiffnessMatrix(beam.lattice, extra);
    Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> solver;
    solver.setTolerance(1e-8);
    solver.setMaxIterations(20000);
    solver.compute(matrix);
    return solver.solve(load);
}

/// Force and moment about the lateral axis x (local) that the springs carry through sections of the middle
/// third, means.
struct SectionLoad {
    double force = 0, moment = 0;
};
SectionLoad sectionLoad(const Beam& beam, const Vector& displacement) {
    const double third = beam.length / 3;
    SectionLoad sum;
    // A mean over all sections of the middle third: each spring counts by the axial length that it spans in
    // there.
    forEachSpring(beam.lattice, [&](std::size_t a, std::size_t b, const glm::dvec3& n, double w, double) {
        const glm::dvec3 pa = glm::transpose(beam.turn) * (beam.lattice.restPosition(a) - beam.middle);
        const glm::dvec3 pb = glm::transpose(beam.turn) * (beam.lattice.restPosition(b) - beam.middle);
        const double low = std::max(std::min(pa.z, pb.z), -0.5 * third),
                     high = std::min(std::max(pa.z, pb.z), 0.5 * third);
        if (high <= low)
            return;
        const double tension = w * glm::dot(n, at(displacement, b) - at(displacement, a));
        const double along = std::abs(glm::dot(n, beam.turn[2]));
        const double share = (high - low) / third;
        const double t = pb.z == pa.z ? 0.5 : (0.5 * (low + high) - pa.z) / (pb.z - pa.z);
        sum.force += tension * along * share;
        sum.moment += tension * along * share * (pa.y + t * (pb.y - pa.y));
    });
    return sum;
}

/// Least squares fit of a component of the displacement over the middle third: coefficients of 1, x, y, z, y
/// z (local).
Eigen::VectorXd fit(const Beam& beam, const Vector& displacement, const glm::dvec3& direction) {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(5, 5);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(5);
    for (std::size_t node = 0; node < beam.lattice.nodeCount(); ++node) {
        const glm::dvec3 p = glm::transpose(beam.turn) * (beam.lattice.restPosition(node) - beam.middle);
        if (std::abs(p.z) > beam.length / 6)
            continue;
        Eigen::VectorXd row(5);
        row << 1, p.x, p.y, p.z, p.y * p.z;
        const double mass = beam.lattice.massShare(node);
        normal += mass * row * row.transpose();
        right += mass * row * glm::dot(direction, at(displacement, node));
    }
    return normal.ldlt().solve(right);
}

double materialArea(const Beam& beam) { // cells: volume over length, of the fills as the lattice has them
    double volume = 0;
    for (const sim::LatticeCell& cell : beam.lattice.cells)
        volume += cell.fill / 255.0;
    return volume / beam.length;
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

BeamMeasures measureBeam(const Beam& beam) {
    BeamMeasures measures;
    const double young = 2.5; // of k/h
    const Vector pulled = solveWithEnds(beam, [](const glm::dvec3& p) { return 1e-3 * p.z; });
    const double strain = fit(beam, pulled, beam.turn[2])[3];
    const double lateral = 0.5 * (fit(beam, pulled, beam.turn[0])[1] + fit(beam, pulled, beam.turn[1])[2]);
    measures.youngShare = sectionLoad(beam, pulled).force / (materialArea(beam) * strain * young);
    measures.poisson = -lateral / strain;

    const Vector bent = solveWithEnds(beam, [](const glm::dvec3& p) { return 1e-4 * p.y * p.z; });
    const double curvature = fit(beam, bent, beam.turn[2])[4];
    const double inertia = std::pow(beam.thickness, 4) / 12;
    measures.bendingShare = sectionLoad(beam, bent).moment / (curvature * young * inertia);
    return measures;
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
    const Vector force = stiffnessMatrix(lattice, {}) * displacement;
    const std::unique_ptr<sim::Solver> solver = sim::makeReferenceSolver(setup);
    solver->setState(state);
    solver->advance(1);
    const sim::LatticeState after = solver->state();
    // Expected with the nominal tissue of 2.5 k/h = E: that is what the static figures assume.
    const double nominal = setup.timeStep * setup.timeStep * sim::Tissue().stiffnessOverMass(lattice.spacing);
    double worst = 0, largest = 0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        const glm::dvec3 expected = -at(force, node);
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
