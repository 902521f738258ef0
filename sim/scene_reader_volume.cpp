// See sim/scene_reader_volume.h.
#include "sim/scene_reader_volume.h"

#include <algorithm>
#include <string>

namespace serosa::sim {

namespace fs = std::filesystem;

Status readCutVolume(const SceneSource& source, const SceneTable& look, const fs::path& folder,
                     Scene& scene) {
    SEROSA_ASSIGN(const toml::table* const content, look.table("cut_volume"));
    if (!content)
        return {};
    const std::string path = "look.cut_volume";
    const SceneTable table(source, path, path, content);
    SEROSA_TRY(table.checkKeys());
    CutVolume volume;
    std::string file;
    SEROSA_TRY(table.read("file", file));
    volume.file = folder / file; // an absolute one stays
    volume.line = table.lineOf("file");
    std::error_code code;
    if (!fs::is_regular_file(volume.file, code))
        return table.errorAt("file", (fs::exists(volume.file, code) ? "is not a file: " : "no such file: ") +
                                         volume.file.string());
    SEROSA_TRY(table.read("at", volume.at));
    SEROSA_TRY(table.readWord("up_axis", volume.upAxis));
    SEROSA_TRY(table.read("level", volume.level));
    SEROSA_TRY(table.read("width", volume.width));
    volume.windowed = table.has("level") || table.has("width");
    SEROSA_ASSIGN(const auto labels, table.tables("label"));
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const SceneTable label(source, path + ".label", path + ".label[" + std::to_string(i) + "]",
                               labels[i]);
        SEROSA_TRY(label.checkKeys());
        int value = 0;
        glm::ivec3 colour(0);
        SEROSA_TRY(label.read("value", value));
        SEROSA_TRY(label.read("colour", colour));
        if (std::any_of(volume.labels.begin(), volume.labels.end(),
                        [value](const auto& other) { return other.first == value; }))
            return label.errorAt("value", std::to_string(value) + " has a colour already: keep one");
        volume.labels.emplace_back(value, colour);
    }
    for (const char* const key : {"level", "width"})
        if (!labels.empty() && table.has(key))
            return table.errorAt(key, "has no effect beside labels, which have colours: remove it");
    if (scene.look.show == Show::surface)
        return table.errorAt("file", "has no effect: surfaces are drawn; set look.show = \"implicit\" or "
                                     "\"both\"");
    if (scene.look.interior == Interior::hollow || scene.look.interior == Interior::combined)
        return table.errorAt("file", "has no effect on what is hollow: set look.interior = \"solid\" or "
                                     "\"shell\"");
    scene.look.cutVolume = std::move(volume);
    return {};
}

} // namespace serosa::sim
