// See sim/scene_reader_tools.h. A shape's own frame (sim/rigid_shape.h): rods, blades and jaws begin with
// their tip at the origin and run along z; x is across, y is a blade's thin side or the way in which jaws
// close.
#include "sim/scene_reader_tools.h"

#include "shaders/shared_constants.h"
#include "sim/distance_field.h"
#include "sim/mesh_check.h"
#include "sim/mesh_reader.h"

#include <algorithm>
#include <memory>

namespace serosa::sim {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostMeshFaces = 50000;
constexpr double kMostMeshExtent = 10;     // m: beyond, the unit is wrong
constexpr double kEdgeShare = 0.1;         // of a box's least side: its rounding, where none is given
constexpr double kShankBends = 4;          // a hook's shank over its bend, where no length is given
constexpr double kLeastHalfWidth = 0.5;    // of a mesh, in steps of its field: thinner parts may be missed
constexpr double kNoLength = 1e-9;         // of directions
constexpr double kDefaultThickness = 1e-3; // m, of a blade

/// The keys that a kind of shape takes; other keys of shapes are refused.
struct KindKeys {
    const char* name; // with its article
    std::vector<std::string> required, optional;
};
// In the order of the words of `kind`.
const KindKeys kToolKinds[] = {{"a sphere", {}, {"radius"}},
                               {"a capsule", {"length"}, {"radius"}},
                               {"a box", {"size"}, {"radius"}},
                               {"a blade", {"length", "width"}, {"thickness"}},
                               {"a hook", {"bend"}, {"radius", "length"}},
                               {"jaws", {"length", "width", "opening"}, {}},
                               {"a mesh", {"model", "length_unit"}, {}}};
const KindKeys kBodyKinds[] = {{"a floor", {}, {"height", "at", "normal", "axis", "angle"}},
                               {"a box", {"at", "size"}, {"radius", "along", "axis", "angle"}},
                               {"a sphere", {"at", "radius"}, {}},
                               {"a capsule", {"at", "length", "radius"}, {"along", "axis", "angle"}},
                               {"a mesh", {"at", "model", "length_unit"}, {"along", "axis", "angle"}}};
const char* const kShapeKeys[] = {"radius",    "length",  "bend",  "size",        "width",
                                  "thickness", "opening", "model", "length_unit", "height",
                                  "at",        "normal",  "along", "axis",        "angle"};

bool isOneOf(const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
}

Status checkKindKeys(const SceneTable& table, const KindKeys& kind) {
    for (const std::string& name : kind.required)
        if (!table.has(name.c_str()))
            return table.errorAt("kind", std::string(kind.name) +
                                             (kind.name[1] == ' ' ? " needs '" : " need '") + name + "'");
    for (const char* name : kShapeKeys)
        if (table.has(name) && !isOneOf(kind.required, name) && !isOneOf(kind.optional, name))
            return table.errorAt(name, "has no effect on " + std::string(kind.name) + ": remove it");
    return {};
}

/// A box of these sides, `radius` of its edges as far as the table says it.
Status readBox(const SceneTable& table, RigidShape& shape) {
    glm::dvec3 size(0);
    SEROSA_TRY(table.read("size", size));
    const double least = std::min({size.x, size.y, size.z});
    shape.kind = ShapeKind::box;
    shape.radius = kEdgeShare * least;
    SEROSA_TRY(table.read("radius", shape.radius));
    if (2 * shape.radius > least)
        return table.errorAt("radius", "is more than half of the box's least side: lower it");
    shape.halfSize = 0.5 * size - shape.radius;
    return {};
}

Status readBlade(const SceneTable& table, RigidShape& shape) {
    double length = 0, width = 0, thickness = kDefaultThickness;
    SEROSA_TRY(table.read("length", length));
    SEROSA_TRY(table.read("width", width));
    SEROSA_TRY(table.read("thickness", thickness));
    for (const auto& [key, value] : {std::pair{"length", length}, std::pair{"width", width}})
        if (value < thickness)
            return table.errorAt(key, "is less than the blade's thickness, " +
                                          formatQuantity(thickness, Dimension::length));
    shape.kind = ShapeKind::box;
    shape.radius = 0.5 * thickness;
    shape.middle = {0, 0, 0.5 * length};
    shape.halfSize = {0.5 * width - shape.radius, 0, 0.5 * length - shape.radius};
    return {};
}

Status readHook(const SceneTable& table, RigidShape& shape) {
    SEROSA_TRY(table.read("radius", shape.radius));
    SEROSA_TRY(table.read("bend", shape.bend));
    shape.length = kShankBends * shape.bend;
    SEROSA_TRY(table.read("length", shape.length));
    if (shape.bend <= shape.radius)
        return table.errorAt("bend", "is not greater than 'radius': the wire fills its own bend");
    shape.kind = ShapeKind::hook;
    return {};
}

/// What jaws hold: all between their pads.
Status readJaws(const SceneTable& table, RigidShape& shape) {
    double length = 0, width = 0, opening = 0;
    SEROSA_TRY(table.read("length", length));
    SEROSA_TRY(table.read("width", width));
    SEROSA_TRY(table.read("opening", opening));
    shape.kind = ShapeKind::box;
    shape.radius = 0;
    shape.middle = {0, 0, 0.5 * length};
    shape.halfSize = {0.5 * width, 0.5 * opening, 0.5 * length};
    return {};
}

Status readMeshShape(const SceneTable& table, const fs::path& folder, RigidShape& shape) {
    std::string model;
    SEROSA_TRY(table.read("model", model));
    enum class Unit { first } word = Unit::first;
    SEROSA_TRY(table.readWord("length_unit", word));
    SEROSA_ASSIGN(const double unit,
                  parseLengthUnit(findSceneKey("organ", "length_unit")->words[std::size_t(word)]));
    const fs::path file = fs::path(model).is_absolute() ? fs::path(model) : folder / model;
    const auto refused = [&](const std::string& why) { return table.errorAt("model", why); };
    Result<TriangleMesh> read = readMesh(file);
    if (!read)
        return refused(read.error().message);
    if (read->faces.size() > kMostMeshFaces)
        return refused(file.string() + " has " + std::to_string(read->faces.size()) + " faces, at most " +
                       std::to_string(kMostMeshFaces) + " are possible: simplify it");
    if (const Status closed = checkClosedSolid(*read, file.string()); !closed)
        return refused(closed.error().message + " (tools and bodies need a closed surface)");
    for (glm::dvec3& position : read->positions)
        position *= unit;
    const glm::dvec3 extent = read->highest() - read->lowest();
    if (const double longest = std::max({extent.x, extent.y, extent.z}); longest > kMostMeshExtent)
        return refused(file.string() + " is " + formatQuantity(longest, Dimension::length) +
                       " long, at most 10 m are possible: look at 'length_unit'");
    auto surface = std::make_shared<TriangleMesh>(std::move(*read));
    auto field = std::make_shared<DistanceField>(*surface);
    if (field->thinnestHalfWidth() < kLeastHalfWidth * field->step())
        return refused(file.string() + " is thinner than its distance field can show, " +
                       formatQuantity(2 * kLeastHalfWidth * field->step(), Dimension::length) +
                       ": make it thicker, or take a blade or box");
    shape.kind = ShapeKind::mesh;
    shape.radius = 0;
    shape.surface = std::move(surface);
    shape.field = std::move(field);
    return {};
}

glm::dquat shortestTurn(const glm::dvec3& from, const glm::dvec3& to) {
    const double cosine = glm::dot(from, to);
    if (cosine < -1 + 1e-12)
        return {0, 1, 0, 0}; // half a turn about x, which is across both y and z
    const glm::dvec3 across = glm::cross(from, to);
    return glm::normalize(glm::dquat(1 + cosine, across.x, across.y, across.z));
}

/// The unit vector under `key`.
Status readDirection(const SceneTable& table, const char* key, glm::dvec3& direction) {
    SEROSA_TRY(table.read(key, direction));
    if (glm::length(direction) < kNoLength)
        return table.errorAt(key, "has no length");
    direction = glm::normalize(direction);
    return {};
}

/// Turns `first` on by `axis` and `angle`, where they are given.
Status readAxisAngle(const SceneTable& table, glm::dquat& turn) {
    if (table.has("axis") != table.has("angle"))
        return table.errorAt(table.has("axis") ? "axis" : "angle",
                             std::string("stands alone: a turn takes 'axis' and 'angle'"));
    if (!table.has("axis"))
        return {};
    glm::dvec3 axis(0);
    SEROSA_TRY(readDirection(table, "axis", axis));
    double angle = 0;
    SEROSA_TRY(table.read("angle", angle));
    turn = glm::normalize(glm::angleAxis(angle, axis) * turn);
    return {};
}

/// `along`, `axis` and `angle`. Leaves `turn` as it is where none is given.
Status readTurn(const SceneTable& table, glm::dquat& turn) {
    if (!table.has("along") && !table.has("axis") && !table.has("angle"))
        return {};
    turn = {1, 0, 0, 0};
    if (table.has("along")) {
        glm::dvec3 along(0);
        SEROSA_TRY(readDirection(table, "along", along));
        turn = shortestTurn({0, 0, 1}, along);
    }
    return readAxisAngle(table, turn);
}

Status readToolKeys(const SceneSource& source, const SceneTable& table, const std::string& path, Tool& tool) {
    SEROSA_ASSIGN(const auto keys, table.tables("keys"));
    tool.line = table.lineOf("keys");
    if (keys.size() < (tool.mode == ToolMode::grasp ? 2u : 1u))
        return table.errorAt("keys", tool.mode == ToolMode::grasp
                                         ? "a grasp needs at least two: take hold, and let go"
                                         : "needs at least one");
    const bool turns =
        tool.shape.kind != ShapeKind::sphere || tool.mode == ToolMode::grasp || tool.friction > 0;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const SceneTable keyTable(source, "tool.keys", path + ".keys[" + std::to_string(i) + "]", keys[i]);
        SEROSA_TRY(keyTable.checkKeys());
        ToolKey key{0, glm::dvec3(0)};
        if (!tool.keys.empty())
            key.turn = tool.keys.back().turn;
        SEROSA_TRY(keyTable.read("t", key.time));
        SEROSA_TRY(keyTable.read("at", key.at));
        for (const char* name : {"along", "axis", "angle"})
            if (keyTable.has(name) && !turns)
                return keyTable.errorAt(name, "has no effect on a sphere without friction: remove it");
        SEROSA_TRY(readTurn(keyTable, key.turn));
        if (!tool.keys.empty() && key.time <= tool.keys.back().time)
            return keyTable.errorAt("t", "is not after the key before it: times must increase");
        tool.keys.push_back(key);
    }
    return {};
}

Status readToolShape(const SceneTable& table, const fs::path& folder, Tool& tool) {
    enum class Kind { sphere, capsule, box, blade, hook, jaws, mesh } kind = Kind::sphere;
    SEROSA_TRY(table.readWord("kind", kind));
    SEROSA_TRY(checkKindKeys(table, kToolKinds[int(kind)]));
    tool.jaws = kind == Kind::jaws;
    switch (kind) {
    case Kind::sphere:
        return table.read("radius", tool.shape.radius);
    case Kind::capsule:
        tool.shape.kind = ShapeKind::capsule;
        SEROSA_TRY(table.read("radius", tool.shape.radius));
        return table.read("length", tool.shape.length);
    case Kind::box:
        return readBox(table, tool.shape);
    case Kind::blade:
        return readBlade(table, tool.shape);
    case Kind::hook:
        return readHook(table, tool.shape);
    case Kind::jaws:
        return readJaws(table, tool.shape);
    case Kind::mesh:
        break;
    }
    return readMeshShape(table, folder, tool.shape);
}

Status readTool(const SceneSource& source, const toml::table& content, std::size_t index,
                const fs::path& folder, Tool& tool) {
    const std::string path = "tool[" + std::to_string(index) + "]";
    const SceneTable table(source, "tool", path, &content);
    SEROSA_TRY(table.checkKeys());
    tool.name = "tool " + std::to_string(index + 1);
    SEROSA_TRY(table.read("name", tool.name));
    SEROSA_TRY(readToolShape(table, folder, tool));
    tool.radius = tool.shape.radius;
    if (tool.jaws)
        tool.mode = ToolMode::grasp;
    SEROSA_TRY(table.readWord("mode", tool.mode));
    if (tool.jaws && tool.mode == ToolMode::push)
        return table.errorAt("mode", "jaws only grasp: remove it, or push with a box");
    const bool push = tool.mode == ToolMode::push;
    if (!push && table.has("friction"))
        return table.errorAt("friction", "has no effect on a grasp: 'grip_force' says how firmly it holds");
    if (push && table.has("grip_force"))
        return table.errorAt("grip_force", "has no effect on a push: write mode = \"grasp\", or remove it");
    if (push)
        SEROSA_TRY(table.read("friction", tool.friction));
    std::optional<double> grip;
    SEROSA_TRY(table.read("grip_force", grip));
    tool.gripForce = grip.value_or(tool.gripForce);
    return readToolKeys(source, table, path, tool);
}

/// Its normal is the shape's own y axis.
Status readFloor(const SceneTable& table, Body& body) {
    body.shape.kind = ShapeKind::halfSpace;
    body.shape.radius = 0;
    for (const char* key : {"at", "normal", "axis", "angle"})
        if (table.has("height") && table.has(key))
            return table.errorAt(key,
                                 "stands beside 'height', which means a level floor: keep one of the two");
    if (!table.has("height") && !table.has("at"))
        return table.errorAt("kind", "a floor needs 'height', or 'at' and 'normal'");
    if (table.has("height"))
        return table.read("height", body.pose.at.y);
    SEROSA_TRY(table.read("at", body.pose.at));
    glm::dvec3 normal(0, 1, 0);
    SEROSA_TRY(readDirection(table, "normal", normal));
    body.pose.turn = shortestTurn({0, 1, 0}, normal);
    return readAxisAngle(table, body.pose.turn);
}

Status readBody(const SceneSource& source, const toml::table& content, std::size_t index,
                const fs::path& folder, Body& body) {
    const SceneTable table(source, "body", "body[" + std::to_string(index) + "]", &content);
    SEROSA_TRY(table.checkKeys());
    body.name = "body " + std::to_string(index + 1);
    body.line = table.lineOf("kind");
    SEROSA_TRY(table.read("name", body.name));
    enum class Kind { floor, box, sphere, capsule, mesh } kind = Kind::floor;
    SEROSA_TRY(table.readWord("kind", kind));
    SEROSA_TRY(checkKindKeys(table, kBodyKinds[int(kind)]));
    SEROSA_TRY(table.read("friction", body.friction));
    switch (kind) {
    case Kind::floor:
        return readFloor(table, body);
    case Kind::box:
        SEROSA_TRY(readBox(table, body.shape));
        break;
    case Kind::sphere:
        SEROSA_TRY(table.read("radius", body.shape.radius));
        break;
    case Kind::capsule:
        body.shape.kind = ShapeKind::capsule;
        SEROSA_TRY(table.read("radius", body.shape.radius));
        SEROSA_TRY(table.read("length", body.shape.length));
        break;
    case Kind::mesh:
        SEROSA_TRY(readMeshShape(table, folder, body.shape));
        break;
    }
    SEROSA_TRY(table.read("at", body.pose.at));
    return readTurn(table, body.pose.turn);
}

} // namespace

Status readToolsAndBodies(const SceneSource& source, const SceneTable& top, const fs::path& folder,
                          Scene& scene) {
    SEROSA_ASSIGN(const auto tools, top.tables("tool"));
    if (tools.size() > SRS_MAX_TOOLS)
        return top.errorAt("tool", "the scene has " + std::to_string(tools.size()) + " tools, at most " +
                                       std::to_string(SRS_MAX_TOOLS) + " are possible");
    for (std::size_t i = 0; i < tools.size(); ++i) {
        Tool tool;
        SEROSA_TRY(readTool(source, *tools[i], i, folder, tool));
        scene.tools.push_back(std::move(tool));
    }
    SEROSA_ASSIGN(const auto bodies, top.tables("body"));
    if (tools.size() + bodies.size() > SRS_MAX_COLLIDERS)
        return top.errorAt("body", "the scene has " + std::to_string(tools.size()) + " tools and " +
                                       std::to_string(bodies.size()) + " bodies, together at most " +
                                       std::to_string(SRS_MAX_COLLIDERS) + " are possible");
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        Body body;
        SEROSA_TRY(readBody(source, *bodies[i], i, folder, body));
        scene.bodies.push_back(std::move(body));
    }
    return {};
}

} // namespace serosa::sim
