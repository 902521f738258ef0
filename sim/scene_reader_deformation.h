#pragma once
// The scene reader's part about what is ray-cast and deformed in the picture. Private to
// sim/scene_reader*.cpp.

#include "sim/scene_table.h"

namespace serosa::sim {

/// `[deformation]`, after `[look]`. Errors: also where nothing is ray-cast, and a kind without what it needs.
Status readDeformation(const SceneSource& source, const SceneTable& top, Scene& scene);

} // namespace serosa::sim
