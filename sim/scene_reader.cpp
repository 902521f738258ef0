// From a TOML file to a Scene. Every table is read in the order of sim/scene_keys.cpp; rules between keys
// follow each table.

#include "sim/scene_reader_coupling.h"
#include "sim/scene_reader_deformation.h"
#include "sim/scene_reader_organ.h"
#include "sim/scene_reader_tools.h"
#include "sim/scene_reader_volume.h"
#include "sim/scene_table.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <set>

namespace serosa::sim {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestSceneFile = 1 << 20; // bytes: a scene is a page of text

Result<std::string> readText(const fs::path& file) {
    std::error_code code;
    const fs::file_status status = fs::status(file, code);
    if (!fs::exists(status))
        return Error{file.string() + ": no such file" +
                     (code && code.value() != ENOENT ? " (" + code.message() + ")" : "")};
    if (!fs::is_regular_file(status))
        return Error{file.string() + " is not a file: name a scene file (.toml)"};
    const std::uintmax_t size = fs::file_size(file, code);
    if (code)
        return Error{file.string() + ": " + code.message()};
    if (size > kLargestSceneFile)
        return Error{file.string() + " has " + std::to_string(size) +
                     " bytes, more than a scene can have (1 MiB): is it the model?"};
    std::ifstream stream(file, std::ios::binary);
    std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    if (stream.bad() || text.size() != size)
        return Error{file.string() + ": cannot be read"};
    return text;
}

Status readCut(const SceneSource& source, const toml::table& content, std::size_t index, Cut& cut) {
    const std::string path = "cut[" + std::to_string(index) + "]";
    const SceneTable table(source, "cut", path, &content);
    SEROSA_TRY(table.checkKeys());
    SEROSA_TRY(table.readWord("kind", cut.kind));
    const bool blade = cut.kind == StrokeKind::blade;
    if (blade && table.has("radius"))
        return table.errorAt("radius", "has no effect on a blade: remove it");
    SEROSA_TRY(table.read("radius", cut.radius));
    SEROSA_ASSIGN(const auto keys, table.tables("keys"));
    if (keys.size() < (blade ? 2u : 1u))
        return table.errorAt("keys", blade ? "a blade needs at least two: where it begins and where it ends"
                                           : "needs at least one");
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const SceneTable keyTable(source, "cut.keys", path + ".keys[" + std::to_string(i) + "]", keys[i]);
        SEROSA_TRY(keyTable.checkKeys());
        CutKey key;
        SEROSA_TRY(keyTable.read("t", key.time));
        SEROSA_TRY(keyTable.read("at", key.at));
        SEROSA_TRY(keyTable.read("end", key.end));
        if (blade != keyTable.has("end"))
            return keyTable.errorAt("end", blade ? "is missing: a blade's edge has two ends"
                                                 : "has no effect on cauterizing: remove it");
        if (!cut.keys.empty() && key.time <= cut.keys.back().time)
            return keyTable.errorAt("t", "is not after the key before it: times must increase");
        cut.keys.push_back(key);
    }
    return {};
}

Status readCamera(const SceneTable& table, Camera& camera) {
    SEROSA_TRY(table.checkKeys());
    SEROSA_TRY(table.readWord("projection", camera.projection));
    SEROSA_TRY(table.read("eye", camera.eye));
    SEROSA_TRY(table.read("target", camera.target));
    SEROSA_TRY(table.read("direction", camera.direction));
    SEROSA_TRY(table.read("up", camera.up));
    SEROSA_TRY(table.read("fov", camera.fieldOfView));
    SEROSA_TRY(table.read("height", camera.height));
    SEROSA_TRY(table.read("zoom", camera.zoom));
    const bool perspective = camera.projection == Projection::perspective;
    if (perspective && camera.height)
        return table.errorAt("height", "belongs to an orthographic camera; a perspective one takes 'fov'");
    if (!perspective && table.has("fov"))
        return table.errorAt("fov", "belongs to a perspective camera; an orthographic one takes 'height'");
    if (camera.eye && table.has("direction"))
        return table.errorAt("direction", "has no effect beside 'eye': keep one of the two");
    if (table.has("zoom") && ((camera.eye && perspective) || camera.height))
        return table.errorAt("zoom", "has no effect beside 'eye' or 'height': remove it");
    if (camera.eye && camera.target && glm::distance(*camera.eye, *camera.target) < 1e-9)
        return table.errorAt("target", "is where 'eye' is");
    const glm::dvec3 view = camera.eye && camera.target ? *camera.target - *camera.eye : camera.direction;
    if (glm::length(camera.direction) < 1e-9)
        return table.errorAt("direction", "has no length");
    if (glm::length(camera.up) < 1e-9)
        return table.errorAt("up", "has no length");
    if ((!camera.eye || camera.target) &&
        glm::length(glm::cross(glm::normalize(view), glm::normalize(camera.up))) < 1e-6)
        return table.errorAt("up", "is along the view direction");
    return {};
}

Status readLightAndLook(const SceneTable& light, const SceneTable& look, Scene& scene) {
    SEROSA_TRY(light.checkKeys());
    SEROSA_TRY(light.read("direction", scene.light.direction));
    SEROSA_TRY(light.read("intensity", scene.light.intensity));
    SEROSA_TRY(light.read("ambient", scene.light.ambient));
    if (glm::length(scene.light.direction) < 1e-9)
        return light.errorAt("direction", "has no length");
    SEROSA_TRY(look.checkKeys());
    SEROSA_TRY(look.readWord("mapping", scene.look.mapping));
    SEROSA_TRY(look.readWord("colour", scene.look.colour));
    SEROSA_TRY(look.readWord("show", scene.look.show));
    SEROSA_TRY(look.readWord("stage", scene.look.stage));
    SEROSA_TRY(look.readWord("interior", scene.look.interior));
    SEROSA_TRY(look.read("shell", scene.look.shell));
    SEROSA_TRY(look.readWord("field", scene.look.field));
    SEROSA_TRY(look.readWord("depth_axis", scene.look.depthAxis));
    if (scene.look.depthAxis != Axis::z && scene.look.field != Field::depth)
        return look.errorAt("depth_axis", "has no effect: set field = \"depth\"");
    SEROSA_TRY(look.read("field_samples", scene.look.fieldSamples));
    SEROSA_TRY(look.readWord("search", scene.look.search));
    SEROSA_TRY(look.read("search_step", scene.look.searchStep));
    SEROSA_TRY(look.read("skip_empty", scene.look.skipEmpty));
    SEROSA_TRY(look.readWord("normals", scene.look.normals));
    SEROSA_TRY(look.read("antialias", scene.look.antialias));
    SEROSA_TRY(look.read("coarse_sampling", scene.look.coarseSampling));
    SEROSA_TRY(look.read("proxy_cells", scene.look.proxyCells));
    SEROSA_TRY(look.read("surface", scene.look.surface));
    SEROSA_TRY(look.read("lattice", scene.look.lattice));
    SEROSA_TRY(look.read("tools", scene.look.tools));
    SEROSA_TRY(look.read("section_at", scene.look.sectionAt));
    SEROSA_TRY(look.read("section_normal", scene.look.sectionNormal));
    if (glm::length(scene.look.sectionNormal) < 1e-9)
        return look.errorAt("section_normal", "has no length");
    SEROSA_TRY(look.read("shadows", scene.look.shadows));
    SEROSA_TRY(look.read("occlusion", scene.look.occlusion));
    SEROSA_TRY(look.read("blood", scene.look.blood));
    return {};
}

Status readOutput(const SceneTable& table, Scene& scene) {
    SEROSA_TRY(table.checkKeys());
    Output& output = scene.output;
    glm::ivec2 size(output.width, output.height);
    SEROSA_TRY(table.read("size", size));
    output.width = size.x;
    output.height = size.y;
    SEROSA_TRY(table.read("surfaces_at", output.surfacesAt));
    SEROSA_TRY(table.read("snapshots_at", output.snapshotsAt));
    SEROSA_TRY(table.read("displacements_at", output.displacementsAt));
    SEROSA_TRY(table.readWord("displacement_format", output.displacementFormat));
    if (output.displacementFormat != ImageFormat::nrrd && output.displacementsAt.empty())
        return table.errorAt("displacement_format", "has no effect without 'displacements_at': remove it");
    SEROSA_TRY(table.read("frame_every", output.frameEvery));
    SEROSA_TRY(table.read("sheet_columns", output.sheetColumns));
    SEROSA_TRY(table.read("sheet_rows", output.sheetRows));
    SEROSA_TRY(table.read("sheet_at", output.sheetAt));
    SEROSA_TRY(table.read("turntable", output.turntable));
    return {};
}

bool namesAFile(const std::string& name) {
    return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return std::isalnum(c) || c == ' ' || c == '-' || c == '_';
    });
}

Status readAll(const SceneSource& source, const toml::table& content, const fs::path& folder, Scene& scene) {
    const SceneTable top(source, "", "", &content);
    // The version first: a file of another one would fail on its keys, with a message that misleads.
    if (!top.has("schema"))
        return sceneError(source.name, {1, 1}, "required key 'schema' is missing: write schema = 1 first");
    int schema = 1;
    SEROSA_TRY(top.read("schema", schema));
    SEROSA_TRY(top.checkKeys());
    SEROSA_TRY(top.read("frame_rate", scene.frameRate));
    SEROSA_TRY(top.read("duration", scene.duration));
    SEROSA_TRY(top.read("gravity", scene.gravity));
    SEROSA_TRY(readOrganContact(top, scene));

    SEROSA_ASSIGN(const auto organs, top.tables("organ"));
    if (organs.empty() || organs.size() > kMostOrgans)
        return top.errorAt("organ", "the scene has " + std::to_string(organs.size()) + " organs, one to " +
                                        std::to_string(kMostOrgans) + " are possible");
    std::set<std::string> names;
    for (std::size_t i = 0; i < organs.size(); ++i) {
        Organ organ;
        const std::string path = "organ[" + std::to_string(i) + "]";
        SEROSA_TRY(readOrgan(source, *organs[i], path, folder, organ));
        const SceneTable table(source, "organ", path, organs[i]);
        if (organs.size() > 1 && !namesAFile(organ.name))
            return table.errorAt("name", inQuotes(organ.name) +
                                             " names files of its own beside other organs: take 1 to 64 "
                                             "letters, digits, blanks, '-' and '_'");
        if (!names.insert(organFileName(organ)).second)
            return table.errorAt("name",
                                 inQuotes(organ.name) + " is the name of another organ already: name each");
        scene.organs.push_back(std::move(organ));
    }

    SEROSA_TRY(readToolsAndBodies(source, top, folder, scene));
    SEROSA_TRY(readThreads(source, top, scene));
    SEROSA_TRY(checkCoupling(source, top, organs, scene));
    SEROSA_ASSIGN(const auto cuts, top.tables("cut"));
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        Cut cut;
        SEROSA_TRY(readCut(source, *cuts[i], i, cut));
        scene.cuts.push_back(std::move(cut));
    }
    if (!cuts.empty() && std::all_of(scene.organs.begin(), scene.organs.end(),
                                     [](const Organ& organ) { return organ.pose.has_value(); }))
        return top.errorAt("cut", "has no effect: every organ has a pose, and none is simulated");
    SEROSA_ASSIGN(const toml::table* camera, top.table("camera"));
    SEROSA_TRY(readCamera({source, "camera", "camera", camera}, scene.camera));
    SEROSA_ASSIGN(const toml::table* light, top.table("light"));
    SEROSA_ASSIGN(const toml::table* look, top.table("look"));
    SEROSA_TRY(readLightAndLook({source, "light", "light", light}, {source, "look", "look", look}, scene));
    SEROSA_TRY(readCutVolume(source, {source, "look", "look", look}, folder, scene));
    SEROSA_TRY(readDeformations(source, top, folder, scene));
    SEROSA_ASSIGN(const toml::table* outputTable, top.table("output"));
    const SceneTable output(source, "output", "output", outputTable);
    SEROSA_TRY(readOutput(output, scene));
    if (const auto problem = findSceneProblem(scene))
        return (problem->table.empty()     ? top
                : problem->table == "look" ? SceneTable(source, "look", "look", look)
                                           : output)
            .errorAt(problem->key.c_str(), problem->message);
    return {};
}

} // namespace

Result<Scene> readScene(const fs::path& file, std::vector<SceneValue>* explained) {
    SEROSA_ASSIGN(const std::string text, readText(file));
    const SceneSource source{file.string(), explained};
    toml::table content;
    try {
        content = toml::parse(std::string_view(text), source.name);
    } catch (const toml::parse_error& problem) {
        return sceneError(source.name, problem.source().begin, std::string(problem.description()));
    }
    Scene scene;
    scene.file = file;
    SEROSA_TRY(readAll(source, content, file.parent_path(), scene));
    return scene;
}

} // namespace serosa::sim
