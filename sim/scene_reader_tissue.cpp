// See sim/scene_reader_organ.h: what an organ is made of. A material inherits what it does not say from the
// organ's tissue; the rules hold for what comes of it.
#include "shaders/shared_constants.h"
#include "sim/scene_reader_organ.h"

#include <algorithm>
#include <cmath>

namespace serosa::sim {

namespace {

constexpr double kLargestModulus = 1e12; // Pa, as of `young`

/// Young's modulus, or a curve in its place; either replaces what was inherited of the two.
Status readTension(const SceneSource& source, const SceneTable& table, const std::string& path,
                   Material& material) {
    if (!table.has("curve")) {
        if (table.has("young"))
            material.curve.clear();
        return table.read("young", material.young);
    }
    if (table.has("young"))
        return table.errorAt("young",
                             "stands beside 'curve', whose first point gives it: keep one of the two");
    SEROSA_ASSIGN(const auto points, table.tables("curve"));
    if (points.empty())
        return table.errorAt("curve", "needs at least one point");
    material.curve.clear();
    CurvePoint before;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SceneTable pointTable(source, "curve", itemPath(path, "curve", i), points[i]);
        SEROSA_TRY(pointTable.checkKeys());
        CurvePoint point;
        SEROSA_TRY(pointTable.read("strain", point.strain));
        SEROSA_TRY(pointTable.read("stress", point.stress));
        if (point.strain <= before.strain)
            return pointTable.errorAt("strain",
                                      "is not above that of the point before it: strains must rise");
        if (point.stress <= before.stress)
            return pointTable.errorAt("stress",
                                      "is not above that of the point before it: stresses must rise");
        const double slope = (point.stress - before.stress) / (point.strain - before.strain);
        if (!(slope > 0 && slope <= kLargestModulus))
            return pointTable.errorAt("stress", "makes the curve rise by " +
                                                    formatQuantity(slope, Dimension::pressure) +
                                                    " over a strain of 1, expected " +
                                                    findSceneKey("organ.tissue", "young")->range.text());
        material.curve.push_back(point);
        before = point;
    }
    material.young = material.curve.front().stress / material.curve.front().strain;
    return {};
}

Status readStrainLimit(const SceneTable& table, Material& material) {
    SEROSA_TRY(table.read("strain_limit", material.strainLimit));
    const std::size_t bends = material.curve.empty() ? 0 : material.curve.size() - 1; // of the curve alone
    const double limit = material.strainLimit, last = bends > 0 ? material.curve[bends - 1].strain : 0;
    const char* at = table.has("strain_limit") ? "strain_limit" : "curve"; // what broke the rule
    if (limit > 0 && limit <= last)
        return table.errorAt(at, "the strain limit of " + formatNumber(limit) +
                                     " does not lie beyond the curve's last point but one, at " +
                                     formatNumber(last) + ": raise it");
    if (bends + (limit > 0 ? 1 : 0) > SRS_CURVE_BREAKS)
        return table.errorAt(table.has("curve") ? "curve" : at,
                             "has " + std::to_string(material.curve.size()) + " points, at most " +
                                 std::to_string(SRS_CURVE_BREAKS + (limit > 0 ? 0 : 1)) + " are possible" +
                                 (limit > 0 ? " beside a strain limit" : "") + ": leave some out");
    return {};
}

Status readFibres(const SceneTable& table, Material& material) {
    std::optional<glm::dvec3> direction;
    std::optional<double> young;
    SEROSA_TRY(table.read("fibre", direction));
    SEROSA_TRY(table.read("fibre_young", young));
    if (direction) {
        const glm::dvec3 size = glm::abs(*direction);
        const double largest = std::max({size.x, size.y, size.z});
        if (largest == 0)
            return table.errorAt("fibre", "has no length");
        material.fibre = glm::normalize(*direction / largest); // whatever its length
    }
    material.fibreYoung = young.value_or(material.fibreYoung);
    const bool directed = material.fibre != glm::dvec3(0);
    if (directed && material.fibreYoung == 0)
        return table.errorAt("fibre", "needs 'fibre_young', Young's modulus along it");
    if (!directed && material.fibreYoung > 0)
        return table.errorAt("fibre_young", "needs 'fibre', the direction that it holds in");
    if (directed && material.fibreYoung < material.young)
        return table.errorAt(
            table.has("fibre_young") ? "fibre_young"
            : table.has("curve")     ? "curve"
                                     : "young",
            "Young's modulus along the fibres, " + formatQuantity(material.fibreYoung, Dimension::pressure) +
                ", is below the one across them, " + formatQuantity(material.young, Dimension::pressure) +
                ": raise 'fibre_young'");
    return {};
}

/// \param material holds defaults, or what is inherited.
Status readLaw(const SceneSource& source, const SceneTable& table, const std::string& path,
               Material& material) {
    SEROSA_TRY(table.checkKeys());
    SEROSA_TRY(readTension(source, table, path, material));
    SEROSA_TRY(readStrainLimit(table, material));
    SEROSA_TRY(table.read("poisson", material.poisson));
    if (material.poisson < 0.25)
        return table.errorAt("poisson", "is " + formatNumber(material.poisson) +
                                            ", at least 0.25 is possible: the springs give 0.25, and the "
                                            "volumetric term can only raise it");
    if (material.poisson > 0.495)
        return table.errorAt("poisson", "is " + formatNumber(material.poisson) +
                                            ", at most 0.495 is possible: at 0.5 nothing can be pressed "
                                            "together, and the time step vanishes");
    SEROSA_TRY(table.read("density", material.density));
    SEROSA_TRY(table.read("damping_time", material.dampingTime));
    return readFibres(table, material);
}

} // namespace

Status readTissue(const SceneSource& source, const SceneTable& organ, const std::string& path,
                  Tissue& tissue) {
    SEROSA_ASSIGN(const toml::table* content, organ.table("tissue"));
    const SceneTable table(source, "organ.tissue", path + ".tissue", content);
    SEROSA_TRY(readLaw(source, table, path + ".tissue", tissue));
    SEROSA_TRY(table.read("air_drag", tissue.airDrag));
    SEROSA_TRY(table.read("recovery", tissue.recovery));

    SEROSA_ASSIGN(const auto materials, organ.tables("material"));
    if (materials.size() > SRS_MAX_MATERIALS - 1)
        return organ.errorAt("material", "the organ has " + std::to_string(materials.size()) +
                                             " materials beside its tissue, at most " +
                                             std::to_string(SRS_MAX_MATERIALS - 1) + " are possible");
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const std::string itsPath = itemPath(path, "material", i);
        const SceneTable itsTable(source, "organ.material", itsPath, materials[i], true);
        Material material = tissue; // its own law alone
        SEROSA_TRY(itsTable.checkKeys());
        SEROSA_TRY(itsTable.read("name", material.name));
        if (material.name == kTissueName)
            return itsTable.errorAt("name", "is the name of [organ.tissue] in regions: take another");
        if (std::any_of(tissue.others.begin(), tissue.others.end(),
                        [&](const Material& other) { return other.name == material.name; }))
            return itsTable.errorAt("name", inQuotes(material.name) +
                                                " is the name of another material already: name each");
        SEROSA_TRY(readLaw(source, itsTable, itsPath, material));
        tissue.others.push_back(std::move(material));
    }
    return {};
}

} // namespace serosa::sim
