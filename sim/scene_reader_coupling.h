#pragma once
// The scene reader's part about organs that touch and the threads between them. Private to
// sim/scene_reader*.cpp.

#include "sim/scene_table.h"

#include <vector>

namespace serosa::sim {

/// `organs_touch` and `organ_friction`.
Status readOrganContact(const SceneTable& top, Scene& scene);

/// `[[thread]]`s, after the organs. Errors: also an end on an organ that is not there or is not simulated.
Status readThreads(const SceneSource& source, const SceneTable& top, Scene& scene);

/// What is asked of organs that touch, touch themselves or are tied, once all tables are read: keys without
/// effect, and combinations that are not supported. \param organs the tables of the scene's organs
Status checkCoupling(const SceneSource& source, const SceneTable& top,
                     const std::vector<const toml::table*>& organs, const Scene& scene);

} // namespace serosa::sim
