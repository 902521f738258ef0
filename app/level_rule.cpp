// See app/level_rule.h.
#include "app/level_rule.h"

#include "sim/shape_distance.h"

#include <algorithm>
#include <cmath>

namespace serosa::app {

namespace {

constexpr double kNear = 4;                 // coarsest spacings from a tool
constexpr int kFramesAhead = 20;            // that a tool or a cut is seen before it comes
constexpr double kFast = 0.2, kCalm = 0.02; // finest spacings a frame

/// A sphere around the organ as it lies, m.
struct Bounds {
    glm::dvec3 centre{0};
    double radius = 0;
};
Bounds boundsOf(const sim::Lattice& lattice, const sim::LatticeState& state) {
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const glm::dvec3& x : state.positions) {
        low = glm::min(low, x);
        high = glm::max(high, x);
    }
    return {lattice.toWorld(0.5 * (low + high)), 0.5 * lattice.spacing * glm::length(high - low)};
}

bool toolNear(const sim::Scene& scene, const Bounds& organ, double distance, double now, double until) {
    for (const sim::Tool& tool : scene.tools) {
        const double reach = sim::boundingRadius(tool.wholeShape()) + organ.radius + distance;
        for (double time = now; time <= until; time += 0.25 * (until - now))
            if (tool.activeAt(time) && glm::distance(tool.poseAt(time).at, organ.centre) < reach)
                return true;
    }
    return false;
}

bool cutMoves(const sim::Scene& scene, double now, double until) {
    return std::any_of(scene.cuts.begin(), scene.cuts.end(), [&](const sim::Cut& cut) {
        return cut.keys.front().time <= until && cut.keys.back().time >= now;
    });
}

} // namespace

int scriptedLevel(const sim::Organ& organ, double time) {
    int level = 1;
    for (const sim::LevelKey& key : organ.levelKeys)
        if (key.time <= time + 1e-9)
            level = key.level;
    return level;
}

RuledLevel ruledLevel(const LevelScene& what, const sim::Lattice& lattice, const sim::LatticeState& state,
                      int frame) {
    const double now = frame / what.scene->frameRate, until = (frame + kFramesAhead) / what.scene->frameRate;
    const double coarsest = what.finest * (1 << (what.organ->levels - 1));
    if (cutMoves(*what.scene, now, until) ||
        toolNear(*what.scene, boundsOf(lattice, state), kNear * coarsest, now, until))
        return {1, true};
    double fastest2 = 0; // lattice units a step
    for (const glm::dvec3& u : state.increments)
        fastest2 = std::max(fastest2, glm::dot(u, u));
    const double speed = std::sqrt(fastest2) * what.stepsAFrame * lattice.spacing / what.finest;
    return {speed > kFast ? 1 : speed > kCalm ? std::min(2, what.organ->levels) : what.organ->levels, false};
}

} // namespace serosa::app
