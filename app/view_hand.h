#pragma once
// The mouse as a hand in `serosa view`: takes hold of what is drawn under the pointer, or pushes it, and
// moves it in the plane of the view.

#include "app/scene_player.h"
#include "app/surface_pick.h"
#include "app/tissue_pick.h"
#include "app/view_input.h"

#include <string>

namespace serosa::app {

class ViewHand {
public:
    /// `parts` outlives this.
    explicit ViewHand(RunParts& parts) : parts_(parts) {}

    /// Follows the controls. To be called before the frames that follow `now` (s of the scene) are taken.
    /// \param window its size, screen units. Returns what is to be said; mostly nothing. Errors: of the
    /// shaders that say what lies under the pointer.
    Result<std::string> follow(ViewControls& controls, const render::CameraView& camera,
                               const glm::dvec2& window, const ScenePlayer& player);
    /// Before a frame that ends at `end`, s.
    void beforeFrame(double end);
    /// After it: what the active hand felt lately.
    void afterFrame(ScenePlayer& player);
    void restart();

    /// Nothing was wanted when the controls were last followed.
    bool idle() const { return !wanted_; }
    bool active() const { return parts_.hands && parts_.hands->active(); }
    /// N: on the active hand, two frames ago.
    double force() const { return force_; }

private:
    Result<std::optional<glm::dvec3>> pick(const Ray& ray, const ScenePlayer& player);

    RunParts& parts_;
    TissuePick tissue_;
    std::optional<HandKind> wanted_; // of the controls when last seen
    glm::dvec3 toEye_{0, 0, 1};
    double depth_ = 0; // m: how far the wheel moved the plane of the drag away from the user
    glm::dvec3 start_{0};
    double force_ = 0;
};

} // namespace serosa::app
