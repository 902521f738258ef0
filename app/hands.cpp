// See app/hands.h.
#include "app/hands.h"

#include "base/check.h"

#include <algorithm>
#include <numbers>

namespace serosa::app {

namespace {

constexpr double kGraspShare = 0.035, kProbeShare = 0.04; // radii, of the organs' size
constexpr double kLeastSpacings =
    1.2; // radius of a grasp: it finds some nodes whatever lies under the pointer
constexpr double kSizesASecond = 2.5; // fastest
constexpr double kGripStrain = 1;     // a grasp gives as much as this strain takes over its cross-section
constexpr double kBeside = 1.02;      // radii that a probe begins beside the surface

} // namespace

Hands::Hands(double spacing, double size, double young, double fastest)
    : paths_{std::make_shared<sim::LiveTool>(), std::make_shared<sim::LiveTool>()},
      fastest_(std::min(fastest, kSizesASecond * size)) {
    sim::Tool grasp, probe;
    grasp.name = "hand";
    grasp.mode = sim::ToolMode::grasp;
    grasp.radius = std::max(kGraspShare * size, kLeastSpacings * spacing);
    grasp.gripForce = kGripStrain * young * std::numbers::pi * grasp.radius * grasp.radius;
    grasp.live = paths_[0];
    probe.name = "finger";
    probe.radius = kProbeShare * size;
    probe.live = paths_[1];
    tools_ = {grasp, probe};
}

void Hands::begin(HandKind kind, double now, const glm::dvec3& touched, const glm::dvec3& toEye) {
    if (active_)
        end(now);
    active_ = kind;
    at_ = target_ = touched;
    away_ = kind == HandKind::probe ? kBeside * tools_[1].radius * toEye : glm::dvec3(0);
    time_ = now;
    path().add({now, at_ + away_, {1, 0, 0, 0}, true});
}

void Hands::sample(double end) {
    if (!active_)
        return;
    SEROSA_CHECK(end > time_, "frames follow one another");
    const glm::dvec3 way = target_ - at_;
    const double length = glm::length(way), most = fastest_ * (end - time_);
    at_ = length > most ? at_ + way * (most / length) : target_;
    time_ = end;
    path().add({end, at_ + away_, {1, 0, 0, 0}, true});
}

void Hands::end(double now) {
    if (!active_)
        return;
    path().add({now, at_ + away_, {1, 0, 0, 0}, false});
    active_.reset();
}

void Hands::clear() {
    active_.reset();
    for (const auto& path : paths_)
        path->clear();
}

} // namespace serosa::app
