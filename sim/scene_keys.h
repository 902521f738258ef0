#pragma once
// Every key that a scene file may hold, once: the parser, its messages and the tables of docs/scene.md are
// made of this list.

#include "sim/quantity.h"

#include <string>
#include <vector>

namespace serosa::sim {

enum class ValueKind {
    integer,
    number,
    boolean,
    text,
    texts,
    word,
    quantity,
    quantity3,
    quantityList,
    number3,
    integer2,
    integer3,
    table,
    tables
};

/// Finite numbers from `low` to `high`, without `low` itself if lowOpen. Quantities: in SI units, angles in
/// degrees.
struct ValueRange {
    double low, high;
    bool lowOpen = false;
    bool holds(double value) const { return (lowOpen ? value > low : value >= low) && value <= high; }
    /// "greater than 0", "from 1 to 16", "at least 0", "" where any number will do.
    std::string text() const;
};

struct SceneKey {
    const char* table; // "" at the top, else "organ", "organ.tissue", ...
    const char* name;
    ValueKind kind;
    Dimension dimension;            // of quantities
    ValueRange range;               // of each number
    std::vector<std::string> words; // of ValueKind::word, in the order of the enum that it stands for
    const char* fallback;           // the default as a TOML value; "" none; nullptr: the key is required
    const char* meaning;
    bool required() const { return fallback == nullptr; }
};

/// In the order of docs/scene.md.
const std::vector<SceneKey>& sceneKeys();
/// The entry of a key; null where there is none.
const SceneKey* findSceneKey(const std::string& table, const std::string& name);
/// Names of all keys of a table.
std::vector<std::string> keyNames(const std::string& table);

/// "length, greater than 0", "\"push\" or \"grasp\"", ...: what a key takes.
std::string describeValue(const SceneKey& key);
/// The reference tables in Markdown: docs/scene.md holds them, `serosa scene keys` prints them.
std::string sceneReference();

} // namespace serosa::sim
