// `serosa doctor` with what this machine has, and with every kind switched off.

#include "app/doctor.h"
#include "base/result.h"
#include "gpu/context.h"
#include "tests/gl_fixture.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <string>

namespace serosa::app {
namespace {

/// Sets an environment variable for a scope.
class ScopedVariable {
public:
    ScopedVariable(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
    ~ScopedVariable() { unsetenv(name_); }
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;

private:
    const char* name_;
};

class GlDoctor : public test::GlTest {};

TEST_F(GlDoctor, ReportsEachKindAndWhatAutomaticTakes) {
    std::ostringstream out;
    EXPECT_EQ(runDoctor(out), exitOk);
    const std::string text = out.str();
    for (const char* part : {"egl (", "egl-device (", "osmesa (", "window (", "renderer:",
                             "GL_MAX_TEXTURE_SIZE", "additive blending of RGBA32F", "--gl auto takes "})
        EXPECT_NE(text.find(part), std::string::npos) << part << " is missing in\n" << text;
    const auto context = gpu::createContext(gpu::GlChoice::automatic);
    ASSERT_TRUE(context.ok());
    const std::string taken = gpu::contextKindName((*context)->kind());
    EXPECT_NE(text.find("--gl auto takes " + taken + "."), std::string::npos) << text;
    EXPECT_EQ(text.find("Warning: that renderer is software") != std::string::npos,
              (*context)->info().software);
}

TEST_F(GlDoctor, WithoutAnyContextSaysWhatToDoAndReturns5) {
    const ScopedVariable off("SEROSA_GL_DISABLE", "egl,egl-device,osmesa,window");
    std::ostringstream out;
    EXPECT_EQ(runDoctor(out), 5);
    const std::string text = out.str();
    EXPECT_EQ(text.find(": available"), std::string::npos) << text;
    EXPECT_NE(text.find("switched off by SEROSA_GL_DISABLE"), std::string::npos) << text;
    EXPECT_NE(text.find("apt install libegl1 libegl-mesa0 libosmesa6"), std::string::npos) << text;
}

TEST_F(GlDoctor, WithoutADisplayTheWindowIsNoError) {
    // GLFW stays connected to a display that another test of this process has opened.
    const ScopedVariable off("SEROSA_GL_DISABLE", "window");
    std::ostringstream out;
    EXPECT_EQ(runDoctor(out), exitOk);
    const std::string text = out.str();
    EXPECT_NE(text.find("window (a window of GLFW, which needs a display): not available"), std::string::npos)
        << text;
}

TEST_F(GlDoctor, AWindowAloneIsNotEnough) {
    const ScopedVariable off("SEROSA_GL_DISABLE", "egl,egl-device,osmesa");
    std::ostringstream out;
    EXPECT_EQ(runDoctor(out), 5);
    EXPECT_EQ(out.str().find("--gl window"), std::string::npos) << out.str();
}

TEST_F(GlDoctor, WithOneKindLeftSaysThatAutomaticTakesIt) {
    const ScopedVariable off("SEROSA_GL_DISABLE", "egl,egl-device");
    std::ostringstream out;
    EXPECT_EQ(runDoctor(out), exitOk);
    EXPECT_NE(out.str().find("--gl auto takes osmesa."), std::string::npos) << out.str();
}

} // namespace
} // namespace serosa::app
