#pragma once
// A scene's deformations under the pointer in `serosa view` (CS07 section 4 and figure 4: a twist or a peel
// is moved, turned and scaled interactively, control points are moved by the user). Ctrl, shift and the left
// button move the box, or the control point under the pointer, in the plane of the view; with the right
// button they turn the box; the wheel meanwhile scales it.

#include "app/run_setup.h"
#include "app/view_input.h"

#include <optional>
#include <string>

namespace serosa::app {

class ViewDeformation {
public:
    /// `parts` outlives this.
    explicit ViewDeformation(RunParts& parts);

    struct Said {
        std::string text; // empty: nothing
        bool isError = false;
    };
    /// Follows pointer and panel, and tells the panel where things are. \param window its size, screen units.
    /// \param time s of the scene
    Said follow(ViewControls& controls, const render::CameraView& camera, const glm::dvec2& window,
                double time);
    /// As the scene says.
    Said restart();

private:
    Said begin(const ViewControls& controls, const render::CameraView& camera, const glm::dvec2& window,
               double time);
    sim::Deformation dragged(BoxDrag drag, ViewControls& controls, const render::CameraView& camera,
                             const glm::dvec2& window);
    Said apply(const sim::Deformation& now);
    Said end();
    void show(DeformationPanel& panel, const render::CameraView& camera, const glm::dvec2& window,
              double time) const;

    RunParts& parts_;
    std::size_t chosen_ = 0;
    std::optional<BoxDrag> wanted_; // of the controls when last seen
    sim::Deformation start_;        // when the drag began
    std::optional<std::size_t> point_;
    glm::dvec2 startPointer_{0}, pointer_{0}; // screen units: of the drag's begin, when last seen
    glm::dvec3 anchor_{0}, toEye_{0, 0, 1};
    double scale_ = 1; // by the wheel, since
    std::string problem_;
};

} // namespace serosa::app
