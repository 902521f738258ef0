#pragma once
// Colours of a surface as its vertices carry them: its own or flesh, and the light of the surround that is
// baked for them (render/baked_occlusion.h).

#include "sim/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace serosa::render {

/// Square root of the linear colour of each vertex, and the light of the surround that arrives there.
/// \param bare linear colour of a mesh without colours; null: flesh
std::vector<glm::u8vec4> vertexColours(const sim::TriangleMesh& mesh, const glm::vec3* bare);

} // namespace serosa::render
