#pragma once
// What a state belongs to, in words that can be compared: the lattice, and all that makes a step. Two setups
// with equal traits take the same steps from the same state. A snapshot keeps them (sim/snapshot.h), so that
// it can say what differs in a scene that it does not belong to.

#include "sim/solver.h"

#include <optional>
#include <string>
#include <vector>

namespace serosa::sim {

struct Trait {
    std::string name;  // "young"
    std::string value; // "5000 Pa"; of long lists: count and hash
    friend bool operator==(const Trait&, const Trait&) = default;
};

/// Of a solver's setup. Whatever is added to Lattice, Tissue, Tool or SolverSetup and changes a step gets its
/// line there.
std::vector<Trait> setupTraits(const SolverSetup& setup);

/// Numbers that read back to the same bits, joined by blanks, with the unit.
std::string traitValue(const std::vector<double>& numbers, const std::string& unit);

/// The first trait that differs, in words ("young is 5000 Pa in the snapshot, 3000 Pa here"); nothing where
/// all are equal, whatever their order.
std::optional<std::string> firstDifference(const std::vector<Trait>& saved, const std::vector<Trait>& here);

} // namespace serosa::sim
