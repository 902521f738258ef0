#pragma once
// The panel of `serosa view`, by Dear ImGui: readings, switches, messages, the keys.

#include "app/view_input.h"
#include "gpu/context_window.h"

#include <string>
#include <vector>

namespace serosa::app {

struct ViewReadings {
    std::string scene, renderer; // names
    std::size_t nodes = 0, vertices = 0;
    int frame = 0, stepsPerFrame = 0;
    std::string method;               // of the organs' steps: "explicit", "implicit", "both"; "" of poses
    double time = 0;                  // s, simulated
    double stepMs = 0;                // one step
    double stepsMs = 0;               // all steps of a frame
    double drawMs = 0;                // one picture
    double realTime = 0;              // simulated time over wall time, lately; 0 while paused
    double handForce = -1;            // N, of the hand that is in the scene; < 0: none is
    bool software = false;            // the CPU draws
    std::vector<std::string> stopped; // a line for each organ that the watchdog froze
    std::string message;              // what happened last
    bool isError = false;
};

class ViewPanel {
public:
    /// Needs the window's context current; dies before it.
    explicit ViewPanel(gpu::Window& window);
    ~ViewPanel();
    ViewPanel(const ViewPanel&) = delete;
    ViewPanel& operator=(const ViewPanel&) = delete;

    /// The pointer is over the panel, or a key goes to it: not for the camera.
    bool wantsMouse() const;
    bool wantsKeyboard() const;
    /// Into framebuffer 0, over what is there.
    void draw(ViewControls& controls, const ViewReadings& readings);
};

} // namespace serosa::app
