// Which kinds of context there are, and in which order they are tried.

#include "gpu/context.h"

#include "gpu/context_backend.h"

#include <algorithm>
#include <cstdlib>

namespace serosa::gpu {

namespace {

constexpr ContextKind kAllKinds[] = {ContextKind::eglDevice, ContextKind::egl, ContextKind::osmesa,
                                     ContextKind::window};
/// What automatic tries, in this order.
constexpr ContextKind kAutomaticKinds[] = {ContextKind::eglDevice, ContextKind::egl, ContextKind::osmesa};

/// Kinds that SEROSA_GL_DISABLE="egl,egl-device,osmesa,window" switches off (to test what happens without
/// them).
Result<std::vector<ContextKind>> disabledKinds() {
    std::vector<ContextKind> kinds;
    const char* value = std::getenv("SEROSA_GL_DISABLE");
    std::string rest = value ? value : "";
    while (!rest.empty()) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        const std::string name = rest.substr(0, comma);
        rest.erase(0, comma + 1);
        if (name.empty())
            continue;
        bool known = false;
        for (const ContextKind kind : kAllKinds)
            if (name == contextKindName(kind)) {
                kinds.push_back(kind);
                known = true;
            }
        if (!known)
            return Error{"SEROSA_GL_DISABLE: unknown kind \"" + name +
                         "\"; use egl, egl-device, osmesa, window"};
    }
    return kinds;
}

std::string describe(ContextKind kind, const Attempt& attempt) {
    return std::string(contextKindName(kind)) + ": " + attempt.problem + " (" + attempt.advice + ")";
}

} // namespace

const char* contextKindName(ContextKind kind) {
    switch (kind) {
    case ContextKind::egl:
        return "egl";
    case ContextKind::eglDevice:
        return "egl-device";
    case ContextKind::osmesa:
        return "osmesa";
    case ContextKind::window:
        return "window";
    }
    return "?";
}

Result<GlChoice> parseGlChoice(const std::string& text) {
    if (text == "auto")
        return GlChoice::automatic;
    if (text == "egl")
        return GlChoice::egl;
    if (text == "egl-device")
        return GlChoice::eglDevice;
    if (text == "osmesa")
        return GlChoice::osmesa;
    return Error{"unknown kind of GL context \"" + text + "\": use auto, egl, egl-device or osmesa"};
}

std::string disabledBecause(ContextKind kind) {
    const auto disabled = disabledKinds();
    if (!disabled.ok())
        return disabled.error().message;
    const bool off = std::find(disabled->begin(), disabled->end(), kind) != disabled->end();
    return off ? "switched off by SEROSA_GL_DISABLE" : "";
}

Attempt tryKind(ContextKind kind, DeviceFilter filter) {
    if (const std::string off = disabledBecause(kind); !off.empty())
        return {nullptr, off, "correct or unset SEROSA_GL_DISABLE"};
    switch (kind) {
    case ContextKind::egl:
        return tryEglSurfaceless();
    case ContextKind::eglDevice:
        return tryEglDevice(filter);
    case ContextKind::osmesa:
        return tryOsmesa();
    case ContextKind::window:
        return tryWindow();
    }
    return {};
}

Result<std::unique_ptr<Context>> createContext(GlChoice choice) {
    if (const auto disabled = disabledKinds(); !disabled.ok())
        return disabled.error();
    std::vector<ContextKind> kinds;
    switch (choice) {
    case GlChoice::automatic:
        kinds.assign(std::begin(kAutomaticKinds), std::end(kAutomaticKinds));
        break;
    case GlChoice::egl:
        kinds = {ContextKind::egl};
        break;
    case GlChoice::eglDevice:
        kinds = {ContextKind::eglDevice};
        break;
    case GlChoice::osmesa:
        kinds = {ContextKind::osmesa};
        break;
    }
    const DeviceFilter filter =
        choice == GlChoice::automatic ? DeviceFilter::hardwareOnly : DeviceFilter::hardwareFirst;
    std::string message = "no OpenGL 4.5 context to be had";
    for (const ContextKind kind : kinds) {
        Attempt attempt = tryKind(kind, filter);
        if (attempt.context)
            return std::unique_ptr<Context>(std::move(attempt.context));
        message += "; " + describe(kind, attempt);
    }
    return Error{message + "; `serosa doctor` says more", exitNoGl};
}

} // namespace serosa::gpu
