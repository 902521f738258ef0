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

} // namespace

Status readOrgan(const SceneSource& source, const toml::table& content, const std::string& path,
                 const fs::path& folder, Organ& organ) {
    const SceneTable table(source, "organ", path, &content);
    SEROSA_TRY(table.checkKeys());
    SEROSA_TRY(table.read("name", organ.name));
    SEROSA_TRY(readModel(table, folder, organ));
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
    for (const char* key : {"tear_strain", "material", "region"})
        if (table.has(key) && table.has("pose"))
            return table.errorAt(key, "has no effect beside 'pose': keep one of the two");
    SEROSA_TRY(readTissue(source, table, path, organ.tissue));
    SEROSA_TRY(readMaterialRegions(source, table, path, organ));
    SEROSA_TRY(readFixedRegions(source, table, path, organ));
    SEROSA_ASSIGN(const toml::table* pose, table.table("pose"));
    if (pose) {
        const SceneTable poseTable(source, "organ.pose", path + ".pose", pose);
        SEROSA_TRY(poseTable.checkKeys());
        organ.pose.emplace();
        SEROSA_TRY(poseTable.read("bend_radius", organ.pose->bendRadius));
    }
    return {};
}

} // namespace serosa::sim
