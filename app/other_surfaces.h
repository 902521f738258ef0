#pragma once
// `--surface ORGAN=FILE`: a scene with another surface for one of its organs, such as a phantom's scene with
// a scan.
//
// A scene's boxes, regions and camera fit its own surface. So the other one is scaled evenly until its
// longest side is that of the organ's own, and moved until the middles of both boxes meet. Where a unit is
// given it keeps its own size and place instead.

#include "base/result.h"
#include "sim/scene.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace serosa::app {

struct OtherSurfaces {
    std::vector<std::string> wanted;   // "ORGAN=FILE"; a scene of one organ: also "FILE"
    std::optional<sim::UpAxis> upAxis; // of these files; nothing: y
    std::optional<double> lengthUnit;  // m, of these files; nothing: they are fitted
    bool repair = false;               // mend them
};

/// Puts them into a scene as its organs' models. Errors: an organ that the scene has not, of the files.
Status takeSurfaces(const OtherSurfaces& others, sim::Scene& scene);

} // namespace serosa::app
