// `serosa view` as a user has it: a window on an X server of the test's own, keys and mouse through XTest,
// what it says, what it shows, what it leaves behind. The pictures of the tour stay in the build folder, to
// be looked at.

#include "render/image.h"
#include "tests/app/child.h"
#include "tests/x_server.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <thread>

namespace serosa::app {
namespace {

namespace fs = std::filesystem;
constexpr double kPatience = 60; // s: sanitizers and a busy machine are slow

/// `serosa view` running.
class ViewChild {
public:
    ViewChild(const fs::path& folder, const std::vector<std::string>& arguments, const std::string& display)
        : out_(streams_.path() / "out"), err_(streams_.path() / "err") {
        const std::string program = std::string(SEROSA_BINARY_DIR) + "/serosa";
        std::vector<std::string> words{program, "view"};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> argv;
        for (std::string& word : words)
            argv.push_back(word.data());
        argv.push_back(nullptr);
        process_ = fork();
        if (process_ == 0) {
            if (chdir(folder.c_str()) != 0 || !freopen("/dev/null", "r", stdin) ||
                !freopen(out_.c_str(), "w", stdout) || !freopen(err_.c_str(), "w", stderr))
                _exit(126);
            if (display.empty())
                unsetenv("DISPLAY");
            else
                setenv("DISPLAY", display.c_str(), 1);
            execv(program.c_str(), argv.data());
            _exit(127);
        }
    }
    ~ViewChild() {
        if (process_ > 0) {
            ::kill(process_, SIGKILL);
            waitpid(process_, nullptr, 0);
        }
    }
    ViewChild(const ViewChild&) = delete;
    ViewChild& operator=(const ViewChild&) = delete;

    std::string out() const { return readWhole(out_); }
    std::string err() const { return readWhole(err_); }
    void signal(int number) const { ::kill(process_, number); }

    /// The rest of the next line that begins with `start`, looked for after what was found before; empty
    /// where none comes.
    std::string next(const std::string& start) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kPatience);
        while (std::chrono::steady_clock::now() < end) {
            const std::string text = out();
            for (std::size_t at = read_; at < text.size();) {
                const std::size_t newline = text.find('\n', at);
                if (newline == std::string::npos)
                    break;
                if (text.compare(at, start.size(), start) == 0) {
                    read_ = newline + 1;
                    return text.substr(at + start.size(), newline - at - start.size());
                }
                at = newline + 1;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        ADD_FAILURE() << "no line \"" << start << "\" in\n" << out() << err();
        return "";
    }

    /// The exit code, or -1 where it does not end.
    int wait() {
        const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kPatience);
        while (std::chrono::steady_clock::now() < end) {
            int status = 0;
            if (waitpid(process_, &status, WNOHANG) == process_) {
                process_ = 0;
                return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return -1;
    }

private:
    TestFolder streams_;
    fs::path out_, err_;
    pid_t process_ = 0;
    std::size_t read_ = 0;
};

class View : public ::testing::Test {
protected:
    void SetUp() override {
        std::string problem;
        server_ = test::XServer::start(problem);
        ASSERT_TRUE(server_) << problem;
        folder_.write(
            "ball.toml",
            "schema = 1\n[[organ]]\nname = \"ball\"\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\n"
            "nodes = 200\n"
            "[[organ.fixed]]\nshape = \"lowest\"\nshare = 0.3\n"
            "[[tool]]\nradius = \"30 mm\"\nkeys = [{ t = \"0 s\", at = [\"0 mm\", \"72 mm\", \"0 mm\"] },"
            " { t = \"1 s\", at = [\"0 mm\", \"55 mm\", \"0 mm\"] }]\n"
            "[[tool]]\nmode = \"grasp\"\nradius = \"15 mm\"\nkeys = [{ t = \"50 ms\", at = [\"45 mm\","
            " \"0 mm\", \"0 mm\"] }, { t = \"2 s\", at = [\"65 mm\", \"0 mm\", \"0 mm\"] }]\n"
            "[output]\nsize = [480, 360]\nframe_every = 1000\n");
        const ChildResult made =
            runSerosa(folder_.path(), {"phantom", "ball", "--faces", "500", "-o", "ball.ply"});
        ASSERT_EQ(made.exitCode, 0) << made.err;
    }

    /// state_hash after so many frames of `serosa run`, which leaves its last picture in `out`.
    std::string hashOfRun(int frames, const std::string& out) const {
        const ChildResult ran =
            runSerosa(folder_.path(), {"run", "ball.toml", "--frames", std::to_string(frames), "--out", out});
        EXPECT_EQ(ran.exitCode, 0) << ran.err;
        const auto json =
            nlohmann::json::parse(readWhole(folder_.path() / out / "summary.json"), nullptr, false);
        return json.is_discarded() ? "" : json["state_hash"].get<std::string>();
    }
    std::string lastPicture(int frames, const std::string& out) const {
        char name[32];
        std::snprintf(name, sizeof name, "frame_%06d.png", frames);
        return readWhole(folder_.path() / out / name);
    }
    render::Image image(const std::string& file) const {
        auto read = render::readPng(folder_.path() / file);
        EXPECT_TRUE(read.ok()) << file;
        return read.ok() ? *read : render::Image{};
    }
    fs::path path(const std::string& name) const { return folder_.path() / name; }

    std::unique_ptr<test::XServer> server_;
    TestFolder folder_;
};

/// "frame 300: t = 5 s, state 0123..." gives the frame and the hash.
std::pair<int, std::string> lastLine(ViewChild& view) {
    const std::string rest = view.next("frame ");
    const std::size_t state = rest.find("state ");
    return {std::atoi(rest.c_str()), state == std::string::npos ? "" : rest.substr(state + 6)};
}

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
    const auto apart = [](const render::Image& a, const render::Image& b) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < a.rgb.size() && i < b.rgb.size(); i += 3)
            count += std::abs(int(a.rgb[i]) - int(b.rgb[i])) > 8;
        return count;
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

// A deformation of an organ at rest: moved by hand, by points, in the plane of the view; its box turned and
// scaled. What the view says of it, put into a scene, shows the same picture.
TEST_F(View, DeformationsFollowTheMouse) {
    const std::string body =
        "schema = 1\ngravity = [\"0 m/s2\", \"0 m/s2\", \"0 m/s2\"]\n"
        "[[organ]]\nname = \"ball\"\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\nnodes = 200\n"
        "[look]\nshow = \"implicit\"\nfield_samples = 40\n"
        "[output]\nsize = [480, 360]\nframe_every = 1000\n";
    const auto twist = [&](const std::string& place) {
        return body +
               "[[deformation]]\nkind = \"pull\"\nsize = [\"160 mm\", \"120 mm\", \"160 mm\"]\nradius = "
               "\"20 mm\"\n" +
               place + "\n";
    };
    folder_.write("pull.toml", twist("amount = \"25 mm\"\nat = [\"0 mm\", \"40 mm\", \"0 mm\"]"));
    ViewChild view(folder_.path(), {"pull.toml"}, server_->display());
    const auto window = server_->waitForWindow("ball - Serosa", kPatience);
    ASSERT_NE(window, 0U) << view.err();
    view.next("view: ball");
    server_->key("space");
    view.next("paused at frame ");
    std::vector<std::string> names;
    const auto picture = [&](const std::string& key = "s") {
        server_->key(key);
        names.push_back(view.next("wrote ./"));
        return image(names.back());
    };
    const auto apart = [](const render::Image& a, const render::Image& b) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < a.rgb.size() && i < b.rgb.size(); i += 3)
            count += std::abs(int(a.rgb[i]) - int(b.rgb[i])) > 8;
        return count;
    };
    const auto drag = [&](unsigned button, int byX, int byY, int wheel) {
        server_->moveTo(400, 180); // beside the panel
        server_->hold("Control_L", true);
        server_->hold("Shift_L", true);
        server_->press(button);
        view.next(button == 1 ? "moves the pull" : "turns the pull");
        server_->moveTo(400 + byX, 180 + byY);
        for (int i = 0; i < wheel; ++i) {
            server_->press(4);
            server_->release(4);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        server_->release(button);
        server_->hold("Shift_L", false);
        server_->hold("Control_L", false);
        return view.next("pull: ");
    };
    const render::Image first = picture();
    const std::string moved = drag(1, 12, 0, 0);
    const render::Image second = picture();
    EXPECT_GT(apart(first, second), 100U);
    const std::string turned = drag(3, 0, 20, 2);
    const render::Image third = picture();
    picture("F12"); // with its box
    EXPECT_GT(apart(second, third), 100U);
    server_->key("r");
    view.next("back at rest");
    EXPECT_EQ(apart(picture(), first), 0U) << "as in the scene";
    // Nothing else can move here: there are no hands.
    server_->hold("Control_L", true);
    server_->press(1);
    view.next("no hands here: deformations alone");
    server_->release(1);
    server_->hold("Control_L", false);
    server_->key("q");
    EXPECT_EQ(view.wait(), 0) << view.err();
    EXPECT_EQ(view.err(), "");
    // What was said is a scene: one key a line.
    for (const auto& [said, seen] : {std::pair(moved, second), std::pair(turned, third)}) {
        std::string lines = said;
        for (const char* key : {", up =", ", along =", ", keys =", ", amount ="})
            if (const std::size_t at = lines.find(key); at != std::string::npos)
                lines.replace(at, 2, "\n");
        folder_.write("said.toml", twist(lines));
        const ChildResult ran =
            runSerosa(folder_.path(), {"run", "said.toml", "--frames", "1", "--out", "said", "--force"});
        ASSERT_EQ(ran.exitCode, 0) << ran.err << lines;
        EXPECT_LT(apart(image("said/frame_000001.png"), seen), 30U) << lines;
    }
    const fs::path kept = fs::path(SEROSA_BINARY_DIR) / "view-deformation";
    fs::remove_all(kept);
    fs::create_directories(kept);
    for (const std::string& name : names)
        fs::copy_file(path(name), kept / name, fs::copy_options::overwrite_existing);
}

// A control point goes where the pointer draws it.
TEST_F(View, ControlPointsFollowTheMouse) {
    folder_.write(
        "points.toml",
        "schema = 1\ngravity = [\"0 m/s2\", \"0 m/s2\", \"0 m/s2\"]\n"
        "[[organ]]\nname = \"ball\"\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\nnodes = 200\n"
        "[look]\nshow = \"implicit\"\nfield_samples = 40\n"
        "[camera]\nprojection = \"orthographic\"\ndirection = [0, 0, -1]\nheight = \"240 mm\"\n"
        "target = [\"0 mm\", \"0 mm\", \"0 mm\"]\n"
        "[output]\nsize = [240, 240]\nframe_every = 1000\n"
        "[[deformation]]\nkind = \"points\"\nat = [\"0 mm\", \"0 mm\", \"0 mm\"]\nsize = [\"200 mm\", \"200 "
        "mm\", \"200 mm\"]\n"
        "texels = [32, 32, 32]\nreach = \"60 mm\"\n"
        "points = [{ from = [\"40 mm\", \"0 mm\", \"0 mm\"], to = [\"40 mm\", \"0 mm\", \"0 mm\"] },"
        " { from = [\"-40 mm\", \"0 mm\", \"0 mm\"], to = [\"-40 mm\", \"0 mm\", \"0 mm\"] }]\n");
    ViewChild view(folder_.path(), {"points.toml", "--no-panel"}, server_->display());
    const auto window = server_->waitForWindow("ball - Serosa", kPatience);
    ASSERT_NE(window, 0U) << view.err();
    view.next("view: ball");
    // A pixel is a millimetre: the first point, 10 mm up and 12 mm out.
    server_->moveTo(160, 120);
    server_->hold("Control_L", true);
    server_->hold("Shift_L", true);
    server_->press(1);
    view.next("point 1 of the points");
    server_->moveTo(172, 110);
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    server_->release(1);
    server_->hold("Shift_L", false);
    server_->hold("Control_L", false);
    const std::string said = view.next("points: ");
    EXPECT_NE(said.find("to = [\"52 mm\", \"10 mm\", \"0 mm\"]"), std::string::npos) << said;
    EXPECT_NE(said.find("to = [\"-40 mm\", \"0 mm\", \"0 mm\"]"), std::string::npos) << said;
    server_->key("q");
    EXPECT_EQ(view.wait(), 0) << view.err();
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
