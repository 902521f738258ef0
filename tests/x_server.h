#pragma once
// An X server without a screen (Xvfb) that a test starts, drives as a user would (XTest), and looks at. The
// tests' own way to the display: nothing here knows of GLFW.

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace serosa::test {

class XServer {
public:
    /// Starts Xvfb on a free display with a screen of this size. Null, with the reason, where it does not
    /// start.
    static std::unique_ptr<XServer> start(std::string& problem, int width = 1280, int height = 1024);
    ~XServer();
    XServer(const XServer&) = delete;
    XServer& operator=(const XServer&) = delete;

    /// ":3", for DISPLAY.
    const std::string& display() const { return display_; }
    /// Ends the server, as a crash would.
    void kill();

    using WindowId = unsigned long;
    /// The shown window with this text in its title; 0 where there is none after `seconds`.
    WindowId waitForWindow(const std::string& title, double seconds);
    std::string title(WindowId window);

    /// "space", "Left", "F5", "w": the names of X.
    void key(const std::string& name);
    /// Holds a key down, or lets it go: "Control_L".
    void hold(const std::string& name, bool down);
    /// Moves the pointer, in pixels of the screen.
    void moveTo(int x, int y);
    /// 1 left, 2 middle, 3 right, 4 and 5 the wheel.
    void press(unsigned button);
    void release(unsigned button);
    void drag(unsigned button, int fromX, int fromY, int toX, int toY);

    void resize(WindowId window, int width, int height);
    /// Asks as a window manager does when the user closes the window.
    void close(WindowId window);
    /// Destroys it over the program's head.
    void destroy(WindowId window);
    /// Says and does what a window manager does to minimise and restore.
    void minimise(WindowId window, bool on);

    struct Picture {
        int width = 0, height = 0;
        std::vector<std::uint8_t> rgb; // top row first
        const std::uint8_t* at(int x, int y) const {
            return &rgb[3 * (std::size_t(y) * std::size_t(width) + std::size_t(x))];
        }
    };
    /// What the screen shows of a window; empty where the window is not on it.
    Picture grab(WindowId window);

private:
    XServer() = default;
    pid_t process_ = 0;
    std::string display_;
    void* connection_ = nullptr; // Display*
};

} // namespace serosa::test
