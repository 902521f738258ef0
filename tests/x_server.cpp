// See tests/x_server.h. Apart from everything of ours: Xlib's macros would break it.

#include "tests/x_server.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

namespace serosa::test {

namespace {

constexpr int kStartMilliseconds = 20000;

Display* of(void* connection) {
    return static_cast<Display*>(connection);
}

/// Windows come and go while we ask about them.
int ignoreError(Display*, XErrorEvent*) {
    return 0;
}

std::string readDisplayNumber(int pipe) {
    std::string digits;
    char c = 0;
    pollfd ready{pipe, POLLIN, 0};
    while (poll(&ready, 1, kStartMilliseconds) == 1 && read(pipe, &c, 1) == 1 && c != '\n')
        digits += c;
    return c == '\n' ? digits : "";
}

void sendToWindow(Display* display, Window window, const char* type, Atom value, long mask, Window to) {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = window;
    event.xclient.message_type = XInternAtom(display, type, False);
    event.xclient.format = 32;
    event.xclient.data.l[0] = long(value);
    XSendEvent(display, to, False, mask, &event);
}

} // namespace

std::unique_ptr<XServer> XServer::start(std::string& problem, int width, int height) {
    int ends[2];
    if (pipe(ends) != 0) {
        problem = "no pipe";
        return nullptr;
    }
    std::unique_ptr<XServer> server(new XServer);
    const std::string screen = std::to_string(width) + "x" + std::to_string(height) + "x24",
                      number = std::to_string(ends[1]);
    server->process_ = fork();
    if (server->process_ == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL); // no server outlives a test that crashes
        ::close(ends[0]);
        const int null = open("/dev/null", O_RDWR);
        for (const int stream : {0, 1, 2})
            dup2(null, stream);
        execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", screen.c_str(), "-nolisten",
               "tcp", "-noreset", nullptr);
        _exit(127);
    }
    ::close(ends[1]);
    const std::string digits = readDisplayNumber(ends[0]);
    ::close(ends[0]);
    server->display_ = ":" + digits;
    if (!digits.empty())
        server->connection_ = XOpenDisplay(server->display_.c_str());
    if (!server->connection_) {
        problem = "Xvfb did not start: run scripts/setup, which installs the packages that the tests need";
        return nullptr;
    }
    XSetErrorHandler(ignoreError);
    return server;
}

XServer::~XServer() {
    kill();
}

void XServer::kill() {
    if (connection_)
        XCloseDisplay(of(connection_));
    connection_ = nullptr;
    if (process_ > 0) {
        ::kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
        // Killed, it leaves its lock and its socket behind.
        const std::string number = display_.substr(1);
        unlink(("/tmp/.X" + number + "-lock").c_str());
        unlink(("/tmp/.X11-unix/X" + number).c_str());
    }
    process_ = 0;
}

std::string XServer::title(WindowId window) {
    char* name = nullptr;
    std::string text;
    if (XFetchName(of(connection_), window, &name) && name) {
        text = name;
        XFree(name);
    }
    return text;
}

XServer::WindowId XServer::waitForWindow(const std::string& wanted, double seconds) {
    Display* display = of(connection_);
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
        Window root = 0, parent = 0, *children = nullptr;
        unsigned count = 0;
        WindowId found = 0;
        if (XQueryTree(display, DefaultRootWindow(display), &root, &parent, &children, &count)) {
            for (unsigned i = 0; i < count; ++i) {
                XWindowAttributes attributes{};
                if (XGetWindowAttributes(display, children[i], &attributes) &&
                    attributes.map_state == IsViewable &&
                    title(children[i]).find(wanted) != std::string::npos)
                    found = children[i];
            }
            if (children)
                XFree(children);
        }
        if (found) {
            // No window manager gives it the keys; the program asks for them itself, but later on a busy
            // machine.
            XSetInputFocus(display, found, RevertToPointerRoot, CurrentTime);
            XSync(display, False);
            return found;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return 0;
}

void XServer::key(const std::string& name) {
    hold(name, true);
    hold(name, false);
}

void XServer::hold(const std::string& name, bool down) {
    Display* display = of(connection_);
    const KeyCode code = XKeysymToKeycode(display, XStringToKeysym(name.c_str()));
    if (code == 0)
        std::abort(); // the test names no key
    XTestFakeKeyEvent(display, code, down ? True : False, 0);
    XSync(display, False);
}

void XServer::moveTo(int x, int y) {
    XTestFakeMotionEvent(of(connection_), -1, x, y, 0);
    XSync(of(connection_), False);
}

void XServer::press(unsigned button) {
    XTestFakeButtonEvent(of(connection_), button, True, 0);
    XSync(of(connection_), False);
}

void XServer::release(unsigned button) {
    XTestFakeButtonEvent(of(connection_), button, False, 0);
    XSync(of(connection_), False);
}

void XServer::drag(unsigned button, int fromX, int fromY, int toX, int toY) {
    constexpr int kPieces = 8;
    moveTo(fromX, fromY);
    press(button);
    for (int i = 1; i <= kPieces; ++i) {
        moveTo(fromX + (toX - fromX) * i / kPieces, fromY + (toY - fromY) * i / kPieces);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    release(button);
}

void XServer::resize(WindowId window, int width, int height) {
    XResizeWindow(of(connection_), window, unsigned(width), unsigned(height));
    XSync(of(connection_), False);
}

void XServer::close(WindowId window) {
    Display* display = of(connection_);
    sendToWindow(display, window, "WM_PROTOCOLS", XInternAtom(display, "WM_DELETE_WINDOW", False),
                 NoEventMask, window);
    XSync(display, False);
}

void XServer::destroy(WindowId window) {
    XDestroyWindow(of(connection_), window);
    XSync(of(connection_), False);
}

void XServer::minimise(WindowId window, bool on) {
    Display* display = of(connection_);
    const Atom state = XInternAtom(display, "WM_STATE", False);
    const long values[2] = {on ? IconicState : NormalState, 0};
    XChangeProperty(display, window, state, state, 32, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(values), 2);
    if (on)
        XUnmapWindow(display, window);
    else
        XMapWindow(display, window);
    XSync(display, False);
}

XServer::Picture XServer::grab(WindowId window) {
    Display* display = of(connection_);
    XWindowAttributes attributes{};
    Picture picture;
    if (!XGetWindowAttributes(display, window, &attributes) || attributes.map_state != IsViewable)
        return picture;
    XImage* image = XGetImage(display, window, 0, 0, unsigned(attributes.width), unsigned(attributes.height),
                              AllPlanes, ZPixmap);
    if (!image)
        return picture;
    picture.width = image->width;
    picture.height = image->height;
    for (int y = 0; y < image->height; ++y)
        for (int x = 0; x < image->width; ++x) {
            const unsigned long pixel = XGetPixel(image, x, y);
            for (const int shift : {16, 8, 0})
                picture.rgb.push_back(std::uint8_t(pixel >> shift & 0xff));
        }
    XDestroyImage(image);
    return picture;
}

} // namespace serosa::test
