#pragma once
// `serosa view`: a scene in a window. Whole frames of the scene follow a clock of their own; how often they
// are drawn changes nothing in them (app/frame_clock.h).

#include "app/run.h"

#include <filesystem>
#include <iosfwd>

namespace serosa::app {

struct ViewOptions {
    RunOptions run;                       // gl, out, force and frames are not looked at
    std::filesystem::path shaders;        // folder that F5 takes the drawing shaders from; empty: none
    std::filesystem::path pictures = "."; // folder for screenshots
    int quitAfter = 0;                    // frames, counted from the last reset; 0: open until closed
    bool fast = false;                    // as fast as it goes, not in real time
    bool panel = true;
};

/// Opens the window and returns when it is closed: 0, 1 (the state ran away), 130 (interrupted). Says on
/// `out` what it does, one line each; the last one has the frame and the hash of the state. Errors: bad
/// input; no display, or a display that goes away (exit code 5).
Result<int> runView(const ViewOptions& options, std::ostream& out);

} // namespace serosa::app
