// A ball less 336 spherical dimples, pushed apart until they are even.
#include "models/golf_ball.h"

#include "models/colour.h"

#include <array>

namespace serosa::models {
namespace {

constexpr double kRadius = kGolfBallRadius;
constexpr double kRim = 0.12; // mm: rounding of the dimples' edges

/// The directions of the dimples: a spiral of equal areas, its points then pushed apart by all others with a
/// force that falls as distance^-7, which leaves six neighbours at nearly one distance almost everywhere.
std::vector<Point> evenDirections() {
    constexpr double spacing = 0.2; // about the distance between neighbours
    constexpr double golden = 2.399963229728653;
    std::vector<Point> points;
    for (int i = 0; i < kDimples; ++i) {
        const double y = 1 - (2 * i + 1.0) / kDimples, r = std::sqrt(1 - y * y);
        points.emplace_back(r * std::cos(golden * i), y, r * std::sin(golden * i));
    }
    std::vector<Point> pushed = points;
    for (int round = 0; round < 400; ++round) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            Point force(0);
            for (const Point& other : points) {
                const Point away = (points[i] - other) / spacing;
                const double d2 = glm::dot(away, away);
                if (d2 > 0 && d2 < 9)
                    force += away / (d2 * d2 * d2 * d2);
            }
            pushed[i] = glm::normalize(points[i] + 0.03 * spacing * force);
        }
        points = pushed;
    }
    return points;
}

/// Dimples by direction: each tile of a cube map lists those that may matter in it.
class Dimples {
public:
    Dimples() : directions_(evenDirections()) {
        // A tile's corners lie within this angle of its middle; a dimple reaches as far as its rim.
        const double reach = 1.5 / kTiles + (kDimpleRadius + 0.8) / kRadius;
        for (int face = 0; face < 6; ++face)
            for (int v = 0; v < kTiles; ++v)
                for (int u = 0; u < kTiles; ++u) {
                    Point middle;
                    middle[face / 2] = face % 2 ? -1 : 1;
                    middle[(face / 2 + 1) % 3] = 2 * (u + 0.5) / kTiles - 1;
                    middle[(face / 2 + 2) % 3] = 2 * (v + 0.5) / kTiles - 1;
                    middle = glm::normalize(middle);
                    auto& list = tiles_[static_cast<std::size_t>((face * kTiles + v) * kTiles + u)];
                    for (const Point& d : directions_)
                        if (glm::dot(d, middle) > std::cos(reach))
                            list.push_back(kCentre * d);
                }
    }

    const std::vector<Point>& directions() const { return directions_; }

    /// Distance to the nearest of the spheres that press the dimples, kBall from their centres; at most
    /// `most`.
    double distance(const Point& p, double most) const {
        const Point a = glm::abs(p);
        const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
        const auto tile = [&](int other) {
            const double t = 0.5 * (p[(axis + other) % 3] / a[axis] + 1) * kTiles;
            return std::clamp(static_cast<int>(t), 0, kTiles - 1);
        };
        const int face = 2 * axis + (p[axis] < 0 ? 1 : 0);
        double best = most;
        for (const Point& centre :
             tiles_[static_cast<std::size_t>((face * kTiles + tile(2)) * kTiles + tile(1))])
            best = std::min(best, glm::length(p - centre) - kBall);
        return best;
    }

private:
    static constexpr int kTiles = 24;
    // The pressing sphere passes through the rim and the dimple's bottom: its sagitta over the rim's plane is
    // the depth less the ball's own.
    static constexpr double kBulge = kDimpleRadius * kDimpleRadius / (2 * kRadius);
    static constexpr double kSagitta = kDimpleDepth - kBulge;
    static constexpr double kBall =
        (kDimpleRadius * kDimpleRadius + kSagitta * kSagitta) / (2 * kSagitta); // mm
    static constexpr double kCentre = kRadius - kDimpleDepth + kBall;

    std::vector<Point> directions_;
    std::array<std::vector<Point>, 6 * kTiles * kTiles> tiles_;
};

const Dimples& dimples() {
    static const Dimples made;
    return made;
}

double distance(const Point& p) {
    const double ball = glm::length(p) - kRadius;
    if (ball > 1)
        return ball;
    if (ball < -1)
        return ball + kDimpleDepth; // the dimples are nearer by no more than that
    return carve(ball, dimples().distance(p, 1.0), kRim);
}

glm::u8vec3 colour(const Point& p) {
    const double depth = kRadius - glm::length(p);
    const Colour lacquer(216, 216, 210), shade(172, 176, 178);
    return toBytes(mix(lacquer, shade, ramp(0, kDimpleDepth, depth)));
}

} // namespace

const std::vector<Point>& dimpleDirections() {
    return dimples().directions();
}

const Solid& golfBallSolid() {
    static const Solid solid = [] {
        Solid s{.name = "golfball", .source = {}, .colour = colour, .fewest = 20000, .most = 600000};
        s.source.distance = distance;
        s.source.lowest = Point(-kRadius);
        s.source.highest = Point(kRadius);
        s.source.thinnest = 1.0; // the flats between dimples
        return s;
    }();
    return solid;
}

Result<sim::TriangleMesh> makeGolfBall(std::size_t faces) {
    return meshSolid(golfBallSolid(), faces);
}

} // namespace serosa::models
