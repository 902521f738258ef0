#pragma once
// Parts of an organ that a scene names: `[[organ.fixed]]` by place, `[[organ.region]]` by place, by depth
// below the surface, or by the paint on it.

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>

namespace serosa::sim {

/// A part of the world.
struct Region {
    enum class Shape { halfSpace, box, sphere } shape = Shape::halfSpace;
    int line = 0;                       // of the scene file, for messages; 0: none
    int axis = 1;                       // half-space: 0 x, 1 y, 2 z (`axis = "y"`)
    std::optional<double> below, above; // half-space: m; exactly one
    glm::dvec3 lowest{0}, highest{0};   // box: `min`, `max`, m
    glm::dvec3 centre{0};               // sphere, m
    double radius = 0;                  // sphere, m
    bool contains(const glm::dvec3& world) const;
};

/// The cells that a material takes. A cell belongs by its centre; sim/assign_materials.h has the rules.
struct MaterialRegion {
    enum class Kind { place, layer, painted } kind = Kind::place;
    std::size_t material = 0;    // index into the organ's tissue
    Region place;                // kind place; its line holds for all kinds
    double from = 0;             // m below the surface, layer and painted: deeper than this
    std::optional<double> depth; // m, and at most this deep; a layer has one
    glm::u8vec3 colour{0};       // painted: sRGB of the surface's vertices,
    int tolerance = 8;           // each channel within this
};

} // namespace serosa::sim
