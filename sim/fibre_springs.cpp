// See sim/fibre_springs.h. <n^4, m^4> = (n . m)^4 for fully symmetric tensors, so that the least squares need
// no tensors; Young's modulus along a is 1 / (a a : S : a a), S the compliance in Voigt's order.
#include "sim/fibre_springs.h"

#include "base/check.h"
#include "sim/lattice.h"

#include <Eigen/Dense>
#include <algorithm>

namespace serosa::sim {

namespace {

using Voigt = Eigen::Matrix<double, 6, 1>;
using Stiffness = Eigen::Matrix<double, 6, 6>;

double fourth(double x) {
    return x * x * x * x;
}

/// n n : strain = dyad . strain (shear strains are engineering ones).
Voigt dyad(const glm::dvec3& n) {
    Voigt v;
    v << n.x * n.x, n.y * n.y, n.z * n.z, n.y * n.z, n.z * n.x, n.x * n.y;
    return v;
}

Stiffness isotropic(double young, double poisson) {
    const double mu = young / (2 * (1 + poisson)), lambda = 2 * mu * poisson / (1 - 2 * poisson);
    Stiffness c = Stiffness::Zero();
    c.topLeftCorner<3, 3>().setConstant(lambda);
    c.diagonal() += (Voigt() << 2 * mu, 2 * mu, 2 * mu, mu, mu, mu).finished();
    return c;
}

/// Shares of n^4 nearest to a^4, none below 0: coordinate descent, each coordinate at its best and not below
/// 0. The matrix is positive definite; a thousand sweeps leave nothing above rounding.
std::array<double, 9> nearestShares(const std::array<glm::dvec3, 9>& n, const glm::dvec3& a) {
    std::array<double, 9> share{};
    for (int sweep = 0; sweep < 1000; ++sweep)
        for (std::size_t p = 0; p < 9; ++p) {
            double residual = fourth(glm::dot(n[p], a));
            for (std::size_t q = 0; q < 9; ++q)
                residual -= q == p ? 0 : fourth(glm::dot(n[p], n[q])) * share[q];
            share[p] = std::max(0.0, residual);
        }
    return share;
}

} // namespace

std::array<double, 9> fibreSprings(const glm::dvec3& direction, double young, double poisson,
                                   double fibreYoung) {
    SEROSA_CHECK(glm::length(direction) > 0 && fibreYoung >= young, "fibres have a direction, and stiffen");
    const glm::dvec3 a = glm::normalize(direction);
    std::array<glm::dvec3, 9> n;
    for (std::size_t p = 0; p < 9; ++p)
        n[p] = glm::normalize(glm::dvec3(kNeighbourOffsets[2 * p]));
    std::array<double, 9> share = nearestShares(n, a);

    const Stiffness tissue = isotropic(young, poisson);
    Stiffness fibres = Stiffness::Zero();
    for (std::size_t p = 0; p < 9; ++p)
        fibres += share[p] * dyad(n[p]) * dyad(n[p]).transpose();
    const Voigt along = dyad(a);
    const auto modulus = [&](double factor) {
        return 1 / along.dot((tissue + factor * fibres).ldlt().solve(along));
    };
    // It grows with the factor; doubled until it is enough, then halved towards it.
    double low = 0, high = fibreYoung - young;
    for (int i = 0; i < 60 && modulus(high) < fibreYoung; ++i)
        high *= 2;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (modulus(middle) < fibreYoung ? low : high) = middle;
    }
    for (std::size_t p = 0; p < 9; ++p)
        share[p] *= high / (p < 3 ? 1.0 : 2.0); // k L^2 / h^3 is the share: L^2 = h^2 or 2 h^2
    return share;
}

} // namespace serosa::sim
