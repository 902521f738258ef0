#pragma once
// The scene reader's part about the volume that colours the faces of cuts, `[look.cut_volume]`. Private to
// sim/scene_reader*.cpp.

#include "sim/scene_table.h"

#include <filesystem>

namespace serosa::sim {

/// After `look`. Errors: also where nothing is ray-cast, and what has no effect. \param folder that the file
/// is relative to.
Status readCutVolume(const SceneSource& source, const SceneTable& look, const std::filesystem::path& folder,
                     Scene& scene);

} // namespace serosa::sim
