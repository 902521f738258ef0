// See sim/implicit_system.h: Phi, its gradient and its matrix. What preconditions them is in
// sim/implicit_precondition.cpp.
#include "sim/implicit_system-inl.h"
#include "sim/pieces.h"
#include "sim/volume_law.h"

#include <cmath>

namespace serosa::sim {

namespace {

template <class Real>
using Matrix3 = glm::mat<3, 3, Real>;

template <class Real>
Matrix3<Real> gradientOf(const std::array<std::int32_t, 8>& corners,
                         const std::vector<glm::vec<3, Real>>& x) {
    const auto at = [&](int corner) -> const glm::vec<3, Real>& {
        return x[std::size_t(corners[std::size_t(corner)])];
    };
    // Differences first: they are exact in float32, and the rest state is exactly the identity.
    const Real quarter(0.25);
    return {quarter * ((at(1) - at(0)) + (at(3) - at(2)) + (at(5) - at(4)) + (at(7) - at(6))),
            quarter * ((at(2) - at(0)) + (at(3) - at(1)) + (at(6) - at(4)) + (at(7) - at(5))),
            quarter * ((at(4) - at(0)) + (at(5) - at(1)) + (at(6) - at(2)) + (at(7) - at(3)))};
}

template <class Real>
Real contract(const Matrix3<Real>& a, const Matrix3<Real>& b) {
    return glm::dot(a[0], b[0]) + glm::dot(a[1], b[1]) + glm::dot(a[2], b[2]);
}

/// W at F + s G minus W at F, without the difference of two large numbers.
template <class Real>
double volumeChange(const Matrix3<Real>& f, const Matrix3<Real>& g, double share, Real bulk, Real recovery) {
    const Matrix3<Real> moved = f + Real(share) * g;
    const Matrix3<Real> before = cofactors(f), after = cofactors(moved), of = cofactors(g);
    const double volume = double(glm::dot(f[0], before[0])),
                 rise = share * (double(contract(before, g)) +
                                 share * (double(contract(of, f)) + share * double(glm::dot(g[0], of[0]))));
    const double q = double(volumeSoftening(frobenius2(before))),
                 movedQ = double(volumeSoftening(frobenius2(after)));
    const double collapse = std::max(0.0, SRS_COLLAPSED - volume),
                 movedCollapse = std::max(0.0, SRS_COLLAPSED - (volume + rise));
    const double part = 0.5 *
                        (double(bulk) * (volume - 1) * (volume - 1) + double(recovery) * collapse * collapse),
                 partRise =
                     0.5 * (double(bulk) * rise * (rise + 2 * (volume - 1)) +
                            double(recovery) * (movedCollapse - collapse) * (movedCollapse + collapse));
    return movedQ * partRise + (movedQ - q) * part;
}

} // namespace

template <class Real>
ImplicitSystem<Real>::ImplicitSystem(const SolverSetup& setup, bool parallel)
    : setup_(setup), field_(*setup.lattice, setup.tissue), shapes_(implicitLevels(*setup.lattice)),
      parallel_(parallel) {
    const Lattice& lattice = *setup.lattice;
    const double dt = setup.timeStep;
    scale_ = dt * dt * setup.tissue.stiffnessOverMass(lattice.spacing);
    drag_ = Real(setup.tissue.airDrag * dt);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        mass_.push_back(Real(field_.massShare(node)));
        totalMass_ += double(mass_.back());
    }
    for (std::size_t place = 0; place < finerWeights_.size(); ++place)
        finerWeights_[place] = Real(finerWeight(place));
    springs_.resize(lattice.nodeCount() * SRS_NEIGHBOURS);
    cells_.resize(lattice.cells.size());
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const MaterialShares& material = field_.materialOf(i);
        cells_[i].corners = shapes_[0].cells[i];
        for (std::size_t pair = 0; pair < material.spring.size(); ++pair)
            cells_[i].spring[pair] = Real(scale_ * lattice.cells[i].fill / 255.0 * (pair < 3 ? 0.25 : 0.5) *
                                          material.spring[pair]);
        cells_[i].damper = Real(material.dampingTime / dt);
    }
    levels_.resize(shapes_.size());
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        levels_[l].cells.resize(shapes_[l].cells.size());
        levels_[l].anchored.resize(shapes_[l].nodes.size());
        levels_[l].inverse.resize(shapes_[l].nodes.size());
        levels_[l].residual.resize(shapes_[l].nodes.size());
        levels_[l].correction.resize(shapes_[l].nodes.size());
    }
    places_.resize(mass_.size());
    connect(lattice.connections);
}

template <class Real>
void ImplicitSystem<Real>::connect(const std::vector<std::uint32_t>& connections) {
    const Lattice& lattice = *setup_.lattice;
    for (std::size_t node = 0; node < connections.size(); ++node)
        for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
            Spring& spring = springs_[node * SRS_NEIGHBOURS + std::size_t(d)];
            const bool connected = connections[node] >> d & 1u;
            spring.other = connected ? std::int32_t(lattice.neighbour(node, d)) : -1;
            spring.weight = connected ? Real(scale_ * field_.springWeight(node, d)) : Real(0);
            spring.damper =
                connected ? Real(scale_ * field_.dampingWeight(node, d) / setup_.timeStep) : Real(0);
        }
    const std::vector<bool> whole = wholeCells(lattice, connections);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        Cell& cell = cells_[i];
        const double share = whole[i] ? scale_ * lattice.cells[i].fill / 255.0 : 0;
        cell.bulk = Real(share * field_.materialOf(i).bulk);
        cell.recovery = Real(share * field_.materialOf(i).recovery);
        for (int c = 0; c < 8; ++c)
            cell.bits[std::size_t(c)] =
                connections[std::size_t(cell.corners[std::size_t(c)])] & directionsInCell(c);
    }
    stiffening_ = Stiffening(lattice, setup_.tissue, connections);
}

template <class Real>
void ImplicitSystem<Real>::begin(Step step) {
    SEROSA_CHECK(step.positions.size() == nodes() && step.expected.size() == nodes() &&
                     step.share.size() == nodes(),
                 "a value of each kind for every node");
    step_ = std::move(step);
    supports_.clear();
}

template <class Real>
void ImplicitSystem<Real>::place(const Vectors& increments) {
    forEachRun(nodes(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            places_[i] = step_.positions[i] + increments[i];
    });
}

template <class Real>
void ImplicitSystem<Real>::findFactors() {
    if (stiffening_.empty())
        return;
    const std::vector<glm::dvec3> exact(places_.begin(), places_.end());
    factors_ = stiffening_.factors(exact);
    tangents_ = stiffening_.tangents(exact);
    forEachRun(springs_.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t slot = first; slot < last; ++slot)
            if (springs_[slot].other >= 0)
                springs_[slot].weight =
                    Real(scale_ *
                         field_.springWeight(slot / SRS_NEIGHBOURS, int(slot % SRS_NEIGHBOURS), factors_));
    });
}

template <class Real>
void ImplicitSystem<Real>::gradient(const Vectors& increments, Vectors& result) {
    place(increments);
    findFactors();
    const bool volumetric = setup_.tissue.volumetric();
    if (volumetric)
        forEachRun(cells_.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                Cell& cell = cells_[i];
                const Real bulk = factors_.empty() ? cell.bulk : cell.bulk * Real(factors_[i]);
                cell.load =
                    cell.bulk > 0 || cell.recovery > 0
                        ? Real(0.25) * volumeStress(gradientOf(cell.corners, places_), bulk, cell.recovery)
                        : Matrix3<Real>(0);
            }
        });
    forEachRun(nodes(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            Vector sum(0);
            const Vector& here = places_[i];
            for (std::size_t d = 0; d < SRS_NEIGHBOURS; ++d) {
                const Spring& spring = springs_[i * SRS_NEIGHBOURS + d];
                if (spring.other < 0)
                    continue;
                const std::size_t other = std::size_t(spring.other);
                const Vector apart = here - places_[other];
                const Real length = std::max(glm::length(apart), Real(1e-6));
                Real pull = spring.weight * (length - restOf<Real>(d));
                if (spring.damper > 0)
                    pull +=
                        spring.damper * (length - glm::length(step_.positions[i] - step_.positions[other]));
                sum += pull / length * apart;
            }
            if (volumetric)
                for (int octant = 0; octant < 8; ++octant)
                    if (const std::int32_t cell = shapes_[0].cellsAround[i][std::size_t(octant)]; cell >= 0)
                        sum += cells_[std::size_t(cell)].load * signOf<Real>(7 - octant);
            const Real share = step_.isHeld(i) ? Real(1) : step_.share[i];
            sum += mass_[i] *
                   ((increments[i] - step_.expected[i]) / share + drag_ * increments[i] - step_.gravity);
            if (!supports_.empty())
                sum -= supports_[i].force;
            result[i] = sum;
        }
    });
}

template <class Real>
std::array<double, 4> ImplicitSystem<Real>::changes(const Vectors& increments, const Vectors& direction,
                                                    const std::array<double, 4>& shares) {
    place(increments);
    const bool volumetric = setup_.tissue.volumetric();
    const auto springChange = [&](std::size_t i, const Spring& spring, std::size_t d,
                                  std::array<double, 4>& sum) {
        const std::size_t other = std::size_t(spring.other);
        const Vector apart = places_[i] - places_[other], turn = direction[i] - direction[other];
        const double length = double(glm::length(apart)), across = 2 * double(glm::dot(apart, turn)),
                     square = double(glm::dot(turn, turn));
        const double weight = stiffening_.empty() ? double(spring.weight) : 0, damper = double(spring.damper);
        const double before =
            damper > 0 ? double(glm::length(step_.positions[i] - step_.positions[other])) : 0;
        for (std::size_t k = 0; k < shares.size(); ++k) {
            const double rise2 = shares[k] * (across + shares[k] * square);
            const double moved = std::sqrt(std::max(0.0, length * length + rise2));
            const double rise = rise2 / std::max(moved + length, 1e-6);
            sum[k] += 0.5 * rise *
                      (weight * (moved + length - 2 * double(restOf<Real>(d))) +
                       damper * (moved + length - 2 * before));
        }
    };
    std::array<double, 4> change = sumRuns(nodes(), [&](std::size_t i, std::array<double, 4>& sum) {
        for (std::size_t d = 0; d < SRS_NEIGHBOURS; d += 2)
            if (const Spring& spring = springs_[i * SRS_NEIGHBOURS + d]; spring.other >= 0)
                springChange(i, spring, d, sum);
        if (step_.isHeld(i))
            return;
        const Vector& u = increments[i];
        const Vector& p = direction[i];
        const double pull = double(
                         glm::dot(p, (u - step_.expected[i]) / step_.share[i] + drag_ * u - step_.gravity)),
                     square = double(glm::dot(p, p)) * double(1 / step_.share[i] + drag_);
        for (std::size_t k = 0; k < shares.size(); ++k)
            sum[k] += double(mass_[i]) * shares[k] * (pull + 0.5 * shares[k] * square);
        if (supports_.empty())
            return;
        const Support& support = supports_[i];
        const double given = double(glm::dot(p, support.force)),
                     stiffness = double(glm::dot(p, support.stiffness * p));
        for (std::size_t k = 0; k < shares.size(); ++k)
            sum[k] += shares[k] * (0.5 * shares[k] * stiffness - given);
    });
    if (volumetric) {
        const std::array<double, 4> cells =
            sumRuns(cells_.size(), [&](std::size_t i, std::array<double, 4>& sum) {
                const Cell& cell = cells_[i];
                const Real bulk = stiffening_.empty() ? cell.bulk : Real(0);
                if (bulk == 0 && cell.recovery == 0)
                    return;
                const Matrix3<Real> f = gradientOf(cell.corners, places_),
                                    g = gradientOf(cell.corners, direction);
                for (std::size_t k = 0; k < shares.size(); ++k)
                    sum[k] += volumeChange(f, g, shares[k], bulk, cell.recovery);
            });
        for (std::size_t k = 0; k < shares.size(); ++k)
            change[k] += cells[k];
    }
    if (!stiffening_.empty()) {
        std::vector<glm::dvec3> exact(places_.begin(), places_.end());
        const double before = stiffening_.energy(exact);
        for (std::size_t k = 0; k < shares.size(); ++k) {
            for (std::size_t i = 0; i < exact.size(); ++i)
                exact[i] = glm::dvec3(places_[i]) + shares[k] * glm::dvec3(direction[i]);
            change[k] += scale_ * (stiffening_.energy(exact) - before);
        }
    }
    return change;
}

template <class Real>
void ImplicitSystem<Real>::linearize(const Vectors& increments) {
    place(increments);
    linearizeSprings();
    linearizeCells();
    coarsen();
    invertCoarsest();
}

template <class Real>
void ImplicitSystem<Real>::linearizeSprings() {
    forEachRun(nodes(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t d = 0; d < SRS_NEIGHBOURS; ++d) {
                Spring& spring = springs_[i * SRS_NEIGHBOURS + d];
                if (spring.other < 0)
                    continue;
                const std::size_t other = std::size_t(spring.other);
                const Vector apart = places_[i] - places_[other];
                const Real length = std::max(glm::length(apart), Real(1e-6)), rest = restOf<Real>(d);
                Real pull = spring.weight * (length - rest);
                if (spring.damper > 0)
                    pull +=
                        spring.damper * (length - glm::length(step_.positions[i] - step_.positions[other]));
                const Real stiffness = tangents_.empty()
                                           ? spring.weight
                                           : Real(scale_ * field_.springWeight(i, int(d), tangents_));
                const Real along = stiffness + spring.damper;
                spring.across = std::clamp(pull / length, Real(0), along);
                spring.root = std::sqrt(along - spring.across) / length * apart;
            }
    });
}

template <class Real>
void ImplicitSystem<Real>::linearizeCells() {
    if (!setup_.tissue.volumetric())
        return;
    forEachRun(cells_.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            Cell& cell = cells_[i];
            cell.root = Matrix3<Real>(0);
            if (cell.bulk == 0 && cell.recovery == 0)
                continue; // a cut runs through it
            const Matrix3<Real> f = gradientOf(cell.corners, places_), cofactor = cofactors(f);
            const Real volume = glm::dot(f[0], cofactor[0]);
            const Real bulk = tangents_.empty() ? cell.bulk : cell.bulk * Real(tangents_[i]);
            const Real stiffness = volumeSoftening(frobenius2(cofactor)) *
                                   (bulk + (volume < Real(SRS_COLLAPSED) ? cell.recovery : Real(0)));
            cell.root = Real(0.25) * std::sqrt(stiffness) * cofactor;
        }
    });
}

template <class Real>
void ImplicitSystem<Real>::apply(const Vectors& p, Vectors& result) {
    const bool volumetric = setup_.tissue.volumetric();
    if (volumetric)
        forEachRun(cells_.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                cells_[i].pull = 4 * contract(cells_[i].root, gradientOf(cells_[i].corners, p));
        });
    forEachRun(nodes(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (step_.isHeld(i)) {
                result[i] = Vector(0);
                continue;
            }
            Vector sum = mass_[i] * (1 / step_.share[i] + drag_) * p[i];
            if (!supports_.empty())
                sum += supports_[i].stiffness * p[i];
            for (std::size_t d = 0; d < SRS_NEIGHBOURS; ++d) {
                const Spring& spring = springs_[i * SRS_NEIGHBOURS + d];
                if (spring.other < 0)
                    continue;
                const Vector apart = p[i] - p[std::size_t(spring.other)];
                sum += glm::dot(spring.root, apart) * spring.root + spring.across * apart;
            }
            if (volumetric)
                for (int octant = 0; octant < 8; ++octant)
                    if (const std::int32_t at = shapes_[0].cellsAround[i][std::size_t(octant)]; at >= 0) {
                        const Cell& cell = cells_[std::size_t(at)];
                        sum += cell.pull * (cell.root * signOf<Real>(7 - octant));
                    }
            result[i] = sum;
        }
    });
}

template <class Real>
double ImplicitSystem<Real>::dot(const Vectors& a, const Vectors& b) const {
    return sumRuns(a.size(), [&](std::size_t i, std::array<double, 4>& sum) {
        sum[0] += double(glm::dot(a[i], b[i]));
    })[0];
}

template class ImplicitSystem<double>;
template class ImplicitSystem<float>;

} // namespace serosa::sim
