// See render/stage_box.h.
#include "render/stage_box.h"

#include <algorithm>

namespace serosa::render {

StageBox StageBox::of(const Warp& warp, const std::array<FaceOfBox, 6>& faces, double width) {
    StageBox made;
    made.mapping = warp.mapping;
    made.half = warp.texture->half();
    const glm::dmat3 axes = warp.mapping.jacobian(glm::dvec3(0));
    for (int axis = 0; axis < 3; ++axis) {
        const double seam = std::min(width / glm::length(axes[axis]), 0.5 * made.half[axis]);
        made.seamLow[axis] = faces[std::size_t(2 * axis)].still ? seam : 0;
        made.seamHigh[axis] = faces[std::size_t(2 * axis + 1)].still ? seam : 0;
    }
    return made;
}

void StageBox::set(gpu::Program& program, const glm::dvec3& origin, double unit) const {
    glm::dmat4 worldFromObject(unit);
    worldFromObject[3] = glm::dvec4(origin, 1);
    program.set("u_stageFromObject", glm::mat4(glm::inverse(mapping.objectFromLocal) * worldFromObject));
    program.set("u_stageCylinder", float(mapping.cylinderRadius)).set("u_stageHalf", glm::vec3(half));
    program.set("u_seamLow", glm::vec3(seamLow)).set("u_seamHigh", glm::vec3(seamHigh));
}

} // namespace serosa::render
