// See render/distance_tree.h.
#include "render/distance_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace serosa::render {

namespace {

constexpr std::size_t kLeafSize = 2; // at most 7: shares a word

struct Box {
    glm::vec3 lowest{std::numeric_limits<float>::max()}, highest{-std::numeric_limits<float>::max()};
    void add(const Box& other) {
        lowest = glm::min(lowest, other.lowest);
        highest = glm::max(highest, other.highest);
    }
};

/// Splits by the median of the centres along the longest side of the box around them.
void build(DistanceTree& tree, const std::vector<Box>& boxes, std::size_t begin, std::size_t end) {
    Box all, centres;
    for (std::size_t i = begin; i < end; ++i) {
        const Box& one = boxes[tree.order[i]];
        const glm::vec3 centre = one.lowest + one.highest;
        all.add(one);
        centres.add({centre, centre});
    }
    const std::size_t index = tree.nodes.size();
    const bool leaf = end - begin <= kLeafSize;
    tree.nodes.push_back({all.lowest, 0, all.highest, leaf ? std::uint32_t(8 * begin + (end - begin)) : 0});
    if (!leaf) {
        const glm::vec3 size = centres.highest - centres.lowest;
        const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        const std::size_t middle = (begin + end) / 2;
        const auto at = [&](std::size_t i) { return tree.order.begin() + std::ptrdiff_t(i); };
        std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
            const float x = boxes[a].lowest[axis] + boxes[a].highest[axis],
                        y = boxes[b].lowest[axis] + boxes[b].highest[axis];
            return x < y || (x == y && a < b);
        });
        build(tree, boxes, begin, middle);
        build(tree, boxes, middle, end);
    }
    tree.nodes[index].skip = std::uint32_t(tree.nodes.size());
}

} // namespace

DistanceTree DistanceTree::create(const std::vector<glm::vec4>& positions,
                                  const std::vector<glm::uvec3>& faces) {
    std::vector<Box> boxes(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 p(positions[faces[i][k]]);
            boxes[i].add({p, p});
        }
    DistanceTree tree;
    tree.order.resize(faces.size());
    std::iota(tree.order.begin(), tree.order.end(), 0u);
    if (!faces.empty())
        build(tree, boxes, 0, faces.size());
    return tree;
}

} // namespace serosa::render
