#pragma once
// The scene reader's part about an organ, `[[organ]]` and all below it. Private to sim/scene_reader*.cpp.

#include "sim/scene_table.h"

#include <filesystem>
#include <string>

namespace serosa::sim {

/// \param path of the organ in messages: "organ[0]". \param folder that the model's path is relative to.
Status readOrgan(const SceneSource& source, const toml::table& content, const std::string& path,
                 const std::filesystem::path& folder, Organ& organ);

/// `[organ.tissue]` and the organ's `[[organ.material]]`s. \param organ the organ's table.
Status readTissue(const SceneSource& source, const SceneTable& organ, const std::string& path,
                  Tissue& tissue);

/// `[[organ.region]]`s, after the tissue. Errors: also a material that no region names.
Status readMaterialRegions(const SceneSource& source, const SceneTable& organTable, const std::string& path,
                           Organ& organ);

/// `[[organ.fixed]]`s.
Status readFixedRegions(const SceneSource& source, const SceneTable& organTable, const std::string& path,
                        Organ& organ);

/// "organ[0].region[2]"
inline std::string itemPath(const std::string& path, const char* key, std::size_t index) {
    return path + "." + key + "[" + std::to_string(index) + "]";
}

} // namespace serosa::sim
