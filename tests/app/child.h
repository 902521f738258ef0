#pragma once
// Runs the built `serosa` as a child in a folder of its own, as a user would, and keeps what it said.

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace serosa::app {

struct ChildResult {
    int exitCode = -1; // 128 + the signal where one ended it
    std::string out, err;
    /// Lines of stderr; Mesa's own chatter is no part of the program's messages.
    std::size_t errorLines() const { return std::size_t(std::count(err.begin(), err.end(), '\n')); }
};

struct ChildOptions {
    std::vector<std::pair<std::string, std::string>> environment = {};
    long long largestFile = -1;      // bytes: writing more fails, as on a full disk; -1: no limit
    std::string interruptAfter = {}; // a file in the child's folder: once it is there, the child gets ...
    int interruptBy = SIGINT;        // ... this
    std::string standardOutput = {}; // a file instead of ChildResult::out
};

inline std::string readWhole(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// A folder that goes away with the test.
class TestFolder {
public:
    TestFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "serosa-app-XXXXXX").string();
        path_ = mkdtemp(name.data());
    }
    ~TestFolder() { std::filesystem::remove_all(path_); }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name, std::ios::binary) << text;
    }
    /// Names of everything in it, at any depth.
    std::set<std::string> names() const {
        std::set<std::string> all;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(path_))
            all.insert(std::filesystem::relative(entry.path(), path_).string());
        return all;
    }

private:
    std::filesystem::path path_;
};

/// Output goes to files outside `folder`, so that what the child leaves in it can be listed.
inline ChildResult runSerosa(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                             const ChildOptions& options = {}) {
    const TestFolder streams;
    const std::string outFile = (streams.path() / "out").string(),
                      errFile = (streams.path() / "err").string();
    const std::string program = std::string(SEROSA_BINARY_DIR) + "/serosa";
    const pid_t child = fork();
    if (child == 0) {
        if (chdir(folder.c_str()) != 0 || !freopen("/dev/null", "r", stdin) ||
            !freopen((options.standardOutput.empty() ? outFile : options.standardOutput).c_str(), "w",
                     stdout) ||
            !freopen(errFile.c_str(), "w", stderr))
            _exit(126);
        for (const auto& [name, value] : options.environment)
            setenv(name.c_str(), value.c_str(), 1);
        if (options.largestFile >= 0) {
            signal(SIGXFSZ, SIG_IGN); // write() fails instead
            const rlimit limit{rlim_t(options.largestFile), rlim_t(options.largestFile)};
            setrlimit(RLIMIT_FSIZE, &limit);
        }
        std::vector<char*> argv{const_cast<char*>(program.c_str())};
        for (const std::string& argument : arguments)
            argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        execv(program.c_str(), argv.data());
        _exit(127);
    }
    int status = 0;
    if (!options.interruptAfter.empty()) {
        while (!std::filesystem::exists(folder / options.interruptAfter) &&
               waitpid(child, &status, WNOHANG) == 0)
            usleep(1000);
        kill(child, options.interruptBy);
    }
    waitpid(child, &status, 0);
    ChildResult result;
    result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.out = readWhole(outFile);
    result.err = readWhole(errFile);
    return result;
}

} // namespace serosa::app
