#pragma once
// Boxes around the triangles of one organ's skin over a whole step, for CPU solvers: 16 triangles that lie
// one after another have a box, and 16 such boxes have one. The triangles are sorted along a curve that keeps
// near ones near (sim/pair_contact_skin.cpp), so that boxes stay small however the organ bends, and placing
// them anew takes one pass. The passes of the GPU (shaders/pair_boxes.comp) have the same boxes.

#include "shaders/shared_constants.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace serosa::sim {

struct Box {
    glm::dvec3 low{1e300}, high{-1e300};
    void add(const Box& other) {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
    void add(const glm::dvec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    /// Squared distance of a point, 0 inside.
    double distance2(const glm::dvec3& point) const {
        const glm::dvec3 apart = glm::max(glm::max(low - point, point - high), glm::dvec3(0));
        return glm::dot(apart, apart);
    }
    bool meets(const Box& other) const {
        return low.x <= other.high.x && low.y <= other.high.y && low.z <= other.high.z &&
               other.low.x <= high.x && other.low.y <= high.y && other.low.z <= high.z;
    }
};

class SkinBoxes {
public:
    /// Box of triangle i = 0 .. count - 1: boxOf(i).
    template <class BoxOf>
    void place(std::size_t count, const BoxOf& boxOf) {
        triangles_.resize(count);
        for (std::size_t i = 0; i < count; ++i)
            triangles_[i] = boxOf(i);
        join(triangles_, leaves_);
        join(leaves_, top_);
        whole_ = Box();
        for (const Box& box : top_)
            whole_.add(box);
    }
    const Box& whole() const { return whole_; }

    /// Calls visit(i), in rising order, for each triangle whose box is nearer to the point than the root of
    /// `limit2`, which visit may lower.
    template <class Visit>
    void near(const glm::dvec3& point, const double& limit2, const Visit& visit) const {
        for (std::size_t t = 0; t < top_.size(); ++t)
            if (top_[t].distance2(point) < limit2)
                for (std::size_t leaf = t * SRS_PAIR_BRANCH, end = last(leaf, leaves_); leaf < end; ++leaf)
                    if (leaves_[leaf].distance2(point) < limit2)
                        for (std::size_t i = leaf * SRS_PAIR_BRANCH, stop = last(i, triangles_); i < stop;
                             ++i)
                            if (triangles_[i].distance2(point) < limit2)
                                visit(i);
    }

private:
    static std::size_t last(std::size_t first, const std::vector<Box>& boxes) {
        return std::min(first + SRS_PAIR_BRANCH, boxes.size());
    }
    static void join(const std::vector<Box>& boxes, std::vector<Box>& joined) {
        joined.assign((boxes.size() + SRS_PAIR_BRANCH - 1) / SRS_PAIR_BRANCH, Box());
        for (std::size_t i = 0; i < boxes.size(); ++i)
            joined[i / SRS_PAIR_BRANCH].add(boxes[i]);
    }

    std::vector<Box> triangles_, leaves_, top_;
    Box whole_;
};

} // namespace serosa::sim
