// See app/verify/lattice_statics.h.
#include "app/verify/lattice_statics.h"

#include "sim/cell_volumes.h"
#include "sim/tissue_field.h"

#include <Eigen/IterativeLinearSolvers>

namespace serosa::app {

namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;

template <class Visit> // visit(first, second, direction from first to second, weight)
void forEachSpring(const sim::Lattice& lattice, const sim::TissueField& field, Visit visit) {
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < 18; d += 2)
            if (const std::int64_t other = lattice.neighbour(node, d); other >= 0) {
                const glm::dvec3 offset(sim::kNeighbourOffsets[std::size_t(d)]);
                visit(node, std::size_t(other), glm::normalize(offset), field.springWeight(node, d));
            }
}

void addDyad(Entries& entries, std::size_t a, std::size_t b, const glm::dvec3& u, const glm::dvec3& v) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            entries.emplace_back(int(3 * a) + i, int(3 * b) + j, u[i] * v[j]);
}

Entries stiffnessEntries(const sim::Lattice& lattice, const sim::Tissue& tissue) {
    const sim::TissueField field(lattice, tissue);
    Entries entries;
    forEachSpring(lattice, field, [&entries](std::size_t a, std::size_t b, const glm::dvec3& n, double w) {
        addDyad(entries, a, a, w * n, n);
        addDyad(entries, b, b, w * n, n);
        addDyad(entries, a, b, -w * n, n);
        addDyad(entries, b, a, -w * n, n);
    });
    for (std::size_t i = 0; i < lattice.cells.size(); ++i) {
        const sim::CellCorners corners = sim::cornersOf(lattice, lattice.cells[i]);
        const double share = field.materialOf(i).bulk * lattice.cells[i].fill / 255.0;
        for (int a = 0; a < 8 && share > 0; ++a)
            for (int b = 0; b < 8; ++b)
                addDyad(entries, corners[std::size_t(a)], corners[std::size_t(b)],
                        share / 16 * sim::cornerSign(a), sim::cornerSign(b));
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

Matrix latticeStiffness(const sim::Lattice& lattice, const sim::Tissue& tissue) {
    return matrixOf(stiffnessEntries(lattice, tissue), lattice.nodeCount());
}

std::array<TrilinearCorner, 8> trilinearCorners(const sim::Lattice& lattice, const glm::dvec3& place) {
    const glm::dvec3 q = place + glm::dvec3(lattice.centre); // grid coordinates
    const glm::ivec3 cell(glm::floor(q));
    const glm::dvec3 t = q - glm::dvec3(cell);
    std::array<TrilinearCorner, 8> corners;
    for (int c = 0; c < 8; ++c) {
        const glm::ivec3 corner = sim::cornerOffset(c);
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis)
            weight *= corner[axis] ? t[axis] : 1 - t[axis];
        corners[std::size_t(c)] = {lattice.nodeAt(cell + corner), weight};
    }
    return corners;
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

Vector LatticeProblem::solve(const sim::Tissue& tissue) const {
    Entries entries = stiffnessEntries(lattice_, tissue);
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
