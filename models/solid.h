#pragma once
// A phantom by its functions: what its mesh is made of now, and what a volume can be sampled from later.
// Lengths in millimetres, y up, about the origin, in the frame of makePhantom.

#include "models/mesher.h"

#include <string>
#include <vector>

namespace serosa::models {

struct Solid {
    std::string name;  // as in the list of phantoms
    MeshSource source; // signed distance, box, thinnest wall, relative size of faces
    /// Colour (sRGB) at a point of the surface; inside, what a cut there would show.
    std::function<glm::u8vec3(const Point&)> colour;
    std::size_t fewest, most; // faces that resolve the shape; faces that memory and time allow
};

/// The surface of `solid` with vertex colours. Errors: a face count out of its range.
Result<sim::TriangleMesh> meshSolid(const Solid& solid, std::size_t faces);

/// What cuts through a solid show, voxel by voxel.
struct ColourVolume {
    glm::ivec3 size{0};
    double voxel = 0;                // mm, along each axis
    Point lowest{0};                 // mm: middle of the first voxel
    std::vector<glm::u8vec3> voxels; // sRGB, x fastest; black far outside
};
/// Errors: a voxel that is not a length above 0, more than 512 along an axis.
Result<ColourVolume> sampleSolid(const Solid& solid, double voxel);

} // namespace serosa::models
