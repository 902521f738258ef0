// GL errors arrive through the debug callback: a log line, or (tests) a record that must stay empty.
// Performance hints and notifications are dropped. So are messages of the shader compiler: Program::create
// returns them.

#include "gpu/context_backend.h"
#include "gpu/gl.h"

#include <spdlog/spdlog.h>

#include <mutex>

namespace serosa::gpu {

namespace {

constexpr std::size_t kMostRecorded = 100; // one broken call in a loop must not fill the memory

struct ErrorRecord {
    std::mutex mutex; // drivers may call back from threads of their own
    GlErrorPolicy policy = GlErrorPolicy::log;
    std::vector<std::string> messages;
};

ErrorRecord& record() {
    static ErrorRecord instance;
    return instance;
}

void report(const std::string& message) {
    ErrorRecord& errors = record();
    const std::lock_guard lock(errors.mutex);
    if (errors.policy == GlErrorPolicy::log)
        spdlog::error("OpenGL: {}", message);
    else if (errors.messages.size() < kMostRecorded)
        errors.messages.push_back(message);
}

void APIENTRY onDebugMessage(GLenum source, GLenum type, GLuint, GLenum severity, GLsizei length,
                             const GLchar* text, const void*) {
    if (source == GL_DEBUG_SOURCE_SHADER_COMPILER)
        return;
    const bool undefined = type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR && severity == GL_DEBUG_SEVERITY_HIGH;
    if (type != GL_DEBUG_TYPE_ERROR && !undefined)
        return;
    std::string message =
        length < 0 ? std::string(text) : std::string(text, static_cast<std::size_t>(length));
    while (!message.empty() && (message.back() == '\n' || message.back() == '\0'))
        message.pop_back();
    report(message);
}

} // namespace

void installDebugCallback() {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS); // the message comes inside the call that caused it
    glDebugMessageCallback(onDebugMessage, nullptr);
    glDebugMessageControl(GL_DONT_CARE, GL_DEBUG_TYPE_PERFORMANCE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_NOTIFICATION, 0, nullptr, GL_FALSE);
}

void setGlErrorPolicy(GlErrorPolicy policy) {
    const std::lock_guard lock(record().mutex);
    record().policy = policy;
}

std::vector<std::string> takeGlErrors() {
    // A driver whose debug output is silent still answers glGetError.
    GLenum silent = GL_NO_ERROR;
    if (BackendContext::current())
        for (GLenum code = glGetError(); code != GL_NO_ERROR; code = glGetError())
            silent = code;
    const std::lock_guard lock(record().mutex);
    std::vector<std::string> messages = std::exchange(record().messages, {});
    if (messages.empty() && silent != GL_NO_ERROR && record().policy == GlErrorPolicy::fail)
        messages.push_back("GL error " + std::to_string(silent) + " without a debug message");
    return messages;
}

} // namespace serosa::gpu
