// See sim/contact_stage.h.
#include "sim/contact_stage.h"

#include "base/check.h"
#include "shaders/shared_constants.h"
#include "sim/contact_triangle.h"
#include "sim/shape_distance.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace serosa::sim {

namespace {

constexpr double kMargin = 1;       // spacings that blocks may move before their spheres are made anew
constexpr double kDeepest = 1;      // contactDepth
constexpr double kMostShare = 1.25; // of a triangle's move, for a corner; equal ones need 1.21
constexpr double kNearBy = 0.25;    // spacings: a triangle so near may touch once others have moved it

/// How far each corner moves where the point with these weights b moves by 1: b_i/m_i over sum b_j^2/m_j, the
/// least energy. No corner moves by more than kMostShare, though, what it does not take the others do: light
/// corners, of cells with little fill, would be thrown.
glm::dvec3 cornerShares(const glm::dvec3& weights, const glm::dvec3& inverseMass) {
    glm::dvec3 shares(0);
    bool full[3] = {};
    for (int round = 0; round < 3; ++round) {
        double left = 1, sum = 0;
        for (int k = 0; k < 3; ++k)
            (full[k] ? left : sum) +=
                full[k] ? -weights[k] * kMostShare : weights[k] * weights[k] * inverseMass[k];
        bool again = false;
        for (int k = 0; k < 3; ++k) {
            if (full[k])
                continue;
            shares[k] = sum > 0 ? std::max(left, 0.0) * weights[k] * inverseMass[k] / sum : 0;
            if (shares[k] > kMostShare) {
                shares[k] = kMostShare;
                full[k] = again = true;
            }
        }
        if (!again)
            break;
    }
    return shares;
}

} // namespace

ContactStage::ContactStage(const SolverSetup& setup, std::vector<double> mass)
    : setup_(setup), mass_(std::move(mass)) {
    const Lattice& lattice = *setup.lattice;
    const std::size_t count = lattice.nodeCount();
    SEROSA_CHECK(mass_.size() == count, "one mass a node");
    SEROSA_CHECK(setup.tools.size() + setup.bodies.size() <= SRS_MAX_COLLIDERS,
                 "at most SRS_MAX_COLLIDERS tools and bodies");
    loads_.resize(setup.tools.size() + setup.bodies.size());
    if (empty())
        return;
    for (std::size_t node = 0; node < count; ++node) {
        const bool fixed = !setup.fixed.empty() && setup.fixed[node];
        inverseMass_.push_back(fixed ? 0 : 1 / mass_[node]);
        depth_.push_back(lattice.restDepth(node));
    }
    start_.resize(count);
    end_.resize(count);
    free_.resize(count);
    seen_.assign(count, 0);
    asked_.assign(count, 0);
    granted_.resize(count);
    mover_.assign(count, 0);
    connect(lattice.connections);
}

void ContactStage::connect(const std::vector<std::uint32_t>& connections) {
    if (empty())
        return;
    surface_ = contactSurface(*setup_.lattice, connections);
    reset();
}

std::vector<ToolLoad> ContactStage::takeLoads() {
    // From mass shares and lattice units a step to N s and N m s.
    const double h = setup_.lattice->spacing, unit = setup_.tissue.nodeMass(h) * h / setup_.timeStep;
    std::vector<ToolLoad> taken;
    for (Load& load : loads_) {
        taken.push_back({load.impulse * unit, load.angular * (unit * h)});
        load = {};
    }
    return taken;
}

void ContactStage::run(std::int64_t step, ContactNodes& nodes, double fastest,
                       std::vector<std::uint32_t>& heldBy) {
    if (empty())
        return;
    place(step, nodes, fastest);
    updateHeld(nodes, heldBy);
    for (const std::uint32_t node : held_)
        loadNode(nodes, node);
    moveHeld(heldBy);
    pushAll(nodes);
    applyMoves(nodes);
}

void ContactStage::keep(std::vector<std::uint32_t> nodes) {
    for (const std::uint32_t node : kept_)
        inverseMass_[node] = 1 / mass_[node];
    std::erase_if(nodes, [this](std::uint32_t node) { return inverseMass_[node] == 0; }); // fixed
    kept_ = std::move(nodes);
    for (const std::uint32_t node : kept_)
        inverseMass_[node] = 0;
}

void ContactStage::push(std::int64_t step, ContactNodes& nodes, double fastest, StepPart part, Loads loads) {
    if (empty())
        return;
    const std::vector<Load> before = loads_;
    place(step, nodes, fastest, part);
    pushAll(nodes);
    applyMoves(nodes);
    if (loads == Loads::forget)
        loads_ = before;
}

std::vector<ContactStage::Push> ContactStage::pushes(std::int64_t step, const ContactNodes& nodes,
                                                     double fastest, StepPart part) {
    std::vector<Push> pushes;
    if (empty())
        return pushes;
    reset(); // these are no moves
    place(step, nodes, fastest, part);
    for (ToolMotion& collider : colliders_)
        collider.friction = 0;
    const std::vector<Load> before = loads_;
    pushAll(nodes);
    loads_ = before;
    reset();
    for (const std::uint32_t node : loaded_)
        if (const glm::dvec3 by = end_[node] - free_[node]; by != glm::dvec3(0))
            pushes.push_back({node, mover_[node], by});
    std::sort(pushes.begin(), pushes.end(), [](const Push& a, const Push& b) { return a.node < b.node; });
    return pushes;
}

/// Colliders, and what may be near them.
void ContactStage::place(std::int64_t step, const ContactNodes& nodes, double fastest, StepPart part) {
    ++run_;
    loaded_.clear();
    colliders_ = colliderMotions(setup_, step, part);
    thin_.clear();
    for (const ToolMotion& collider : colliders_)
        thin_.push_back(thinnestHalfWidth(collider.shape));
    drift_ = drift_ < 0 ? drift_ : drift_ + fastest;
    if (!(drift_ >= 0 && drift_ <= kMargin))
        makeSpheres(nodes, fastest);
}

void ContactStage::pushAll(const ContactNodes& nodes) {
    const std::vector<Near> nearTriangles = nearBlocks(triangleSpheres_, true),
                            nearNodes = nearBlocks(nodeSpheres_, false);
    load(nodes, surface_.triangleBlocks, nearTriangles);
    load(nodes, surface_.nodes, nearNodes);
    const std::vector<Candidate> triangles = candidates(nearTriangles);
    for (int round = 0; round < SRS_CONTACT_ITERATIONS && !triangles.empty(); ++round)
        if (!pushTriangles(triangles, round > 0))
            break;
    pushNodes(nearNodes);
}

void ContactStage::applyMoves(ContactNodes& nodes) {
    double furthest2 = 0;
    for (const std::uint32_t node : loaded_) {
        const glm::dvec3 by = end_[node] - free_[node];
        if (by == glm::dvec3(0))
            continue;
        furthest2 = std::max(furthest2, glm::dot(by, by));
        nodes.move(node, by);
    }
    drift_ += std::sqrt(furthest2);
}

// Grasps.

void ContactStage::updateHeld(const ContactNodes& nodes, std::vector<std::uint32_t>& heldBy) {
    for (std::size_t tool = 0; tool < setup_.tools.size(); ++tool) {
        const ToolMotion& motion = colliders_[tool];
        for (std::uint32_t node = 0; motion.opens && node < heldBy.size(); ++node)
            if (heldBy[node] == tool + 1)
                heldBy[node] = 0;
        for (std::uint32_t node = 0; motion.closes && node < heldBy.size(); ++node)
            if (heldBy[node] == 0 && inverseMass_[node] > 0 && graspReaches(motion, nodes.start(node)))
                heldBy[node] = std::uint32_t(tool + 1);
    }
    if (heldBy == heldSeen_)
        return;
    heldSeen_ = heldBy;
    held_.clear();
    for (std::uint32_t node = 0; node < heldBy.size(); ++node)
        if (heldBy[node] != 0)
            held_.push_back(node);
}

void ContactStage::moveHeld(std::vector<std::uint32_t>& heldBy) {
    std::array<double, SRS_MAX_COLLIDERS> heldMass{};
    for (const std::uint32_t node : held_)
        if (heldBy[node] <= setup_.tools.size())
            heldMass[heldBy[node] - 1] += mass_[node];
    for (const std::uint32_t node : held_) {
        const std::size_t tool = heldBy[node] - 1;
        if (tool >= setup_.tools.size() || colliders_[tool].mode != SRS_TOOL_GRASP)
            continue;
        const ToolMotion& motion = colliders_[tool];
        glm::dvec3 by = motion.carried(start_[node]) - end_[node];
        // An impulse of grip m_i / (held mass): the same displacement for all.
        const double far = glm::length(by), most = motion.grip / heldMass[tool];
        if (far > most)
            by *= most / far;
        loads_[tool].add(motion, mass_[node], start_[node], by);
        end_[node] += by;
        if (motion.grip < std::numeric_limits<double>::infinity() &&
            shapeDistance(motion.shape, motion.ownAtEnd(end_[node])) > SRS_GRIP_SLACK)
            heldBy[node] = 0;
    }
}

// What is near.

void ContactStage::makeSpheres(const ContactNodes& nodes, double fastest) {
    const auto spheresOf = [&](const ContactBlocks& blocks) {
        std::vector<Sphere> spheres(blocks.blocks.size());
        tbb::parallel_for(std::size_t(0), spheres.size(), [&](std::size_t i) {
            const ContactBlock& block = blocks.blocks[i];
            glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
            for (std::uint32_t k = block.firstNode; k < block.firstNode + block.nodes; ++k) {
                const glm::dvec3 p = nodes.end(blocks.nodes[k]); // it started within `fastest` of it
                low = glm::min(low, p);
                high = glm::max(high, p);
            }
            spheres[i] = {0.5 * (low + high), 0.5 * glm::length(high - low) + fastest + kMargin};
        });
        return spheres;
    };
    nodeSpheres_ = spheresOf(surface_.nodes);
    triangleSpheres_ = spheresOf(surface_.triangleBlocks);
    whole_ = {};
    for (const Sphere& sphere : nodeSpheres_)
        whole_.centre += sphere.centre / double(nodeSpheres_.size());
    for (const Sphere& sphere : nodeSpheres_)
        whole_.radius = std::max(whole_.radius, glm::distance(sphere.centre, whole_.centre) + sphere.radius);
    drift_ = 0;
}

std::vector<ContactStage::Near> ContactStage::nearBlocks(const std::vector<Sphere>& spheres,
                                                         bool triangles) const {
    // In the collider's frame a block's points start and end within its sphere as seen from there, and go
    // straight in between. What is no number counts as near.
    const auto far = [](const ToolMotion& collider, const Sphere& sphere) {
        const glm::dvec3 y0 = collider.ownAtStart(sphere.centre), y1 = collider.ownAtEnd(sphere.centre);
        return shapeLowerBound(collider.shape, y1) > glm::distance(y0, y1) + sphere.radius + kDeepest;
    };
    std::vector<Near> near;
    std::vector<std::uint32_t> pushing;
    for (std::uint32_t i = 0; i < colliders_.size(); ++i)
        if (colliders_[i].mode == SRS_TOOL_PUSH && !far(colliders_[i], whole_) &&
            !(triangles && colliders_[i].shape.kind == ShapeKind::halfSpace))
            pushing.push_back(i);
    for (std::uint32_t block = 0; block < spheres.size() && !pushing.empty(); ++block) {
        Mask mask = 0;
        for (const std::uint32_t i : pushing)
            if (!far(colliders_[i], spheres[block]))
                mask |= 1u << i;
        if (mask != 0)
            near.push_back({block, mask});
    }
    return near;
}

void ContactStage::loadNode(const ContactNodes& nodes, std::uint32_t node) {
    if (seen_[node] == run_)
        return;
    seen_[node] = run_;
    start_[node] = nodes.start(node);
    free_[node] = end_[node] = nodes.end(node);
    loaded_.push_back(node);
}

void ContactStage::load(const ContactNodes& nodes, const ContactBlocks& blocks,
                        const std::vector<Near>& near) {
    for (const Near& one : near) {
        const ContactBlock& block = blocks.blocks[one.block];
        for (std::uint32_t k = block.firstNode; k < block.firstNode + block.nodes; ++k)
            loadNode(nodes, blocks.nodes[k]);
    }
}

// Triangles.

std::vector<ContactStage::Candidate> ContactStage::candidates(const std::vector<Near>& near) const {
    std::vector<std::vector<Candidate>> found(near.size());
    tbb::parallel_for(std::size_t(0), near.size(), [&](std::size_t i) {
        const ContactBlock& block = surface_.triangleBlocks.blocks[near[i].block];
        for (Mask mask = near[i].colliders; mask != 0; mask &= mask - 1) {
            const auto collider = std::uint32_t(std::countr_zero(mask));
            const ToolMotion& motion = colliders_[collider];
            for (std::uint32_t triangle = block.first; triangle < block.first + block.count; ++triangle) {
                const glm::uvec3& t = surface_.triangles[triangle];
                double path = 0;
                for (int k = 0; k < 3; ++k)
                    path = std::max(
                        path, glm::distance(motion.ownAtStart(start_[t[k]]), motion.ownAtEnd(end_[t[k]])));
                const double edge = std::max(glm::distance(end_[t.x], end_[t.y]),
                                             glm::distance(end_[t.x], end_[t.z])),
                             depth =
                                 std::max({depth_[t.x], depth_[t.y], depth_[t.z], -0.5 * thin_[collider]});
                if (shapeLowerBound(motion.shape, motion.ownAtEnd(end_[t.x])) <=
                    edge + path + std::max(depth, double(SRS_WALL)) + kNearBy)
                    found[i].push_back({triangle, collider});
            }
        }
    });
    std::vector<Candidate> all;
    for (const std::vector<Candidate>& part : found)
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

bool ContactStage::ask(const Candidate& candidate, Asked& asked) const {
    const ToolMotion& motion = colliders_[candidate.collider];
    const double thin = thin_[candidate.collider];
    const glm::uvec3& t = surface_.triangles[candidate.triangle];
    Corners y0, y1;
    glm::dvec3 depth;
    for (int k = 0; k < 3; ++k) {
        y0[std::size_t(k)] = motion.ownAtStart(start_[t[k]]);
        y1[std::size_t(k)] = motion.ownAtEnd(end_[t[k]]);
        depth[k] = contactDepthFor(depth_[t[k]], thin);
    }
    const TriangleContact contact = triangleContact({motion.shape, thin, motion.friction}, y0, y1, depth);
    if (contact.move == glm::dvec3(0))
        return false;
    const glm::dvec3 shares =
        cornerShares(contact.weights, {inverseMass_[t.x], inverseMass_[t.y], inverseMass_[t.z]});
    if (shares == glm::dvec3(0)) // fixed
        return false;
    asked = {candidate.triangle, {candidate.collider, candidate.collider, candidate.collider}, {}};
    for (int k = 0; k < 3; ++k)
        asked.moves[k] = motion.turnTo * contact.move * shares[k];
    return true;
}

bool ContactStage::pushTriangles(const std::vector<Candidate>& candidates, bool again) {
    constexpr std::size_t kGrain = 64;
    std::vector<std::vector<Asked>> parts((candidates.size() + kGrain - 1) / kGrain);
    tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t part) {
        const std::size_t end = std::min(candidates.size(), (part + 1) * kGrain);
        Asked asked;
        for (std::size_t i = part * kGrain; i < end; ++i)
            if ((!again || movedLast(candidates[i].triangle)) && ask(candidates[i], asked))
                parts[part].push_back(asked);
    });
    // Triangle by triangle, each once: of several colliders a corner takes the largest move.
    std::vector<Asked> all;
    for (const std::vector<Asked>& part : parts)
        all.insert(all.end(), part.begin(), part.end());
    std::stable_sort(all.begin(), all.end(),
                     [](const Asked& a, const Asked& b) { return a.triangle < b.triangle; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (kept == 0 || all[kept - 1].triangle != all[i].triangle) {
            all[kept++] = all[i];
            continue;
        }
        Asked& one = all[kept - 1];
        for (int k = 0; k < 3; ++k)
            if (glm::dot(all[i].moves[k], all[i].moves[k]) > glm::dot(one.moves[k], one.moves[k])) {
                one.moves[k] = all[i].moves[k];
                one.colliders[k] = all[i].colliders[k];
            }
    }
    all.resize(kept);

    ++round_;
    std::vector<std::uint32_t> moved;
    const auto grant = [&](std::uint32_t node, const glm::dvec3& by, std::uint32_t collider) {
        if (asked_[node] != round_) {
            asked_[node] = round_;
            granted_[node] = glm::dvec3(0);
            moved.push_back(node);
        }
        const double length2 = glm::dot(by, by), lacks = length2 - glm::dot(granted_[node], by);
        if (!(lacks > 0))
            return;
        const glm::dvec3 more = by * (lacks / length2);
        granted_[node] += more;
        mover_[node] = collider;
        loads_[collider].add(colliders_[collider], mass_[node], start_[node], more);
    };
    for (const Asked& asked : all)
        for (int k = 0; k < 3; ++k)
            grant(surface_.triangles[asked.triangle][k], asked.moves[k], asked.colliders[k]);
    for (const std::uint32_t node : moved)
        end_[node] += granted_[node];
    return !moved.empty();
}

// Nodes.

void ContactStage::pushNodes(const std::vector<Near>& near) {
    std::vector<std::array<Load, SRS_MAX_COLLIDERS>> loads(near.size());
    tbb::parallel_for(std::size_t(0), near.size(), [&](std::size_t i) {
        const ContactBlock& block = surface_.nodes.blocks[near[i].block];
        for (std::uint32_t k = block.firstNode; k < block.firstNode + block.nodes; ++k) {
            const std::uint32_t node = surface_.nodes.nodes[k];
            for (Mask mask = near[i].colliders; mask != 0 && inverseMass_[node] > 0; mask &= mask - 1) {
                const auto collider = std::size_t(std::countr_zero(mask));
                const ToolMotion& motion = colliders_[collider];
                const glm::dvec3 y0 = motion.ownAtStart(start_[node]), y1 = motion.ownAtEnd(end_[node]);
                const double path = glm::distance(y0, y1),
                             depth = contactDepthFor(depth_[node], thin_[collider]);
                if (!(shapeLowerBound(motion.shape, y1) - depth < path))
                    continue; // no part of the way is nearer
                const glm::dvec3 move = pointContact({motion.shape, thin_[collider], motion.friction}, y0, y1,
                                                     depth, sweepSamples(path, thin_[collider]));
                if (move == glm::dvec3(0))
                    continue;
                const glm::dvec3 by = motion.turnTo * move;
                loads[i][collider].add(motion, mass_[node], start_[node], by);
                end_[node] += by;
                mover_[node] = std::uint32_t(collider);
            }
        }
    });
    for (const auto& part : loads)
        for (std::size_t collider = 0; collider < loads_.size(); ++collider)
            loads_[collider].add(part[collider]);
}

} // namespace serosa::sim
