#pragma once
// Which axis of a model file points up. The world is right-handed with y up; a model of another convention is
// turned, by a quarter or half turn that only exchanges and negates coordinates, so that no digit is lost.

#include <glm/glm.hpp>

namespace serosa::sim {

/// In the order of the words of scene key `up_axis`: "y", "x", "z", "-y", "-x", "-z".
enum class UpAxis { y, x, z, minusY, minusX, minusZ };

/// A proper rotation that takes the named axis of the file to +y of the world: z up gives (x, z, -y).
constexpr glm::dvec3 worldFromFile(UpAxis up, const glm::dvec3& p) {
    switch (up) {
    case UpAxis::x:
        return {-p.y, p.x, p.z};
    case UpAxis::z:
        return {p.x, p.z, -p.y};
    case UpAxis::minusY:
        return {p.x, -p.y, -p.z};
    case UpAxis::minusX:
        return {p.y, -p.x, p.z};
    case UpAxis::minusZ:
        return {p.x, -p.z, p.y};
    case UpAxis::y:
        break;
    }
    return p;
}

/// Its inverse.
constexpr glm::dvec3 fileFromWorld(UpAxis up, const glm::dvec3& p) {
    switch (up) {
    case UpAxis::x:
        return worldFromFile(UpAxis::minusX, p);
    case UpAxis::z:
        return worldFromFile(UpAxis::minusZ, p);
    case UpAxis::minusX:
        return worldFromFile(UpAxis::x, p);
    case UpAxis::minusZ:
        return worldFromFile(UpAxis::z, p);
    case UpAxis::y:
    case UpAxis::minusY:
        break;
    }
    return worldFromFile(up, p); // a half turn is its own inverse
}

} // namespace serosa::sim
