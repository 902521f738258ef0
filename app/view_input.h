#pragma once
// What keys and mouse do in `serosa view` (docs/view.md): to the camera at once, to the rest through switches
// that the panel sets, too.

#include "app/hands.h"
#include "app/orbit_camera.h"
#include "gpu/context_window.h"
#include "sim/scene.h"

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace serosa::app {

/// What a drag does to the box of a deformation (app/view_deformation.h).
enum class BoxDrag { move, turn };

/// The chosen deformation of a scene, as panel and view show it to each other.
struct DeformationPanel {
    std::vector<std::string> names; // of all; empty: the scene has none
    int chosen = 0;
    glm::vec3 at{0}; // mm: middle of its box
    float scale = 1, amount = 0;
    const char* unit = nullptr; // of amount; null: it has none
    // The panel did these; the view clears them.
    bool edited = false, settled = false, restore = false;
    bool outline = true;                                // the box is shown
    std::vector<std::pair<glm::vec2, glm::vec2>> lines; // of it, in the window
};

/// What keys and panel both set; the loop of the view acts on it.
struct ViewControls {
    bool paused = false, wireframe = false, panel = true;
    sim::Look look;
    sim::Mapping sceneMapping = sim::Mapping::curvature; // what the scene asks for
    // A hand that follows the pointer, as long as a button is held.
    std::optional<HandKind> hand;
    glm::dvec2 pointer{0}; // screen units from the window's top left corner, y down
    double deeper = 0;     // turns of the wheel away from the user since the last look
    // A deformation that follows it, likewise: the wheel then scales its box.
    std::optional<BoxDrag> box;
    bool nextBox = false; // the next one of the scene's deformations
    DeformationPanel deformation;
    // Asked for once; the loop clears them.
    int steps = 0; // frames, one by one
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
