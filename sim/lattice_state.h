#pragma once
// What moves: positions and increments in lattice units (sim/lattice.h), and its hash.

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace serosa::sim {

struct LatticeState {
    std::int64_t step = 0;              // steps taken since rest; time = step * time step
    std::vector<glm::dvec3> positions;  // lattice units, one a node
    std::vector<glm::dvec3> increments; // x_n - x_(n-1), lattice units
    std::vector<std::uint32_t> normals; // packed (sim/packed_normal.h)
    std::vector<std::uint32_t> heldBy;  // 0 free, 1 + tool index
    // 18 bits a node, as Lattice::connections: what cuts left of them. Empty: nothing was ever cut.
    std::vector<std::uint32_t> connections;
    // Of implicit steps: xyz the increment before `increments`, w 1; 0 for a node that has none, because it
    // starts or was held; xyz what contact gave it (mass shares times lattice units), w -1 where it stuck, -2
    // where it slid. Empty: as 0 for all (explicit steps leave it so).
    std::vector<glm::dvec4> earlier;

    /// 128-bit hash (XXH3, hex) of the float32 values: equal for byte-equal snapshots of the GPU state.
    std::string hash() const;
};

} // namespace serosa::sim
