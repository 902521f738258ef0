// Coins with raised rims and a star, laid one after the other into the hollow of the bank.
#include "models/coins.h"

#include "models/colour.h"
#include "models/shaping.h"

namespace serosa::models {
namespace {

const Point kLowest(-48, -54, -44), kHighest(66, -8, 44);
constexpr double kRelief = 0.4; // of rim and star, mm
constexpr double kFillet = 3.0; // where coins touch; closes gaps that no lattice would keep, mm
constexpr double kEdge = 0.5;   // rounding of the edges, mm
constexpr double kRim = kCoinRadius - 1.9;

double star(double x, double y) { // signed distance, about
    constexpr double fifth = 2 * 3.14159265358979323846 / 5;
    double angle = std::atan2(y, x);
    angle = std::abs(angle - fifth * std::round(angle / fifth));
    const double r = std::hypot(x, y);
    // The line from a tip (r = 8) to the notch beside it (r = 3.4).
    const glm::dvec2 tip(8, 0), notch(3.4 * std::cos(fifth / 2), 3.4 * std::sin(fifth / 2));
    const glm::dvec2 along = glm::normalize(notch - tip), p(r * std::cos(angle), r * std::sin(angle));
    return (p.x - tip.x) * along.y - (p.y - tip.y) * along.x;
}

double relief(const Point& q) { // 0 to 1: field, and rim or star
    const double r = std::hypot(q.x, q.z), d = star(q.x, q.z);
    const double dome = std::clamp(-d / 2.2, 0.0, 1.0);
    return std::max(ramp(kRim - 0.8, kRim + 0.4, r), ramp(0.5, -0.5, d) * (0.55 + 0.45 * dome));
}

struct Laid {
    Point at;
    glm::dmat3 worldFromCoin;
};

const std::vector<Laid>& laid() {
    static const std::vector<Laid> list = [] {
        std::vector<Laid> out;
        for (const Coin& coin : coinHeap()) {
            const double turn = 2.4 * static_cast<double>(out.size()); // each faces its own way
            const Frame frame(coin.at, coin.axis, {std::cos(turn), 0, std::sin(turn)});
            out.push_back({coin.at, frame.worldFromLocal});
        }
        return out;
    }();
    return list;
}

double disc(const Point& q) {
    const double beside = std::hypot(q.x, q.z) - kCoinRadius + kEdge;
    const double above = std::abs(q.y) - 0.5 * kCoinThickness + kEdge;
    const double outer = std::hypot(std::max(beside, 0.0), std::max(above, 0.0)) - kEdge;
    return std::min(std::max(beside, above), 0.0) + outer;
}

/// How far the field lies below the rim at a point near the coin's surface.
double sunk(const Point& q) {
    return std::hypot(q.x, q.z) < kCoinRadius ? kRelief * (1 - relief(q)) : 0.0;
}

Point local(const Laid& coin, const Point& p) {
    return (p - coin.at) * coin.worldFromCoin;
}

glm::u8vec3 colour(const Point& p) {
    constexpr Colour metals[3] = {{226, 178, 66}, {190, 192, 196}, {190, 112, 68}};
    std::size_t nearest = 0;
    double best = 1e9;
    for (std::size_t i = 0; i < laid().size(); ++i) {
        const double d = disc(local(laid()[i], p));
        if (d < best)
            best = d, nearest = i;
    }
    const Point q = local(laid()[nearest], p);
    const double worn = 0.5 + 0.5 * layeredNoise(p / 7.0, 2);
    Colour c = metals[coinHeap()[nearest].metal];
    c *= 0.86 + 0.14 * worn;
    if (std::abs(q.y) > 0.5 * kCoinThickness - 0.8 && std::hypot(q.x, q.z) < kCoinRadius - 0.4)
        c *= 0.78 + 0.22 * relief(q); // tarnish stays in the field
    return toBytes(c);
}

double wantedSize(const Point& p) {
    double size = 1;
    for (const Laid& coin : laid()) {
        const Point q = local(coin, p);
        if (std::abs(disc(q)) < 0.6 && std::abs(q.y) > 0.5 * kCoinThickness - 1)
            size = std::min(size, 0.6 + 0.6 * ramp(0.5, 2.5, std::abs(star(q.x, q.z))));
    }
    return size;
}

} // namespace

const std::vector<Coin>& coinHeap() {
    static const std::vector<Coin> heap = {
        {{8.49, -46.72, -1.05}, {0.021, 1.000, 0.023}, 0},
        {{6.76, -44.20, 2.56}, {0.020, 1.000, 0.023}, 1},
        {{7.33, -41.71, 5.01}, {0.021, 1.000, 0.023}, 2},
        {{31.97, -42.62, -1.00}, {-0.359, 0.933, 0.023}, 1},
        {{-10.48, -39.89, 0.29}, {-0.210, 0.978, 0.003}, 2},
        {{19.09, -39.28, 0.99}, {0.056, 0.998, 0.017}, 0},
        {{-11.14, -37.37, -6.12}, {-0.210, 0.978, -0.001}, 2},
        {{20.64, -36.94, 9.13}, {0.055, 0.998, 0.019}, 0},
        {{18.34, -38.84, -21.89}, {-0.172, 0.795, 0.582}, 1},
        {{-5.85, -37.95, 23.45}, {0.208, 0.796, -0.568}, 0},
        {{-19.44, -36.42, -2.24}, {-0.223, 0.975, -0.008}, 1},
        {{31.24, -34.85, 7.98}, {0.090, 0.996, 0.024}, 0},
        {{13.52, -34.29, -8.95}, {-0.396, 0.891, -0.224}, 1},
        {{-5.71, -33.46, 7.80}, {0.271, 0.900, 0.342}, 0},
        {{-2.90, -32.93, -16.25}, {0.056, 0.884, -0.465}, 1},
        {{6.75, -33.00, 16.59}, {0.099, 0.993, 0.067}, 0},
        {{-34.11, -32.83, 6.18}, {0.054, 0.981, -0.188}, 1},
        {{-34.28, -31.74, -1.85}, {0.053, 0.980, -0.191}, 2},
        {{35.57, -32.72, 9.85}, {0.090, 0.996, 0.024}, 1},
        {{38.57, -31.13, -15.26}, {-0.089, 0.950, 0.298}, 2},
        {{7.37, -30.13, 16.40}, {0.088, 0.996, 0.027}, 0},
        {{-5.44, -31.04, -18.51}, {0.057, 0.885, -0.463}, 2},
        {{-27.15, -30.65, -8.27}, {0.075, 0.974, -0.216}, 0},
        {{40.52, -30.51, 6.11}, {0.090, 0.996, 0.024}, 1},
        {{16.36, -28.49, 21.90}, {0.094, 0.995, 0.032}, 0},
        {{9.35, -27.93, -17.20}, {0.135, 0.928, -0.348}, 1},
    };
    return heap;
}

double coinsDistance(const Point& p) {
    double d = 1e9, nearest = 1e9, second = 1e9;
    Point onNearest(0);
    for (const Laid& coin : laid()) {
        const double away = glm::length(p - coin.at) - std::hypot(kCoinRadius, 0.5 * kCoinThickness);
        const Point q = local(coin, p);
        const double own = away > 12 ? away : disc(q);
        d = blend(d, own, kFillet);
        if (own < nearest)
            second = nearest, nearest = own, onNearest = q;
        else
            second = std::min(second, own);
    }
    // No relief where another coin lies on this one: it would enclose a hollow.
    return std::abs(d) > 6 ? d : d + sunk(onNearest) * ramp(1.8, 4.0, second);
}

const Solid& coinsSolid() {
    static const Solid solid = [] {
        Solid s{.name = "coins", .source = {}, .colour = colour, .fewest = 40000, .most = 600000};
        s.source.distance = coinsDistance;
        s.source.lowest = kLowest;
        s.source.highest = kHighest;
        s.source.thinnest = 1.0; // between coins that lean on each other
        s.source.size = wantedSize;
        return s;
    }();
    return solid;
}

Result<sim::TriangleMesh> makeCoins(std::size_t faces) {
    return meshSolid(coinsSolid(), faces);
}

} // namespace serosa::models
