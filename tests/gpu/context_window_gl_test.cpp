// A window beside the other kinds of context in one thread: GLX, EGL and OSMesa share Mesa's dispatch and do
// not know of each other.

#include "gpu/context_window.h"
#include "gpu/handles.h"
#include "tests/gl_fixture.h"
#include "tests/x_server.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

namespace serosa::gpu {
namespace {

using Pixel = std::array<std::uint8_t, 4>;

/// A 4 x 4 image in the current context, cleared to a colour through a framebuffer.
struct Marker {
    explicit Marker(const Pixel& wanted) : colour(wanted) {
        framebuffer.attach(GL_COLOR_ATTACHMENT0, texture);
        draw();
    }
    void draw() const {
        framebuffer.bind(4, 4);
        glClearColor(colour[0] / 255.0F, colour[1] / 255.0F, colour[2] / 255.0F, 1);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    bool readsBack() const {
        std::vector<Pixel> pixels(16);
        texture.download(pixels.data(), pixels.size() * sizeof(Pixel));
        return std::all_of(pixels.begin(), pixels.end(), [this](const Pixel& p) { return p == colour; });
    }
    Pixel colour;
    Texture2D texture{"marker", GL_RGBA8, 4, 4};
    Framebuffer framebuffer{"marker"};
};

/// A context of any kind, with its window if it has one, and a marker in it.
struct Maker {
    std::unique_ptr<Context> context;
    std::unique_ptr<Window> window;
    std::unique_ptr<Marker> marker;
    ~Maker() {
        if (marker)
            context->makeCurrent();
    }
};

class GlWindows : public test::GlTest {
protected:
    static test::XServer* server() {
        static std::string problem;
        // Until the program ends: GLFW stays connected.
        static const std::unique_ptr<test::XServer> started = [] {
            auto made = test::XServer::start(problem);
            if (made)
                setenv("DISPLAY", made->display().c_str(), 1);
            return made;
        }();
        EXPECT_TRUE(started) << problem;
        return started.get();
    }
    void SetUp() override {
        ASSERT_TRUE(server());
        GlTest::SetUp();
    }
    static OpenedWindow open(int width = 64, int height = 48) {
        WindowRequest request;
        request.title = "serosa test";
        request.width = width;
        request.height = height;
        auto opened = openWindow(request);
        EXPECT_TRUE(opened.ok()) << opened.error().message;
        return opened.ok() ? std::move(opened).value() : OpenedWindow{};
    }
    static std::unique_ptr<Maker> make(ContextKind kind, const Pixel& colour) {
        auto maker = std::make_unique<Maker>();
        if (kind == ContextKind::window) {
            OpenedWindow opened = open();
            maker->context = std::move(opened.context);
            maker->window = std::move(opened.window);
        } else {
            auto made = createContext(parseGlChoice(contextKindName(kind)).value());
            EXPECT_TRUE(made.ok()) << made.error().message;
            if (made.ok())
                maker->context = std::move(made).value();
        }
        if (maker->context)
            maker->marker = std::make_unique<Marker>(colour);
        return maker;
    }
};

constexpr Pixel kColours[] = {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}};

TEST_F(GlWindows, ThreeKindsInTurnInOneThreadEachReadItsMarkerBack) {
    std::array<ContextKind, 3> order = {ContextKind::egl, ContextKind::osmesa, ContextKind::window};
    do {
        for (std::size_t i = 0; i < order.size(); ++i) {
            const auto maker = make(order[i], kColours[i]);
            ASSERT_TRUE(maker->marker);
            EXPECT_EQ(maker->context->kind(), order[i]);
            EXPECT_TRUE(maker->marker->readsBack()) << contextKindName(order[i]);
        }
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST_F(GlWindows, ThreeLiveKindsInterleave) {
    std::array<ContextKind, 3> order = {ContextKind::egl, ContextKind::osmesa, ContextKind::window};
    do {
        std::vector<std::unique_ptr<Maker>> makers;
        for (std::size_t i = 0; i < order.size(); ++i) {
            makers.push_back(make(order[i], kColours[i]));
            ASSERT_TRUE(makers.back()->marker);
        }
        for (int round = 0; round < 3; ++round)
            for (const auto& maker : makers) {
                maker->context->makeCurrent();
                EXPECT_TRUE(maker->marker->readsBack()) << contextKindName(maker->context->kind());
                maker->marker->draw();
            }
        for (auto& maker : makers) {
            maker.reset();
            for (const auto& other : makers)
                if (other) {
                    other->context->makeCurrent();
                    EXPECT_TRUE(other->marker->readsBack()) << "after another died";
                }
        }
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST_F(GlWindows, ShowsWhatIsDrawnIntoFramebuffer0) {
    const OpenedWindow opened = open();
    ASSERT_TRUE(opened.context);
    const auto shown = server()->waitForWindow("serosa test", 5);
    ASSERT_NE(shown, 0U);
    test::XServer::Picture picture;
    for (int i = 0; i < 100 && (picture.width == 0 || picture.at(5, 5)[1] != 128); ++i) {
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glClearColor(1, 128 / 255.0F, 0, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        opened.window->present();
        opened.window->poll(0.01);
        picture = server()->grab(shown);
    }
    ASSERT_EQ(picture.width, 64);
    ASSERT_EQ(picture.height, 48);
    EXPECT_EQ(std::vector<int>(picture.at(5, 5), picture.at(5, 5) + 3), (std::vector<int>{255, 128, 0}));
    EXPECT_EQ(opened.window->problem(), "");
}

TEST_F(GlWindows, GivesWhatTheUserDoesInOrder) {
    const OpenedWindow opened = open(200, 100);
    ASSERT_TRUE(opened.context);
    const auto shown = server()->waitForWindow("serosa test", 5);
    ASSERT_NE(shown, 0U);
    opened.window->poll(0.1);
    server()->drag(1, 20, 30, 60, 40);
    for (const char* key : {"space", "r", "1", "F12", "period", "Left"})
        server()->key(key);
    server()->press(4);
    server()->release(4);
    std::vector<WindowEvent> events;
    const auto start = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - start < std::chrono::seconds(5) &&
           (events.empty() || events.back().kind != WindowEvent::Kind::scrolled))
        for (const WindowEvent& event : opened.window->poll(0.05))
            events.push_back(event);
    std::vector<int> keys;
    glm::dvec2 pressedAt(-1), releasedAt(-1);
    for (const WindowEvent& event : events) {
        if (event.kind == WindowEvent::Kind::keyPressed)
            keys.push_back(event.key);
        if (event.kind == WindowEvent::Kind::buttonPressed)
            pressedAt = event.at;
        if (event.kind == WindowEvent::Kind::buttonReleased)
            releasedAt = event.at;
    }
    EXPECT_EQ(keys, (std::vector<int>{' ', 'r', '1', keyF12, '.', keyLeft}));
    EXPECT_EQ(pressedAt, glm::dvec2(20, 30));
    EXPECT_EQ(releasedAt, glm::dvec2(60, 40));
    ASSERT_FALSE(events.empty());
    EXPECT_EQ(events.back().kind, WindowEvent::Kind::scrolled);
    EXPECT_EQ(events.back().at.y, 1);
}

TEST_F(GlWindows, FollowsItsSizeAndItsClosing) {
    const OpenedWindow opened = open();
    ASSERT_TRUE(opened.context);
    EXPECT_EQ(opened.window->framebufferSize(), glm::ivec2(64, 48));
    const auto shown = server()->waitForWindow("serosa test", 5);
    ASSERT_NE(shown, 0U);
    server()->resize(shown, 120, 30);
    for (int i = 0; i < 200 && opened.window->framebufferSize().x != 120; ++i)
        opened.window->poll(0.02);
    EXPECT_EQ(opened.window->framebufferSize(), glm::ivec2(120, 30));
    server()->minimise(shown, true);
    for (int i = 0; i < 200 && opened.window->framebufferSize().x != 0; ++i)
        opened.window->poll(0.02);
    EXPECT_EQ(opened.window->framebufferSize(), glm::ivec2(0)) << "minimised";
    server()->minimise(shown, false);
    for (int i = 0; i < 200 && opened.window->framebufferSize().x == 0; ++i)
        opened.window->poll(0.02);
    EXPECT_EQ(opened.window->framebufferSize(), glm::ivec2(120, 30));
    EXPECT_FALSE(opened.window->closing());
    server()->close(shown);
    for (int i = 0; i < 200 && !opened.window->closing(); ++i)
        opened.window->poll(0.02);
    EXPECT_TRUE(opened.window->closing());
}

TEST_F(GlWindows, FitsTheMonitor) {
    const OpenedWindow opened = open(5000, 2500);
    ASSERT_TRUE(opened.context);
    EXPECT_EQ(opened.window->size(), glm::ivec2(1280, 640));
}

/// Sets SEROSA_GL_DISABLE for a scope.
class ScopedDisable {
public:
    explicit ScopedDisable(const char* kinds) { setenv("SEROSA_GL_DISABLE", kinds, 1); }
    ~ScopedDisable() { unsetenv("SEROSA_GL_DISABLE"); }
    ScopedDisable(const ScopedDisable&) = delete;
    ScopedDisable& operator=(const ScopedDisable&) = delete;
};

TEST_F(GlWindows, IsNeverTakenByItself) {
    const ScopedDisable off("egl,egl-device,osmesa");
    const auto context = createContext(GlChoice::automatic);
    ASSERT_FALSE(context.ok());
    EXPECT_EQ(context.error().exitCode, 5);
    const std::vector<ContextOffer> offers = surveyContexts();
    ASSERT_EQ(offers.back().kind, ContextKind::window);
    EXPECT_TRUE(offers.back().available) << offers.back().problem;
    EXPECT_FALSE(automaticKind(offers).has_value());
    EXPECT_FALSE(parseGlChoice("window").ok()) << "a window is no choice of --gl";
}

TEST_F(GlWindows, CanBeSwitchedOff) {
    const ScopedDisable off("window");
    const auto opened = openWindow({});
    ASSERT_FALSE(opened.ok());
    EXPECT_EQ(opened.error().exitCode, 5);
    EXPECT_NE(opened.error().message.find("SEROSA_GL_DISABLE"), std::string::npos) << opened.error().message;
}

} // namespace
} // namespace serosa::gpu
