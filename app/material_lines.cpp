// See app/material_lines.h.
#include "app/material_lines.h"

#include "app/organ_setup.h"
#include "shaders/shared_constants.h"
#include "sim/assign_materials.h"

#include <algorithm>
#include <array>
#include <limits>
#include <unordered_map>

namespace serosa::app {

namespace {

/// sRGB, the tissue first: told apart by hue and by lightness.
constexpr std::array<glm::u8vec3, SRS_MAX_MATERIALS> kColours{{{186, 98, 84},
                                                               {72, 120, 176},
                                                               {236, 196, 76},
                                                               {84, 158, 96},
                                                               {150, 90, 164},
                                                               {228, 142, 58},
                                                               {110, 196, 204},
                                                               {206, 88, 134},
                                                               {128, 128, 56},
                                                               {190, 190, 190},
                                                               {62, 70, 120},
                                                               {168, 220, 120},
                                                               {120, 72, 44},
                                                               {246, 176, 176},
                                                               {40, 116, 106},
                                                               {90, 90, 90}}};

std::string remarks(const sim::Material& material) {
    std::string text;
    const auto add = [&text](const std::string& more) { text += (text.empty() ? "; " : ", ") + more; };
    if (!material.curve.empty())
        add("curve of " + std::to_string(material.curve.size()) +
            (material.curve.size() == 1 ? " point" : " points"));
    if (material.strainLimit > 0)
        add("strain limit " + shortNumber(material.strainLimit));
    if (material.fibrous())
        add(shortNumber(material.fibreYoung / 1e3) + " kPa along its fibres");
    return text;
}

std::string inMm(double metres) {
    return shortNumber(1e3 * metres) + " mm";
}

} // namespace

std::string materialName(const sim::Organ& organ, std::size_t material) {
    return material == 0 ? sim::kTissueName : organ.tissue.material(material).name;
}

bool plainTissue(const sim::Organ& organ) {
    return organ.tissue.materialCount() == 1 && !organ.tissue.stiffens() && !organ.tissue.fibrous();
}

std::vector<MaterialLine> materialLines(const sim::Organ& organ, const sim::Lattice& lattice) {
    const std::vector<sim::MaterialAmount> amounts = sim::materialAmounts(lattice, organ.tissue);
    std::vector<MaterialLine> lines;
    for (std::size_t i = 0; i < amounts.size(); ++i) {
        const sim::Material& material = organ.tissue.material(i);
        lines.push_back(
            {materialName(organ, i), "young " + shortNumber(material.young / 1e3) + " kPa, poisson " +
                                         shortNumber(material.poisson) + ", " + grouped(amounts[i].cells) +
                                         (amounts[i].cells == 1 ? " cell, " : " cells, ") +
                                         shortNumber(1e6 * amounts[i].volume) + " ml, " +
                                         shortNumber(1e3 * amounts[i].mass) + " g" + remarks(material)});
    }
    return lines;
}

std::vector<std::string> materialNotes(const sim::Organ& organ, const sim::Lattice& lattice) {
    std::vector<std::string> notes;
    std::vector<bool> told(organ.tissue.materialCount(), false);
    for (const sim::MaterialRegion& region : organ.regions) {
        if (!region.depth || *region.depth - region.from >= lattice.spacing || told[region.material])
            continue;
        told[region.material] = true; // once
        notes.push_back("the layer of " + materialName(organ, region.material) + ", " +
                        inMm(*region.depth - region.from) + ", is thinner than the lattice's spacing, " +
                        inMm(lattice.spacing) + ": one layer of cells stands for it, as thick as they are");
    }
    const std::vector<sim::MaterialAmount> amounts = sim::materialAmounts(lattice, organ.tissue);
    for (std::size_t i = 1; i < amounts.size(); ++i)
        if (amounts[i].cells == 0)
            notes.push_back("no cell is left to " + materialName(organ, i) + ": later regions took them all");
    return notes;
}

std::vector<glm::u8vec3> materialColours(const sim::Lattice& lattice, const sim::TriangleMesh& metres) {
    const auto key = [&lattice](const glm::ivec3& cell) {
        return (std::int64_t(cell.z) * lattice.nodeDims.y + cell.y) * lattice.nodeDims.x + cell.x;
    };
    std::unordered_map<std::int64_t, std::uint8_t> materials;
    for (const sim::LatticeCell& cell : lattice.cells)
        materials.emplace(key(cell.grid), cell.material);
    std::vector<glm::u8vec3> colours;
    colours.reserve(metres.positions.size());
    for (const glm::dvec3& position : metres.positions) {
        const glm::dvec3 place = lattice.toLattice(position) + glm::dvec3(lattice.centre);
        const glm::ivec3 home(glm::floor(place));
        double nearest = std::numeric_limits<double>::infinity();
        std::uint8_t material = 0;
        for (int i = 0; i < 27; ++i) {
            const glm::ivec3 cell = home + glm::ivec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
            if (glm::any(glm::lessThan(cell, glm::ivec3(0))) ||
                glm::any(glm::greaterThanEqual(cell, lattice.nodeDims)))
                continue;
            const auto found = materials.find(key(cell));
            const double distance = cell == home ? 0 : glm::distance(place, glm::dvec3(cell) + 0.5);
            if (found != materials.end() && distance < nearest) {
                nearest = distance;
                material = found->second;
            }
        }
        colours.push_back(kColours[material]);
    }
    return colours;
}

} // namespace serosa::app
