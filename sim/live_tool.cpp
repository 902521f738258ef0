// See sim/live_tool.h.
#include "sim/live_tool.h"

#include "base/check.h"

#include <algorithm>

namespace serosa::sim {

namespace {

using devices::ToolSample;

/// The first sample after `time`.
auto firstAfter(const std::vector<ToolSample>& samples, double time) {
    return std::upper_bound(samples.begin(), samples.end(), time,
                            [](double t, const ToolSample& sample) { return t < sample.time; });
}

} // namespace

void LiveTool::add(const ToolSample& sample) {
    SEROSA_CHECK(samples_.empty() || sample.time >= samples_.back().time, "samples come in order");
    if (!samples_.empty() && samples_.back().time == sample.time)
        samples_.pop_back();
    samples_.push_back(sample);
    samples_.back().turn = glm::normalize(sample.turn);
}

RigidPose LiveTool::poseAt(double time) const {
    if (samples_.empty())
        return {};
    const auto after = firstAfter(samples_, time);
    if (after == samples_.begin())
        return {samples_.front().at, samples_.front().turn};
    const ToolSample& a = after[-1];
    if (after == samples_.end())
        return {a.at, a.turn};
    const ToolSample& b = after[0];
    return poseBetween({a.at, a.turn}, {b.at, b.turn}, (time - a.time) / (b.time - a.time));
}

bool LiveTool::activeAt(double time) const {
    const auto after = firstAfter(samples_, time);
    return after != samples_.begin() && after[-1].active;
}

} // namespace serosa::sim
