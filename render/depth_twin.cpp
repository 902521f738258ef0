// Depth maps in double, on the processor (render/depth_maps.h).
#include "render/depth_maps.h"
#include "render/parallel.h"
#include "shaders/raycast_constants.h"
#include "sim/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace serosa::render {

namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Depth of both ends of the body along the column of a texel; (inf, -inf): it meets none.
glm::dvec2 endsOf(const sim::TriangleTree& tree, const VolumeGrid& grid, int axis, int u, int v) {
    glm::dvec3 from(0), along(0);
    from[(axis + 1) % 3] = u;
    from[(axis + 2) % 3] = v;
    from[axis] = -1;
    const double length = grid.size[axis] + 1;
    along[axis] = length * grid.step;
    glm::dvec2 ends(kNone, -kNone);
    tree.allHits(grid.lowest + grid.step * from, along, 1, [&](const sim::TriangleTree::Hit& hit) {
        ends.x = std::min(ends.x, hit.t * length - 1);
        ends.y = std::max(ends.y, hit.t * length - 1);
    });
    return ends;
}

/// What an empty texel gets: shaders/depth_map_finish.comp.
glm::dvec2 beyondRim(const std::vector<glm::dvec2>& ends, int side, int u, int v, FieldKind kind) {
    double nearest = kNone;
    glm::dvec2 at(0);
    for (int y = std::max(v - SRS_DEPTH_RIM, 0); y <= std::min(v + SRS_DEPTH_RIM, side - 1); ++y)
        for (int x = std::max(u - SRS_DEPTH_RIM, 0); x <= std::min(u + SRS_DEPTH_RIM, side - 1); ++x) {
            const glm::dvec2& one = ends[std::size_t(y) * std::size_t(side) + std::size_t(x)];
            const double apart = std::hypot(x - u, y - v);
            if (one.x <= one.y && apart < nearest) {
                nearest = apart;
                at = one;
            }
        }
    if (nearest == kNone)
        return glm::dvec2(0.5 * side) + double(SRS_DEPTH_RIM) * glm::dvec2(1, -1);
    const double half = 0.5 * (at.y - at.x);
    const double out = kind == FieldKind::depth ? std::max(half, 1e-3) + nearest - 1
                       : nearest < 1.5          ? -half
                                                : nearest - 1.5;
    return glm::dvec2(0.5 * (at.x + at.y)) + out * glm::dvec2(1, -1);
}

/// rho min(|f|, |g|), in our sign.
double combined(double f, double g) {
    const double least = std::min(std::abs(f), std::abs(g));
    return f < 0 && g < 0 ? -least : least;
}

} // namespace

DepthLayers depthsOnGrid(const sim::TriangleMesh& mesh, const VolumeGrid& grid, const DepthPlan& plan) {
    const sim::TriangleTree tree(mesh.positions, mesh.faces);
    DepthLayers made{std::max({grid.size.x, grid.size.y, grid.size.z}), {}};
    const auto side = std::size_t(made.side);
    for (int layer = 0; layer < plan.layers(); ++layer) {
        std::vector<glm::dvec2> ends(side * side);
        parallelFor(ends.size(), [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                ends[i] = endsOf(tree, grid, plan.axisOf(layer), int(i % side), int(i / side));
        });
        std::vector<glm::dvec2> whole = ends;
        for (std::size_t i = 0; i < ends.size(); ++i)
            if (ends[i].x > ends[i].y)
                whole[i] = beyondRim(ends, made.side, int(i % side), int(i / side), plan.kind);
        made.layers.push_back(std::move(whole));
    }
    return made;
}

double depthField(const DepthLayers& maps, const VolumeGrid& grid, const DepthPlan& plan,
                  const glm::dvec3& place) {
    const glm::dvec3 free = (place - grid.lowest) / grid.step,
                     at = glm::clamp(free, glm::dvec3(0), glm::dvec3(grid.size - 1));
    double f = -kNone;
    for (int layer = 0; layer < plan.layers(); ++layer) {
        const int axis = plan.axisOf(layer);
        const glm::dvec2 texel(at[(axis + 1) % 3], at[(axis + 2) % 3]);
        const glm::ivec2 cell = glm::min(glm::ivec2(texel), maps.side - 2);
        const glm::dvec2 share = texel - glm::dvec2(cell);
        glm::dvec2 ends(0);
        for (int corner = 0; corner < 4; ++corner) {
            const int x = corner & 1, y = corner >> 1;
            ends += (x ? share.x : 1 - share.x) * (y ? share.y : 1 - share.y) *
                    maps.layers[std::size_t(layer)]
                               [std::size_t(cell.y + y) * std::size_t(maps.side) + std::size_t(cell.x + x)];
        }
        f = combined(combined(f, ends.x - at[axis]), at[axis] - ends.y);
    }
    return grid.step * (f + glm::distance(free, at));
}

} // namespace serosa::render
