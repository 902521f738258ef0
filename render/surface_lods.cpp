// See render/surface_lods.h.
#include "render/surface_lods.h"

#include <meshoptimizer.h>

namespace serosa::render {

namespace {

constexpr std::size_t kLeastFaces = 10'000, kRatio = 4;
constexpr float kMostError = 0.02F; // of the size

} // namespace

std::vector<SurfaceLod> surfaceLods(const std::vector<glm::dvec3>& positions,
                                    const std::vector<glm::uvec3>& faces) {
    std::vector<SurfaceLod> lods;
    glm::dvec3 middle(0); // organs may lie metres from the origin
    for (const glm::dvec3& p : positions)
        middle += p / double(positions.size());
    std::vector<glm::vec3> points;
    points.reserve(positions.size());
    for (const glm::dvec3& p : positions)
        points.emplace_back(p - middle);
    std::vector<unsigned> indices;
    for (const glm::uvec3& face : faces)
        indices.insert(indices.end(), {face.x, face.y, face.z});
    const double scale = meshopt_simplifyScale(&points[0].x, points.size(), sizeof(glm::vec3));
    double error = 0;
    while (indices.size() / 3 >= kRatio * kLeastFaces) {
        std::vector<unsigned> fewer(indices.size());
        float added = 0;
        fewer.resize(meshopt_simplify(fewer.data(), indices.data(), indices.size(), &points[0].x,
                                      points.size(), sizeof(glm::vec3), indices.size() / kRatio, kMostError,
                                      0, &added));
        if (fewer.size() > indices.size() / 2)
            break; // no further within the error
        error += added * scale;
        SurfaceLod& lod = lods.emplace_back();
        lod.error = error;
        for (std::size_t i = 0; i < fewer.size(); i += 3)
            lod.faces.emplace_back(fewer[i], fewer[i + 1], fewer[i + 2]);
        indices = std::move(fewer);
    }
    return lods;
}

} // namespace serosa::render
