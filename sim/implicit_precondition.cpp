// What preconditions the implicit step's matrix (docs/methods/implicit.md): block Jacobi on every level at
// once (Bramble, Pasciak & Xu 1990, Parallel multilevel preconditioners), exact on the last:
//   z = D_0^-1 r + P_1 (D_1^-1 P_1^T r + P_2 (... A_L^-1 P_L^T ... r)),    P trilinear interpolation.
// Coarse matrices are needed for their diagonal blocks only. A cell of level 0 is one point of quadrature:
// its springs, each along e with the matrix H, are sum e_a e_b H (six symmetric matrices), its volumetric
// term a rank-one matrix; a coarser cell has the averages of its octants. Springs with a held end are no
// resistance to a gradient: like the mass, they are summed at their free end, and handed up.
#include "sim/implicit_system-inl.h"
#include "sim/volume_law.h"

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <cmath>

namespace serosa::sim {

namespace {

// Of the largest part of a diagonal: keeps what is all but singular (coarse functions that hardly overlap the
// lattice) from being inverted to noise.
constexpr double kRegular = 1e-6;

/// Symmetric products of an offset's coordinates: xx, yy, zz, xy, yz, zx.
template <class Real>
std::array<Real, 6> productsOf(const glm::ivec3& e) {
    return {Real(e.x * e.x), Real(e.y * e.y), Real(e.z * e.z),
            Real(e.x * e.y), Real(e.y * e.z), Real(e.z * e.x)};
}

/// Those of two gradients.
template <class Real>
std::array<Real, 6> productsOf(const glm::dvec3& a, const glm::dvec3& b) {
    return {Real(a.x * b.x),
            Real(a.y * b.y),
            Real(a.z * b.z),
            Real(a.x * b.y + a.y * b.x),
            Real(a.y * b.z + a.z * b.y),
            Real(a.z * b.x + a.x * b.z)};
}

/// Of every corner of a cell at the middle of every octant: its gradient, and the products of two of them.
template <class Real>
struct OctantTable {
    glm::vec<3, Real> gradient[8][8];      // octant, corner
    std::array<Real, 6> products[8][8][8]; // octant, corner, corner

    OctantTable() {
        for (int octant = 0; octant < 8; ++octant)
            for (int a = 0; a < 8; ++a) {
                const glm::dvec3 of = octantGradient(a, octant);
                gradient[octant][a] = glm::vec<3, Real>(of);
                for (int b = 0; b < 8; ++b)
                    products[octant][a][b] = productsOf<Real>(of, octantGradient(b, octant));
            }
    }
    static const OctantTable& get() {
        static const OctantTable table;
        return table;
    }
};

/// What the quadrature of level - 1 counts in the blocks of `level`: its volume over the spacing squared.
template <class Real>
Real partVolume(std::size_t level) {
    return std::ldexp(Real(1), int(level) - 3);
}

} // namespace

template <class Real>
Symmetric3<Real> Symmetric3<Real>::inverse() const {
    const Real most = std::max({xx, yy, zz});
    if (!(most > 0))
        return {};
    const Real more = Real(kRegular) * most;
    const Real a = xx + more, b = yy + more, c = zz + more;
    // Scaled by its diagonal: a stiff direction must not drown the determinant of the others.
    const Real p = 1 / std::sqrt(a), q = 1 / std::sqrt(b), r = 1 / std::sqrt(c);
    const Real u = xy * p * q, v = yz * q * r, w = zx * r * p;
    const Real determinant = std::max(1 - u * u - v * v - w * w + 2 * u * v * w, Real(kRegular));
    const Real s = 1 / determinant;
    return {s * p * p * (1 - v * v), s * q * q * (1 - w * w), s * r * r * (1 - u * u),
            s * p * q * (v * w - u), s * q * r * (u * w - v), s * r * p * (u * v - w)};
}

template <class Real>
typename ImplicitSystem<Real>::Quadrature ImplicitSystem<Real>::quadratureOf(std::size_t index) const {
    Quadrature quadrature;
    const Cell& cell = cells_[index];
    const Real factor = tangents_.empty() ? Real(1) : Real(tangents_[index]);
    bool free = true;
    for (int c = 0; c < 8; ++c) {
        const std::size_t node = std::size_t(cell.corners[std::size_t(c)]);
        free = free && !step_.isHeld(node);
        for (std::size_t d = 0; d < SRS_NEIGHBOURS; d += 2) {
            if (!(cell.bits[std::size_t(c)] >> d & 1u) || step_.isHeld(node))
                continue;
            const Spring& spring = springs_[node * SRS_NEIGHBOURS + d];
            if (step_.isHeld(std::size_t(spring.other)))
                continue;
            // The cell's share of the spring: its matrix over its stiffness, times what the cell gives to it.
            const Real whole = glm::dot(spring.root, spring.root) + spring.across;
            const Real share = cell.spring[d / 2] * (factor + cell.damper) / std::max(whole, Real(1e-30));
            Matrix stiffness = Matrix::dyad(spring.root);
            stiffness += Matrix::identity(spring.across);
            const std::array<Real, 6> products = productsOf<Real>(kNeighbourOffsets[d]);
            for (std::size_t k = 0; k < products.size(); ++k)
                if (products[k] != 0)
                    quadrature.tensor[k] += share * products[k] * stiffness;
        }
    }
    if (free)
        quadrature.root = Real(4) * cell.root;
    return quadrature;
}

template <class Real>
void ImplicitSystem<Real>::coarsen() {
    Level& fine = levels_[0];
    forEachRun(cells_.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            fine.cells[i] = quadratureOf(i);
    });
    const bool volumetric = setup_.tissue.volumetric();
    forEachRun(nodes(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            Matrix anchored, inside;
            if (!step_.isHeld(i)) {
                anchored = Matrix::identity(mass_[i] * (1 / step_.share[i] + drag_));
                if (!supports_.empty())
                    anchored += supports_[i].stiffness;
                for (std::size_t d = 0; d < SRS_NEIGHBOURS; ++d) {
                    const Spring& spring = springs_[i * SRS_NEIGHBOURS + d];
                    if (spring.other < 0)
                        continue;
                    Matrix& sum = step_.isHeld(std::size_t(spring.other)) ? anchored : inside;
                    sum += Matrix::dyad(spring.root);
                    sum += Matrix::identity(spring.across);
                }
                for (int octant = 0; volumetric && octant < 8; ++octant) {
                    const std::int32_t at = shapes_[0].cellsAround[i][std::size_t(octant)];
                    if (at < 0)
                        continue;
                    const Cell& cell = cells_[std::size_t(at)];
                    const Matrix block = Matrix::dyad(cell.root * signOf<Real>(7 - octant));
                    inside += block;
                    // With held corners: its rank-one matrix is at most as many times its diagonal blocks
                    // as it has free corners.
                    int free = 0;
                    for (const std::int32_t corner : cell.corners)
                        free += step_.isHeld(std::size_t(corner)) ? 0 : 1;
                    if (free < 8)
                        anchored += Real(free) * block;
                }
            }
            fine.anchored[i] = anchored;
            inside += anchored;
            fine.inverse[i] = inside.inverse();
        }
    });
    for (std::size_t l = 1; l < levels_.size(); ++l) {
        const ImplicitLevel& shape = shapes_[l];
        const Level& below = levels_[l - 1];
        Level& level = levels_[l];
        forEachRun(shape.cells.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                Quadrature mean;
                Real square = 0;
                for (const std::int32_t part : shape.finerCells[i]) {
                    if (part < 0)
                        continue;
                    const Quadrature& of = below.cells[std::size_t(part)];
                    for (std::size_t k = 0; k < mean.tensor.size(); ++k)
                        mean.tensor[k] += Real(0.125) * of.tensor[k];
                    mean.root += of.root; // for its direction
                    square += Real(0.125) * frobenius2(of.root);
                }
                if (square > 0)
                    mean.root *= std::sqrt(square / std::max(frobenius2(mean.root), Real(1e-6) * square));
                level.cells[i] = mean;
            }
        });
        const OctantTable<Real>& table = OctantTable<Real>::get();
        const Real volume = partVolume<Real>(l);
        forEachRun(shape.nodes.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                Matrix anchored, inside;
                for (std::size_t place = 0; place < 27; ++place)
                    if (const std::int32_t node = shape.finer[i][place]; node >= 0)
                        anchored += finerWeights_[place] * below.anchored[std::size_t(node)];
                level.anchored[i] = anchored;
                for (int octant = 0; octant < 8; ++octant)
                    if (const std::int32_t cell = shape.cellsAround[i][std::size_t(octant)]; cell >= 0)
                        forEachPart(l, std::size_t(cell), [&](const Quadrature& part, int at) {
                            const std::array<Real, 6>& products = table.products[at][7 - octant][7 - octant];
                            for (std::size_t k = 0; k < products.size(); ++k)
                                inside += products[k] * part.tensor[k];
                            if (volumetric)
                                inside += Matrix::dyad(part.root * table.gradient[at][7 - octant]);
                        });
                anchored += volume * inside;
                level.inverse[i] = anchored.inverse();
            }
        });
    }
}

template <class Real>
template <class Add>
void ImplicitSystem<Real>::forEachPart(std::size_t level, std::size_t cell, const Add& add) const {
    for (int octant = 0; octant < 8; ++octant)
        if (const std::int32_t part = shapes_[level].finerCells[cell][std::size_t(octant)]; part >= 0)
            add(levels_[level - 1].cells[std::size_t(part)], octant);
}

template <class Real>
void ImplicitSystem<Real>::invertCoarsest() {
    const std::size_t last = levels_.size() - 1, size = shapes_[last].nodes.size();
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(Eigen::Index(3 * size), Eigen::Index(3 * size));
    const auto add = [&](std::size_t a, std::size_t b, const Matrix& m) {
        const Eigen::Index row = Eigen::Index(3 * a), column = Eigen::Index(3 * b);
        const double entries[3][3] = {{double(m.xx), double(m.xy), double(m.zx)},
                                      {double(m.xy), double(m.yy), double(m.yz)},
                                      {double(m.zx), double(m.yz), double(m.zz)}};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                dense(row + i, column + j) += entries[i][j];
    };
    for (std::size_t i = 0; i < size; ++i)
        add(i, i, levels_[last].anchored[i]);
    const double volume = partVolume<double>(last);
    const OctantTable<Real>& table = OctantTable<Real>::get();
    for (std::size_t cell = 0; cell < shapes_[last].cells.size(); ++cell)
        forEachPart(last, cell, [&](const Quadrature& part, int octant) {
            for (int a = 0; a < 8; ++a)
                for (int b = 0; b < 8; ++b) {
                    const std::size_t rowNode = std::size_t(shapes_[last].cells[cell][std::size_t(a)]),
                                      columnNode = std::size_t(shapes_[last].cells[cell][std::size_t(b)]);
                    const std::array<Real, 6>& products = table.products[octant][a][b];
                    Matrix block;
                    for (std::size_t k = 0; k < products.size(); ++k)
                        block += Real(volume) * products[k] * part.tensor[k];
                    add(rowNode, columnNode, block);
                    const glm::dvec3 pa(part.root * table.gradient[octant][a]),
                        pb(part.root * table.gradient[octant][b]);
                    for (int i = 0; i < 3; ++i)
                        for (int j = 0; j < 3; ++j)
                            dense(Eigen::Index(3 * rowNode) + i, Eigen::Index(3 * columnNode) + j) +=
                                volume * pa[i] * pb[j];
                }
        });
    dense.diagonal().array() += std::max(kRegular * dense.diagonal().maxCoeff(), 1e-30);
    const Eigen::MatrixXd inverse =
        Eigen::LLT<Eigen::MatrixXd>(dense).solve(Eigen::MatrixXd::Identity(dense.rows(), dense.cols()));
    coarsest_.resize(std::size_t(dense.size()));
    for (Eigen::Index i = 0; i < dense.rows(); ++i)
        for (Eigen::Index j = 0; j < dense.cols(); ++j)
            coarsest_[std::size_t(i * dense.cols() + j)] = Real(0.5 * (inverse(i, j) + inverse(j, i)));
}

template <class Real>
void ImplicitSystem<Real>::precondition(const Vectors& r, Vectors& result) {
    const std::size_t last = levels_.size() - 1;
    const auto residualOf = [&](std::size_t level) -> const Vectors& {
        return level == 0 ? r : levels_[level].residual;
    };
    for (std::size_t l = 1; l <= last; ++l)
        forEachRun(shapes_[l].nodes.size(), [&](std::size_t first, std::size_t end) {
            const Vectors& below = residualOf(l - 1);
            for (std::size_t i = first; i < end; ++i) {
                Vector sum(0);
                for (std::size_t place = 0; place < 27; ++place)
                    if (const std::int32_t node = shapes_[l].finer[i][place]; node >= 0)
                        sum += finerWeights_[place] * below[std::size_t(node)];
                levels_[l].residual[i] = sum;
            }
        });
    Level& coarsest = levels_[last];
    const std::size_t size = coarsest.residual.size();
    for (std::size_t i = 0; i < size; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            const Real* row = coarsest_.data() + (3 * i + std::size_t(axis)) * 3 * size;
            Real sum = 0;
            for (std::size_t j = 0; j < size; ++j, row += 3)
                sum += row[0] * coarsest.residual[j].x + row[1] * coarsest.residual[j].y +
                       row[2] * coarsest.residual[j].z;
            coarsest.correction[i][axis] = sum;
        }
    for (std::size_t l = last; l-- > 0;)
        forEachRun(shapes_[l].nodes.size(), [&](std::size_t first, std::size_t end) {
            Vectors& to = l == 0 ? result : levels_[l].correction;
            const Vectors& from = levels_[l + 1].correction;
            for (std::size_t i = first; i < end; ++i) {
                if (l == 0 && step_.isHeld(i)) {
                    to[i] = Vector(0);
                    continue;
                }
                Vector sum(0);
                int count = 0;
                for (const std::int32_t node : shapes_[l].coarser[i]) {
                    if (node < 0)
                        break;
                    sum += from[std::size_t(node)];
                    ++count;
                }
                to[i] = levels_[l].inverse[i] * residualOf(l)[i] + sum / Real(count);
            }
        });
}

template struct Symmetric3<double>;
template struct Symmetric3<float>;
template class ImplicitSystem<double>;
template class ImplicitSystem<float>;

} // namespace serosa::sim
