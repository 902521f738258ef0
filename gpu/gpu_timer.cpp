// GPU time: a query on hardware, the clock between two glFinish on software.

#include "base/check.h"
#include "gpu/context_backend.h"
#include "gpu/handles.h"
#include "gpu/label.h"

namespace serosa::gpu {

GpuTimer::GpuTimer(const std::string& label) {
    checkContext(label);
    software_ = BackendContext::current()->info().software;
    glCreateQueries(GL_TIME_ELAPSED, 1, &id_);
    labelObject(GL_QUERY, id_, label);
}

GpuTimer& GpuTimer::operator=(GpuTimer&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(software_, other.software_);
    std::swap(running_, other.running_);
    std::swap(ended_, other.ended_);
    std::swap(start_, other.start_);
    std::swap(stop_, other.stop_);
    return *this;
}

GpuTimer::~GpuTimer() {
    if (id_) {
        checkContext("a timer that dies");
        glDeleteQueries(1, &id_);
    }
}

void GpuTimer::begin() {
    SEROSA_CHECK(id_ && !running_, "begin of an empty or running timer");
    running_ = true;
    if (software_) {
        glFinish();
        start_ = std::chrono::steady_clock::now();
    } else {
        glBeginQuery(GL_TIME_ELAPSED, id_);
    }
}

void GpuTimer::end() {
    SEROSA_CHECK(running_, "end of a timer that was not begun");
    running_ = false;
    ended_ = true;
    if (software_) {
        glFinish();
        stop_ = std::chrono::steady_clock::now();
    } else {
        glEndQuery(GL_TIME_ELAPSED);
    }
}

double GpuTimer::milliseconds() const {
    SEROSA_CHECK(ended_ && !running_, "milliseconds of a timer that was not begun and ended");
    if (software_)
        return std::chrono::duration<double, std::milli>(stop_ - start_).count();
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(id_, GL_QUERY_RESULT, &nanoseconds);
    return 1e-6 * static_cast<double>(nanoseconds);
}

} // namespace serosa::gpu
