// Windows by GLFW. Mesa's GLX shares its dispatch with EGL and OSMesa, so the context is bound and released
// like theirs (gpu/context_backend.cpp).

#include "gpu/context_window.h"

#include "base/check.h"
#include "gpu/context_backend.h"
#include "gpu/window_x11.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

namespace serosa::gpu {

struct WindowState {
    WindowState() = default;
    WindowState(const WindowState&) = delete;
    WindowState& operator=(const WindowState&) = delete;
    ~WindowState() {
        if (window && !displayProblem()) // a lost display takes its windows along
            glfwDestroyWindow(window);
    }

    GLFWwindow* window = nullptr;
    std::vector<WindowEvent> events;
    std::optional<glm::dvec2> pointer; // where the last event left it: it may be elsewhere by now
};

namespace {

constexpr const char* kAdvice =
    "without a screen use 'serosa run'; or set DISPLAY, or start it with xvfb-run";

std::string& glfwProblem() {
    static std::string text;
    return text;
}

void onGlfwError(int, const char* text) {
    glfwProblem() = text;
}

WindowState& stateOf(GLFWwindow* window) {
    return *static_cast<WindowState*>(glfwGetWindowUserPointer(window));
}

int namedKey(int key) {
    static constexpr std::pair<int, int> kNamed[] = {
        {GLFW_KEY_ESCAPE, keyEscape}, {GLFW_KEY_LEFT, keyLeft},    {GLFW_KEY_RIGHT, keyRight},
        {GLFW_KEY_UP, keyUp},         {GLFW_KEY_DOWN, keyDown},    {GLFW_KEY_PAGE_UP, keyPageUp},
        {GLFW_KEY_HOME, keyHome},     {GLFW_KEY_SPACE, ' '},       {GLFW_KEY_PAGE_DOWN, keyPageDown},
        {GLFW_KEY_KP_ADD, '+'},       {GLFW_KEY_KP_SUBTRACT, '-'}, {GLFW_KEY_KP_DECIMAL, '.'}};
    for (const auto& [glfw, ours] : kNamed)
        if (key == glfw)
            return ours;
    if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12)
        return keyF1 + key - GLFW_KEY_F1;
    // Digits by their place: some layouts type them with shift only.
    if (key >= GLFW_KEY_0 && key <= GLFW_KEY_9)
        return '0' + key - GLFW_KEY_0;
    if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9)
        return '0' + key - GLFW_KEY_KP_0;
    return 0;
}

int characterOf(int key, int scancode) {
    const char* typed = glfwGetKeyName(key, scancode);
    if (!typed || typed[0] == '\0' || typed[1] != '\0')
        return 0;
    return std::tolower(static_cast<unsigned char>(typed[0]));
}

void onKey(GLFWwindow* window, int key, int scancode, int action, int mods) {
    if (action == GLFW_RELEASE)
        return;
    WindowEvent event;
    event.kind = WindowEvent::Kind::keyPressed;
    event.key = namedKey(key);
    if (event.key == 0)
        event.key = characterOf(key, scancode);
    event.repeated = action == GLFW_REPEAT;
    event.shift = (mods & GLFW_MOD_SHIFT) != 0;
    event.control = (mods & GLFW_MOD_CONTROL) != 0;
    stateOf(window).events.push_back(event);
}

void onButton(GLFWwindow* window, int button, int action, int mods) {
    if (button > GLFW_MOUSE_BUTTON_MIDDLE)
        return;
    WindowEvent event;
    event.kind = action == GLFW_PRESS ? WindowEvent::Kind::buttonPressed : WindowEvent::Kind::buttonReleased;
    event.button = MouseButton(button);
    event.shift = (mods & GLFW_MOD_SHIFT) != 0;
    event.control = (mods & GLFW_MOD_CONTROL) != 0;
    WindowState& state = stateOf(window);
    if (state.pointer)
        event.at = *state.pointer;
    else
        glfwGetCursorPos(window, &event.at.x, &event.at.y);
    state.events.push_back(event);
}

void onMove(GLFWwindow* window, double x, double y) {
    WindowEvent event;
    event.kind = WindowEvent::Kind::moved;
    event.at = {x, y};
    stateOf(window).pointer = event.at;
    stateOf(window).events.push_back(event);
}

void onScroll(GLFWwindow* window, double x, double y) {
    WindowEvent event;
    event.kind = WindowEvent::Kind::scrolled;
    event.at = {x, y};
    stateOf(window).events.push_back(event);
}

class WindowContext final : public BackendContext {
public:
    explicit WindowContext(std::shared_ptr<WindowState> state) : state_(std::move(state)) {}
    ~WindowContext() override { releaseThis(); }
    ContextKind kind() const override { return ContextKind::window; }

protected:
    Status bind() override {
        glfwProblem().clear();
        glfwMakeContextCurrent(state_->window);
        if (!glfwProblem().empty())
            return Error{"glfwMakeContextCurrent failed: " + glfwProblem(), exitNoGl};
        return {};
    }
    void unbind() override {
        if (!displayProblem())
            glfwMakeContextCurrent(nullptr);
    }
    GlProc proc(const char* name) const override { return glfwGetProcAddress(name); }

private:
    std::shared_ptr<WindowState> state_;
};

/// GLFW stays initialised until the program ends: closing its display would unload Mesa's driver, which LLVM
/// inside does not survive.
Status initialiseGlfw() {
    glfwSetErrorCallback(onGlfwError);
    glfwProblem().clear();
    if (!glfwInit())
        return Error{glfwProblem().empty() ? "GLFW found no window system" : glfwProblem(), exitNoGl};
    watchDisplay();
    return {};
}

/// The request, made to fit the monitor's work area with its proportions kept.
glm::ivec2 fittingSize(const WindowRequest& request) {
    glm::ivec2 size(request.width, request.height);
    int x = 0, y = 0;
    glm::ivec2 area(0);
    if (GLFWmonitor* monitor = glfwGetPrimaryMonitor())
        glfwGetMonitorWorkarea(monitor, &x, &y, &area.x, &area.y);
    if (area.x > 0 && area.y > 0 && (size.x > area.x || size.y > area.y)) {
        const double scale = std::min(double(area.x) / size.x, double(area.y) / size.y);
        size = glm::max(glm::ivec2(glm::dvec2(size) * scale), glm::ivec2(1));
    }
    return size;
}

struct Made {
    std::unique_ptr<BackendContext> context;
    std::shared_ptr<WindowState> state;
    std::string problem;
};

Made makeWindow(const WindowRequest& request) {
    if (displayProblem())
        return {nullptr, nullptr, displayProblem()};
    BackendContext::releaseCurrent();
    if (const Status initialised = initialiseGlfw(); !initialised.ok())
        return {nullptr, nullptr, initialised.error().message};
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0); // pictures are drawn in targets of their own
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    glfwWindowHint(GLFW_VISIBLE, request.visible ? GLFW_TRUE : GLFW_FALSE);
    const glm::ivec2 size = fittingSize(request);
    auto state = std::make_shared<WindowState>();
    state->window = glfwCreateWindow(size.x, size.y, request.title.c_str(), nullptr, nullptr);
    watchDisplay();
    if (!state->window)
        return {nullptr, nullptr, "no window with OpenGL 4.5 core: " + glfwProblem()};
    glfwSetWindowUserPointer(state->window, state.get());
    glfwSetKeyCallback(state->window, onKey);
    glfwSetMouseButtonCallback(state->window, onButton);
    glfwSetCursorPosCallback(state->window, onMove);
    glfwSetScrollCallback(state->window, onScroll);
    auto context = std::make_unique<WindowContext>(state);
    if (const Status started = context->start(); !started.ok())
        return {nullptr, nullptr, started.error().message};
    glfwSwapInterval(1);
    return {std::move(context), std::move(state), ""};
}

} // namespace

Window::Window(std::shared_ptr<WindowState> state) : state_(std::move(state)) {}
Window::~Window() = default;

std::vector<WindowEvent> Window::poll(double seconds) {
    if (!displayProblem()) {
        if (seconds > 0)
            glfwWaitEventsTimeout(seconds);
        else
            glfwPollEvents();
    }
    return std::exchange(state_->events, {});
}

bool Window::closing() const {
    return glfwWindowShouldClose(state_->window) != 0;
}

std::string Window::problem() const {
    return displayProblem() ? displayProblem() : "";
}

glm::ivec2 Window::framebufferSize() const {
    glm::ivec2 size(0);
    if (!displayProblem() && !glfwGetWindowAttrib(state_->window, GLFW_ICONIFIED))
        glfwGetFramebufferSize(state_->window, &size.x, &size.y);
    // Where the display went away during the call, GLFW hands out what was in memory.
    return displayProblem() ? glm::ivec2(0) : glm::max(size, glm::ivec2(0));
}

glm::ivec2 Window::size() const {
    glm::ivec2 size(0);
    if (!displayProblem())
        glfwGetWindowSize(state_->window, &size.x, &size.y);
    return displayProblem() ? glm::ivec2(0) : size;
}

double Window::contentScale() const {
    float x = 1, y = 1;
    if (!displayProblem())
        glfwGetWindowContentScale(state_->window, &x, &y);
    return std::max(1.0F, x);
}

void Window::present() {
    if (!displayProblem())
        glfwSwapBuffers(state_->window);
}

void Window::setTitle(const std::string& title) {
    if (!displayProblem())
        glfwSetWindowTitle(state_->window, title.c_str());
}

GLFWwindow* Window::handle() const {
    return state_->window;
}

Result<OpenedWindow> openWindow(const WindowRequest& request) {
    if (const std::string off = disabledBecause(ContextKind::window); !off.empty())
        return Error{"no window: " + off, exitNoGl};
    Made made = makeWindow(request);
    if (!made.context)
        return Error{"no window: " + made.problem + ": " + kAdvice, exitNoGl};
    return OpenedWindow{std::move(made.context), std::make_unique<Window>(made.state)};
}

Attempt tryWindow() {
    WindowRequest request;
    request.width = request.height = 64;
    request.visible = false;
    Made made = makeWindow(request);
    return {std::move(made.context), made.problem,
            "only 'serosa view' needs it; set DISPLAY, or use xvfb-run"};
}

} // namespace serosa::gpu
