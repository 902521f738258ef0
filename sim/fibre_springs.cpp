// See sim/fibre_springs.h. <n^4, m^4> = (n . m)^4 for fully symmetric tensors, so that the normal equations
// need no tensors.
#include "sim/fibre_springs.h"

#include "base/check.h"
#include "sim/lattice.h"

#include <algorithm>

namespace serosa::sim {

namespace {

double fourth(double x) {
    return x * x * x * x;
}

} // namespace

std::array<double, 9> fibreSprings(const glm::dvec3& direction) {
    SEROSA_CHECK(glm::length(direction) > 0, "fibres have a direction");
    const glm::dvec3 a = glm::normalize(direction);
    std::array<glm::dvec3, 9> n;
    for (std::size_t p = 0; p < 9; ++p)
        n[p] = glm::normalize(glm::dvec3(kNeighbourOffsets[2 * p]));

    // Least squares with no share below 0: coordinate descent, each coordinate at its best and not below 0.
    // The matrix is positive definite; a thousand sweeps leave nothing above rounding.
    std::array<double, 9> share{};
    for (int sweep = 0; sweep < 1000; ++sweep)
        for (std::size_t p = 0; p < 9; ++p) {
            double residual = fourth(glm::dot(n[p], a));
            for (std::size_t q = 0; q < 9; ++q)
                residual -= q == p ? 0 : fourth(glm::dot(n[p], n[q])) * share[q];
            share[p] = std::max(0.0, residual);
        }
    double along = 0;
    for (std::size_t p = 0; p < 9; ++p)
        along += share[p] * fourth(glm::dot(n[p], a));
    for (std::size_t p = 0; p < 9; ++p)
        share[p] /= along * (p < 3 ? 1.0 : 2.0); // k L^2 / h^3 is the share: L^2 = h^2 or 2 h^2
    return share;
}

} // namespace serosa::sim
