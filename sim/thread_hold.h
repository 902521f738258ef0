#pragma once
// Threads and clips at work (sim/thread.h): after each step, each keeps its two ends together by a constraint
// on positions (as SHAKE: Ryckaert, Ciccotti & Berendsen 1977, Numerical Integration of the Cartesian
// Equations of Motion of a System with Constraints), and breaks where that takes more force than it carries.
// For CPU solvers, in double; shaders/thread_hold.comp is its twin on the GPU.
//
// An end is a material point: weights over the nodes of the cell that holds its place at rest, or, outside of
// all cells, of the nearest triangle of the lattice's boundary. With P, Q the ends, L the length that is
// asked for, and n = (P - Q)/|P - Q| as the step began: the impulse along n that makes |P - Q| = L at its
// end, shared by the weights, equal and opposite, so that momentum and angular momentum are kept (a span that
// turns so far in one step that no impulse along n does it takes n as the step ended). A suture only pulls.
// Threads are taken in their order, SRS_THREAD_SWEEPS times; each adds to the impulse that it has given in
// the step.
//
// L goes from the distance at the time when the thread is tied to its length, evenly within `tightening`, but
// by no more than SRS_THREAD_PULL spacings a step. The force is the step's impulse over its time, averaged
// with weights that fall off by e in SRS_THREAD_MEAN seconds; above `strength` the thread breaks for good.

#include "sim/pair_contact.h"
#include "sim/thread.h"

#include <array>
#include <cstdint>
#include <vector>

namespace serosa::sim {

/// Material point of an organ: sum of weight times node. Weights sum to 1; places that are not needed have
/// weight 0 and repeat a node.
struct ThreadAnchor {
    std::array<std::uint32_t, 8> nodes{};
    std::array<double, 8> weights{};
};

/// The material point at a place at rest. \param distance receives how far (m) the place lies outside the
/// lattice's cells; the anchor is then the nearest point of their boundary.
ThreadAnchor anchorAt(const Lattice& lattice, const glm::dvec3& world, double& distance);

/// A thread of a group of organs.
struct TiedThread {
    Thread thread;
    std::uint32_t organs[2] = {0, 0}; // of the group
    ThreadAnchor anchors[2];          // lattice nodes
};

/// What is known of a thread beside the scene.
struct ThreadState {
    double startLength = -1; // m, when it was tied; negative before that
    double force = 0;        // N, averaged
    double mostForce = 0;    // N: the largest of these so far
    bool broken = false;
    double brokenAfter = 0; // s after it was tied, where it is broken
    // Since they were last taken:
    double impulse = 0; // N s
    double work = 0;    // J, by drawing in
};

/// P - Q of a thread as one sum over nodes of the group: weights of the first end less those of the second.
struct ThreadSpan {
    Thread thread;
    std::array<std::uint32_t, 16> nodes{};
    std::array<double, 16> weights{};
    double pull = 0; // m a step: the most that it is drawn in by

    glm::dvec3 of(const std::vector<glm::dvec3>& values) const;
};
/// One a thread. \param group has all nodes of the anchors
std::vector<ThreadSpan> threadSpans(const CoupledGroup& group, const std::vector<TiedThread>& threads);

class ThreadHold {
public:
    /// \param group has all nodes of the anchors; outlives this. \param timeStep s.
    ThreadHold(const CoupledGroup& group, const std::vector<TiedThread>& threads, double timeStep);

    /// Step number `step` (from step * dt on): changes increments and states.
    void solve(std::int64_t step, CoupledMotion& motion, std::vector<ThreadState>& states) const;

private:
    const CoupledGroup& group_;
    std::vector<ThreadSpan> spans_; // one a thread
    double timeStep_;
};

/// Length that a tied thread is drawn in to at a time, m.
double threadLengthAt(const ThreadSpan& span, double startLength, double time, double timeStep);
/// Is it tied in step number `step`?
bool threadTied(const Thread& thread, std::int64_t step, double timeStep);
/// Share of a step's force in the average.
double threadMeanShare(double timeStep);

} // namespace serosa::sim
