// See gpu/window_x11.h. Everything of X is found at run time, in the library that GLFW has loaded.

#include "gpu/window_x11.h"

#include <X11/Xlib.h>
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>

namespace serosa::gpu {

namespace {

constexpr int kExitNoGl = 5;

const char* gProblem = nullptr;

int onConnectionLost(Display*) {
    gProblem = "the X display went away";
    return 0;
}

/// Xlib of 1.7 or later returns from the call that failed, and from all later ones, when this does.
void onConnectionLostExit(Display*, void*) {}

/// Errors that arrive late, from requests sent before: only those that mean that our window is gone matter.
int onError(Display*, XErrorEvent* event) {
    constexpr int kFirstExtensionError = 128; // GLX: its drawable is gone
    if (event->error_code == BadWindow || event->error_code == BadDrawable ||
        event->error_code >= kFirstExtensionError)
        gProblem = "another program destroyed the window";
    return 0;
}

int onConnectionLostOldXlib(Display*) {
    std::fputs(
        "serosa: error: the X display went away: files written so far are whole; 'serosa run' needs no "
        "display\n",
        stderr);
    std::_Exit(kExitNoGl); // Xlib before 1.7 would call exit(1) after this
}

} // namespace

void watchDisplay() {
    void* const xlib = dlopen("libX11.so.6", RTLD_NOW | RTLD_NOLOAD);
    const auto glfwDisplay = reinterpret_cast<Display* (*)()>(dlsym(RTLD_DEFAULT, "glfwGetX11Display"));
    Display* const display = glfwDisplay ? glfwDisplay() : nullptr;
    if (!xlib || !display)
        return;
    const auto setIoError =
        reinterpret_cast<decltype(&XSetIOErrorHandler)>(dlsym(xlib, "XSetIOErrorHandler"));
    const auto setIoExit = reinterpret_cast<void (*)(Display*, void (*)(Display*, void*), void*)>(
        dlsym(xlib, "XSetIOErrorExitHandler"));
    const auto setError = reinterpret_cast<decltype(&XSetErrorHandler)>(dlsym(xlib, "XSetErrorHandler"));
    setError(onError);
    setIoError(setIoExit ? onConnectionLost : onConnectionLostOldXlib);
    if (setIoExit)
        setIoExit(display, onConnectionLostExit, nullptr);
    dlclose(xlib); // GLFW holds it
}

const char* displayProblem() {
    return gProblem;
}

} // namespace serosa::gpu
