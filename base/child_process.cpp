// See base/child_process.h. posix_spawn starts the child in a process group of its own, so that what it
// starts ends with it; a process descriptor is waited on with the time limit (Linux 5.3).
#include "base/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

namespace serosa {

namespace {

namespace fs = std::filesystem;

std::string lastLine(const fs::path& file) {
    std::ifstream stream(file);
    std::string line, last;
    while (std::getline(stream, line))
        if (line.find_first_not_of(" \t\r") != std::string::npos)
            last = line;
    return last;
}

Result<pid_t> start(const ChildCommand& command, const fs::path& output) {
    std::vector<char*> arguments{const_cast<char*>(command.program.c_str())};
    for (const std::string& argument : command.arguments)
        arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0600);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    posix_spawn_file_actions_addchdir_np(&actions, command.folder.c_str());
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    pid_t child = 0;
    const int failed =
        posix_spawnp(&child, command.program.c_str(), &actions, &attributes, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (failed != 0)
        return Error{"cannot start '" + command.program + "': " + std::strerror(failed)};
    return child;
}

/// False when time ran out.
bool endsWithin(pid_t child, double seconds) {
    using Clock = std::chrono::steady_clock;
    // <sys/pidfd.h> of glibc 2.36 forgets that it is read by C++, too.
    const int descriptor = int(syscall(SYS_pidfd_open, child, 0));
    SEROSA_CHECK(descriptor >= 0, "process descriptors: Linux 5.3 or newer");
    const auto limit = Clock::now() + std::chrono::duration<double>(seconds);
    int ready = 0;
    do {
        const std::chrono::duration<double, std::milli> left = limit - Clock::now();
        pollfd waited{descriptor, POLLIN, 0};
        ready = poll(&waited, 1, int(std::max(0.0, left.count()) + 1));
    } while (ready < 0 && errno == EINTR);
    close(descriptor);
    return ready > 0;
}

} // namespace

Result<TemporaryFolder> TemporaryFolder::create() {
    std::error_code code;
    const fs::path parent = fs::temp_directory_path(code);
    std::string name = (parent / "serosa-XXXXXX").string();
    if (code || !mkdtemp(name.data()))
        return Error{"no folder can be made in " + parent.string() + " (" + std::strerror(errno) +
                     "): set TMPDIR to a folder that can be written to"};
    return TemporaryFolder(fs::path(name));
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty())
        fs::remove_all(path_, ignored);
}

bool programExists(const std::string& name) {
    const char* folders = std::getenv("PATH");
    std::istringstream list(folders ? folders : "");
    for (std::string folder; std::getline(list, folder, ':');)
        if (access((fs::path(folder) / name).c_str(), X_OK) == 0)
            return true;
    return false;
}

Status runChild(const ChildCommand& command) {
    const fs::path output = fs::absolute(command.folder / "output.txt");
    SEROSA_ASSIGN(const pid_t child, start(command, output));
    const bool ended = endsWithin(child, command.seconds);
    if (!ended)
        kill(-child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    const std::string said = lastLine(output);
    const std::string tail = said.empty() ? "" : "; it last said: " + said;
    const std::string subject = "the child '" + command.program + "' ";
    if (!ended) {
        std::ostringstream limit;
        limit << command.seconds;
        return Error{subject + "took more than " + limit.str() + " s and was stopped" + tail,
                     exitChildFailed};
    }
    if (WIFSIGNALED(status))
        return Error{subject + "crashed: " + strsignal(WTERMSIG(status)) + tail, exitChildFailed};
    if (WEXITSTATUS(status) != 0)
        return Error{subject + "failed with exit code " + std::to_string(WEXITSTATUS(status)) + tail,
                     exitChildFailed};
    return {};
}

} // namespace serosa
