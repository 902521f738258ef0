// Key poses: linear between two keys, constant outside them. Written so that a key's own time gives its pose
// exactly.

#include "sim/tool.h"

#include "base/check.h"

#include <algorithm>

namespace serosa::sim {

glm::dvec3 Tool::centreAt(double time) const {
    SEROSA_CHECK(!keys.empty(), "a tool has at least one key");
    const auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                        [](double t, const ToolKey& key) { return t < key.time; });
    if (after == keys.begin())
        return keys.front().at;
    if (after == keys.end())
        return keys.back().at;
    const ToolKey &a = after[-1], &b = after[0];
    return a.at + (b.at - a.at) * ((time - a.time) / (b.time - a.time));
}

bool Tool::activeAt(double time) const {
    if (mode == ToolMode::push)
        return true;
    return !keys.empty() && keys.front().time <= time && time < keys.back().time;
}

} // namespace serosa::sim
