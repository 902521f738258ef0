// The grooves are found, not drawn: the interventricular grooves are where the surface is as far from one
// ventricle as from the other, the atrioventricular groove where it is as far from ventricles as from atria.
// Branches run between points given as height along the heart's axis (mm) and angle around it (degrees: 0
// left, 90 front, 180 right).
#include "models/heart_coronaries.h"

#include <functional>

namespace serosa::models {
namespace {

using Anatomy = HeartAnatomy;

class Layer {
public:
    explicit Layer(const Anatomy& heart) : heart_(heart) {}

    /// First point of the muscle's surface from outside, towards the axis at `height`, at `angle`.
    Point surface(double height, double angle, bool withAtria) const {
        const double a = glm::radians(angle);
        const Point out = heart_.toWorld({std::cos(a), 0, std::sin(a)});
        const Point axis = heart_.toWorld({kAxisX, height, kAxisZ});
        double r = 75;
        for (int step = 0; step < 200 && r > 0.5; ++step) {
            const auto d = heart_.distances(axis + r * out);
            const double away = withAtria ? Anatomy::muscle(d) : Anatomy::ventricles(d);
            if (away < 1e-3)
                break;
            r -= 0.9 * away;
        }
        return axis + r * out;
    }

    /// Angle between `left` (nearer the left ventricle) and `right` where the interventricular groove runs.
    double grooveAngle(double height, double left, double right) const {
        for (int step = 0; step < 18; ++step) {
            const double middle = 0.5 * (left + right);
            const auto d = heart_.distances(surface(height, middle, false));
            (d.outer[Anatomy::leftVentricle] < d.outer[Anatomy::rightVentricle] ? left : right) = middle;
        }
        return 0.5 * (left + right);
    }

    /// Height of the atrioventricular groove at `angle`.
    double grooveHeight(double angle) const {
        double low = -25, high = 32;
        for (int step = 0; step < 18; ++step) {
            const double middle = 0.5 * (low + high);
            const auto d = heart_.distances(surface(middle, angle, true));
            const double atria = std::min(d.outer[Anatomy::leftAtrium], d.outer[Anatomy::rightAtrium]);
            (Anatomy::ventricles(d) < atria ? low : high) = middle;
        }
        return 0.5 * (low + high);
    }

    struct Stop {
        double height, angle;
    };
    /// A vessel along the surface through `stops`, with radius from r0 to r1, raised by `lift` of its radius.
    std::vector<TubePoint> along(const std::vector<Stop>& stops, double r0, double r1, bool withAtria) const {
        std::vector<TubePoint> control;
        for (const Stop& s : stops)
            control.push_back({Point(s.height, s.angle, 0), 1});
        std::vector<TubePoint> path = spline(control, 2.5);
        for (std::size_t i = 0; i < path.size(); ++i) {
            const double t = static_cast<double>(i) / static_cast<double>(path.size() - 1);
            const double wander = 1.2 * std::sin(0.21 * path[i].at.x + 0.13 * path[i].at.y);
            const Point p = surface(path[i].at.x, path[i].at.y + wander, withAtria);
            path[i].radius = r0 + (r1 - r0) * t;
            path[i].at = p + kLift * path[i].radius * normal(p);
        }
        return path;
    }

    Point normal(const Point& p) const {
        constexpr double e = 0.05;
        const auto f = [&](const Point& q) { return Anatomy::muscle(heart_.distances(q)); };
        return glm::normalize(Point(f(p + Point(e, 0, 0)) - f(p - Point(e, 0, 0)),
                                    f(p + Point(0, e, 0)) - f(p - Point(0, e, 0)),
                                    f(p + Point(0, 0, e)) - f(p - Point(0, 0, e))));
    }

private:
    static constexpr double kAxisX = 0, kAxisZ = 0;
    static constexpr double kLift = 0.25;
    const Anatomy& heart_;
};

} // namespace

Coronaries layCoronaries(const HeartAnatomy& heart) {
    const Layer lay(heart);
    using Stops = std::vector<Layer::Stop>;
    Coronaries out;
    const auto front = [&](double height) { return lay.grooveAngle(height, -10, 110); };
    const auto back = [&](double height) { return lay.grooveAngle(height, 300, 190); };

    // Left anterior descending, with the great cardiac vein beside it, and diagonals over the left ventricle.
    Stops descending, beside;
    for (double h = -4; h >= -70; h -= 6) {
        descending.push_back({h, front(h)});
        beside.push_back({h, front(h) - 7 - 0.03 * h});
    }
    out.arteries.add(lay.along(descending, 2.1, 1.1, false));
    out.veins.add(lay.along(beside, 1.7, 0.9, false));
    const auto branch = [&](double h, double angle, double toH, double toAngle, double r) {
        const double midH = 0.5 * (h + toH) + 4, midAngle = 0.5 * (angle + toAngle);
        out.arteries.add(lay.along({{h, angle}, {midH, midAngle}, {toH, toAngle}}, r, 0.55 * r, false));
    };
    branch(-12, front(-12), -48, front(-48) - 48, 1.6);
    branch(-26, front(-26), -58, front(-58) - 40, 1.4);
    branch(-42, front(-42), -64, front(-64) - 34, 1.2);
    branch(-20, front(-20), -36, front(-36) + 36, 1.15);
    branch(-38, front(-38), -52, front(-52) + 34, 1.05);

    // Circumflex and right coronary in the atrioventricular groove; marginals; coronary sinus.
    const auto groove = [&](double from, double to) {
        Stops stops;
        const double step = from < to ? 9 : -9;
        for (double a = from; step > 0 ? a <= to : a >= to; a += step)
            stops.push_back({lay.grooveHeight(a), a});
        return stops;
    };
    // The circumflex comes out from under the left auricle.
    out.arteries.add(lay.along(groove(-22, -85), 1.9, 1.2, true));
    const Stops right = groove(122, 252);
    out.arteries.add(lay.along(right, 2.1, 1.4, true));
    Stops sinus = groove(-20, -92);
    for (Layer::Stop& s : sinus)
        s.height += 4;
    out.veins.add(lay.along(sinus, 1.6, 2.4, true));
    branch(lay.grooveHeight(-12) - 2, -12, -50, -6, 1.5);
    branch(lay.grooveHeight(-45) - 2, -45, -52, -34, 1.4);
    branch(lay.grooveHeight(158) - 2, 158, -46, 132, 1.4);
    branch(lay.grooveHeight(192) - 2, 192, -50, 172, 1.5);

    // Posterior descending, with the middle cardiac vein.
    Stops posterior, middle;
    for (double h = -6; h >= -62; h -= 7) {
        posterior.push_back({h, back(h)});
        middle.push_back({h, back(h) + 8 - 0.03 * h});
    }
    out.arteries.add(lay.along(posterior, 1.6, 1.0, false));
    out.veins.add(lay.along(middle, 1.5, 0.9, false));
    branch(-22, back(-22), -48, back(-48) + 40, 1.2);
    out.arteries.build();
    out.veins.build();
    return out;
}

} // namespace serosa::models
