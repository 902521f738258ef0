#pragma once
// Tubes along splines: the vessels of the heart, the dragon's body. A tube is a chain of short tapering
// capsules; an end may be cut flat, as a surgeon's scissors leave a vessel stump. Lengths in millimetres.

#include "models/sdf.h"

#include <vector>

namespace serosa::models {

struct TubePoint {
    Point at;
    double radius;
};

/// Catmull-Rom spline through `control` (at least two points), sampled about every `step`; radii follow.
std::vector<TubePoint> spline(const std::vector<TubePoint>& control, double step);

class Tube {
public:
    enum class End { round, flat };

    /// The chain of `points` (at least two). A flat end continues straight by its own radius plus `beyond`
    /// and is cut there at right angles.
    explicit Tube(std::vector<TubePoint> points, End start = End::round, End finish = End::round,
                  double beyond = 2.0);

    /// Distance to the tube. More than kReach away, a lower bound of it.
    double distance(const Point& p) const;

    static constexpr double kReach = 12.0;

private:
    struct Stump {
        Point from, direction;
        double length, radius;
    };

    struct Run { // consecutive segments and a sphere that holds them
        std::size_t first, last;
        Point centre;
        double radius;
    };

    std::vector<TubePoint> points_;
    std::vector<Run> runs_;
    std::vector<Stump> stumps_;
    Point lowest_, highest_;
};

/// Many thin tubes at once (coronary vessels): the same chain, looked up through a coarse grid.
class TubeTree {
public:
    void add(const std::vector<TubePoint>& points);
    /// Call once after the last add.
    void build();
    /// Distance to the nearest tube; kReach where none is that near.
    double distance(const Point& p) const;

    static constexpr double kReach = 4.0;

private:
    struct Segment {
        TubePoint a, b;
    };
    std::vector<Segment> segments_;
    std::vector<std::vector<int>> cells_;
    Point lowest_{0};
    glm::ivec3 size_{0};
    static constexpr double kCell = 3.0;
};

} // namespace serosa::models
