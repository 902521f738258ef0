#pragma once
// The tissue under the pointer, asked of a hierarchy on the GPU (sim/node_tree.h; MS05 3.6): one answer comes
// back, no state and no surface. What the ray meets is the lattice's boundary, which lies up to a spacing
// outside of the drawn surface; how far is known of each node at rest (Lattice::restDepth) and taken off, as
// contact does.

#include "app/surface_pick.h"
#include "base/result.h"
#include "sim/node_tree.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace serosa::app {

struct OrganParts;

class TissuePick {
public:
    /// Where the ray first meets the organ, as a distance along it in m; nothing where it misses.
    /// \param organ its index: a tree is kept for each, made when first asked. \param connections what cuts
    /// left; empty: all. Errors: of the shaders.
    Result<std::optional<double>> firstHit(std::size_t organ, const OrganParts& parts,
                                           const std::vector<std::uint32_t>& connections, const Ray& ray);

private:
    struct Tree {
        const sim::Lattice* lattice = nullptr;  // whose it is: an organ may change its level of detail
        std::vector<std::uint32_t> connections; // it was made for
        std::optional<sim::NodeTree> tree;
    };
    Status update(Tree& tree, const OrganParts& parts, const std::vector<std::uint32_t>& connections);

    std::vector<Tree> trees_; // one an organ
};

} // namespace serosa::app
