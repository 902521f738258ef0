#pragma once
// Scripted cuts of a scene: a blade that follows timed key poses, or a ball of tissue burnt away at each key.

#include "sim/blade.h"

#include <glm/glm.hpp>

#include <vector>

namespace serosa::sim {

struct CutKey {
    double time = 0;          // s
    glm::dvec3 at{0}, end{0}; // m, world: ends of the blade's edge; cauterize: `at` is the ball's centre
};

struct Cut {
    StrokeKind kind = StrokeKind::blade; // blade or cauterize
    double radius = 0.003;               // cauterize, m
    std::vector<CutKey> keys;            // strictly increasing times; a blade has at least two

    /// What it does after `from` and until `to`, s: a blade sweeps on, in a straight line between keys, and
    /// the parts of its stroke continue each other; balls burn at their keys. A key at 0 belongs to the time
    /// after it.
    std::vector<Stroke> strokes(double from, double to) const;
};

} // namespace serosa::sim
