// The report of `serosa doctor`, from gpu::surveyContexts.

#include "app/doctor.h"

#include "base/result.h"
#include "gpu/context.h"

#include <iomanip>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace serosa::app {

namespace {

const char* explanation(gpu::ContextKind kind) {
    switch (kind) {
    case gpu::ContextKind::egl:
        return "EGL without a surface";
    case gpu::ContextKind::eglDevice:
        return "EGL device, a GPU without a display server";
    case gpu::ContextKind::osmesa:
        return "OSMesa, software";
    case gpu::ContextKind::window:
        return "a window of GLFW, which needs a display";
    }
    return "?";
}

void writeOffer(std::ostream& out, const gpu::ContextOffer& offer) {
    out << gpu::contextKindName(offer.kind) << " (" << explanation(offer.kind) << "): ";
    if (!offer.available) {
        out << "not available\n  why:      " << offer.problem << "\n  to do:    " << offer.advice << "\n\n";
        return;
    }
    out << "available\n"
        << "  vendor:   " << offer.info.vendor << "\n"
        << "  renderer: " << offer.info.renderer << (offer.info.software ? "  [software]" : "") << "\n"
        << "  version:  " << offer.info.version << ", GLSL " << offer.info.glslVersion << "\n";
    out << "  limits (here, needed):\n";
    bool isShort = false;
    for (const gpu::ContextOffer::Limit& limit : offer.limits) {
        const bool enough = limit.value >= limit.needed;
        isShort = isShort || !enough;
        out << "    " << std::left << std::setw(36) << limit.name << std::right << std::setw(8) << limit.value
            << std::setw(8) << limit.needed << (enough ? "  ok" : "  TOO SMALL") << "\n";
    }
    out << "  float targets (rendered and read back):\n";
    for (const auto& [name, works] : offer.floatTargets) {
        isShort = isShort || !works;
        out << "    " << std::left << std::setw(36) << name << std::right << (works ? "ok" : "DOES NOT WORK")
            << "\n";
    }
    if (isShort)
        out << "  to do:    update the GPU's driver, or take another kind with --gl; large models or some "
               "views "
               "may fail here\n";
    out << "\n";
}

} // namespace

const char* doctorHelp() {
    return "Tries every kind of OpenGL context (egl, egl-device and osmesa, which run without a window; and "
           "the window\nof 'serosa view', which needs a display) and prints for each\n"
           "vendor, renderer, version, limits beside what serosa needs, float targets tried by rendering, or "
           "why it is\n"
           "not available and which Debian 12 package helps. Warns when the renderer is software.\n"
           "Environment: SEROSA_GL_DISABLE=egl,egl-device,osmesa,window (any of them) makes kinds "
           "unavailable, to "
           "test the rest.\n"
           "Exit code: 0 if at least one kind without a window works, 5 if none does.";
}

int runDoctor(std::ostream& out) {
    const std::vector<gpu::ContextOffer> offers = gpu::surveyContexts();
    out << "serosa needs OpenGL 4.5 core.\n\n";
    for (const gpu::ContextOffer& offer : offers)
        writeOffer(out, offer);
    const std::optional<gpu::ContextKind> choice = gpu::automaticKind(offers);
    if (!choice) {
        // A software EGL device alone is not taken by itself, but works when asked for.
        for (const gpu::ContextOffer& offer : offers)
            if (offer.available && offer.kind != gpu::ContextKind::window) {
                out << "--gl auto finds nothing; use --gl " << gpu::contextKindName(offer.kind) << ".\n";
                return exitOk;
            }
        out << "No kind of context without a window works: serosa cannot simulate or draw here (its commands "
               "end with exit "
               "code "
            << exitNoGl << ").\n"
            << "To do: apt install libegl1 libegl-mesa0 libosmesa6 (software, any machine), or the GPU "
               "maker's driver.\n";
        return exitNoGl;
    }
    out << "--gl auto takes " << gpu::contextKindName(*choice) << ".\n";
    for (const gpu::ContextOffer& offer : offers)
        if (offer.kind == *choice && offer.info.software)
            out << "Warning: that renderer is software (the CPU draws). Results are valid, but it is slow: "
                   "for real "
                   "time use a machine with a GPU and its driver.\n";
    return exitOk;
}

} // namespace serosa::app
