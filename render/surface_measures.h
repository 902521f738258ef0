#pragma once
// What the figures of MS05 show, as numbers: the jagged silhouette (figure 2), stretched edges and flipped
// faces across triangles of nodes (figures 5 and 6), and how far normals are from the true ones.

#include <glm/glm.hpp>

#include <functional>
#include <vector>

namespace serosa::render {

/// Figure 2: how far the outline along +-`axis` (0 x, 1 y, 2 z) departs from the same outline, averaged over
/// `window`; root mean square. The outline is the farthest point of the projected edges in each of 1440
/// directions from the middle of the projection's bounds.
/// \param positions, window in one unit, which is the result's; at least one face
double silhouetteJaggedness(const std::vector<glm::dvec3>& positions, const std::vector<glm::uvec3>& faces,
                            int axis, double window);

/// Figures 5 and 6: a mapped surface against the one that the deformation itself makes.
struct SurfaceDamage {
    double largestStretch = 0; // of an edge, over its length under the deformation itself
    std::size_t flipped = 0;   // faces that look the other way than under the deformation itself
};
SurfaceDamage surfaceDamage(const std::vector<glm::dvec3>& mapped, const std::vector<glm::dvec3>& deformed,
                            const std::vector<glm::uvec3>& faces);

struct AngleSpread {
    double median = 0, largest = 0; // degrees
};
/// Between two unit vectors each.
AngleSpread anglesBetween(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b);

/// The upper quantile of values that may not be empty; 1: the largest. NaN wins.
double quantile(std::vector<double> values, double share);

} // namespace serosa::render
