// See app/progress.h.

#include "app/progress.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace serosa::app {

namespace {

volatile std::sig_atomic_t gInterrupted = 0;

// What a terminal, a scheduler's time limit and a closed connection send.
constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

extern "C" void onInterrupt(int which) {
    gInterrupted = 1;
    std::signal(which, SIG_DFL);
}

constexpr int kBarWidth = 40;
constexpr std::chrono::milliseconds kInterval{100};

} // namespace

Progress::Progress(std::string what, int total)
    : what_(std::move(what)), total_(total), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
    if (terminal_)
        std::fputs("\r\033[K", stderr);
}

void Progress::show(int done) {
    const auto now = std::chrono::steady_clock::now();
    if (!terminal_ || (done < total_ && now - last_ < kInterval))
        return;
    last_ = now;
    const int filled = total_ > 0 ? int(std::int64_t(done) * kBarWidth / total_) : kBarWidth;
    std::fprintf(stderr, "\r%s [%s%s] %d/%d\033[K", what_.c_str(),
                 std::string(std::size_t(filled), '#').c_str(),
                 std::string(std::size_t(kBarWidth - filled), '.').c_str(), done, total_);
}

InterruptGuard::InterruptGuard() {
    gInterrupted = 0;
    for (std::size_t i = 0; i < previous_.size(); ++i)
        previous_[i] = std::signal(kSignals[i], onInterrupt);
}

InterruptGuard::~InterruptGuard() {
    for (std::size_t i = 0; i < previous_.size(); ++i)
        if (previous_[i] != SIG_ERR)
            std::signal(kSignals[i], previous_[i]);
}

bool InterruptGuard::interrupted() const {
    return gInterrupted != 0;
}

} // namespace serosa::app
