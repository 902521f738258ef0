// See sim/pair_contact.h.
#include "sim/pair_contact.h"

#include "base/check.h"
#include "sim/triangle_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

namespace serosa::sim {

namespace {

glm::dvec3 weighted(const glm::dvec3& weights, const std::vector<glm::dvec3>& values, const glm::uvec3& t) {
    return weights.x * values[t.x] + weights.y * values[t.y] + weights.z * values[t.z];
}

/// Motion of the node against the touched point over the step, and how it answers to an impulse.
struct Row {
    glm::dvec3 motion;
    double answer; // 1/mass, of split masses
};

Row rowOf(const PairContact& c, const CoupledMotion& motion, const std::vector<std::uint32_t>& counts) {
    Row row{motion.increments[c.node] - weighted(c.weights, motion.increments, c.corners),
            counts[c.node] * motion.inverseMass[c.node]};
    for (int i = 0; i < 3; ++i)
        row.answer += c.weights[i] * c.weights[i] * counts[c.corners[i]] * motion.inverseMass[c.corners[i]];
    return row;
}

/// Impulses of a contact.
struct Given {
    double normal = 0;
    glm::dvec3 friction{0};
};

/// All rounds. `gap` of a contact is that of the increments as they come in.
void iterate(std::vector<PairContact>& contacts, double friction, CoupledMotion& motion) {
    std::vector<std::uint32_t> counts(motion.increments.size(), 0), touched;
    const auto count = [&](std::uint32_t node) {
        if (counts[node]++ == 0)
            touched.push_back(node);
    };
    for (const PairContact& c : contacts) {
        count(c.node);
        for (int corner = 0; corner < 3; ++corner)
            count(c.corners[corner]);
    }
    std::vector<double> starts; // motion along the normal as it comes in
    for (const PairContact& c : contacts)
        starts.push_back(glm::dot(c.normal, rowOf(c, motion, counts).motion));
    std::vector<glm::dvec3> given(motion.increments.size(), glm::dvec3(0)); // in one round
    std::vector<glm::dvec3> before = motion.increments;
    std::vector<Given> last(contacts.size());
    for (int round = 0; round < SRS_PAIR_ROUNDS; ++round) {
        const double ahead = round / (round + 3.0);
        for (const std::uint32_t node : touched) {
            const glm::dvec3 now = motion.increments[node];
            motion.increments[node] += ahead * (now - before[node]);
            before[node] = now;
        }
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            PairContact& c = contacts[i];
            const Row row = rowOf(c, motion, counts);
            if (!(row.answer > 0))
                continue;
            const Given from{c.normalImpulse + ahead * (c.normalImpulse - last[i].normal),
                             c.friction + ahead * (c.friction - last[i].friction)};
            last[i] = {c.normalImpulse, c.friction};
            const double along = glm::dot(c.normal, row.motion);
            c.normalImpulse = std::max(0.0, from.normal - (c.gap + along - starts[i]) / row.answer);
            if (friction > 0) {
                c.friction = from.friction - (row.motion - along * c.normal) / row.answer;
                const double most = friction * c.normalImpulse, size = glm::length(c.friction);
                if (size > most)
                    c.friction *= most / size;
            }
            const glm::dvec3 impulse =
                (c.normalImpulse - from.normal) * c.normal + (c.friction - from.friction);
            given[c.node] += impulse;
            for (int corner = 0; corner < 3; ++corner)
                given[c.corners[corner]] -= c.weights[corner] * impulse;
        }
        for (const std::uint32_t node : touched) {
            motion.increments[node] += motion.inverseMass[node] * given[node];
            given[node] = glm::dvec3(0);
        }
    }
}

} // namespace

PairContacts::PairContacts(const CoupledGroup& group, double friction)
    : group_(group), friction_(friction), boxes_(group.organs.size()), fastest_(group.organs.size()) {
    SEROSA_CHECK(friction >= 0, "friction is not negative");
}

bool PairContacts::isNear(std::uint32_t node, const glm::uvec3& corners) const {
    const auto begin = group_.near.begin() + group_.nearFirst[node],
               end = group_.near.begin() + group_.nearFirst[node + 1];
    return std::binary_search(begin, end, corners.x) || std::binary_search(begin, end, corners.y) ||
           std::binary_search(begin, end, corners.z);
}

std::optional<PairContact> PairContacts::touch(std::uint32_t node, std::uint32_t organ,
                                               const CoupledMotion& motion) const {
    const CoupledOrgan &other = group_.organs[organ], &own = group_.organs[group_.organOf[node]];
    const glm::dvec3 move = motion.increments[node];
    const double deepest = SRS_PAIR_DEEPEST * std::max(other.scale, own.scale),
                 longest = glm::length(move) + fastest_[organ];
    Box path;
    path.add(points_[node]);
    path.add(points_[node] + move);
    path.low -= deepest;
    path.high += deepest;
    if (!path.meets(boxes_[organ].whole()) || !std::isfinite(longest))
        return {};
    const double parts = glm::clamp(std::ceil(longest / (0.5 * other.scale)), 1.0, double(SRS_PAIR_PARTS));
    const double reach = std::max(deepest, longest / parts);
    for (double part = 0; part < parts; ++part) {
        const double s = part / parts;
        const glm::dvec3 p = points_[node] + s * move;
        PairContact best;
        double distance2 = reach * reach;
        bool found = false;
        boxes_[organ].near(p, distance2, [&](std::size_t i) {
            const glm::uvec3 t = group_.triangles[other.firstTriangle + i];
            const auto faces = [&](int k) { return glm::dot(normals_[t[k]], normals_[node]); };
            if (faces(0) >= 0 && faces(1) >= 0 && faces(2) >= 0)
                return; // no point of it is against the node's normal: most of a skin, cheaply
            const auto corner = [&](int k) { return points_[t[k]] + s * motion.increments[t[k]]; };
            const TrianglePoint closest = closestPointOnTriangle(p, corner(0), corner(1), corner(2));
            const glm::dvec3 apart = p - closest.point;
            if (!(glm::dot(apart, apart) < distance2))
                return;
            const glm::dvec3 there = weighted(closest.weights, normals_, t);
            const double most = -SRS_PAIR_AGAINST * glm::length(there) * group_.flatness[node];
            if (!(glm::dot(there, normals_[node]) < most) || (&other == &own && isNear(node, t)))
                return;
            found = true;
            distance2 = glm::dot(apart, apart);
            best.corners = t;
            best.weights = closest.weights;
            best.normal = glm::normalize(there - normals_[node]);
            best.gap = glm::dot(best.normal, apart);
        });
        if (!found)
            continue;
        const glm::dvec3 against = move - weighted(best.weights, motion.increments, best.corners);
        const double closing = glm::dot(best.normal, against), gap = best.gap,
                     distance = std::sqrt(distance2);
        const double thin =
            SRS_PAIR_THIN *
            (group_.thickness[node] + glm::dot(best.weights, glm::dvec3(group_.thickness[best.corners.x],
                                                                        group_.thickness[best.corners.y],
                                                                        group_.thickness[best.corners.z])));
        const double slack = SRS_PAIR_SLACK * other.scale,
                     farthest = gap < 0 ? std::min(deepest, thin) : glm::length(against) / parts + slack;
        const bool aside = distance > slack && std::abs(gap) < 0.7 * distance;
        if (!(distance <= farthest) || aside || !(gap + closing / parts < 0))
            continue;
        best.node = node;
        best.organ = organ;
        best.gap = gap + (1 - s) * closing - std::min(0.0, gap + SRS_EJECTION * other.scale);
        if (best.gap < 0)
            return best;
    }
    return {};
}

void PairContacts::find(const CoupledMotion& motion) {
    placeSkin(group_, motion.positions, offsets_, normals_);
    points_.resize(group_.nodeCount());
    for (std::size_t i = 0; i < points_.size(); ++i) {
        points_[i] = motion.positions[i] + offsets_[i];
        normals_[i] *= group_.flatness[i];
    }
    for (std::size_t o = 0; o < group_.organs.size(); ++o) {
        const CoupledOrgan& organ = group_.organs[o];
        double fastest2 = 0;
        for (std::size_t i = organ.firstNode; i < organ.firstNode + organ.skinNodes; ++i)
            fastest2 = std::max(fastest2, glm::dot(motion.increments[i], motion.increments[i]));
        fastest_[o] = std::sqrt(fastest2);
        boxes_[o].place(organ.triangles, [&](std::size_t i) {
            Box box;
            const glm::uvec3& t = group_.triangles[organ.firstTriangle + i];
            for (int k = 0; k < 3; ++k) {
                box.add(points_[t[k]]);
                box.add(points_[t[k]] + motion.increments[t[k]]);
            }
            return box;
        });
    }
    contacts_.clear();
    std::vector<std::optional<PairContact>> found(group_.nodeCount());
    for (std::uint32_t o = 0; o < group_.organs.size(); ++o)
        for (std::uint32_t other = 0; other < group_.organs.size(); ++other) {
            const CoupledOrgan& organ = group_.organs[o];
            if (o == other ? !organ.touchesItself : !organ.touches || !group_.organs[other].touches)
                continue;
            Box whole = boxes_[o].whole();
            const double deepest = SRS_PAIR_DEEPEST * std::max(organ.scale, group_.organs[other].scale);
            whole.low -= deepest;
            whole.high += deepest;
            if (!whole.meets(boxes_[other].whole()))
                continue;
            tbb::parallel_for(
                tbb::blocked_range<std::uint32_t>(organ.firstNode, organ.firstNode + organ.skinNodes, 64),
                [&](const tbb::blocked_range<std::uint32_t>& range) {
                    for (std::uint32_t node = range.begin(); node != range.end(); ++node)
                        found[node] = touch(node, other, motion);
                });
            for (std::uint32_t node = organ.firstNode; node < organ.firstNode + organ.skinNodes; ++node)
                if (found[node])
                    contacts_.push_back(*found[node]);
        }
}

void PairContacts::solve(CoupledMotion& motion) {
    find(motion);
    if (!contacts_.empty())
        iterate(contacts_, friction_, motion);
}

} // namespace serosa::sim
