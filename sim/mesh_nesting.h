#pragma once
// Which closed shell lies inside which: a vertex lies in a shell if the shell's signed solid angles around it
// sum up to a full turn (van Oosterom & Strackee 1983). Unlike a ray, the sum has no edge or corner to hit.

#include "sim/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

struct Shell {
    double volume = 0;       // signed: positive when wound outward
    std::uint32_t depth = 0; // number of shells that it lies in
};

/// How often the shell of these faces winds around p: 1 inside of an outward one, -1 inside of an inward one,
/// 0 outside.
double windingNumber(const TriangleMesh& mesh, const std::vector<std::uint32_t>& faces, const glm::dvec3& p);

/// One a shell. Where two shells cross, most of up to nine vertices decide.
std::vector<Shell> findNesting(const TriangleMesh& mesh,
                               const std::vector<std::vector<std::uint32_t>>& shellFaces);

} // namespace serosa::sim
