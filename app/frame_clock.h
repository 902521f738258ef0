#pragma once
// When the next frame of a scene is due. A scene advances by whole frames of a fixed number of steps, so how
// fast pictures are drawn, or how late a frame comes, changes nothing in what is simulated; only when.

namespace serosa::app {

class FrameClock {
public:
    /// \param frameTime s of simulated time a frame. \param most frames owed at once: what is beyond is
    /// dropped, and the simulation runs slower than real time instead of ever further behind.
    FrameClock(double frameTime, int most) : frameTime_(frameTime), most_(most) {}

    /// Whole frames that are due after `elapsed` more seconds; at least 0.
    int due(double elapsed) {
        owed_ += elapsed > 0 ? elapsed : 0;
        if (owed_ > most_ * frameTime_)
            owed_ = most_ * frameTime_;
        const int frames = int(owed_ / frameTime_ + 1e-9);
        owed_ -= frames * frameTime_;
        owed_ = owed_ < 0 ? 0 : owed_;
        return frames;
    }
    /// Seconds until the next frame is due.
    double untilNext() const { return frameTime_ - owed_; }
    /// Nothing is owed: after a pause.
    void restart() { owed_ = 0; }

private:
    double frameTime_, owed_ = 0; // s
    int most_;
};

} // namespace serosa::app
