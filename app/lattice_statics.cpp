// See app/lattice_statics.h.
#include "app/lattice_statics.h"

#include <Eigen/IterativeLinearSolvers>

namespace serosa::app {

namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;

template <class Visit> // visit(first, second, direction from first to second, weight)
void forEachSpring(const sim::Lattice& lattice, Visit visit) {
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < 18; d += 2)
            if (const std::int64_t other = lattice.neighbour(node, d); other >= 0) {
                const glm::dvec3 offset(sim::kNeighbourOffsets[std::size_t(d)]);
                visit(node, std::size_t(other), glm::normalize(offset), lattice.springWeight(node, d));
            }
}

void addDyad(Entries& entries, std::size_t a, std::size_t b, const glm::dvec3& u, const glm::dvec3& v) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            entries.emplace_back(int(3 * a) + i, int(3 * b) + j, u[i] * v[j]);
}

Entries stiffnessEntries(const sim::Lattice& lattice, double bulk) {
    Entries entries;
    forEachSpring(lattice, [&entries](std::size_t a, std::size_t b, const glm::dvec3& n, double w) {
        addDyad(entries, a, a, w * n, n);
        addDyad(entries, b, b, w * n, n);
        addDyad(entries, a, b, -w * n, n);
        addDyad(entries, b, a, -w * n, n);
    });
    for (const sim::LatticeCell& cell : lattice.cells) {
        if (bulk <= 0)
            break;
        for (int a = 0; a < 8; ++a)
            for (int b = 0; b < 8; ++b) {
                const auto corner = [](int c) { return glm::ivec3(c & 1, (c >> 1) & 1, c >> 2); };
                const auto node = [&](int c) { return std::size_t(lattice.nodeAt(cell.grid + corner(c))); };
                const auto gradient = [&](int c) { return 0.25 * (2.0 * glm::dvec3(corner(c)) - 1.0); };
                addDyad(entries, node(a), node(b), bulk * cell.fill / 255.0 * gradient(a), gradient(b));
            }
    }
    return entries;
}

Matrix matrixOf(const Entries& entries, std::size_t nodes) {
    const auto size = Eigen::Index(3 * nodes);
    Matrix matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

} // namespace

glm::dvec3 nodeVector(const Vector& v, std::size_t node) {
    return {v[Eigen::Index(3 * node)], v[Eigen::Index(3 * node + 1)], v[Eigen::Index(3 * node + 2)]};
}

Matrix latticeStiffness(const sim::Lattice& lattice, double bulk) {
    return matrixOf(stiffnessEntries(lattice, bulk), lattice.nodeCount());
}

LatticeProblem::LatticeProblem(const sim::Lattice& lattice)
    : lattice_(lattice), load_(Vector::Zero(Eigen::Index(3 * lattice.nodeCount()))),
      held_(lattice.nodeCount(), false) {
    // A light hold against rigid drift: far below any force that is measured.
    for (int i = 0; i < int(3 * lattice.nodeCount()); ++i)
        extra_.emplace_back(i, i, 1e-10);
}

void LatticeProblem::push(std::size_t node, const glm::dvec3& force) {
    for (int i = 0; i < 3; ++i)
        load_[Eigen::Index(3 * node) + i] += force[i];
}

void LatticeProblem::hold(std::size_t node) {
    held_[node] = true;
}

void LatticeProblem::prescribe(std::size_t node, const glm::dvec3& direction, double displacement) {
    const double grip = 1e3; // of k
    addDyad(extra_, node, node, grip * direction, direction);
    push(node, grip * displacement * direction);
}

Vector LatticeProblem::solve(double bulk) const {
    Entries entries = stiffnessEntries(lattice_, bulk);
    entries.insert(entries.end(), extra_.begin(), extra_.end());
    Vector load = load_;
    // Held nodes drop out: neither their rows nor their columns stay, but for a one on the diagonal.
    const auto held = [this](int unknown) { return held_[std::size_t(unknown) / 3]; };
    std::erase_if(entries, [&](const auto& entry) { return held(entry.row()) || held(entry.col()); });
    for (int i = 0; i < int(load.size()); ++i)
        if (held(i)) {
            entries.emplace_back(i, i, 1);
            load[i] = 0;
        }
    const Matrix matrix = matrixOf(entries, lattice_.nodeCount());
    Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> solver;
    solver.setTolerance(1e-8);
    solver.setMaxIterations(20000);
    solver.compute(matrix);
    return solver.solve(load);
}

} // namespace serosa::app
