// Key poses: linear between two keys, constant outside them. Written so that a key's own time gives its pose
// exactly.

#include "sim/tool.h"

#include "base/check.h"

#include <algorithm>

namespace serosa::sim {

RigidShape Tool::wholeShape() const {
    RigidShape whole = shape;
    whole.radius = radius;
    return whole;
}

RigidPose Tool::poseAt(double time) const {
    if (live)
        return live->poseAt(time);
    SEROSA_CHECK(!keys.empty(), "a tool has at least one key");
    const auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                        [](double t, const ToolKey& key) { return t < key.time; });
    if (after == keys.begin())
        return {keys.front().at, keys.front().turn};
    if (after == keys.end())
        return {keys.back().at, keys.back().turn};
    const ToolKey &a = after[-1], &b = after[0];
    return poseBetween({a.at, a.turn}, {b.at, b.turn}, (time - a.time) / (b.time - a.time));
}

bool Tool::activeAt(double time) const {
    if (live)
        return live->activeAt(time);
    if (mode == ToolMode::push)
        return true;
    return !keys.empty() && keys.front().time <= time && time < keys.back().time;
}

} // namespace serosa::sim
