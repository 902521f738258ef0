// See sim/scene_reader_organ.h: an organ's own keys, its model and its pose.
#include "sim/scene_reader_organ.h"

namespace serosa::sim {

namespace {

namespace fs = std::filesystem;

Status readModel(const SceneTable& table, const fs::path& folder, Organ& organ) {
    std::string model, unit = "mm"; // both required
    SEROSA_TRY(table.read("model", model));
    organ.model = fs::path(model).is_absolute() ? fs::path(model) : folder / model;
    organ.modelLine = table.lineOf("model");
    std::error_code code;
    if (!fs::exists(organ.model, code))
        return table.errorAt("model", "no such file: " + organ.model.string());
    if (!fs::is_regular_file(organ.model, code))
        return table.errorAt("model", organ.model.string() + " is not a file");
    enum class Unit { first } word = Unit::first;
    SEROSA_TRY(table.readWord("length_unit", word));
    SEROSA_ASSIGN(organ.lengthUnit,
                  parseLengthUnit(findSceneKey("organ", "length_unit")->words[std::size_t(word)]));
    return {};
}

Status readLook(const SceneTable& table, const fs::path& folder, OrganLook& look) {
    SEROSA_TRY(table.checkKeys());
    SEROSA_TRY(table.readWord("texture", look.texture));
    const auto picture = [&](const char* key, fs::path& file, int& line) -> Status {
        std::string name;
        if (!table.has(key))
            return {};
        SEROSA_TRY(table.read(key, name));
        if (look.texture != TissueTexture::none)
            return table.errorAt(key, "stands beside 'texture': keep one of the two");
        file = fs::path(name).is_absolute() ? fs::path(name) : folder / name;
        line = table.lineOf(key);
        std::error_code code;
        if (!fs::is_regular_file(file, code))
            return table.errorAt(key, (fs::exists(file, code) ? "is not a file: " : "no such file: ") +
                                          file.string());
        return {};
    };
    SEROSA_TRY(picture("albedo", look.albedo, look.albedoLine));
    SEROSA_TRY(picture("normal", look.normal, look.normalLine));
    SEROSA_TRY(picture("height", look.height, look.heightLine));
    SEROSA_TRY(table.read("tile", look.tile));
    SEROSA_TRY(table.read("relief", look.relief));
    const OrganLook plain;
    for (const auto& [key, differs] :
         {std::pair{"tile", look.tile != plain.tile}, {"relief", look.relief != plain.relief}})
        if (differs && !look.textured())
            return table.errorAt(key, "has no effect without a texture or a picture: remove it");
    return {};
}

Status readMethod(const SceneTable& table, Organ& organ) {
    SEROSA_TRY(table.readWord("method", organ.method));
    organ.methodLine = table.lineOf("method");
    if (organ.method == StepMethod::implicit && organ.levels > 1)
        return table.errorAt("method", "is \"implicit\", which levels of detail do not know yet: keep one of "
                                       "'levels' and 'method'");
    return {};
}

Status readLevels(const SceneSource& source, const SceneTable& table, const std::string& path, Organ& organ) {
    SEROSA_TRY(table.read("levels", organ.levels));
    enum class Way { scripted, byRule } way = Way::scripted;
    SEROSA_TRY(table.readWord("level_of_detail", way));
    organ.levelsByRule = way == Way::byRule;
    SEROSA_ASSIGN(const auto keys, table.tables("level"));
    for (const char* key : {"levels", "level_of_detail", "level"})
        if (table.has(key) && table.has("pose"))
            return table.errorAt(key, "has no effect beside 'pose': keep one of the two");
    if (organ.levels == 1)
        for (const char* key : {"level_of_detail", "level"})
            if (table.has(key) && (key != std::string("level_of_detail") || organ.levelsByRule))
                return table.errorAt(key, "has no effect on an organ of one level: set 'levels' to 2 or 3");
    if (organ.levelsByRule && table.has("level"))
        return table.errorAt("level", "has no effect beside level_of_detail = \"auto\": keep one of the two");
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const SceneTable keyTable(source, "organ.level", itemPath(path, "level", i), keys[i]);
        SEROSA_TRY(keyTable.checkKeys());
        LevelKey key;
        SEROSA_TRY(keyTable.read("t", key.time));
        SEROSA_TRY(keyTable.read("level", key.level));
        if (key.level > organ.levels)
            return keyTable.errorAt("level", "is " + std::to_string(key.level) + ", and the organ has " +
                                                 std::to_string(organ.levels) + " levels: raise 'levels'");
        if (!organ.levelKeys.empty() && key.time <= organ.levelKeys.back().time)
            return keyTable.errorAt("t", "is not after the change before it: times must increase");
        organ.levelKeys.push_back(key);
    }
    return {};
}

} // namespace

Status readOrgan(const SceneSource& source, const toml::table& content, const std::string& path,
                 const fs::path& folder, Organ& organ) {
    const SceneTable table(source, "organ", path, &content);
    SEROSA_TRY(table.checkKeys());
    SEROSA_TRY(table.read("name", organ.name));
    SEROSA_TRY(readModel(table, folder, organ));
    SEROSA_TRY(table.read("at", organ.at));
    SEROSA_TRY(table.readWord("up_axis", organ.upAxis));
    SEROSA_TRY(table.read("repair", organ.repair));
    if (table.has("nodes") && table.has("spacing"))
        return table.errorAt("spacing", "stands beside 'nodes': keep one of the two");
    if (table.has("spacing"))
        SEROSA_TRY(table.read("spacing", organ.spacing));
    else
        SEROSA_TRY(table.read("nodes", organ.nodes));

    std::optional<double> tearStrain;
    SEROSA_TRY(table.read("tear_strain", tearStrain));
    organ.tearStrain = tearStrain.value_or(0);
    SEROSA_TRY(table.read("self_contact", organ.selfContact));
    organ.selfContactLine = table.lineOf("self_contact");
    for (const char* key : {"tear_strain", "self_contact", "material", "region", "method"})
        if (table.has(key) && table.has("pose"))
            return table.errorAt(key, "has no effect beside 'pose': keep one of the two");
    SEROSA_TRY(readTissue(source, table, path, organ.tissue));
    SEROSA_TRY(readMaterialRegions(source, table, path, organ));
    SEROSA_TRY(readFixedRegions(source, table, path, organ));
    SEROSA_TRY(readLevels(source, table, path, organ));
    SEROSA_TRY(readMethod(table, organ));
    SEROSA_ASSIGN(const toml::table* pose, table.table("pose"));
    if (pose) {
        const SceneTable poseTable(source, "organ.pose", path + ".pose", pose);
        SEROSA_TRY(poseTable.checkKeys());
        organ.pose.emplace();
        SEROSA_TRY(poseTable.read("bend_radius", organ.pose->bendRadius));
    }
    SEROSA_ASSIGN(const toml::table* look, table.table("look"));
    SEROSA_TRY(readLook({source, "organ.look", path + ".look", look}, folder, organ.look));
    return {};
}

} // namespace serosa::sim
