// Rest states and hashes of states.
#include "sim/lattice_state.h"

#include "sim/packed_normal.h"
#include "sim/solver.h"

#include <xxhash.h>

#include <cstdio>

namespace serosa::sim {

std::string LatticeState::hash() const {
    XXH3_state_t* hasher = XXH3_createState();
    XXH3_128bits_reset(hasher);
    XXH3_128bits_update(hasher, &step, sizeof step);
    const auto add = [hasher](const std::vector<glm::dvec3>& vectors) {
        for (const glm::dvec3& v : vectors) {
            const glm::vec3 rounded(v);
            XXH3_128bits_update(hasher, &rounded, sizeof rounded);
        }
    };
    add(positions);
    add(increments);
    XXH3_128bits_update(hasher, normals.data(), normals.size() * sizeof normals[0]);
    XXH3_128bits_update(hasher, heldBy.data(), heldBy.size() * sizeof heldBy[0]);
    if (!connections.empty())
        XXH3_128bits_update(hasher, connections.data(), connections.size() * sizeof connections[0]);
    for (const glm::dvec4& v : earlier) {
        const glm::vec4 rounded(v);
        XXH3_128bits_update(hasher, &rounded, sizeof rounded);
    }
    const XXH128_hash_t digest = XXH3_128bits_digest(hasher);
    XXH3_freeState(hasher);
    char text[40];
    std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(digest.high64),
                  static_cast<unsigned long long>(digest.low64));
    return text;
}

LatticeState restState(const Lattice& lattice) {
    LatticeState state;
    state.increments.assign(lattice.nodeCount(), glm::dvec3(0));
    state.heldBy.assign(lattice.nodeCount(), 0);
    state.positions.reserve(lattice.nodeCount());
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        state.positions.push_back(lattice.restPosition(node));
    for (const glm::dvec3& sum : restNormalSums(lattice))
        state.normals.push_back(packNormal(glm::vec3(sum)));
    return state;
}

} // namespace serosa::sim
