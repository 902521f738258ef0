#pragma once
// What lies in a scene and does not move: a floor, a table, a bone. Organs rest on it and slide along it.

#include "sim/rigid_shape.h"

#include <string>

namespace serosa::sim {

struct Body {
    std::string name;
    RigidShape shape;
    RigidPose pose;
    double friction = 0; // Coulomb's coefficient against tissue
    int line = 0;        // of the scene file, for messages; 0: none
};

} // namespace serosa::sim
