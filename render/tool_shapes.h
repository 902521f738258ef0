#pragma once
// What is drawn of a scene's tools and bodies at a time: shapes with poses. Jaws are drawn as two pads that
// close on what they hold, with a shaft; a floor as a patch below the organs.

#include "sim/scene.h"

#include <vector>

namespace serosa::render {

enum class Finish { steel, matte, floor };

struct DrawnShape {
    sim::RigidShape shape; // metres
    sim::RigidPose pose;
    Finish finish = Finish::steel;
    double extent = 0; // floor, m: half the side of its patch, about the pose's place
};

/// \param lowest, highest bounds of the organs at rest, m: a floor's patch lies about them
std::vector<DrawnShape> drawnShapes(const sim::Scene& scene, double time, const glm::dvec3& lowest,
                                    const glm::dvec3& highest);
/// One tool; nothing of a live one that rests.
std::vector<DrawnShape> drawnTool(const sim::Tool& tool, double time);

} // namespace serosa::render
