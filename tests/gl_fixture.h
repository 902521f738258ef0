#pragma once
// Base of every test that needs a GL context: one context a process, of the kind that SEROSA_TEST_GL names
// (egl when unset), GL errors are failures. Name the suite Gl* and the file *_gl_test.cpp.

#include "gpu/context.h"
#include "gpu/gl.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

namespace serosa::test {

/// The kind of context that this run tests.
inline gpu::GlChoice testGlChoice() {
    const char* name = std::getenv("SEROSA_TEST_GL");
    return gpu::parseGlChoice(name ? name : "egl").value();
}

/// The process's context, made at first use; null, with a failure, when there is none. Destroyed after the
/// last test.
inline gpu::Context* sharedTestContext() {
    static std::unique_ptr<gpu::Context> context;
    static bool tried = false;
    struct Destroy : ::testing::Environment {
        void TearDown() override {
            context.reset();
            tried = false; // for --gtest_repeat
        }
    };
    static ::testing::Environment* const destroy =
        ::testing::AddGlobalTestEnvironment(new Destroy); // gtest owns it
    static_cast<void>(destroy);
    if (!tried) {
        tried = true;
        auto made = gpu::createContext(testGlChoice());
        if (made.ok())
            context = std::move(made).value();
        else
            ADD_FAILURE() << made.error().message;
    }
    return context.get();
}

class GlTest : public ::testing::Test {
protected:
    void SetUp() override {
        gpu::Context* context = sharedTestContext();
        ASSERT_TRUE(context) << "no GL context";
        context->makeCurrent();
        gpu::setGlErrorPolicy(gpu::GlErrorPolicy::fail);
        ASSERT_TRUE(gpu::takeGlErrors().empty()) << "left over from outside a test";
        for (const GLenum state :
             {GL_BLEND, GL_DEPTH_TEST, GL_CULL_FACE, GL_SCISSOR_TEST, GL_RASTERIZER_DISCARD})
            glDisable(state); // what an earlier test may have left on
    }

    void TearDown() override {
        if (!sharedTestContext())
            return;
        for (const std::string& message : gpu::takeGlErrors())
            ADD_FAILURE() << "GL error: " << message;
    }
};

} // namespace serosa::test
