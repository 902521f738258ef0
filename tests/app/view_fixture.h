#pragma once
// `serosa view` in a window on an X server of the test's own, for tests that drive it by keys and mouse.

#include "render/image.h"
#include "tests/app/child.h"
#include "tests/x_server.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <thread>

namespace serosa::app {

inline constexpr double kPatience = 60; // s: sanitizers and a busy machine are slow

/// `serosa view` running.
class ViewChild {
public:
    ViewChild(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
              const std::string& display)
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
    std::filesystem::path out_, err_;
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
    std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

    std::unique_ptr<test::XServer> server_;
    TestFolder folder_;
};

/// "frame 300: t = 5 s, state 0123..." gives the frame and the hash.
inline std::pair<int, std::string> lastLine(ViewChild& view) {
    const std::string rest = view.next("frame ");
    const std::size_t state = rest.find("state ");
    return {std::atoi(rest.c_str()), state == std::string::npos ? "" : rest.substr(state + 6)};
}

/// Pixels in which two pictures differ visibly.
inline std::size_t apart(const render::Image& a, const render::Image& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.rgb.size() && i < b.rgb.size(); i += 3)
        count += std::abs(int(a.rgb[i]) - int(b.rgb[i])) > 8;
    return count;
}

} // namespace serosa::app
