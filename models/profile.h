#pragma once
// Bodies of revolution about the y axis, from a drawn profile.

#include "models/sdf.h"

#include <vector>

namespace serosa::models {

class Profile {
public:
    /// A smooth curve through `control`, points (radius, y) in mm that run from the axis (radius 0) round the
    /// outside and back to the axis, clockwise as seen with the radius to the right and y up.
    explicit Profile(const std::vector<glm::dvec2>& control);

    /// Signed distance at `radius` (at least 0) from the axis and height y; exact for the curve, which is
    /// sampled every 0.5 mm.
    double distance(double radius, double y) const;

private:
    std::vector<glm::dvec2> points_;
};

} // namespace serosa::models
