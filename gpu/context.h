#pragma once
// OpenGL 4.5 core contexts behind one interface: surfaceless EGL, an EGL device (a GPU without a display
// server), OSMesa (software, opened with dlopen(RTLD_LOCAL) and never linked: it exports every gl name), and
// a window (gpu/context_window.h), which is only ever made explicitly. OSMesa shares its dispatch with Mesa's
// EGL and GLX: makeCurrent releases the current context of any other kind first.

#include "base/result.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace serosa::gpu {

enum class ContextKind { egl, eglDevice, osmesa, window };
/// "egl", "egl-device", "osmesa", "window"
const char* contextKindName(ContextKind kind);

/// What a user asks for (`--gl`): automatic is an EGL device with hardware, EGL surfaceless, then OSMesa;
/// never a window.
enum class GlChoice { automatic, egl, eglDevice, osmesa };
Result<GlChoice> parseGlChoice(const std::string& text);

struct ContextInfo {
    ContextKind kind = ContextKind::egl;
    std::string vendor, renderer, version, glslVersion;
    bool software = false; // llvmpipe, softpipe, swrast
};

class Context {
public:
    virtual ~Context() = default;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Makes this context current in the calling thread, releases one of another kind, and points the entry
    /// points of gpu/gl.h at this context's own loader.
    virtual void makeCurrent() = 0;
    virtual ContextKind kind() const = 0;
    const ContextInfo& info() const { return info_; }

protected:
    Context() = default;
    ContextInfo info_;
};

/// Creates a context (core profile, 4.5 or later, debug output on) and makes it current.
/// Errors (exit code 5): says for each kind that was tried what failed, and what to install or set. The
/// environment variable SEROSA_GL_DISABLE="egl,egl-device,osmesa,window" (any of them) makes kinds
/// unavailable, to test what happens then.
Result<std::unique_ptr<Context>> createContext(GlChoice choice);

/// What `serosa doctor` prints of one kind.
struct ContextOffer {
    ContextKind kind;
    bool available = false;
    std::string problem, advice; // when not available
    ContextInfo info;
    struct Limit {
        std::string name;
        long long value, needed;
    };
    std::vector<Limit> limits; // texture size, image units, vertex texture units, ...
    std::vector<std::pair<std::string, bool>>
        floatTargets; // renderable: RGBA32F, RGBA16F, ..., additive blending of RGBA32F
};
/// Tries every kind in turn (each in this thread, the window hidden) and reports; the context that was
/// current is so again afterwards.
std::vector<ContextOffer> surveyContexts();

/// The kind that GlChoice::automatic takes, judged by a survey (never the window); nothing when it finds
/// none.
std::optional<ContextKind> automaticKind(const std::vector<ContextOffer>& offers);

/// How GL errors that the debug callback reports are treated: a log line (default), or counted as failures by
/// tests.
enum class GlErrorPolicy { log, fail };
void setGlErrorPolicy(GlErrorPolicy policy);
/// GL errors seen since the last call, with their messages (policy fail); tests assert that this is empty.
std::vector<std::string> takeGlErrors();

} // namespace serosa::gpu
