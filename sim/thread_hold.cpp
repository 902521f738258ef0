// See sim/thread_hold.h.
#include "sim/thread_hold.h"

#include "base/check.h"
#include "sim/cell_volumes.h"
#include "sim/triangle_tree.h"

#include <algorithm>
#include <cmath>

namespace serosa::sim {

glm::dvec3 ThreadSpan::of(const std::vector<glm::dvec3>& values) const {
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        sum += weights[i] * values[nodes[i]];
    return sum;
}

ThreadAnchor anchorAt(const Lattice& lattice, const glm::dvec3& world, double& distance) {
    const glm::dvec3 at = lattice.toLattice(world) + glm::dvec3(lattice.centre); // grid coordinates
    // Of cells that share the place, the first; which one changes nothing.
    for (const LatticeCell& cell : lattice.cells) {
        const glm::dvec3 in = at - glm::dvec3(cell.grid);
        constexpr double kRounding = 1e-9;
        if (!(in.x >= -kRounding && in.y >= -kRounding && in.z >= -kRounding && in.x <= 1 + kRounding &&
              in.y <= 1 + kRounding && in.z <= 1 + kRounding))
            continue;
        distance = 0;
        ThreadAnchor anchor;
        anchor.nodes = cornersOf(lattice, cell);
        for (int c = 0; c < 8; ++c) {
            const glm::dvec3 part = glm::mix(1.0 - in, in, glm::dvec3(cornerOffset(c)));
            anchor.weights[std::size_t(c)] = part.x * part.y * part.z;
        }
        return anchor;
    }
    std::vector<glm::dvec3> rest;
    for (const glm::ivec3& node : lattice.nodes)
        rest.emplace_back(node);
    const TriangleTree tree(std::move(rest), lattice.boundary);
    const TriangleTree::Closest closest = tree.closest(at);
    SEROSA_CHECK(closest, "a lattice with a boundary");
    distance = lattice.spacing * std::sqrt(closest.distance2);
    const glm::uvec3 corners = lattice.boundary[closest.triangle];
    ThreadAnchor anchor;
    anchor.nodes.fill(corners.x);
    for (int i = 0; i < 3; ++i) {
        anchor.nodes[std::size_t(i)] = corners[i];
        anchor.weights[std::size_t(i)] = closest.weights[i];
    }
    return anchor;
}

bool threadTied(const Thread& thread, std::int64_t step, double timeStep) {
    return double(step) * timeStep + 1e-6 * timeStep >= thread.time;
}

double threadMeanShare(double timeStep) {
    return 1 - std::exp(-timeStep / SRS_THREAD_MEAN);
}

double threadLengthAt(const ThreadSpan& span, double startLength, double time, double timeStep) {
    const Thread& thread = span.thread;
    const double way = startLength - thread.length;
    if (way < 0 && !thread.clip) // slack
        return thread.length;
    const double within = std::max(thread.tightening, std::abs(way) / span.pull * timeStep);
    const double share = within > 0 ? std::clamp((time - thread.time) / within, 0.0, 1.0) : 1;
    return thread.length + way * (1 - share);
}

std::vector<ThreadSpan> threadSpans(const CoupledGroup& group, const std::vector<TiedThread>& threads) {
    std::vector<ThreadSpan> spans;
    for (const TiedThread& thread : threads) {
        ThreadSpan span;
        span.thread = thread.thread;
        double spacing = group.length;
        std::vector<std::pair<std::uint32_t, double>> sum; // each node once
        for (std::size_t end = 0; end < 2; ++end) {
            spacing = std::min(spacing, group.organs[thread.organs[end]].lattice->spacing);
            for (std::size_t i = 0; i < 8; ++i) {
                const std::int64_t node = group.find(thread.organs[end], thread.anchors[end].nodes[i]);
                SEROSA_CHECK(node >= 0, "the group has the nodes of its threads");
                const double weight = thread.anchors[end].weights[i] * (end == 0 ? 1 : -1);
                const auto same = std::find_if(sum.begin(), sum.end(), [node](const auto& entry) {
                    return entry.first == std::uint32_t(node);
                });
                if (same != sum.end())
                    same->second += weight;
                else
                    sum.emplace_back(std::uint32_t(node), weight);
            }
        }
        span.pull = SRS_THREAD_PULL * spacing;
        span.nodes.fill(sum.front().first);
        for (std::size_t i = 0; i < sum.size(); ++i) {
            span.nodes[i] = sum[i].first;
            span.weights[i] = sum[i].second;
        }
        spans.push_back(span);
    }
    return spans;
}

ThreadHold::ThreadHold(const CoupledGroup& group, const std::vector<TiedThread>& threads, double timeStep)
    : group_(group), spans_(threadSpans(group, threads)), timeStep_(timeStep) {}

void ThreadHold::solve(std::int64_t step, CoupledMotion& motion, std::vector<ThreadState>& states) const {
    SEROSA_CHECK(states.size() == spans_.size(), "one state a thread");
    const double start = double(step) * timeStep_, end = double(step + 1) * timeStep_;
    const double newton = group_.mass * group_.length / (timeStep_ * timeStep_); // a unit of impulse a step
    std::vector<double> given(spans_.size(), 0);                                 // pull, group units
    for (std::size_t i = 0; i < spans_.size(); ++i)
        if (threadTied(spans_[i].thread, step, timeStep_) && states[i].startLength < 0)
            states[i].startLength = glm::length(spans_[i].of(motion.positions)) * group_.length;
    const auto holds = [&](std::size_t i) { return states[i].startLength >= 0 && !states[i].broken; };
    const auto lengthAt = [&](std::size_t i, double time) {
        return threadLengthAt(spans_[i], states[i].startLength, time, timeStep_);
    };
    for (int sweep = 0; sweep < SRS_THREAD_SWEEPS; ++sweep)
        for (std::size_t i = 0; i < spans_.size(); ++i) {
            if (!holds(i))
                continue;
            const ThreadSpan& span = spans_[i];
            const glm::dvec3 began = span.of(motion.positions), now = began + span.of(motion.increments);
            const double distance = glm::length(now), length = lengthAt(i, end) / group_.length;
            double answer = 0; // 1/mass of the span
            for (std::size_t k = 0; k < span.nodes.size(); ++k)
                answer += span.weights[k] * span.weights[k] * motion.inverseMass[span.nodes[k]];
            if (!(distance > 1e-9) || !(answer > 0))
                continue;
            glm::dvec3 direction = now / distance;
            double shift = distance - length;
            if (glm::dot(began, now) > 0.5 * glm::length(began) * distance) {
                const glm::dvec3 first = glm::normalize(began);
                const double along = glm::dot(now, first);
                const glm::dvec3 aside = now - along * first;
                const double inside = length * length - glm::dot(aside, aside);
                if (inside >= 0) {
                    direction = first;
                    shift = along - std::sqrt(inside);
                }
            }
            double pull = given[i] + shift / answer;
            if (!span.thread.clip)
                pull = std::max(pull, 0.0);
            const glm::dvec3 impulse = (pull - given[i]) * direction; // from the first end on
            given[i] = pull;
            for (std::size_t k = 0; k < span.nodes.size(); ++k)
                motion.increments[span.nodes[k]] -=
                    span.weights[k] * motion.inverseMass[span.nodes[k]] * impulse;
        }
    for (std::size_t i = 0; i < spans_.size(); ++i) {
        if (!holds(i))
            continue;
        ThreadState& state = states[i];
        const double force = given[i] * newton;
        state.impulse += force * timeStep_;
        state.work += std::max(0.0, force * (lengthAt(i, start) - lengthAt(i, end)));
        state.force += (std::abs(force) - state.force) * threadMeanShare(timeStep_);
        state.mostForce = std::max(state.mostForce, state.force);
        if (state.force > spans_[i].thread.strength) {
            state.broken = true;
            state.brokenAfter = end - spans_[i].thread.time;
            state.force = 0;
        }
    }
}

} // namespace serosa::sim
