// See app/view_deformation.h.
#include "app/view_deformation.h"

#include "app/surface_pick.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

namespace serosa::app {

namespace {

constexpr double kGrab = 0.04;       // of the window's height: so near a control point is taken hold of
constexpr double kWheelScale = 1.05; // a notch
constexpr double kLeast = 0.02, kMost = 50; // of a box's scale
constexpr int kCurve = 8;                   // lines of a wound edge

double degrees(double radians) {
    return radians * 180 / std::numbers::pi;
}

bool turns(sim::DeformationKind kind) {
    return kind == sim::DeformationKind::twist || kind == sim::DeformationKind::bend;
}

bool hasAmount(sim::DeformationKind kind) {
    using Kind = sim::DeformationKind;
    return turns(kind) || kind == Kind::pull || kind == Kind::wave || kind == Kind::peel ||
           kind == Kind::knife || kind == Kind::seam || kind == Kind::incision;
}

/// From the window's top left corner; nothing: behind the eye.
std::optional<glm::dvec2> onWindow(const render::CameraView& camera, const glm::dvec2& window,
                                   const glm::dvec3& at) {
    const glm::dvec4 clip = camera.clipFromCamera * (camera.cameraFromWorld * glm::dvec4(at, 1));
    if (clip.w <= 1e-9)
        return std::nullopt;
    return window * (glm::dvec2(0.5) + glm::dvec2(0.5, -0.5) * glm::dvec2(clip) / clip.w);
}

/// A row of the camera's axes in the world: right, up, to the eye.
glm::dvec3 axisOf(const render::CameraView& camera, int row) {
    return {camera.cameraFromWorld[0][row], camera.cameraFromWorld[1][row], camera.cameraFromWorld[2][row]};
}

/// As a scene file has numbers.
std::string plainText(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.5g", std::abs(value) < 1e-9 ? 0 : value);
    return text;
}

std::string lengthsText(const glm::dvec3& at) {
    std::string text = "[";
    for (int axis = 0; axis < 3; ++axis)
        text += (axis ? ", \"" : "\"") + plainText(1e3 * at[axis]) + " mm\"";
    return text + "]";
}

std::string numbersText(const glm::dvec3& at) {
    return "[" + plainText(at.x) + ", " + plainText(at.y) + ", " + plainText(at.z) + "]";
}

/// What a scene file says of it.
std::string sceneText(const sim::Deformation& one) {
    const sim::DeformationKey place = one.placeAt(0);
    std::string text = "at = " + lengthsText(place.at) + ", up = " + numbersText(one.up) +
                       ", along = " + numbersText(one.along);
    if (place.scale != 1 || place.turn != 0)
        text += ", keys = [{ t = \"0 s\", at = " + lengthsText(place.at) + ", turn = \"" +
                plainText(degrees(place.turn)) + " deg\", scale = " + plainText(place.scale) + " }]";
    if (turns(one.kind))
        text += ", angle = \"" + plainText(degrees(one.amount)) + " deg\"";
    else if (hasAmount(one.kind))
        text += ", amount = \"" + plainText(1e3 * one.amount) + " mm\"";
    for (std::size_t k = 0; k < one.points.size(); ++k)
        text += (k ? ", " : ", points = [") + std::string("{ from = ") + lengthsText(one.points[k].first) +
                ", to = " + lengthsText(one.points[k].second) + " }" +
                (k + 1 == one.points.size() ? "]" : "");
    return text;
}

} // namespace

ViewDeformation::ViewDeformation(RunParts& parts) : parts_(parts) {}

ViewDeformation::Said ViewDeformation::begin(const ViewControls& controls, const render::CameraView& camera,
                                             const glm::dvec2& window, double time) {
    const SceneDeformation& all = *parts_.implicit.deformation();
    start_ = all.deformation(chosen_);
    const sim::DeformationKey place = start_.placeAt(time);
    start_.at = place.at;
    start_.keys = {place}; // it stays where the hand leaves it
    startPointer_ = pointer_ = controls.pointer;
    toEye_ = axisOf(camera, 2);
    anchor_ = place.at;
    scale_ = 1;
    point_.reset();
    double nearest = kGrab * window.y;
    const render::TextureMapping mapping = all.mapping(chosen_, time);
    for (std::size_t k = 0; k < start_.points.size() && *controls.box == BoxDrag::move; ++k) {
        const glm::dvec3 at = mapping.toObject(start_.points[k].second);
        const auto seen = onWindow(camera, window, at);
        if (seen && glm::distance(*seen, controls.pointer) < nearest) {
            nearest = glm::distance(*seen, controls.pointer);
            point_ = k;
            anchor_ = at;
        }
    }
    const std::string name = all.name(chosen_);
    return {point_ ? "point " + std::to_string(*point_ + 1) + " of the " + name
                   : (*controls.box == BoxDrag::move ? "moves the " : "turns the ") + name};
}

sim::Deformation ViewDeformation::dragged(BoxDrag drag, ViewControls& controls,
                                          const render::CameraView& camera, const glm::dvec2& window) {
    sim::Deformation now = start_;
    sim::DeformationKey& place = now.keys.front();
    scale_ = std::clamp(scale_ * std::pow(kWheelScale, std::exchange(controls.deeper, 0)),
                        kLeast / place.scale, kMost / place.scale);
    const glm::dvec3 way = onPlane(rayThrough(camera, controls.pointer, window), anchor_, toEye_) -
                           onPlane(rayThrough(camera, startPointer_, window), anchor_, toEye_);
    if (point_) {
        // The box's own axes, which a scene's points are in.
        const render::TextureMapping mapping =
            parts_.implicit.deformation()->mapping(chosen_, start_.keys.front().time);
        now.points[*point_].second = mapping.toTexture(anchor_ + way);
        return now;
    }
    place.scale *= scale_;
    if (drag == BoxDrag::move) {
        place.at += way;
    } else {
        const glm::dvec2 by = std::numbers::pi / window.y * (controls.pointer - startPointer_);
        const glm::dmat3 turn = glm::dmat3(glm::rotate(glm::dmat4(1), by.x, axisOf(camera, 1))) *
                                glm::dmat3(glm::rotate(glm::dmat4(1), by.y, axisOf(camera, 0)));
        now.up = glm::normalize(turn * start_.up);
        now.along = turn * start_.along;
        now.along = glm::normalize(now.along - glm::dot(now.along, now.up) * now.up);
    }
    now.at = place.at;
    return now;
}

ViewDeformation::Said ViewDeformation::apply(const sim::Deformation& now) {
    SceneDeformation& all = *parts_.implicit.deformation();
    const Status edited = all.edit(chosen_, now);
    std::string problem = edited.ok() ? "" : edited.error().message;
    if (std::exchange(problem_, problem) == problem || problem.empty())
        return {};
    return {problem, true};
}

/// Says where it is, as a scene would; or what is wrong with it there.
ViewDeformation::Said ViewDeformation::end() {
    SceneDeformation& all = *parts_.implicit.deformation();
    for (std::size_t i = 0; i < parts_.organs.size(); ++i)
        if (const Status fits = all.check(i, parts_.organs[i]->surface.metres); !fits.ok())
            return {fits.error().message, true};
    std::string text = all.name(chosen_) + ": " + sceneText(all.deformation(chosen_));
    for (const std::string& note : all.notes())
        text += "\n" + note;
    return {text};
}

ViewDeformation::Said ViewDeformation::follow(ViewControls& controls, const render::CameraView& camera,
                                              const glm::dvec2& window, double time) {
    DeformationPanel& panel = controls.deformation;
    const bool next = std::exchange(controls.nextBox, false);
    SceneDeformation* const all = parts_.implicit.deformation();
    if (!all) {
        const bool begun = std::exchange(wanted_, controls.box) != controls.box && controls.box;
        return {begun || next ? "no deformation here" : ""};
    }
    Said said;
    if (!controls.box) { // the wheel is the camera's
        if (next)
            panel.chosen = int((chosen_ + 1) % all->count());
        if (chosen_ != std::size_t(panel.chosen) || next) {
            chosen_ = std::size_t(panel.chosen);
            said.text = "deformation " + std::to_string(chosen_ + 1) + " of " + std::to_string(all->count()) +
                        ": " + all->name(chosen_);
        } else if (std::exchange(panel.restore, false)) {
            said = restart();
        } else if (std::exchange(panel.edited, false)) {
            sim::Deformation now = all->deformation(chosen_);
            sim::DeformationKey place = now.placeAt(time);
            place.at = 1e-3 * glm::dvec3(panel.at);
            place.scale = std::clamp(double(panel.scale), kLeast, kMost);
            now.at = place.at;
            now.keys = {place};
            if (hasAmount(now.kind))
                now.amount = turns(now.kind) ? panel.amount * std::numbers::pi / 180 : 1e-3 * panel.amount;
            said = apply(now);
        } else if (std::exchange(panel.settled, false)) {
            said = end();
        }
    }
    const std::optional<BoxDrag> before = std::exchange(wanted_, controls.box);
    if (before != controls.box && controls.box) {
        said = begin(controls, camera, window, time);
    } else if (before) {
        // To where the button was let go, too; a hand that rests changes nothing.
        if (std::exchange(pointer_, controls.pointer) != controls.pointer || controls.deeper != 0)
            said = apply(dragged(*before, controls, camera, window));
        if (!controls.box && !said.isError)
            said = end();
    }
    show(panel, camera, window, time);
    return said;
}

ViewDeformation::Said ViewDeformation::restart() {
    SceneDeformation* const all = parts_.implicit.deformation();
    if (!all)
        return {};
    wanted_.reset();
    problem_.clear();
    const Status restored = all->restore();
    return restored.ok() ? Said{"deformations as in the scene"} : Said{restored.error().message, true};
}

void ViewDeformation::show(DeformationPanel& panel, const render::CameraView& camera,
                           const glm::dvec2& window, double time) const {
    const SceneDeformation& all = *parts_.implicit.deformation();
    const sim::Deformation& one = all.deformation(chosen_);
    const sim::DeformationKey place = one.placeAt(time);
    panel.names.clear();
    for (std::size_t i = 0; i < all.count(); ++i)
        panel.names.push_back(std::to_string(i + 1) + ": " + all.name(i));
    panel.chosen = int(chosen_);
    panel.at = glm::vec3(1e3 * place.at);
    panel.scale = float(place.scale);
    panel.unit = turns(one.kind) ? "deg" : hasAmount(one.kind) ? "mm" : nullptr;
    panel.amount = float(turns(one.kind) ? degrees(one.amount) : 1e3 * one.amount);
    panel.lines.clear();
    const render::TextureMapping mapping = all.mapping(chosen_, time);
    const auto line = [&](const glm::dvec3& from, const glm::dvec3& to) {
        const auto a = onWindow(camera, window, mapping.toObject(from)),
                   b = onWindow(camera, window, mapping.toObject(to));
        if (a && b)
            panel.lines.emplace_back(*a, *b);
    };
    const int parts = one.wound > 0 ? kCurve : 1;
    for (int axis = 0; axis < 3; ++axis)
        for (const double u : {-0.5, 0.5})
            for (const double v : {-0.5, 0.5})
                for (int k = 0; k < parts; ++k) {
                    glm::dvec3 share(0);
                    share[(axis + 1) % 3] = u;
                    share[(axis + 2) % 3] = v;
                    const auto at = [&](int i) {
                        share[axis] = double(i) / parts - 0.5;
                        return share * one.size;
                    };
                    line(at(k), at(k + 1));
                }
    for (const auto& [from, to] : one.points) {
        line(from, to);
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 by(0);
            by[axis] = 0.01 * one.size[axis];
            line(to - by, to + by);
        }
    }
}

} // namespace serosa::app
