// See sim/scene_reader_organ.h: regions, those of materials and the fixed ones. Both share the shapes that
// lie at a place; each has shapes of its own.
#include "sim/scene_reader_organ.h"
#include "sim/suggest.h"

#include <algorithm>
#include <set>

namespace serosa::sim {

namespace {

/// The keys that a shape of region takes; others are refused.
struct ShapeKeys {
    std::vector<std::string> required, optional;
};
const ShapeKeys kPlaceKeys[] = {
    {{}, {"axis", "below", "above"}}, {{"min", "max"}, {}}, {{"centre", "radius"}, {}}}; // Region::Shape
const ShapeKeys kLowestKeys{{"share"}, {}}, kLayerKeys{{"depth"}, {"from"}},
    kPaintedKeys{{"colour"}, {"depth", "from", "tolerance"}};

bool isOneOf(const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
}

/// \param tableName in scene_keys.h. \param shape index of the word.
Status checkShapeKeys(const SceneTable& table, const std::string& tableName, std::size_t shape,
                      const ShapeKeys& keys) {
    const std::string shapeName = "\"" + findSceneKey(tableName, "shape")->words[shape] + "\"";
    for (const std::string& name : keyNames(tableName)) {
        const bool required = isOneOf(keys.required, name);
        if (required && !table.has(name.c_str()))
            return table.errorAt("shape", shapeName + " needs '" + name + "'");
        if (table.has(name.c_str()) && !required && !isOneOf(keys.optional, name) && name != "shape" &&
            name != "material")
            return table.errorAt(name.c_str(), "does not belong to shape " + shapeName);
    }
    return {};
}

Status readPlace(const SceneTable& table, Region& region) {
    switch (region.shape) {
    case Region::Shape::halfSpace: {
        enum class Axis { x, y, z } axis = Axis::y;
        SEROSA_TRY(table.readWord("axis", axis));
        region.axis = int(axis);
        SEROSA_TRY(table.read("below", region.below));
        SEROSA_TRY(table.read("above", region.above));
        if (region.below.has_value() == region.above.has_value())
            return table.errorAt("shape", "a half-space needs 'below' or 'above', not " +
                                              std::string(region.below ? "both" : "neither"));
        break;
    }
    case Region::Shape::box:
        SEROSA_TRY(table.read("min", region.lowest));
        SEROSA_TRY(table.read("max", region.highest));
        if (!glm::all(glm::lessThan(region.lowest, region.highest)))
            return table.errorAt("max", "is not greater than 'min' along every axis");
        break;
    case Region::Shape::sphere:
        SEROSA_TRY(table.read("centre", region.centre));
        SEROSA_TRY(table.read("radius", region.radius));
        break;
    }
    return {};
}

Status readFixed(const SceneTable& table, Organ& organ) {
    SEROSA_TRY(table.checkKeys());
    enum class Shape { halfSpace, box, sphere, lowest } shape = Shape::halfSpace;
    SEROSA_TRY(table.readWord("shape", shape));
    const bool lowest = shape == Shape::lowest;
    SEROSA_TRY(checkShapeKeys(table, "organ.fixed", std::size_t(shape),
                              lowest ? kLowestKeys : kPlaceKeys[int(shape)]));
    if (lowest && organ.fixedLowestShare > 0)
        return table.errorAt("shape", "a second region \"lowest\" of one organ: keep one");
    if (lowest)
        return table.read("share", organ.fixedLowestShare);
    Region region;
    region.line = table.lineOf("shape");
    region.shape = Region::Shape(shape);
    SEROSA_TRY(readPlace(table, region));
    organ.fixed.push_back(region);
    return {};
}

/// `depth` and `from` of a layer or of paint.
Status readDepths(const SceneTable& table, MaterialRegion& region) {
    SEROSA_TRY(table.read("depth", region.depth));
    SEROSA_TRY(table.read("from", region.from));
    if (region.depth && *region.depth <= region.from)
        return table.errorAt("from", "is not less than 'depth': nothing lies between them");
    return {};
}

Status readMaterialRegion(const SceneTable& table, const std::vector<std::string>& names,
                          MaterialRegion& region) {
    SEROSA_TRY(table.checkKeys());
    std::string material;
    SEROSA_TRY(table.read("material", material));
    const auto found = std::find(names.begin(), names.end(), material);
    if (found == names.end())
        return table.errorAt("material", inQuotes(material) + " is no [[organ.material]] of this organ" +
                                             suggestion(material, names));
    region.material = std::size_t(found - names.begin());

    enum class Shape { halfSpace, box, sphere, layer, painted } shape = Shape::halfSpace;
    SEROSA_TRY(table.readWord("shape", shape));
    SEROSA_TRY(checkShapeKeys(table, "organ.region", std::size_t(shape),
                              shape == Shape::layer     ? kLayerKeys
                              : shape == Shape::painted ? kPaintedKeys
                                                        : kPlaceKeys[int(shape)]));
    region.place.line = table.lineOf("shape");
    if (shape == Shape::layer) {
        region.kind = MaterialRegion::Kind::layer;
        return readDepths(table, region);
    }
    if (shape == Shape::painted) {
        region.kind = MaterialRegion::Kind::painted;
        SEROSA_TRY(readDepths(table, region));
        glm::ivec3 colour(0);
        SEROSA_TRY(table.read("colour", colour));
        region.colour = glm::u8vec3(colour);
        return table.read("tolerance", region.tolerance);
    }
    region.place.shape = Region::Shape(shape);
    return readPlace(table, region.place);
}

} // namespace

Status readFixedRegions(const SceneSource& source, const SceneTable& organTable, const std::string& path,
                        Organ& organ) {
    SEROSA_ASSIGN(const auto regions, organTable.tables("fixed"));
    for (std::size_t i = 0; i < regions.size(); ++i)
        SEROSA_TRY(readFixed({source, "organ.fixed", itemPath(path, "fixed", i), regions[i]}, organ));
    return {};
}

Status readMaterialRegions(const SceneSource& source, const SceneTable& organTable, const std::string& path,
                           Organ& organ) {
    SEROSA_ASSIGN(const auto regions, organTable.tables("region"));
    SEROSA_ASSIGN(const auto materials, organTable.tables("material"));
    if (!regions.empty() && materials.empty())
        return organTable.errorAt("region", "there is no [[organ.material]] that it could give");
    std::vector<std::string> names{kTissueName};
    for (const Material& material : organ.tissue.others)
        names.push_back(material.name);
    std::set<std::size_t> named;
    for (std::size_t i = 0; i < regions.size(); ++i) {
        MaterialRegion region;
        SEROSA_TRY(readMaterialRegion({source, "organ.region", itemPath(path, "region", i), regions[i]},
                                      names, region));
        named.insert(region.material);
        organ.regions.push_back(region);
    }
    for (std::size_t i = 0; i < materials.size(); ++i)
        if (!named.contains(i + 1))
            return SceneTable(source, "organ.material", itemPath(path, "material", i), materials[i])
                .errorAt("name", "no [[organ.region]] gives " + inQuotes(organ.tissue.others[i].name) +
                                     " to any cell: add one, or remove the material");
    return {};
}

} // namespace serosa::sim
