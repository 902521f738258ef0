#pragma once
// A window with an OpenGL 4.5 core context, by GLFW: the fourth kind of context (gpu/context.h), made only
// when asked for. Context and window come together: the context is used like any other; the window gives what
// the user does, and shows what was drawn into framebuffer 0. Windows belong to the main thread.

#include "gpu/context.h"

#include <glm/glm.hpp>

#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;

namespace serosa::gpu {

/// Keys without a character of their own. Other keys come as the character that they type without shift, in
/// lower case and in the user's layout: 'r', ' ', '.', '1'.
enum WindowKey : int {
    keyEscape = 256,
    keyLeft,
    keyRight,
    keyUp,
    keyDown,
    keyPageUp,
    keyPageDown,
    keyHome,
    keyF1,
    keyF5 = keyF1 + 4,
    keyF12 = keyF1 + 11
};

enum class MouseButton { left, right, middle };

/// One thing that the user did, in the order in which it was done.
struct WindowEvent {
    enum class Kind { keyPressed, buttonPressed, buttonReleased, moved, scrolled } kind = Kind::moved;
    int key = 0;           // character or WindowKey; 0: a key that has neither
    bool repeated = false; // keyPressed: the key is held down
    bool shift = false, control = false;
    MouseButton button = MouseButton::left;
    glm::dvec2 at{
        0}; // moved, button...: from the window's top left corner, y down, in screen units; scrolled: amounts
};

/// What the window and its context share, private to the implementation.
struct WindowState;

class Window {
public:
    explicit Window(std::shared_ptr<WindowState> state);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// What happened since the last call; waits up to `seconds` (0: not at all) for something to happen.
    std::vector<WindowEvent> poll(double seconds);
    /// The user wants it closed.
    bool closing() const;
    /// Why nothing can be shown any more (the display went away, another program destroyed the window), or
    /// empty. The GL context still answers, so that state can be saved; no other call of this class does
    /// anything.
    std::string problem() const;

    /// Of framebuffer 0, pixels; (0, 0) while the window is minimised: draw nothing then.
    glm::ivec2 framebufferSize() const;
    /// In screen units, which events use.
    glm::ivec2 size() const;
    /// Pixels a screen unit that text should have, for panels.
    double contentScale() const;
    /// Shows what was drawn into framebuffer 0; waits for the screen's refresh where there is one.
    void present();
    void setTitle(const std::string& title);

    /// For libraries that draw into GLFW windows.
    GLFWwindow* handle() const;

private:
    std::shared_ptr<WindowState> state_;
};

struct WindowRequest {
    std::string title = "Serosa";
    int width = 960, height = 960; // screen units; made smaller to fit the monitor
    bool visible = true;
};

struct OpenedWindow {
    std::unique_ptr<Context> context; // current
    std::unique_ptr<Window> window;
};

/// Opens a window; its context is current afterwards. Either of the two may die first.
/// Errors (exit code 5): no display, no OpenGL 4.5 core, SEROSA_GL_DISABLE=window; one line that says what to
/// do.
Result<OpenedWindow> openWindow(const WindowRequest& request);

} // namespace serosa::gpu
