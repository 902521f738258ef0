#pragma once
// What keys and mouse do in `serosa view` (docs/view.md): to the camera at once, to the rest through switches
// that the panel sets, too.

#include "app/hands.h"
#include "app/orbit_camera.h"
#include "gpu/context_window.h"
#include "sim/scene.h"

#include <glm/glm.hpp>

#include <optional>

namespace serosa::app {

/// What keys and panel both set; the loop of the view acts on it.
struct ViewControls {
    bool paused = false, wireframe = false, panel = true;
    sim::Look look;
    sim::Mapping sceneMapping = sim::Mapping::curvature; // what the scene asks for
    // Asked for once; the loop clears them.
    // A hand that follows the pointer, as long as a button is held.
    std::optional<HandKind> hand;
    glm::dvec2 pointer{0}; // screen units from the window's top left corner, y down
    double deeper = 0;     // turns of the wheel away from the user since the last look
    int steps = 0;         // frames, one by one
    bool restart = false, picture = false, windowPicture = false, reload = false, resetCamera = false,
         quit = false;
};

class ViewInput {
public:
    /// Both outlive this.
    ViewInput(ViewControls& controls, OrbitCamera& camera) : controls_(controls), camera_(camera) {}

    /// \param height of the window, in the units of events. \param taken the panel has this event: a drag
    /// does not begin, a key or the wheel does nothing.
    void take(const gpu::WindowEvent& event, int height, bool taken);

private:
    void mouse(const gpu::WindowEvent& event, double height, bool taken);
    void key(const gpu::WindowEvent& event);
    void press(int key);

    enum class Drag { none, turn, move };
    ViewControls& controls_;
    OrbitCamera& camera_;
    Drag drag_ = Drag::none;
    glm::dvec2 pointer_{0};
};

} // namespace serosa::app
