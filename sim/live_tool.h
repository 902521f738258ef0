#pragma once
// The path of a tool that a hand moves (Tool::live): samples instead of keys, added while the simulation
// runs. All copies of a setup share it, so that solvers see a sample as soon as it is there. A frame is
// simulated once the sample at its end is known; played again, the same samples give the same steps.

#include "devices/tool_sample.h"
#include "sim/rigid_shape.h"

#include <vector>

namespace serosa::sim {

class LiveTool {
public:
    /// Not before the last sample's time, s; at that time it replaces it. `turn` is normalized.
    void add(const devices::ToolSample& sample);
    /// Forgets all samples.
    void clear() { samples_.clear(); }
    const std::vector<devices::ToolSample>& samples() const { return samples_; }

    /// Between samples places are linear, turns at an even rate; before and after them, and without any, it
    /// stays.
    RigidPose poseAt(double time) const;
    /// What the last sample at or before `time` says; false before the first.
    bool activeAt(double time) const;

private:
    std::vector<devices::ToolSample> samples_;
};

} // namespace serosa::sim
