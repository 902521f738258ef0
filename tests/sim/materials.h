#pragma once
// Tissue and lattices of several materials that the tests of solvers share.

#include "sim/lattice.h"
#include "sim/material.h"

#include <cstdint>
#include <random>
#include <vector>

namespace serosa::test {

/// A block with holes and random fills, of material 0.
inline sim::Lattice raggedLattice(std::uint32_t seed, int size = 3) {
    std::mt19937 random(seed);
    std::vector<sim::LatticeCell> cells;
    for (int i = 0; i < size * size * size; ++i)
        if (i == 0 || random() % 3)
            cells.push_back({{i % size, i / size % size, i / size / size}, std::uint8_t(1 + random() % 255)});
    return sim::latticeFromCells(cells, 0.003, glm::dvec3(0));
}

/// The same with random materials 0, 1 and 2.
inline sim::Lattice patchedLattice(std::uint32_t seed, int size = 3) {
    sim::Lattice lattice = raggedLattice(seed, size);
    std::mt19937 random(seed + 1000);
    for (sim::LatticeCell& cell : lattice.cells)
        cell.material = std::uint8_t(random() % 3);
    return lattice;
}

/// Soft and linear; nearly incompressible with a toe region and a limit; stiff, heavy and fibrous. All that
/// materials can be, with damping of their own.
inline sim::Tissue threeMaterials() {
    sim::Tissue tissue;
    tissue.young = 3000;
    tissue.recovery = true;
    sim::Material toe;
    toe.name = "toe";
    toe.poisson = 0.45;
    toe.young = 2000;
    toe.dampingTime = 0.0002;
    toe.curve = {{0.01, 20}, {0.05, 300}, {0.1, 900}};
    toe.strainLimit = 0.2;
    sim::Material muscle;
    muscle.name = "muscle";
    muscle.poisson = 0.3;
    muscle.young = 9000;
    muscle.density = 1500;
    muscle.dampingTime = 0.001;
    muscle.fibre = {1, 2, 0.5};
    muscle.fibreYoung = 20000;
    tissue.others = {toe, muscle};
    return tissue;
}

} // namespace serosa::test
