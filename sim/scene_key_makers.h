#pragma once
// What the lists of scene keys (sim/scene_keys*.cpp) are written with.

#include "sim/scene_keys.h"

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace serosa::sim {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr ValueRange kAny{-kInfinity, kInfinity};
constexpr ValueRange kPositive{0, kInfinity, true};
constexpr ValueRange kNotNegative{0, kInfinity};
constexpr ValueRange kShare{0, 1, true};

inline SceneKey quantity(const char* table, const char* name, Dimension dimension, ValueRange range,
                         const char* fallback, const char* meaning, ValueKind kind = ValueKind::quantity) {
    return {table, name, kind, dimension, range, {}, fallback, meaning};
}
inline SceneKey plain(const char* table, const char* name, ValueKind kind, ValueRange range,
                      const char* fallback, const char* meaning) {
    return {table, name, kind, Dimension::length, range, {}, fallback, meaning};
}
inline SceneKey word(const char* table, const char* name, std::vector<std::string> words,
                     const char* fallback, const char* meaning) {
    return {table, name, ValueKind::word, Dimension::length, kAny, std::move(words), fallback, meaning};
}

using Kind = ValueKind;
using Dim = Dimension;

/// Of `[deformation]` (sim/scene_keys_deformation.cpp).
std::vector<SceneKey> deformationKeys();

/// Of `[look.cut_volume]` (sim/scene_keys_deformation.cpp).
std::vector<SceneKey> cutVolumeKeys();

} // namespace serosa::sim
