#pragma once
// A progress bar on stderr, only where that is a terminal; and the flag that an interruption sets.

#include <array>
#include <chrono>
#include <string>

namespace serosa::app {

class Progress {
public:
    Progress(std::string what, int total);
    ~Progress(); // clears the line
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    void show(int done);

private:
    std::string what_;
    int total_;
    bool terminal_;
    std::chrono::steady_clock::time_point last_{};
};

/// From its making to its end, SIGINT, SIGTERM and SIGHUP set a flag instead of ending the program; a second
/// one ends it.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;
    bool interrupted() const;

private:
    std::array<void (*)(int), 3> previous_;
};

} // namespace serosa::app
