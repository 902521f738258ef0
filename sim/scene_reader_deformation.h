#pragma once
// The scene reader's part about what is ray-cast and deformed in the picture. Private to
// sim/scene_reader*.cpp.

#include "sim/scene_table.h"

#include <filesystem>

namespace serosa::sim {

/// `[deformation]` or several `[[deformation]]`, after `[look]`. Errors: also where nothing is ray-cast, and
/// a kind without what it needs, or with what it does not know. \param folder of the scene file
Status readDeformations(const SceneSource& source, const SceneTable& top, const std::filesystem::path& folder,
                        Scene& scene);

} // namespace serosa::sim
