#pragma once
// The user's hands in a scene: a grasp and a probe that follow a pointer, as live tools (sim/live_tool.h).
// Whatever moves the pointer: the mouse in `serosa view`, or a script in a test. A hand that rests changes
// nothing. Its speed is limited, and its grip is finite: a fast pointer pulls tissue no faster, and lets it
// slip.

#include "sim/live_tool.h"
#include "sim/tool.h"

#include <glm/glm.hpp>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace serosa::app {

enum class HandKind { grasp, probe };

class Hands {
public:
    /// \param spacing of the coarsest lattice, \param size diagonal of the organs' bounds, m.
    /// \param young of the stiffest tissue, Pa. \param fastest m/s: what the organs' steps bear
    Hands(double spacing, double size, double young,
          double fastest = std::numeric_limits<double>::infinity());

    /// Both, for a setup that has room for them.
    const std::vector<sim::Tool>& tools() const { return tools_; }

    /// A hand comes in at time `now`, s. Grasp: takes hold about `touched`. Probe: begins beside it, outside
    /// by its radius.
    /// \param touched on a surface, m. \param toEye unit, away from the tissue
    void begin(HandKind kind, double now, const glm::dvec3& touched, const glm::dvec3& toEye);
    /// Where the pointer wants the point that was touched to be, m.
    void moveTo(const glm::dvec3& target) { target_ = target; }
    /// The frame until `end` is about to be taken.
    void sample(double end);
    /// Lets go, or goes away.
    void end(double now);
    /// Both rest, and have no past.
    void clear();

    std::optional<HandKind> active() const { return active_; }
    /// Where the touched point is held or pushed to now, m.
    const glm::dvec3& at() const { return at_; }

private:
    sim::LiveTool& path() { return *paths_[std::size_t(*active_)]; }

    std::shared_ptr<sim::LiveTool> paths_[2]; // by kind
    std::vector<sim::Tool> tools_;            // by kind
    double fastest_ = 0;                      // m/s
    std::optional<HandKind> active_;
    double time_ = 0;                        // s: of the last sample
    glm::dvec3 at_{0}, target_{0}, away_{0}; // m; away_: from the touched point to the tool's
};

} // namespace serosa::app
