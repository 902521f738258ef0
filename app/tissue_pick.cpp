// See app/tissue_pick.h.
#include "app/tissue_pick.h"

#include "app/run_setup.h"
#include "sim/pieces.h"

#include <algorithm>
#include <utility>

namespace serosa::app {

Status TissuePick::update(Tree& tree, const OrganParts& parts,
                          const std::vector<std::uint32_t>& connections) {
    const bool others = tree.lattice != &parts.lattice;
    if (others) {
        SEROSA_ASSIGN(sim::NodeTree made, sim::NodeTree::create(parts.lattice, parts.textures().layout()));
        tree.tree.emplace(std::move(made));
        tree.lattice = &parts.lattice;
        tree.connections.clear();
    }
    if (connections != tree.connections) {
        tree.tree->rebuild(parts.lattice, connections.empty()
                                              ? parts.lattice.boundary
                                              : sim::boundaryLeft(parts.lattice, connections));
        tree.connections = connections;
    }
    tree.tree->refit(parts.textures());
    return {};
}

Result<std::optional<double>> TissuePick::firstHit(std::size_t organ, const OrganParts& parts,
                                                   const std::vector<std::uint32_t>& connections,
                                                   const Ray& ray) {
    trees_.resize(std::max(trees_.size(), organ + 1));
    Tree& tree = trees_[organ];
    SEROSA_TRY(update(tree, parts, connections));
    SEROSA_ASSIGN(const std::optional<sim::NodeTree::Pick> pick,
                  tree.tree->pick(parts.textures(), ray.from, ray.along));
    if (!pick)
        return std::optional<double>();
    double depth = 0; // spacings below the surface; negative outside
    for (int k = 0; k < 3; ++k)
        depth += pick->weights[k] * parts.lattice.restDepth(pick->nodes[k]);
    return std::optional<double>(pick->distance + std::max(-depth, 0.0) * parts.lattice.spacing);
}

} // namespace serosa::app
