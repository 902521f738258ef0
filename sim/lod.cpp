// See sim/lod.h. The GPU's twin: sim/lod_pass.cpp and shaders/lod_*.comp.
#include "sim/lod.h"

#include "base/check.h"
#include "shaders/shared_constants.h"
#include "sim/cell_volumes.h"
#include "sim/packed_normal.h"
#include "sim/tissue_field.h"

#include <cmath>

namespace serosa::sim {

namespace {

constexpr double kInertiaFloor = 1e-12; // of the trace: a line of nodes does not turn about itself

/// kg, one a node.
std::vector<double> nodeMasses(const Lattice& lattice, const Tissue& tissue) {
    const TissueField field(lattice, tissue);
    std::vector<double> masses;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        masses.push_back(field.massShare(node) * tissue.nodeMass(lattice.spacing));
    return masses;
}

double total(const std::vector<double>& masses) {
    double sum = 0;
    for (const double mass : masses)
        sum += mass;
    return sum;
}

std::vector<glm::dvec3> restPositions(const Lattice& lattice) {
    std::vector<glm::dvec3> rest;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        rest.push_back(lattice.restPosition(node));
    return rest;
}

/// Masses in shares of the target's full node, without the fixed ones.
std::vector<double> freeMasses(const SolverSetup& setup, std::vector<double> masses, double unit) {
    for (std::size_t node = 0; node < masses.size(); ++node)
        masses[node] = !setup.fixed.empty() && setup.fixed[node] ? 0 : masses[node] / unit;
    return masses;
}

struct Sums {
    double mass = 0;
    glm::dvec3 linear{0}, angular{0}, first{0}; // first: sum of m x
    glm::dmat3 second{0};                       // sum of m x x^T
    void add(double m, const glm::dvec3& x, const glm::dvec3& u) {
        mass += m;
        linear += m * u;
        angular += m * glm::cross(x, u);
        first += m * x;
        second += m * glm::outerProduct(x, x);
    }
    glm::dvec3 centre() const { return mass > 0 ? first / mass : glm::dvec3(0); }
    /// Angular momentum about the centre of mass.
    glm::dvec3 spin() const { return angular - glm::cross(centre(), linear); }
};

/// The rigid motion a + w x (x - c) that gives `now` the momenta of `wanted`.
struct RigidMotion {
    glm::dvec3 a{0}, w{0}, c{0};
    glm::dvec3 at(const glm::dvec3& x) const { return a + glm::cross(w, x - c); }
};
RigidMotion missing(const Sums& wanted, const Sums& now) {
    RigidMotion motion;
    if (!(now.mass > 0))
        return motion;
    motion.c = now.centre();
    motion.a = (wanted.linear - now.linear) / now.mass;
    const glm::dmat3 spread = now.second - now.mass * glm::outerProduct(motion.c, motion.c);
    const double trace = spread[0][0] + spread[1][1] + spread[2][2];
    const glm::dmat3 inertia = glm::dmat3(trace * (1 + kInertiaFloor)) - spread;
    if (trace > 0)
        motion.w = glm::inverse(inertia) * (wanted.spin() - now.spin());
    return motion;
}

glm::dvec3 gather(const LodRows& rows, std::size_t node, const std::vector<glm::dvec3>& values) {
    glm::dvec3 sum(0);
    for (std::uint32_t i = rows.starts[node]; i < rows.starts[node + 1]; ++i)
        sum += double(rows.entries[i].weight) * values[rows.entries[i].node];
    return sum;
}

/// Mean deformation gradient of the coarse cell that a fine node lies in.
glm::dmat3 frameOf(const LodTransfer& toFiner, std::size_t node, const std::vector<glm::dvec3>& positions) {
    glm::dmat3 frame(0);
    const LodEntry* corners = &toFiner.places.entries[toFiner.places.starts[node]];
    for (int c = 0; c < 8; ++c)
        for (int axis = 0; axis < 3; ++axis)
            frame[axis] += 0.25 * cornerSign(c)[axis] * positions[corners[c].node];
    return frame;
}

std::vector<glm::dvec3> displacements(const std::vector<glm::dvec3>& positions,
                                      const std::vector<glm::dvec3>& rest) {
    std::vector<glm::dvec3> moved;
    for (std::size_t i = 0; i < positions.size(); ++i)
        moved.push_back(positions[i] - rest[i]);
    return moved;
}

/// MS05 eq. 3 of a state whose springs are all there.
void setNormals(const Lattice& lattice, LatticeState& state) {
    state.normals.clear();
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        glm::dvec3 sum(0);
        for (int d = 0; d < 18; ++d)
            if (const std::int64_t other = lattice.neighbour(node, d); other >= 0) {
                const glm::dvec3 apart = state.positions[node] - state.positions[std::size_t(other)];
                sum += apart / std::max(glm::length(apart), 1e-6);
            }
        state.normals.push_back(packNormal(glm::vec3(sum)));
    }
}

} // namespace

Tissue matchedTissue(const Tissue& tissue, const Lattice& fine, const Lattice& coarse) {
    const double factor = total(nodeMasses(fine, tissue)) / total(nodeMasses(coarse, tissue));
    Tissue matched = tissue;
    matched.density *= factor;
    for (Material& other : matched.others)
        other.density *= factor;
    return matched;
}

LodTransfer LodTransfer::make(const SolverSetup& from, const SolverSetup& to) {
    SEROSA_CHECK(from.lattice && to.lattice && from.timeStep > 0 && to.timeStep > 0, "two levels' setups");
    const Lattice &source = *from.lattice, &target = *to.lattice;
    LodTransfer transfer;
    transfer.finer = target.spacing < source.spacing;
    const std::vector<double> sourceMasses = nodeMasses(source, from.tissue);
    if (transfer.finer) {
        transfer.places = trilinearRows(source, target);
        transfer.velocities = transfer.places;
    } else {
        transfer.velocities = meanRows(source, sourceMasses, target);
        transfer.places = placeRows(source, transfer.velocities, target);
    }
    transfer.sourceRest = restPositions(source);
    transfer.targetRest = restPositions(target);
    const double unit = to.tissue.nodeMass(target.spacing);
    transfer.sourceMasses = freeMasses(from, sourceMasses, unit);
    transfer.targetMasses = freeMasses(to, nodeMasses(target, to.tissue), unit);
    transfer.targetFixed = to.fixed;
    transfer.targetFixed.resize(target.nodeCount(), false);
    transfer.lengthScale = source.spacing / target.spacing;
    transfer.stepScale = to.timeStep / from.timeStep;
    return transfer;
}

LodDetail detailOf(const LodTransfer& toFiner, const LatticeState& coarse, const LatticeState& fine) {
    SEROSA_CHECK(toFiner.finer, "the transfer from coarse to fine");
    const std::vector<glm::dvec3> moved = displacements(coarse.positions, toFiner.sourceRest);
    LodDetail detail;
    for (std::size_t node = 0; node < fine.positions.size(); ++node) {
        const glm::dvec3 left = fine.positions[node] - toFiner.targetRest[node] -
                                toFiner.lengthScale * gather(toFiner.places, node, moved);
        const glm::dmat3 frame = frameOf(toFiner, node, coarse.positions);
        const bool carries = glm::determinant(frame) > SRS_LOD_LEAST_VOLUME && !toFiner.targetFixed[node];
        detail.push_back(carries ? glm::inverse(frame) * left : glm::dvec3(0));
    }
    return detail;
}

LatticeState transferState(const LodTransfer& transfer, const Lattice& target, const LatticeState& from,
                           const std::vector<glm::dvec3>& before, double lead, std::int64_t step,
                           const LodDetail& detail) {
    SEROSA_CHECK(from.positions.size() == transfer.sourceRest.size() &&
                     target.nodeCount() == transfer.targetRest.size(),
                 "a state of the transfer's source, and the lattice of its target");
    SEROSA_CHECK(before.empty() || before.size() == from.increments.size(), "increments of every node");
    const std::vector<glm::dvec3> moved = displacements(from.positions, transfer.sourceRest);
    std::vector<glm::dvec3> velocities = from.increments; // at the target's half step, the source's units
    for (std::size_t i = 0; i < before.size(); ++i)
        velocities[i] += lead * (from.increments[i] - before[i]);
    const double velocityScale = transfer.lengthScale * transfer.stepScale;

    LatticeState state;
    state.step = step;
    state.heldBy.assign(target.nodeCount(), 0);
    Sums wanted, now;
    for (std::size_t node = 0; node < target.nodeCount(); ++node) {
        glm::dvec3 x = transfer.targetRest[node], u(0);
        if (!transfer.targetFixed[node]) {
            x += transfer.lengthScale * gather(transfer.places, node, moved);
            if (!detail.empty())
                x += frameOf(transfer, node, from.positions) * detail[node];
            u = velocityScale * gather(transfer.velocities, node, velocities);
        }
        state.positions.push_back(x);
        state.increments.push_back(u);
        now.add(transfer.targetMasses[node], x, u);
    }
    for (std::size_t node = 0; node < velocities.size(); ++node)
        wanted.add(transfer.sourceMasses[node], transfer.lengthScale * from.positions[node],
                   velocityScale * velocities[node]);
    const RigidMotion motion = missing(wanted, now);
    for (std::size_t node = 0; node < target.nodeCount(); ++node)
        if (transfer.targetMasses[node] > 0)
            state.increments[node] += motion.at(state.positions[node]);
    setNormals(target, state);
    return state;
}

Momentum momentumOf(const SolverSetup& setup, const LatticeState& state) {
    const Lattice& lattice = *setup.lattice;
    const std::vector<double> masses = freeMasses(setup, nodeMasses(lattice, setup.tissue), 1);
    Sums sums;
    for (std::size_t node = 0; node < masses.size(); ++node)
        sums.add(masses[node], lattice.spacing * state.positions[node],
                 lattice.spacing / setup.timeStep * state.increments[node]);
    return {sums.linear, sums.spin()};
}

} // namespace serosa::sim
