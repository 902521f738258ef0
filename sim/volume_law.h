#pragma once
// The law of one cell's volumetric term (sim/volume_term.h has the derivation), in double or float32.

#include "shaders/shared_constants.h"

#include <glm/glm.hpp>

#include <algorithm>

namespace serosa::sim {

/// Cofactors of a matrix: the derivative of its determinant.
template <class Real>
glm::mat<3, 3, Real> cofactors(const glm::mat<3, 3, Real>& f) {
    return {glm::cross(f[1], f[2]), glm::cross(f[2], f[0]), glm::cross(f[0], f[1])};
}

template <class Real>
Real frobenius2(const glm::mat<3, 3, Real>& m) {
    return glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]);
}

/// q of the law. \param size |cof F|^2
template <class Real>
Real volumeSoftening(Real size) {
    const Real share = std::min(Real(1), Real(SRS_VOLUME_STIFFENING) / std::max(size, Real(1e-12)));
    return share * share;
}

/// dW/dF, k/h.
template <class Real>
glm::mat<3, 3, Real> volumeStress(const glm::mat<3, 3, Real>& gradient, Real bulk, Real recovery) {
    const glm::mat<3, 3, Real> cofactor = cofactors(gradient);
    const Real change = glm::dot(gradient[0], cofactor[0]) - 1,
               collapse = std::max(Real(0), Real(SRS_COLLAPSED) - 1 - change);
    const Real size = frobenius2(cofactor), q = volumeSoftening(size);
    glm::mat<3, 3, Real> stress = q * (bulk * change - recovery * collapse) * cofactor;
    if (size > Real(SRS_VOLUME_STIFFENING)) // dq/dF = -4 q / size (|F|^2 F - F F^T F)
        stress -= 2 * q / size * (bulk * change * change + recovery * collapse * collapse) *
                  (frobenius2(gradient) * gradient - gradient * glm::transpose(gradient) * gradient);
    return stress;
}

} // namespace serosa::sim
