// Meshes a solid and colours its vertices.
#include "models/solid.h"

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

} // namespace serosa::models
