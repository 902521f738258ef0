// What `serosa doctor` reports of each kind of context: limits beside what the program needs, and float
// targets tried by really rendering to them (drivers have been seen to call a float target complete and then
// not to blend into it).

#include "gpu/context.h"
#include "gpu/context_backend.h"
#include "gpu/handles.h"
#include "gpu/program.h"

#include <array>
#include <cmath>

namespace serosa::gpu {

namespace {

struct Need {
    const char* name;
    GLenum parameter;
    long long atLeast;
};
constexpr Need kNeeds[] = {
    {"GL_MAX_TEXTURE_SIZE", GL_MAX_TEXTURE_SIZE, 16384}, // a million nodes in rows
    {"GL_MAX_3D_TEXTURE_SIZE", GL_MAX_3D_TEXTURE_SIZE, 512},
    {"GL_MAX_TEXTURE_IMAGE_UNITS", GL_MAX_TEXTURE_IMAGE_UNITS, 16},
    {"GL_MAX_VERTEX_TEXTURE_IMAGE_UNITS", GL_MAX_VERTEX_TEXTURE_IMAGE_UNITS, 8},
    {"GL_MAX_FRAGMENT_IMAGE_UNIFORMS", GL_MAX_FRAGMENT_IMAGE_UNIFORMS, 6},
    {"GL_MAX_IMAGE_UNITS", GL_MAX_IMAGE_UNITS, 8},
    {"GL_MAX_COLOR_ATTACHMENTS", GL_MAX_COLOR_ATTACHMENTS, 4},
    {"GL_MAX_SAMPLES", GL_MAX_SAMPLES, 4},
};

/// Exact in half floats, negative and above 1: a target that clamps fails.
constexpr glm::vec4 kValue(-1.5f, 1024.25f, 0.125f, 3.0f);

/// Draws `value` over a 4 x 4 image of `format`, `times` times (added up from the second on), and reads it
/// back.
bool drawsAndAdds(Program& program, const VertexArray& empty, GLenum format, int components, int times) {
    constexpr int kSide = 4;
    Texture2D target("survey", format, kSide, kSide);
    target.clear(glm::vec4(0.0f));
    Framebuffer framebuffer("survey");
    framebuffer.attach(GL_COLOR_ATTACHMENT0, target);
    if (glCheckNamedFramebufferStatus(framebuffer.id(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return false;
    framebuffer.bind(kSide, kSide);
    program.set("u_value", kValue).use();
    if (times > 1) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE);
    }
    for (int i = 0; i < times; ++i)
        drawFullScreen(empty);
    glDisable(GL_BLEND);
    std::vector<float> pixels(static_cast<std::size_t>(kSide * kSide * components));
    target.download(pixels.data(), pixels.size() * sizeof(float));
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const float expected = static_cast<float>(times) * kValue[static_cast<int>(i) % components];
        if (!(std::abs(pixels[i] - expected) <= 1e-3f * std::abs(expected)))
            return false;
    }
    return true;
}

std::vector<std::pair<std::string, bool>> surveyTargets() {
    auto program = Program::create(ShaderLibrary(), {"pass.vert", "constant.frag"});
    if (!program.ok())
        return {{"shaders compile", false}};
    const VertexArray empty("survey");
    return {{"RGBA32F", drawsAndAdds(*program, empty, GL_RGBA32F, 4, 1)},
            {"RGBA16F", drawsAndAdds(*program, empty, GL_RGBA16F, 4, 1)},
            {"R32F", drawsAndAdds(*program, empty, GL_R32F, 1, 1)},
            {"additive blending of RGBA32F", drawsAndAdds(*program, empty, GL_RGBA32F, 4, 3)}};
}

ContextOffer survey(ContextKind kind) {
    ContextOffer offer;
    offer.kind = kind;
    const Attempt attempt = tryKind(kind, DeviceFilter::hardwareFirst);
    if (!attempt.context) {
        offer.problem = attempt.problem;
        offer.advice = attempt.advice;
        return offer;
    }
    offer.available = true;
    offer.info = attempt.context->info();
    for (const Need& need : kNeeds) {
        GLint64 value = 0;
        glGetInteger64v(need.parameter, &value);
        offer.limits.push_back({need.name, value, need.atLeast});
    }
    offer.floatTargets = surveyTargets();
    return offer;
}

} // namespace

std::vector<ContextOffer> surveyContexts() {
    BackendContext* const before = BackendContext::current();
    std::vector<ContextOffer> offers;
    for (const ContextKind kind :
         {ContextKind::egl, ContextKind::eglDevice, ContextKind::osmesa, ContextKind::window})
        offers.push_back(survey(kind));
    if (before)
        before->makeCurrent();
    return offers;
}

std::optional<ContextKind> automaticKind(const std::vector<ContextOffer>& offers) {
    for (const ContextKind kind : {ContextKind::eglDevice, ContextKind::egl, ContextKind::osmesa})
        for (const ContextOffer& offer : offers)
            if (offer.kind == kind && offer.available &&
                (kind != ContextKind::eglDevice || !offer.info.software))
                return kind;
    return std::nullopt;
}

} // namespace serosa::gpu
