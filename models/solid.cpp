// Meshes a solid and colours its vertices, or samples it.
#include "models/solid.h"

#include <cmath>

namespace serosa::models {

Result<sim::TriangleMesh> meshSolid(const Solid& solid, std::size_t faces) {
    if (faces < solid.fewest || faces > solid.most)
        return Error{"the " + solid.name + " phantom has from " + std::to_string(solid.fewest) + " to " +
                     std::to_string(solid.most) + " faces, not " + std::to_string(faces)};
    SEROSA_ASSIGN(sim::TriangleMesh mesh, meshShape(solid.source, faces));
    mesh.colours.reserve(mesh.positions.size());
    for (const Point& p : mesh.positions)
        mesh.colours.push_back(solid.colour(p));
    return mesh;
}

Result<ColourVolume> sampleSolid(const Solid& solid, double voxel) {
    constexpr int kMost = 512;
    constexpr double kBeyond = 2; // voxels: so far outside colours go on, for what lies between voxels
    if (!(voxel > 0) || !std::isfinite(voxel))
        return Error{"a voxel has a length above 0"};
    const Point extent = solid.source.highest - solid.source.lowest;
    ColourVolume made;
    made.voxel = voxel;
    for (int axis = 0; axis < 3; ++axis) {
        const double count = std::ceil(extent[axis] / voxel);
        if (count > kMost)
            return Error{"voxels of " + std::to_string(voxel) + " mm are " + std::to_string(count) +
                         " along an axis of the " + solid.name + " phantom, and " + std::to_string(kMost) +
                         " are the most: take larger ones"};
        made.size[axis] = int(count);
    }
    made.lowest = 0.5 * (solid.source.lowest + solid.source.highest) - 0.5 * voxel * (Point(made.size) - 1.0);
    made.voxels.reserve(std::size_t(made.size.x) * std::size_t(made.size.y) * std::size_t(made.size.z));
    for (int z = 0; z < made.size.z; ++z)
        for (int y = 0; y < made.size.y; ++y)
            for (int x = 0; x < made.size.x; ++x) {
                const Point at = made.lowest + voxel * Point(x, y, z);
                made.voxels.push_back(solid.source.distance(at) < kBeyond * voxel ? solid.colour(at)
                                                                                  : glm::u8vec3(0));
            }
    return made;
}

} // namespace serosa::models
