#pragma once
// "Did you mean ...": the nearest of the known words, for messages about unknown keys, units and names.

#include <string>
#include <string_view>
#include <vector>

namespace serosa::sim {

/// Letters to insert, delete, replace or swap with their neighbour to turn `a` into `b` (optimal string
/// alignment).
std::size_t editDistance(std::string_view a, std::string_view b);

/// The candidate nearest to `word`, upper and lower case alike, or "" where none is near: at most a third of
/// its letters (at least one) differ. The first of equals wins.
std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates);

/// "; did you mean 'stiffness'?", or " (known: a, b, c)" where none is near.
std::string suggestion(std::string_view word, const std::vector<std::string>& candidates);

} // namespace serosa::sim
