#pragma once
// The equations of one implicit step on a lattice, and what solves them; docs/methods/implicit.md derives
// both. In double for the reference, in float32 on all cores for the `cpu` solver; shaders/implicit_* are the
// GPU's twin.
//
// In lattice units and masses as shares of a full node, the increments u' of a step minimize
//   Phi(u') = sum_i m_i (|u'_i - v_i|^2 / (2 c_i) + drag dt/2 |u'_i|^2 - g . u'_i)
//           + a (E(x + u') + sum_s D_s/2 (|d'_s| - |d_s|)^2),            a = dt^2 k/(rho h^3),  g = dt^2 g/h,
// with E the energy of springs and cells in k h^2, d_s the springs before and d'_s after the step, D_s
// damping time over dt times the spring's weight; v = 3/2 u - 1/2 (the u before), c = 1/2 (Houbolt 1950:
// second order, and what the step cannot resolve dies out), or v = u, c = 1 (backward Euler) for a node that
// has no increment before u.
//
// Where Phi is minimal, every node has m ((u' - v)/c + drag dt u') = a F(x + u') + m g. Nodes that are held
// take no part; their u' is given.

#include "sim/implicit_levels.h"
#include "sim/solver.h"
#include "sim/stiffening.h"
#include "sim/tissue_field.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace serosa::sim {

/// A symmetric 3x3 matrix: xx, yy, zz, xy, yz, zx.
template <class Real>
struct Symmetric3 {
    Real xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, zx = 0;

    Symmetric3& operator+=(const Symmetric3& o) {
        xx += o.xx, yy += o.yy, zz += o.zz, xy += o.xy, yz += o.yz, zx += o.zx;
        return *this;
    }
    friend Symmetric3 operator+(Symmetric3 a, const Symmetric3& b) { return a += b; }
    friend Symmetric3 operator*(Real s, const Symmetric3& m) {
        return {s * m.xx, s * m.yy, s * m.zz, s * m.xy, s * m.yz, s * m.zx};
    }
    friend glm::vec<3, Real> operator*(const Symmetric3& m, const glm::vec<3, Real>& v) {
        return {m.xx * v.x + m.xy * v.y + m.zx * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
                m.zx * v.x + m.yz * v.y + m.zz * v.z};
    }
    static Symmetric3 identity(Real s) { return {s, s, s, 0, 0, 0}; }
    static Symmetric3 dyad(const glm::vec<3, Real>& v) {
        return {v.x * v.x, v.y * v.y, v.z * v.z, v.x * v.y, v.y * v.z, v.z * v.x};
    }
    /// Of a positive matrix; what is nearly singular is inverted as if it were a little less so.
    Symmetric3 inverse() const;
};

/// \tparam Real double or float
template <class Real>
class ImplicitSystem {
public:
    using Vector = glm::vec<3, Real>;
    using Vectors = std::vector<Vector>; // one a node
    using Matrix = Symmetric3<Real>;

    /// \param parallel on the threads of the task arena it is called in; the same bytes with any number
    ImplicitSystem(const SolverSetup& setup, bool parallel);

    /// By what cuts left of the connections, 18 bits a node.
    void connect(const std::vector<std::uint32_t>& connections);

    /// What one step starts from. Lattice units.
    struct Step {
        Vectors positions;       // x
        Vectors expected;        // v
        Vectors guess;           // u' where the search begins
        std::vector<Real> share; // c; 0: the node is held
        Vector gravity{0};       // dt^2 g/h
        bool isHeld(std::size_t node) const { return share[node] == 0; }
    };
    void begin(Step step);
    const Step& step() const { return step_; }

    /// What else acts on a node near the increments that it was asked at: Phi grows there by
    /// -force . p + p . stiffness p / 2 for a change p of them. \see sim/implicit_contact.h
    struct Support {
        Vector force{0};
        Matrix stiffness; // positive
    };
    /// One a node, or none at all. begin() takes them away.
    void support(std::vector<Support> supports) { supports_ = std::move(supports); }
    const std::vector<Support>& supports() const { return supports_; }

    /// Phi's gradient with respect to u', a force; at held nodes what holds them has to give.
    void gradient(const Vectors& increments, Vectors& result);
    /// Takes the matrix H of Phi's second derivatives at u', made positive: springs under pressure do not
    /// pull apart sideways, cells keep cof F (x) cof F. Also all that preconditions it. Follows gradient(),
    /// which it takes cells' factors from.
    void linearize(const Vectors& increments);
    /// The change of Phi from u' to u' + share p for each of the shares.
    std::array<double, 4> changes(const Vectors& increments, const Vectors& direction,
                                  const std::array<double, 4>& shares);
    /// H p, zero at held nodes.
    void apply(const Vectors& p, Vectors& result);
    /// An approximate inverse of H, symmetric and positive; zero at held nodes.
    void precondition(const Vectors& r, Vectors& result);
    /// The same sum whatever the number of threads.
    double dot(const Vectors& a, const Vectors& b) const;

    std::size_t nodes() const { return mass_.size(); }
    double mass(std::size_t node) const { return double(mass_[node]); }
    double totalMass() const { return totalMass_; }
    /// Calls work(first, last) for runs of indices, in any order.
    template <class Work>
    void forEachRun(std::size_t count, const Work& work) const;

private:
    struct Spring { // one a node and direction
        std::int32_t other = -1;
        Real weight = 0, damper = 0; // times a
        Vector root{0};              // n times the root of stiffness along minus across
        Real across = 0;
    };
    struct Cell {
        std::array<std::int32_t, 8> corners;
        Real bulk = 0, recovery = 0;         // a f b, a f r; 0 where a cut runs through the cell
        std::array<Real, 9> spring{};        // by direction pair: what it gives to a spring, times a
        Real damper = 0;                     // damping time over dt
        std::array<std::uint32_t, 8> bits{}; // connections left inside the cell at each corner
        glm::mat<3, 3, Real> root{0};        // cof F / 4 times the root of its stiffness
        glm::mat<3, 3, Real> load{0};        // a f dW/dF / 4
        Real pull = 0;                       // root : gradient of what the matrix is applied to
    };
    struct Quadrature { // of one cell of any level, averages over its volume
        std::array<Matrix, 6> tensor{};
        glm::mat<3, 3, Real> root{0}; // cof F times the root of its stiffness
    };
    struct Level {
        std::vector<Quadrature> cells;
        std::vector<Matrix> anchored; // mass and held neighbours' springs, one a node
        std::vector<Matrix> inverse;  // of the diagonal block
        Vectors residual, correction;
    };

    void place(const Vectors& increments);
    void findFactors();
    void linearizeSprings();
    void linearizeCells();
    void coarsen();
    void invertCoarsest();
    Quadrature quadratureOf(std::size_t cell) const;
    template <class Add>
    void forEachPart(std::size_t level, std::size_t cell, const Add& add) const;
    template <class Add> // add(index, four sums)
    std::array<double, 4> sumRuns(std::size_t count, const Add& add) const;

    SolverSetup setup_;
    TissueField field_;
    std::vector<ImplicitLevel> shapes_;
    std::array<Real, 27> finerWeights_{};
    bool parallel_;
    Real drag_ = 0;    // air drag dt
    double scale_ = 0; // a
    std::vector<Real> mass_;
    double totalMass_ = 0;
    std::vector<Spring> springs_;
    std::vector<Cell> cells_;
    Stiffening stiffening_;
    std::vector<double> factors_, tangents_; // one a cell, where cells stiffen
    Step step_;
    std::vector<Support> supports_;
    std::vector<Level> levels_;
    std::vector<Real> coarsest_; // inverse of the dense matrix of the last level, row after row
    Vectors places_;             // x + u'
};

} // namespace serosa::sim
