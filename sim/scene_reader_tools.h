#pragma once
// The scene reader's part about what is rigid, `[[tool]]` and `[[body]]`. Private to sim/scene_reader*.cpp.

#include "sim/scene_table.h"

#include <filesystem>

namespace serosa::sim {

/// \param top the file's top table. \param folder that models' paths are relative to. Reads meshes. Errors:
/// also too many of them, keys that do not belong to a shape, a mesh that is open, too large or too thin.
Status readToolsAndBodies(const SceneSource& source, const SceneTable& top,
                          const std::filesystem::path& folder, Scene& scene);

} // namespace serosa::sim
