#pragma once
// What Xlib would end the program for: a display that goes away, a window that another program destroys. Its
// handlers are replaced, so that both become a state that the window's owner asks for. Apart from the rest of
// gpu/, because Xlib's macros (Status, None, Bool) fit no C++ header. Private to gpu/.

namespace serosa::gpu {

/// Watches the display that GLFW has opened (nothing on other window systems). Repeat it after GLFW calls
/// that may have put Xlib's own error handler back: all that open windows.
void watchDisplay();

/// Why nothing can be shown any more, or null. Stays so until the program ends.
const char* displayProblem();

} // namespace serosa::gpu
