// See sim/lod_map.h. Moving least squares: Lancaster & Salkauskas 1981.
#include "sim/lod_map.h"

#include "base/check.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace serosa::sim {

namespace {

constexpr double kSamePlace = 1e-4;           // spacings
constexpr double kLeastVariance = 0.03;       // squared coarse spacings: below, a fit knows no slope that way
constexpr double kReaches[] = {1, 1.5, 2, 3}; // of a fit, coarse spacings: the first that knows all slopes

/// Index of the material cell at a grid coordinate, or -1.
class CellGrid3 {
public:
    explicit CellGrid3(const Lattice& lattice) : dims_(lattice.nodeDims - 1) {
        cells_.assign(std::size_t(dims_.x) * std::size_t(dims_.y) * std::size_t(dims_.z), -1);
        for (std::size_t i = 0; i < lattice.cells.size(); ++i)
            cells_[index(lattice.cells[i].grid)] = std::int32_t(i);
    }
    bool holds(const glm::ivec3& at) const {
        return glm::all(glm::greaterThanEqual(at, glm::ivec3(0))) && glm::all(glm::lessThan(at, dims_)) &&
               cells_[index(at)] >= 0;
    }

private:
    std::size_t index(const glm::ivec3& at) const {
        return (std::size_t(at.z) * std::size_t(dims_.y) + std::size_t(at.y)) * std::size_t(dims_.x) +
               std::size_t(at.x);
    }
    glm::ivec3 dims_;
    std::vector<std::int32_t> cells_;
};

/// Grid coordinate (the node (0, 0, 0) is 0) on `to` of a node of `from`; half spacings are exact.
glm::dvec3 gridPlace(const Lattice& to, const Lattice& from, std::size_t node) {
    const glm::dvec3 at = to.toLattice(from.toWorld(from.restPosition(node))) + glm::dvec3(to.centre);
    const glm::dvec3 half = 0.5 * glm::round(2.0 * at);
    return glm::all(glm::lessThan(glm::abs(half - at), glm::dvec3(kSamePlace))) ? half : at;
}

double distance2(const glm::dvec3& at, const glm::ivec3& cell) {
    const glm::dvec3 low(cell), inside = glm::clamp(at, low, low + 1.0);
    return glm::dot(at - inside, at - inside);
}

/// The material cell nearest to a grid place, the lowest of several.
glm::ivec3 nearestCell(const CellGrid3& cells, const glm::dvec3& at) {
    const glm::ivec3 base(glm::floor(at));
    glm::ivec3 best(0);
    double nearest = 1e30;
    for (int reach = 1; reach <= 4 && nearest > 1e29; ++reach)
        for (int z = -reach; z <= reach; ++z)
            for (int y = -reach; y <= reach; ++y)
                for (int x = -reach; x <= reach; ++x) {
                    const glm::ivec3 cell = base + glm::ivec3(x, y, z);
                    const double d2 = cells.holds(cell) ? distance2(at, cell) : 1e30;
                    if (d2 < nearest) {
                        nearest = d2;
                        best = cell;
                    }
                }
    SEROSA_CHECK(nearest < 1e29, "two lattices of one organ");
    return best;
}

/// Fine nodes around a coarse one with their weights in the fit.
struct Support {
    std::vector<std::uint32_t> nodes;
    std::vector<double> weights;
    std::vector<glm::dvec3> places; // from the coarse node, coarse spacings
};

Support supportOf(const Lattice& fine, const std::vector<double>& masses, const glm::dvec3& middle,
                  double ratio, double reach) {
    Support support;
    const glm::ivec3 low(glm::floor(middle - reach * ratio)), high(glm::ceil(middle + reach * ratio));
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x) {
                const std::int64_t node = fine.nodeAt({x, y, z});
                if (node < 0)
                    continue;
                const glm::dvec3 place = (glm::dvec3(x, y, z) - middle) / ratio;
                const glm::dvec3 hat = glm::max(1.0 - glm::abs(place) / reach, glm::dvec3(0));
                const double weight = hat.x * hat.y * hat.z * masses[std::size_t(node)];
                if (!(weight > 0))
                    continue;
                support.nodes.push_back(std::uint32_t(node));
                support.weights.push_back(weight);
                support.places.push_back(place);
            }
    return support;
}

/// Weights of the fit's value at the origin; false where some slope is not known. \param force take what is
/// known
bool fit(Support& support, bool force) {
    double sum = 0;
    glm::dvec3 mean(0);
    for (std::size_t i = 0; i < support.nodes.size(); ++i) {
        sum += support.weights[i];
        mean += support.weights[i] * support.places[i];
    }
    if (!(sum > 0))
        return false;
    mean /= sum;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < support.nodes.size(); ++i) {
        const glm::dvec3 d = support.places[i] - mean;
        const Eigen::Vector3d e(d.x, d.y, d.z);
        spread += support.weights[i] / sum * e * e.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
    if (!force && solver.eigenvalues()(0) < kLeastVariance)
        return false;
    Eigen::Vector3d slope = Eigen::Vector3d::Zero(); // spread^-1 (0 - mean)
    for (int i = 0; i < 3; ++i)
        if (solver.eigenvalues()(i) >= kLeastVariance) {
            const Eigen::Vector3d axis = solver.eigenvectors().col(i);
            slope -= axis * axis.dot(Eigen::Vector3d(mean.x, mean.y, mean.z)) / solver.eigenvalues()(i);
        }
    for (std::size_t i = 0; i < support.nodes.size(); ++i) {
        const glm::dvec3 d = support.places[i] - mean;
        support.weights[i] *= (1 + slope.dot(Eigen::Vector3d(d.x, d.y, d.z))) / sum;
    }
    return true;
}

} // namespace

LodRows trilinearRows(const Lattice& coarse, const Lattice& fine) {
    const CellGrid3 cells(coarse);
    LodRows rows;
    for (std::size_t node = 0; node < fine.nodeCount(); ++node) {
        rows.starts.push_back(std::uint32_t(rows.entries.size()));
        const glm::dvec3 at = gridPlace(coarse, fine, node);
        const glm::ivec3 base(glm::floor(at));
        const glm::ivec3 cell = cells.holds(base) ? base : nearestCell(cells, at);
        const glm::dvec3 share = at - glm::dvec3(cell);
        for (int c = 0; c < 8; ++c) {
            double weight = 1;
            for (int axis = 0; axis < 3; ++axis)
                weight *= cornerOffset(c)[axis] ? share[axis] : 1 - share[axis];
            rows.entries.push_back({std::uint32_t(coarse.nodeAt(cell + cornerOffset(c))), float(weight)});
        }
    }
    rows.starts.push_back(std::uint32_t(rows.entries.size()));
    return rows;
}

LodRows meanRows(const Lattice& fine, const std::vector<double>& masses, const Lattice& coarse) {
    const double ratio = coarse.spacing / fine.spacing;
    LodRows rows;
    for (std::size_t node = 0; node < coarse.nodeCount(); ++node) {
        rows.starts.push_back(std::uint32_t(rows.entries.size()));
        const glm::dvec3 middle = gridPlace(fine, coarse, node);
        Support support;
        bool known = false;
        for (const double reach : kReaches) {
            support = supportOf(fine, masses, middle, ratio, reach);
            known = fit(support, false);
            if (known)
                break;
        }
        if (!known) {
            support = supportOf(fine, masses, middle, ratio, std::end(kReaches)[-1]);
            SEROSA_CHECK(fit(support, true), "two lattices of one organ");
        }
        for (std::size_t i = 0; i < support.nodes.size(); ++i)
            rows.entries.push_back({support.nodes[i], float(support.weights[i])});
    }
    rows.starts.push_back(std::uint32_t(rows.entries.size()));
    return rows;
}

LodRows placeRows(const Lattice& fine, const LodRows& means, const Lattice& coarse) {
    LodRows rows;
    for (std::size_t node = 0; node < coarse.nodeCount(); ++node) {
        rows.starts.push_back(std::uint32_t(rows.entries.size()));
        const glm::dvec3 at = gridPlace(fine, coarse, node), whole = glm::round(at);
        const std::int64_t there = at == whole ? fine.nodeAt(glm::ivec3(whole)) : -1;
        if (there >= 0)
            rows.entries.push_back({std::uint32_t(there), 1.0F});
        else
            rows.entries.insert(rows.entries.end(), means.entries.begin() + means.starts[node],
                                means.entries.begin() + means.starts[node + 1]);
    }
    rows.starts.push_back(std::uint32_t(rows.entries.size()));
    return rows;
}

} // namespace serosa::sim
