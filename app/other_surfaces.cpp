// See app/other_surfaces.h.
#include "app/other_surfaces.h"

#include "app/organ_setup.h"
#include "sim/mesh_reader.h"
#include "sim/quantity.h"
#include "sim/suggest.h"

#include <algorithm>
#include <set>

namespace serosa::app {

namespace {

double longestSide(const glm::dvec3& lowest, const glm::dvec3& highest) {
    const glm::dvec3 size = highest - lowest;
    return std::max({size.x, size.y, size.z});
}

struct Wanted {
    std::size_t organ;
    std::filesystem::path file;
};

Result<Wanted> parse(const std::string& text, const sim::Scene& scene) {
    std::vector<std::string> names;
    for (const sim::Organ& organ : scene.organs)
        names.push_back(organ.name);
    const std::size_t equals = text.find('=');
    const std::string name = equals == std::string::npos ? "" : text.substr(0, equals),
                      file = equals == std::string::npos ? text : text.substr(equals + 1);
    const auto found = std::find(names.begin(), names.end(), name);
    if (equals == std::string::npos && names.size() > 1)
        return Error{"--surface: " + sim::inQuotes(text) +
                     " names no organ, and the scene has several: write ORGAN=FILE" +
                     sim::suggestion("", names)};
    if (equals != std::string::npos && found == names.end())
        return Error{"--surface: no organ is named " + sim::inQuotes(name) + sim::suggestion(name, names)};
    if (file.empty())
        return Error{"--surface: " + sim::inQuotes(text) + " names no file: write ORGAN=FILE"};
    return Wanted{name.empty() ? 0 : std::size_t(found - names.begin()), file};
}

/// Size and place of the organ's own surface.
Status fit(const OrganSurface& own, sim::Organ& organ) {
    SEROSA_ASSIGN(const sim::TriangleMesh other, sim::readMesh(organ.model));
    const glm::dvec3 a = sim::worldFromFile(organ.upAxis, other.lowest()),
                     b = sim::worldFromFile(organ.upAxis, other.highest());
    const double side = longestSide(glm::min(a, b), glm::max(a, b));
    if (!(side > 0))
        return Error{organ.model.string() + ": has no size: is it a surface?"};
    organ.lengthUnit = longestSide(own.metres.lowest(), own.metres.highest()) / side;
    organ.at = 0.5 * (own.metres.lowest() + own.metres.highest()) - 0.5 * (a + b) * organ.lengthUnit;
    return {};
}

} // namespace

Status takeSurfaces(const OtherSurfaces& others, sim::Scene& scene) {
    std::set<std::size_t> taken;
    for (const std::string& text : others.wanted) {
        SEROSA_ASSIGN(const Wanted wanted, parse(text, scene));
        sim::Organ& organ = scene.organs[wanted.organ];
        if (!taken.insert(wanted.organ).second)
            return Error{"--surface: names " + sim::inQuotes(organ.name) + " twice: keep one"};
        SEROSA_ASSIGN(const OrganSurface own, loadSurface(organ, scene.file));
        organ.model = wanted.file;
        organ.modelLine = 0; // messages name the file, not the scene's line
        organ.upAxis = others.upAxis.value_or(sim::UpAxis::y);
        organ.repair = others.repair;
        if (others.lengthUnit) {
            organ.lengthUnit = *others.lengthUnit;
            organ.at = glm::dvec3(0);
        } else {
            SEROSA_TRY(fit(own, organ));
        }
    }
    return {};
}

} // namespace serosa::app
