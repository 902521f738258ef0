#pragma once
// A box of object space.

#include <glm/glm.hpp>

namespace serosa::render {

struct Bounds {
    glm::dvec3 lowest{0}, highest{0}; // m
};

} // namespace serosa::render
