#pragma once
// Vessels that leave an organ and were cut: solid inside it, open for a few millimetres at the end.

#include "models/tube.h"

namespace serosa::models {

class Stump {
public:
    /// Along a spline through `control`, whose radii are the vessel's outer ones, mm; the last point is where
    /// the flat end begins. `wall`: thickness, mm; `open`: how deep one can look in, mm.
    Stump(const std::vector<TubePoint>& control, double wall, double open);

    double outer(const Point& p) const { return outer_.distance(p); }
    double lumen(const Point& p) const { return lumen_.distance(p); }

private:
    Tube outer_, lumen_;
};

} // namespace serosa::models
