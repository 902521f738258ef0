#pragma once
// Boxes around triangles as a list that a shader walks without a stack (shaders/distance_tree.comp): nodes in
// the order of a depth-first walk, each with the place of the node to go on with when its box is too far
// away.

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace serosa::render {

struct DistanceTree {
    struct Node { // as std430 has it
        glm::vec3 lowest{0};
        std::uint32_t skip = 0; // next node where this one's box is passed by
        glm::vec3 highest{0};
        std::uint32_t leaf = 0; // 8 begin + count of its triangles; 0: its first child follows
    };
    std::vector<Node> nodes;
    std::vector<std::uint32_t> order; // of the triangles: leaves hold ranges of it

    /// \param faces at most 2^29, indices into positions
    static DistanceTree create(const std::vector<glm::vec4>& positions, const std::vector<glm::uvec3>& faces);
};

} // namespace serosa::render
