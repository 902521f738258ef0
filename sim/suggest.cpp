// Edit distance by the usual table of prefixes (optimal string alignment: a swap of neighbours counts once).

#include "sim/suggest.h"

#include <algorithm>
#include <cctype>

namespace serosa::sim {

namespace {

std::string lowerCase(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        c = char(std::tolower(static_cast<unsigned char>(c)));
    return lower;
}

// Longer words than any key are not near to one, and must not cost quadratic time.
constexpr std::size_t kLongestWord = 64;

} // namespace

std::size_t editDistance(std::string_view a, std::string_view b) {
    const std::size_t columns = b.size() + 1;
    std::vector<std::size_t> table((a.size() + 1) * columns);
    const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& { return table[i * columns + j]; };
    for (std::size_t i = 0; i <= a.size(); ++i)
        at(i, 0) = i;
    for (std::size_t j = 0; j <= b.size(); ++j)
        at(0, j) = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replace = at(i - 1, j - 1) + (a[i - 1] == b[j - 1] ? 0 : 1);
            at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, replace});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
        }
    }
    return at(a.size(), b.size());
}

std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates) {
    if (word.empty() || word.size() > kLongestWord)
        return "";
    const std::string lower = lowerCase(word);
    std::string nearest;
    std::size_t least = kLongestWord;
    for (const std::string& candidate : candidates) {
        const std::size_t distance = editDistance(lower, lowerCase(candidate));
        const std::size_t allowed = std::max<std::size_t>(1, std::max(word.size(), candidate.size()) / 3);
        if (distance <= allowed && distance < least) {
            least = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& candidates) {
    if (const std::string nearest = nearestWord(word, candidates); !nearest.empty())
        return "; did you mean '" + nearest + "'?";
    std::string known;
    for (const std::string& candidate : candidates)
        known += (known.empty() ? "" : ", ") + candidate;
    return " (known: " + known + ")";
}

} // namespace serosa::sim
