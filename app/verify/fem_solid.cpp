// See app/verify/fem_solid.h. In barycentric coordinates l_i: corners have the shape functions l_i (2 l_i -
// 1), edge middles 4 l_i l_j; gradients of l_i are constant in an element.
#include "app/verify/fem_solid.h"

#include "app/verify/fem_preconditioner.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace serosa::app {

namespace {

using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

constexpr int kMostIterations = 3000;

/// For each node the nodes that it shares an element with, itself too, in rising order.
std::vector<std::vector<std::uint32_t>> neighboursOf(const TetMesh& mesh) {
    std::vector<std::vector<std::uint32_t>> neighbours(mesh.nodes.size());
    for (const std::array<std::uint32_t, 10>& element : mesh.elements)
        for (const std::uint32_t a : element)
            neighbours[a].insert(neighbours[a].end(), element.begin(), element.end());
    for (std::vector<std::uint32_t>& list : neighbours) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        list.shrink_to_fit();
    }
    return neighbours;
}

/// All entries that may be other than zero, as zeros.
FemMatrix emptyMatrix(const TetMesh& mesh, const std::vector<std::vector<std::uint32_t>>& neighbours) {
    const auto size = Index(3 * mesh.nodes.size());
    FemMatrix matrix(size, size);
    std::vector<int> perRow(std::size_t(size), 3); // a node of no element: its own block
    for (std::size_t node = 0; node < neighbours.size(); ++node)
        for (int i = 0; i < 3; ++i)
            perRow[3 * node + std::size_t(i)] = std::max(3, int(3 * neighbours[node].size()));
    matrix.reserve(perRow);
    for (std::size_t node = 0; node < neighbours.size(); ++node)
        for (int i = 0; i < 3; ++i)
            for (const std::uint32_t other : neighbours[node])
                for (int j = 0; j < 3; ++j)
                    matrix.insert(Index(3 * node) + i, Index(3 * other) + j) = 0;
    matrix.makeCompressed();
    return matrix;
}

/// Ends when the step that the preconditioner would take is small in the energy norm: in the plain norm of
/// the residual a few flat tetrahedra, very stiff and long settled, drown the rest.
Result<Vector> conjugateGradients(const FemMatrix& matrix, const FemPreconditioner& preconditioner,
                                  const Vector& right, double tolerance) {
    Vector x = Vector::Zero(right.size()), residual = right, step = preconditioner.solve(residual),
           direction = step;
    double size = residual.dot(step);
    const double enough = tolerance * tolerance * size;
    for (int iteration = 0; size > enough; ++iteration) {
        const Vector turned = matrix * direction;
        const double curvature = direction.dot(turned);
        if (iteration == kMostIterations || !(curvature > 0))
            return Error{"the finite-element solution does not converge: is a part of the solid not held?"};
        x += size / curvature * direction;
        residual -= size / curvature * turned;
        step = preconditioner.solve(residual);
        const double before = size;
        size = residual.dot(step);
        direction = step + size / before * direction;
    }
    return x;
}

} // namespace

std::array<TetPoint, 4> gaussPoints(const TetMesh& mesh, std::size_t element) {
    const std::array<std::uint32_t, 10>& e = mesh.elements[element];
    const double volume = mesh.volume(element);
    std::array<glm::dvec3, 4> slopes; // of l_i: the opposite face's inward normal over three times the volume
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec3 a = mesh.nodes[e[(i + 1) % 4]], b = mesh.nodes[e[(i + 2) % 4]],
                         c = mesh.nodes[e[(i + 3) % 4]], p = mesh.nodes[e[i]];
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        slopes[i] = normal / glm::dot(normal, p - a);
    }
    const double root = std::sqrt(5.0), near = (5 + 3 * root) / 20, far = (5 - root) / 20;
    std::array<TetPoint, 4> points;
    for (std::size_t g = 0; g < 4; ++g) {
        std::array<double, 4> l{far, far, far, far};
        l[g] = near;
        points[g].volume = volume / 4;
        for (std::size_t i = 0; i < 4; ++i) {
            points[g].shapes[i] = l[i] * (2 * l[i] - 1);
            points[g].gradients[i] = (4 * l[i] - 1) * slopes[i];
        }
        for (std::size_t edge = 0; edge < kTetEdges.size(); ++edge) {
            const auto a = std::size_t(kTetEdges[edge][0]), b = std::size_t(kTetEdges[edge][1]);
            points[g].shapes[4 + edge] = 4 * l[a] * l[b];
            points[g].gradients[4 + edge] = 4.0 * (l[a] * slopes[b] + l[b] * slopes[a]);
        }
    }
    return points;
}

FemMatrix femStiffness(const TetMesh& mesh, const ElasticSolid& solid) {
    const std::vector<std::vector<std::uint32_t>> neighbours = neighboursOf(mesh);
    FemMatrix matrix = emptyMatrix(mesh, neighbours);
    const double lambda = solid.lambda(), mu = solid.mu();
    double* values = matrix.valuePtr();
    const int* rows = matrix.outerIndexPtr();
    for (std::size_t element = 0; element < mesh.elements.size(); ++element) {
        const std::array<TetPoint, 4> points = gaussPoints(mesh, element);
        for (std::size_t a = 0; a < 10; ++a)
            for (std::size_t b = 0; b < 10; ++b) {
                const std::uint32_t row = mesh.elements[element][a], column = mesh.elements[element][b];
                glm::dmat3 block(0); // block[j][i]: row i, column j
                for (const TetPoint& point : points) {
                    const glm::dvec3 &u = point.gradients[a], &v = point.gradients[b];
                    block += point.volume * (lambda * glm::outerProduct(u, v) + mu * glm::outerProduct(v, u) +
                                             glm::dmat3(mu * glm::dot(u, v)));
                }
                const std::vector<std::uint32_t>& list = neighbours[row];
                const auto place = int(std::lower_bound(list.begin(), list.end(), column) - list.begin());
                for (int i = 0; i < 3; ++i)
                    for (int j = 0; j < 3; ++j)
                        values[rows[3 * row + std::uint32_t(i)] + 3 * place + j] += block[j][i];
            }
    }
    return matrix;
}

Vector bodyForces(const TetMesh& mesh, const glm::dvec3& perVolume) {
    Vector forces = Vector::Zero(Index(3 * mesh.nodes.size()));
    for (std::size_t element = 0; element < mesh.elements.size(); ++element)
        for (const TetPoint& point : gaussPoints(mesh, element))
            for (std::size_t a = 0; a < 10; ++a)
                for (int i = 0; i < 3; ++i)
                    forces[Index(3 * mesh.elements[element][a]) + i] +=
                        point.volume * point.shapes[a] * perVolume[i];
    return forces;
}

Result<Vector> solveFem(const TetMesh& mesh, FemMatrix stiffness, const Vector& forces,
                        const std::vector<bool>& held, const Vector& given, double tolerance) {
    Vector right = forces;
    // Held unknowns go to the right-hand side; their own equations say what is given.
    const auto isHeld = [&held](Index unknown) { return held[std::size_t(unknown) / 3]; };
    const auto valueOf = [&given](Index unknown) { return given.size() > 0 ? given[unknown] : 0.0; };
    for (Index row = 0; row < stiffness.rows(); ++row)
        for (FemMatrix::InnerIterator entry(stiffness, row); entry; ++entry) {
            if (!isHeld(row) && !isHeld(entry.col()))
                continue;
            if (!isHeld(row))
                right[row] -= entry.value() * valueOf(entry.col());
            entry.valueRef() = 0;
        }
    const double size = stiffness.diagonal().maxCoeff();
    for (Index row = 0; row < stiffness.rows(); ++row)
        if (isHeld(row) || stiffness.coeff(row, row) == 0) { // held, or a node of no element
            stiffness.coeffRef(row, row) = size;
            right[row] = size * valueOf(row);
        }
    return conjugateGradients(stiffness, FemPreconditioner(stiffness, mesh.nodes, held), right, tolerance);
}

glm::dvec3 displacementAt(const TetMesh& mesh, std::size_t element, const TetPoint& point,
                          const Vector& displacements) {
    glm::dvec3 sum(0);
    for (std::size_t a = 0; a < 10; ++a)
        for (int i = 0; i < 3; ++i)
            sum[i] += point.shapes[a] * displacements[Index(3 * mesh.elements[element][a]) + i];
    return sum;
}

double largestStrain(const TetMesh& mesh, const Vector& displacements) {
    double largest = 0;
    for (std::size_t element = 0; element < mesh.elements.size(); ++element)
        for (const TetPoint& point : gaussPoints(mesh, element)) {
            Eigen::Matrix3d slope = Eigen::Matrix3d::Zero();
            for (std::size_t a = 0; a < 10; ++a)
                for (int i = 0; i < 3; ++i)
                    for (int j = 0; j < 3; ++j)
                        slope(i, j) +=
                            displacements[Index(3 * mesh.elements[element][a]) + i] * point.gradients[a][j];
            const Eigen::Matrix3d strain = 0.5 * (slope + slope.transpose());
            const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(strain, Eigen::EigenvaluesOnly);
            largest = std::max(largest, principal.eigenvalues().cwiseAbs().maxCoeff());
        }
    return largest;
}

} // namespace serosa::app
