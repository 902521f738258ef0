#pragma once
// A suture's thread or a clip: two places of organs that it keeps together, up to a force.

#include <glm/glm.hpp>

#include <limits>
#include <string>

namespace serosa::sim {

/// An end: the material point of an organ that rests nearest to a place.
struct ThreadEnd {
    std::string organ; // name
    glm::dvec3 at{0};  // m, world, at rest
    int line = 0;      // of the scene file, for messages
};

/// From `time` on the ends are at most `length` apart (a clip: exactly), until that takes more than
/// `strength`.
struct Thread {
    std::string name;
    ThreadEnd ends[2];
    double time = 0;       // s: tied then
    double length = 0;     // m, at least; drawn in to this within `tightening`
    double tightening = 0; // s
    bool clip = false;     // also pushes
    double strength = std::numeric_limits<double>::infinity(); // N: it breaks
    int line = 0;                                              // of the scene file, for messages
};

} // namespace serosa::sim
