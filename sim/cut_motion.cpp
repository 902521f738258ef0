// See sim/cut_motion.h. Neighbouring parts of a stroke share the blade's pose, so nothing is left between
// them.
#include "sim/cut_motion.h"

#include <algorithm>

namespace serosa::sim {

std::vector<Stroke> Cut::strokes(double from, double to) const {
    std::vector<Stroke> result;
    if (kind == StrokeKind::cauterize) {
        for (const CutKey& key : keys)
            if ((from < key.time || (from == 0 && key.time == 0)) && key.time <= to) {
                Stroke stroke;
                stroke.kind = kind;
                stroke.from[0] = key.at;
                stroke.radius = radius;
                result.push_back(stroke);
            }
        return result;
    }
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
        const CutKey &a = keys[i], &b = keys[i + 1];
        const double start = std::max(from, a.time), stop = std::min(to, b.time);
        if (start >= stop)
            continue;
        Stroke stroke;
        const auto edge = [&](double time) -> std::array<glm::dvec3, 2> {
            if (time == b.time)
                return {b.at, b.end};
            const double share = (time - a.time) / (b.time - a.time);
            return {a.at + (b.at - a.at) * share, a.end + (b.end - a.end) * share};
        };
        stroke.from = edge(start);
        stroke.to = edge(stop);
        stroke.continues = start > keys.front().time;
        result.push_back(stroke);
    }
    return result;
}

} // namespace serosa::sim
