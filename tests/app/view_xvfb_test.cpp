// `serosa view` as a user has it: a window on an X server of the test's own, keys and mouse through XTest,
// what it says, what it shows, what it leaves behind. The pictures of the tour stay in the build folder, to
// be looked at.

#include "tests/app/view_fixture.h"

namespace serosa::app {
namespace {

namespace fs = std::filesystem;

TEST_F(View, After300FramesTheStateIsThatOfARunWithoutAWindow) {
    const std::string expected = hashOfRun(300, "run");
    ASSERT_EQ(expected.size(), 32U);
    ViewChild fast(folder_.path(), {"ball.toml", "--quit-after", "300", "--fast"}, server_->display());
    EXPECT_EQ(fast.wait(), 0) << fast.err();
    EXPECT_EQ(lastLine(fast), std::pair(300, expected));
    // In real time, with another size of window, and disturbed.
    ViewChild paced(folder_.path(), {"ball.toml", "--quit-after", "300", "--size", "200x300", "--no-panel"},
                    server_->display());
    const auto window = server_->waitForWindow("ball - Serosa", kPatience);
    ASSERT_NE(window, 0U) << paced.err();
    server_->drag(1, 50, 50, 150, 90);
    server_->resize(window, 320, 240);
    server_->key("l");
    EXPECT_EQ(paced.wait(), 0) << paced.err();
    EXPECT_EQ(lastLine(paced), std::pair(300, expected));
    EXPECT_EQ(paced.err(), "");
}

TEST_F(View, TheReferenceSolverToo) {
    const ChildResult ran = runSerosa(
        folder_.path(), {"run", "ball.toml", "--frames", "20", "--solver", "reference", "--out", "run"});
    ASSERT_EQ(ran.exitCode, 0) << ran.err;
    const auto json = nlohmann::json::parse(readWhole(path("run/summary.json")), nullptr, false);
    ViewChild view(folder_.path(), {"ball.toml", "--quit-after", "20", "--fast", "--solver", "reference"},
                   server_->display());
    EXPECT_EQ(view.wait(), 0) << view.err();
    EXPECT_EQ(lastLine(view), std::pair(20, json["state_hash"].get<std::string>()));
}

TEST_F(View, ATourByMouseAndKeys) {
    fs::copy(fs::path(SEROSA_SOURCE_DIR) / "shaders", path("shaders"));
    ViewChild view(folder_.path(), {"ball.toml", "--shaders", "shaders"}, server_->display());
    const auto window = server_->waitForWindow("ball - Serosa", kPatience);
    ASSERT_NE(window, 0U) << view.err();
    view.next("view: ball");
    std::vector<std::string> tour;
    const auto picture = [&](const std::string& key = "s") {
        server_->key(key);
        tour.push_back(view.next("wrote ./"));
        return readWhole(path(tour.back()));
    };

    // Paused, the picture is the one that a run writes, to the byte; and it is what the screen shows.
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    server_->key("space");
    const int paused = std::atoi(view.next("paused at frame ").c_str());
    ASSERT_GT(paused, 0);
    const std::string first = picture();
    hashOfRun(paused, "run");
    EXPECT_EQ(first, lastPicture(paused, "run")) << "frame " << paused;
    const render::Image drawn = image(tour.back());
    const test::XServer::Picture shown = server_->grab(window);
    ASSERT_EQ(shown.width, drawn.width);
    ASSERT_EQ(shown.height, drawn.height);
    int different = 0, panel = 0;
    for (int y = 0; y < shown.height; ++y)
        for (int x = 0; x < shown.width; ++x)
            if (!std::equal(shown.at(x, y), shown.at(x, y) + 3,
                            &drawn.rgb[3 * std::size_t(y * shown.width + x)]))
                ++(x < 290 || y > 310 ? panel : different);
    EXPECT_EQ(different, 0) << "beside the panel and the message";
    EXPECT_GT(panel, 1000) << "the panel";

    server_->key("period");
    view.next("frame " + std::to_string(paused + 1));
    server_->key("period");
    view.next("frame " + std::to_string(paused + 2));

    // Each changes the picture; what changes it back gives the same bytes again.
    const std::string plain = picture();
    EXPECT_NE(plain, first) << "two frames later";
    EXPECT_EQ(picture(), plain);
    std::set<std::string> all{first, plain};
    for (const char* key : {"1", "2", "l", "w", "n"}) {
        server_->key(key);
        EXPECT_TRUE(all.insert(picture()).second) << key;
    }
    for (const char* key : {"3", "l", "w", "n"})
        server_->key(key);
    EXPECT_EQ(picture(), plain);
    server_->drag(1, 400, 200, 440, 150);
    EXPECT_TRUE(all.insert(picture()).second) << "turned";
    server_->drag(3, 400, 200, 440, 150);
    EXPECT_TRUE(all.insert(picture()).second) << "moved";
    server_->press(4);
    server_->release(4);
    EXPECT_TRUE(all.insert(picture()).second) << "zoomed";
    EXPECT_TRUE(all.insert(picture("F12")).second) << "with the panel";
    server_->key("c");
    EXPECT_EQ(picture(), plain) << "the scene's camera again";

    // Shaders: edited, broken, mended.
    const std::string fragment = readWhole(path("shaders/surface.frag"));
    const std::size_t end = fragment.rfind('}');
    ASSERT_NE(end, std::string::npos);
    const std::string magenta =
        fragment.substr(0, end) + "    o_colour = vec4(1.0, 0.0, 1.0, 1.0);\n" + fragment.substr(end);
    folder_.write("shaders/surface.frag", magenta);
    server_->key("F5");
    view.next("shaders of shaders");
    const std::string inMagenta = picture();
    const render::Image magentaImage = image(tour.back());
    int magentaPixels = 0;
    for (std::size_t i = 0; i + 2 < magentaImage.rgb.size(); i += 3)
        magentaPixels +=
            magentaImage.rgb[i] == 255 && magentaImage.rgb[i + 1] == 0 && magentaImage.rgb[i + 2] == 255;
    EXPECT_GT(magentaPixels, 10000);
    folder_.write("shaders/surface.frag", fragment.substr(0, end) + "    o_colour = no_such_thing;\n}\n");
    server_->key("F5");
    EXPECT_NE(view.next("error: shaders stay as they were: ").find("surface.frag"), std::string::npos);
    picture("F12"); // with the compiler's message
    EXPECT_EQ(picture(), inMagenta) << "the old ones still draw";
    folder_.write("shaders/surface.frag", "#version 450 core\nuniform float u_never;\nout vec4 o_colour;\n"
                                          "void main() { o_colour = vec4(u_never); }\n");
    server_->key("F5");
    EXPECT_NE(view.next("error: shaders stay as they were: ").find("surface.frag"), std::string::npos);
    EXPECT_EQ(picture(), inMagenta) << "compiles, but fits nothing";
    folder_.write("shaders/surface.frag", fragment);
    server_->key("F5");
    view.next("shaders of shaders");
    EXPECT_EQ(picture(), plain);

    // Sizes, down to a pixel; minimised and back.
    for (const auto& [width, height] : {std::pair(640, 200), std::pair(1, 1), std::pair(300, 500)}) {
        server_->resize(window, width, height);
        render::Image resized;
        for (int i = 0; i < 50 && (resized.width != width || resized.height != height); ++i) {
            picture();
            resized = image(tour.back());
        }
        EXPECT_EQ(resized.width, width);
        EXPECT_EQ(resized.height, height);
    }
    server_->minimise(window, true);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    server_->minimise(window, false);
    ASSERT_NE(server_->waitForWindow("ball - Serosa", kPatience), 0U);
    server_->resize(window, 480, 360);

    // From rest, ten frames by hand are ten frames of a run.
    server_->key("r");
    view.next("back at rest");
    for (int i = 1; i <= 10; ++i) {
        server_->key("period");
        view.next("frame " + std::to_string(i));
    }
    server_->close(window);
    EXPECT_EQ(view.wait(), 0) << view.err();
    EXPECT_EQ(lastLine(view), std::pair(10, hashOfRun(10, "run10")));
    EXPECT_EQ(view.err(), "");

    const fs::path kept = fs::path(SEROSA_BINARY_DIR) / "view-screenshots";
    fs::remove_all(kept);
    fs::create_directories(kept);
    for (const std::string& name : tour)
        fs::copy_file(path(name), kept / name, fs::copy_options::overwrite_existing);
}

// Ctrl and the left button take hold of the ball and pull it, ctrl and the right one push it; a hand that is
// gone leaves no trace in what comes after a restart.
TEST_F(View, HandsHoldAndPushTissue) {
    const std::string expected = hashOfRun(10, "run");
    ViewChild view(folder_.path(), {"ball.toml", "--no-panel"}, server_->display());
    const auto window = server_->waitForWindow("ball - Serosa", kPatience);
    ASSERT_NE(window, 0U) << view.err();
    view.next("view: ball");
    server_->key("space");
    view.next("paused at frame ");
    server_->key("r");
    view.next("back at rest");
    const auto steps = [&](int from, int to) {
        for (int frame = from + 1; frame <= to; ++frame) {
            server_->key("period");
            view.next("frame " + std::to_string(frame));
        }
    };
    const auto picture = [&] {
        server_->key("s");
        return image(view.next("wrote ./"));
    };
    steps(0, 10);
    const render::Image alone = picture();
    const int x = 240, y = 180; // the middle of the window
    std::string hash;
    for (const auto& [button, says] :
         {std::pair(1U, "the hand takes hold"), std::pair(3U, "the finger pushes")}) {
        server_->key("r");
        view.next("back at rest");
        server_->moveTo(x, y);
        server_->hold("Control_L", true);
        server_->press(button);
        view.next(says);
        server_->moveTo(x + 60, y - 20);
        for (int i = 0; i < 20 && button == 3; ++i) { // the wheel pushes it in
            server_->press(4);
            server_->release(4);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        steps(0, 10);
        EXPECT_GT(apart(picture(), alone), 500U) << says;
        server_->release(button);
        server_->hold("Control_L", false);
    }
    server_->moveTo(3, 3);
    server_->hold("Control_L", true);
    server_->press(1);
    view.next("no tissue under the pointer");
    server_->release(1);
    server_->hold("Control_L", false);
    server_->key("r");
    view.next("back at rest");
    steps(0, 10);
    server_->key("q");
    EXPECT_EQ(view.wait(), 0) << view.err();
    EXPECT_EQ(lastLine(view), std::pair(10, expected));
    EXPECT_EQ(view.err(), "");
}

TEST_F(View, QuitsByKeyAndBySignal) {
    ViewChild byKey(folder_.path(), {"ball.toml"}, server_->display());
    ASSERT_NE(server_->waitForWindow("ball - Serosa", kPatience), 0U) << byKey.err();
    byKey.next("view: ");
    server_->key("q");
    EXPECT_EQ(byKey.wait(), 0) << byKey.err();
    ViewChild bySignal(folder_.path(), {"ball.toml"}, server_->display());
    bySignal.next("view: ");
    bySignal.signal(SIGINT);
    EXPECT_EQ(bySignal.wait(), 130) << bySignal.err();
}

TEST_F(View, LosingTheDisplayEndsWithTheStateInOneLine) {
    ViewChild view(folder_.path(), {"ball.toml"}, server_->display());
    ASSERT_NE(server_->waitForWindow("ball - Serosa", kPatience), 0U) << view.err();
    view.next("view: ");
    server_->key("space");
    const std::string paused = std::to_string(std::atoi(view.next("paused at frame ").c_str()) + 1);
    server_->key("period");
    view.next("frame " + paused);
    server_->key("s");
    const std::string picture = view.next("wrote ./");
    server_->kill();
    EXPECT_EQ(view.wait(), 5);
    const std::string err = view.err(), expected = hashOfRun(std::atoi(paused.c_str()), "run");
    EXPECT_EQ(err.find("serosa: error: the X display went away after frame " + paused + " (state " +
                       expected + ")"),
              0U)
        << err;
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
    EXPECT_EQ(image(picture).width, 480) << "what was written is whole";
}

TEST_F(View, LosingTheDisplayWhileRunningIsNoCrash) {
    ViewChild view(folder_.path(), {"ball.toml", "--fast"}, server_->display());
    ASSERT_NE(server_->waitForWindow("ball - Serosa", kPatience), 0U) << view.err();
    view.next("view: ");
    server_->kill();
    EXPECT_EQ(view.wait(), 5) << view.err();
    EXPECT_NE(view.err().find("the X display went away after frame "), std::string::npos) << view.err();
}

TEST_F(View, AWindowThatAnotherProgramDestroysIsNoCrash) {
    ViewChild view(folder_.path(), {"ball.toml"}, server_->display());
    const auto window = server_->waitForWindow("ball - Serosa", kPatience);
    ASSERT_NE(window, 0U) << view.err();
    view.next("view: ");
    server_->destroy(window);
    EXPECT_EQ(view.wait(), 5) << view.err();
    EXPECT_NE(view.err().find("another program destroyed the window after frame "), std::string::npos)
        << view.err();
}

TEST_F(View, WithoutADisplaySaysWhatToDo) {
    for (const std::string display : {"", ":54321"}) {
        ViewChild view(folder_.path(), {"ball.toml"}, display);
        EXPECT_EQ(view.wait(), 5);
        const std::string err = view.err();
        EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
        for (const char* part : {"serosa: error: no window: ", "'serosa run'", "DISPLAY", "xvfb-run"})
            EXPECT_NE(err.find(part), std::string::npos) << part << " is missing in " << err;
    }
}

TEST_F(View, BadInputComesBeforeTheWindow) {
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{}, "view needs a scene file"},
        {{"nowhere.toml"}, "nowhere.toml"},
        {{"ball.toml", "--shaders", "nowhere"}, "--shaders: nowhere is no folder"},
        {{"ball.toml", "--out", "nowhere"}, "--out: nowhere is no folder"},
        {{"--model", "ball.ply"}, "--length-unit"}};
    for (const auto& [arguments, part] : cases) {
        ViewChild view(folder_.path(), arguments, "");
        EXPECT_EQ(view.wait(), 2);
        EXPECT_NE(view.err().find(part), std::string::npos) << view.err();
    }
}

TEST_F(View, ShowsAModelWithoutAScene) {
    ViewChild view(
        folder_.path(),
        {"--model", "ball.ply", "--length-unit", "mm", "--nodes", "200", "--fast", "--quit-after", "5"},
        server_->display());
    EXPECT_EQ(view.wait(), 0) << view.err();
    EXPECT_EQ(lastLine(view).first, 5);
}

} // namespace
} // namespace serosa::app
