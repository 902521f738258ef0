// Chooses the lattice so that marching tetrahedra give about three times the faces wanted, then remeshes.
#include "models/mesher.h"

#include "models/marching_tetrahedra.h"
#include "models/remesher.h"

namespace serosa::models {
namespace {

constexpr double kSurplus = 3.2;    // faces before remeshing, in faces wanted
constexpr double kMostPoints = 8e7; // lattice points: 640 MB

} // namespace

Result<sim::TriangleMesh> meshShape(const MeshSource& source, std::size_t faces) {
    faces += faces % 2;
    const Point extent = source.highest - source.lowest;
    const double coarsest = std::min(0.95 * source.thinnest, std::max({extent.x, extent.y, extent.z}) / 30);
    double cell = coarsest;
    const auto tooMany = [&] {
        return Error{"a phantom of " + std::to_string(faces) +
                     " faces needs more memory than is sensible; ask for fewer faces"};
    };
    if (latticePoints(source, cell) > kMostPoints)
        return tooMany();
    sim::TriangleMesh mesh = marchTetrahedra(source, cell);
    // A coarse lattice misses part of a thin shape, so the first guess may need a second.
    for (int attempt = 0; attempt < 3; ++attempt) {
        const double ratio = static_cast<double>(mesh.faces.size()) / (kSurplus * static_cast<double>(faces));
        if (ratio > 0.85 && (ratio < 1.3 || attempt > 0 || cell == coarsest))
            break;
        cell = std::min(coarsest, cell * std::sqrt(std::max(ratio, 1e-3)));
        if (latticePoints(source, cell) > kMostPoints)
            return tooMany();
        mesh = marchTetrahedra(source, cell);
    }
    mesh = remesh(mesh, source, faces);
    if (mesh.faces.size() < faces ||
        static_cast<double>(mesh.faces.size()) > 1.05 * static_cast<double>(faces))
        return Error{"the phantom cannot be had with " + std::to_string(faces) + " faces (" +
                     std::to_string(mesh.faces.size()) + " is the nearest); ask for more"};
    return mesh;
}

} // namespace serosa::models
