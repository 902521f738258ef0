// Contexts of every kind in one thread: they must not see each other's objects, nor disturb each other's
// dispatch.

#include "gpu/context.h"
#include "gpu/handles.h"
#include "tests/gl_fixture.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

namespace serosa::gpu {
namespace {

using Pixel = std::array<std::uint8_t, 4>;

std::unique_ptr<Context> make(GlChoice choice) {
    auto context = createContext(choice);
    EXPECT_TRUE(context.ok()) << context.error().message;
    return context.ok() ? std::move(context).value() : nullptr;
}

/// A 4 x 4 image in the current context, cleared to `colour` through a framebuffer.
struct Marker {
    explicit Marker(const glm::vec4& colour) {
        framebuffer.attach(GL_COLOR_ATTACHMENT0, texture);
        framebuffer.bind(4, 4);
        glClearColor(colour.r, colour.g, colour.b, colour.a);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    Pixel read() const {
        std::vector<Pixel> pixels(16);
        texture.download(pixels.data(), 16 * sizeof(Pixel));
        return pixels[5];
    }
    Texture2D texture{"marker", GL_RGBA8, 4, 4};
    Framebuffer framebuffer{"marker"};
};

constexpr Pixel kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255};

class GlContexts : public test::GlTest {};

TEST_F(GlContexts, EachKindInTurnDrawsAndReadsBack) {
    for (int round = 0; round < 2; ++round)
        for (const GlChoice choice :
             {GlChoice::egl, GlChoice::osmesa, GlChoice::eglDevice, GlChoice::osmesa}) {
            const auto context = make(choice);
            ASSERT_TRUE(context);
            const Marker marker({1, 0, 0, 1});
            EXPECT_EQ(marker.read(), kRed) << contextKindName(context->kind());
            EXPECT_TRUE(takeGlErrors().empty());
        }
}

TEST_F(GlContexts, TwoLiveContextsOfDifferentKindsInterleave) {
    const std::pair<GlChoice, GlChoice> pairs[] = {{GlChoice::egl, GlChoice::osmesa},
                                                   {GlChoice::osmesa, GlChoice::eglDevice},
                                                   {GlChoice::eglDevice, GlChoice::egl},
                                                   {GlChoice::egl, GlChoice::egl}};
    for (const auto& [firstChoice, secondChoice] : pairs) {
        auto first = make(firstChoice);
        ASSERT_TRUE(first);
        auto red = std::make_unique<Marker>(glm::vec4(1, 0, 0, 1));
        auto second = make(secondChoice);
        ASSERT_TRUE(second);
        auto green = std::make_unique<Marker>(glm::vec4(0, 1, 0, 1));
        // Ids are counted in each context on its own: the same number is another texture.
        EXPECT_EQ(red->texture.id(), green->texture.id());
        for (int i = 0; i < 3; ++i) {
            first->makeCurrent();
            EXPECT_EQ(red->read(), kRed);
            red->framebuffer.bind(4, 4);
            glClear(GL_COLOR_BUFFER_BIT);
            second->makeCurrent();
            EXPECT_EQ(green->read(), kGreen);
            green->framebuffer.bind(4, 4);
            glClear(GL_COLOR_BUFFER_BIT);
        }
        green.reset();
        second.reset(); // the current one dies; the other lives on
        first->makeCurrent();
        EXPECT_EQ(red->read(), kRed);
        red.reset();
    }
}

TEST_F(GlContexts, TheOneThatIsNotCurrentMayDieFirst) {
    auto egl = make(GlChoice::egl);
    const auto osmesa = make(GlChoice::osmesa);
    ASSERT_TRUE(egl && osmesa);
    const Marker marker({0, 1, 0, 1});
    egl.reset();
    EXPECT_EQ(marker.read(), kGreen);
}

TEST_F(GlContexts, WithoutACurrentContextTheEntryPointsAreNull) {
    { const auto context = make(test::testGlChoice()); }
    EXPECT_EQ(glDrawArrays, nullptr);
    EXPECT_DEATH(Buffer("early", 4, nullptr), "early: no GL context is current");
}

TEST_F(GlContexts, InfoTellsVersionAndSoftware) {
    const auto context = make(test::testGlChoice());
    ASSERT_TRUE(context);
    const ContextInfo& info = context->info();
    EXPECT_EQ(info.kind, context->kind());
    EXPECT_GE(info.version.substr(0, 3), "4.5");
    EXPECT_FALSE(info.renderer.empty());
    EXPECT_EQ(info.software, info.renderer.find("llvmpipe") != std::string::npos);
}

TEST_F(GlContexts, ErrorsReachTheRecordAndPerformanceHintsDoNot) {
    glEnable(0x1234);
    const std::vector<std::string> errors = takeGlErrors();
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_NE(errors[0].find("glEnable"), std::string::npos) << errors[0];
    EXPECT_TRUE(takeGlErrors().empty()) << "taken once";
    glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_PERFORMANCE, 1, GL_DEBUG_SEVERITY_HIGH,
                         -1, "slow");
    glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_OTHER, 1, GL_DEBUG_SEVERITY_NOTIFICATION,
                         -1, "note");
    EXPECT_TRUE(takeGlErrors().empty());
    glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_ERROR, 1, GL_DEBUG_SEVERITY_HIGH, -1,
                         "our own");
    EXPECT_EQ(takeGlErrors(), std::vector<std::string>{"our own"});
}

TEST_F(GlContexts, UnderThePolicyLogNothingIsRecorded) {
    setGlErrorPolicy(GlErrorPolicy::log);
    testing::internal::CaptureStdout();
    glEnable(0x1234);
    const std::string printed = testing::internal::GetCapturedStdout();
    EXPECT_TRUE(takeGlErrors().empty());
    EXPECT_NE(printed.find("glEnable"), std::string::npos) << printed;
}

/// Sets SEROSA_GL_DISABLE for a scope.
class ScopedDisable {
public:
    explicit ScopedDisable(const char* kinds) { setenv("SEROSA_GL_DISABLE", kinds, 1); }
    ~ScopedDisable() { unsetenv("SEROSA_GL_DISABLE"); }
    ScopedDisable(const ScopedDisable&) = delete;
    ScopedDisable& operator=(const ScopedDisable&) = delete;
};

TEST_F(GlContexts, WithoutAnyTheErrorNamesEachKindThatWasTried) {
    const ScopedDisable off("egl,osmesa,egl-device");
    const auto context = createContext(GlChoice::automatic);
    ASSERT_FALSE(context.ok());
    EXPECT_EQ(context.error().exitCode, 5);
    const std::string& message = context.error().message;
    for (const char* part : {"; egl-device: switched off", "; egl: switched off", "; osmesa: switched off"})
        EXPECT_NE(message.find(part), std::string::npos) << part << " is missing in " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << "one line";
    const auto one = createContext(GlChoice::osmesa);
    ASSERT_FALSE(one.ok());
    EXPECT_EQ(one.error().message.find("egl:"), std::string::npos) << "only what was asked for is tried";
}

TEST_F(GlContexts, AutomaticFallsBackToSoftware) {
    const ScopedDisable off("egl,egl-device");
    const auto context = createContext(GlChoice::automatic);
    ASSERT_TRUE(context.ok()) << context.error().message;
    EXPECT_EQ((*context)->kind(), ContextKind::osmesa);
}

TEST_F(GlContexts, AWrongDisableListIsAnError) {
    const ScopedDisable off("egl,glx");
    const auto context = createContext(GlChoice::automatic);
    ASSERT_FALSE(context.ok());
    EXPECT_NE(context.error().message.find("unknown kind \"glx\""), std::string::npos)
        << context.error().message;
}

TEST_F(GlContexts, TheSurveyLeavesTheCurrentContextCurrent) {
    std::vector<ContextOffer> offers;
    {
        const Marker marker({1, 0, 0, 1});
        offers = surveyContexts();
        EXPECT_EQ(marker.read(), kRed);
    }
    ASSERT_EQ(offers.size(), 4u);
    for (const ContextOffer& offer : offers) {
        if (offer.kind == ContextKind::window) // tests/gpu/context_window_gl_test.cpp
            continue;
        EXPECT_TRUE(offer.available) << offer.problem;
        EXPECT_EQ(offer.limits.size(), 8u);
        EXPECT_EQ(offer.floatTargets.size(), 4u);
        for (const auto& [name, works] : offer.floatTargets)
            EXPECT_TRUE(works) << contextKindName(offer.kind) << " " << name;
    }
    const auto taken = createContext(GlChoice::automatic);
    ASSERT_TRUE(taken.ok());
    EXPECT_EQ(automaticKind(offers), (*taken)->kind());
}

TEST(ContextNames, RoundTripThroughTheCommandLine) {
    EXPECT_EQ(parseGlChoice("auto").value(), GlChoice::automatic);
    EXPECT_EQ(parseGlChoice(contextKindName(ContextKind::egl)).value(), GlChoice::egl);
    EXPECT_EQ(parseGlChoice(contextKindName(ContextKind::eglDevice)).value(), GlChoice::eglDevice);
    EXPECT_EQ(parseGlChoice(contextKindName(ContextKind::osmesa)).value(), GlChoice::osmesa);
    const auto wrong = parseGlChoice("vulkan");
    ASSERT_FALSE(wrong.ok());
    EXPECT_NE(wrong.error().message.find("use auto, egl, egl-device or osmesa"), std::string::npos);
}

} // namespace
} // namespace serosa::gpu
