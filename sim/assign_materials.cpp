// See sim/assign_materials.h.
#include "sim/assign_materials.h"

#include "sim/node_depths.h"
#include "sim/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace serosa::sim {

namespace {

std::string colourText(const glm::u8vec3& colour) {
    return "[" + std::to_string(colour.x) + ", " + std::to_string(colour.y) + ", " +
           std::to_string(colour.z) + "]";
}

/// Largest difference of a channel.
int apart(const glm::u8vec3& a, const glm::u8vec3& b) {
    const glm::ivec3 difference = glm::abs(glm::ivec3(a) - glm::ivec3(b));
    return std::max({difference.x, difference.y, difference.z});
}

/// Does a triangle touch a box? The part of it that each side leaves, one after the other (Sutherland &
/// Hodgman 1974).
bool touches(std::vector<glm::dvec3> polygon, const glm::dvec3& lowest, const glm::dvec3& highest) {
    for (int side = 0; side < 6 && !polygon.empty(); ++side) {
        const int axis = side / 2;
        const auto within = [&](const glm::dvec3& p) { // above 0: by how much
            return side % 2 ? highest[axis] - p[axis] : p[axis] - lowest[axis];
        };
        std::vector<glm::dvec3> left;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
            const double atA = within(a), atB = within(b);
            if (atA >= 0)
                left.push_back(a);
            if ((atA < 0) != (atB < 0))
                left.push_back(a + (b - a) * (atA / (atA - atB)));
        }
        polygon = std::move(left);
    }
    return !polygon.empty();
}

class CellChoice {
public:
    CellChoice(const Lattice& lattice, const TriangleMesh& metres)
        : lattice_(lattice), metres_(metres),
          reach_(2 * glm::length(metres.highest() - metres.lowest()) + 4 * lattice.spacing) {}

    bool holds(const MaterialRegion& region, std::size_t index) {
        const LatticeCell& cell = lattice_.cells[index];
        const glm::dvec3 centre = lattice_.toWorld(glm::dvec3(cell.grid - lattice_.centre) + glm::dvec3(0.5));
        if (region.kind == MaterialRegion::Kind::place)
            return region.place.contains(centre);
        const bool always = region.from == 0 && isOutermost(index);
        const auto closest =
            !always && region.depth ? tree().closest(centre, *region.depth) : tree().closest(centre);
        if (!closest)
            return false; // deeper
        if (!always && (closest.distance2 <= region.from * region.from ||
                        (cell.fill < 255 && !isInside(tree(), centre, reach_))))
            return false;
        return region.kind == MaterialRegion::Kind::layer || isPainted(region, closest);
    }

    /// Why a region holds no cell, and what to do.
    std::string whyEmpty(const MaterialRegion& region) const {
        if (region.kind == MaterialRegion::Kind::place)
            return "this region holds no cell of the organ: look at its position and unit, or take a finer "
                   "lattice";
        if (region.kind == MaterialRegion::Kind::layer)
            return "this layer holds no cell of the organ: look at its depth and unit, or take a finer "
                   "lattice";
        glm::u8vec3 nearest = metres_.colours.front();
        for (const glm::u8vec3& colour : metres_.colours)
            if (apart(colour, region.colour) < apart(nearest, region.colour))
                nearest = colour;
        if (apart(nearest, region.colour) > region.tolerance)
            return "the model has no paint of colour " + colourText(region.colour) +
                   ": the nearest colour is " + colourText(nearest);
        return "the paint of colour " + colourText(region.colour) +
               " holds no cell of the organ: look at depth and from, or take a finer lattice";
    }

private:
    const TriangleTree& tree() {
        if (!tree_)
            tree_ = std::make_unique<TriangleTree>(metres_.positions, metres_.faces);
        return *tree_;
    }

    /// Does the surface touch the cell?
    bool isOutermost(std::size_t index) {
        const LatticeCell& cell = lattice_.cells[index];
        if (cell.fill < 255)
            return true;
        const double rounding = 1e-9; // of a surface on the cell's face
        const glm::dvec3 corner(cell.grid - lattice_.centre);
        const glm::dvec3 lowest = lattice_.toWorld(corner - rounding),
                         highest = lattice_.toWorld(corner + 1.0 + rounding);
        bool touched = false;
        tree().overlapping(lowest, highest, [&](std::uint32_t triangle) {
            const glm::uvec3 face = metres_.faces[triangle];
            touched = touched || touches({metres_.positions[face.x], metres_.positions[face.y],
                                          metres_.positions[face.z]},
                                         lowest, highest);
        });
        return touched;
    }

    bool isPainted(const MaterialRegion& region, const TriangleTree::Closest& closest) const {
        const glm::uvec3 face = metres_.faces[closest.triangle];
        std::uint32_t nearest = face.x;
        for (const std::uint32_t corner : {face.y, face.z})
            if (glm::distance(metres_.positions[corner], closest.point) <
                glm::distance(metres_.positions[nearest], closest.point))
                nearest = corner;
        return apart(metres_.colours[nearest], region.colour) <= region.tolerance;
    }

    const Lattice& lattice_;
    const TriangleMesh& metres_;
    double reach_;                       // m: of a ray that leaves the organ
    std::unique_ptr<TriangleTree> tree_; // once a region asks for the surface
};

} // namespace

Status assignMaterials(Lattice& lattice, const TriangleMesh& metres,
                       const std::vector<MaterialRegion>& regions,
                       const std::function<std::string(int line)>& position) {
    CellChoice choice(lattice, metres);
    for (const MaterialRegion& region : regions) {
        if (region.kind == MaterialRegion::Kind::painted && metres.colours.empty())
            return Error{position(region.place.line) +
                         "the model has no vertex colours, which a painted region goes by: PLY, OFF and OBJ "
                         "files can have them"};
        std::size_t held = 0;
        for (std::size_t cell = 0; cell < lattice.cells.size(); ++cell)
            if (choice.holds(region, cell)) {
                lattice.cells[cell].material = std::uint8_t(region.material);
                ++held;
            }
        if (held == 0)
            return Error{position(region.place.line) + choice.whyEmpty(region)};
    }
    return {};
}

std::vector<MaterialAmount> materialAmounts(const Lattice& lattice, const Tissue& tissue) {
    std::vector<MaterialAmount> amounts(tissue.materialCount());
    const double cellVolume = lattice.spacing * lattice.spacing * lattice.spacing;
    std::vector<std::uint64_t> fills(amounts.size(), 0); // exact, in 1/255
    for (const LatticeCell& cell : lattice.cells) {
        ++amounts.at(cell.material).cells;
        fills[cell.material] += cell.fill;
    }
    for (std::size_t i = 0; i < amounts.size(); ++i) {
        amounts[i].volume = double(fills[i]) / 255 * cellVolume;
        amounts[i].mass = amounts[i].volume * tissue.material(i).density;
    }
    return amounts;
}

} // namespace serosa::sim
