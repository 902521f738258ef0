// See sim/region.h.
#include "sim/region.h"

namespace serosa::sim {

bool Region::contains(const glm::dvec3& world) const {
    switch (shape) {
    case Shape::halfSpace:
        return below ? world[axis] < *below : world[axis] > *above;
    case Shape::box:
        return glm::all(glm::greaterThanEqual(world, lowest)) && glm::all(glm::lessThanEqual(world, highest));
    case Shape::sphere:
        return glm::distance(world, centre) <= radius;
    }
    return false;
}

} // namespace serosa::sim
