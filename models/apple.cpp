// A body of revolution with five faint lobes, a stem in its hollow and the dried calyx in the basin below.
#include "models/apple.h"

#include "models/colour.h"
#include "models/profile.h"
#include "models/tube.h"

namespace serosa::models {
namespace {

constexpr double kTurn = 2 * 3.14159265358979323846;
const Point kLowest(-42, -38, -42), kHighest(42, 43, 42);

struct Apple {
    Profile profile{{{0, 14},
                     {3, 15.5},
                     {7, 21},
                     {12, 27.5},
                     {19, 31.2},
                     {28, 29},
                     {35, 21.5},
                     {38.2, 10},
                     {37.2, -4},
                     {32.5, -18},
                     {25.5, -28},
                     {18, -33.4},
                     {12.5, -34.4},
                     {8.5, -32},
                     {5, -28},
                     {0, -26.4}}};
    Tube stem{spline({{{0, 11, 0}, 2.0},
                      {{0.2, 18, 0}, 1.5},
                      {{0.9, 27, 0.4}, 1.35},
                      {{3.0, 34, 1.0}, 1.5},
                      {{4.6, 37, 1.4}, 1.9}},
                     1.0),
              Tube::End::round, Tube::End::flat, 0.0};
};

const Apple& apple() {
    static const Apple made;
    return made;
}

double body(const Point& p) {
    const double r = std::hypot(p.x, p.z), lobes = std::cos(5 * std::atan2(p.z, p.x));
    // The lobes are strongest round the basin and fade to the axis, where the angle has no meaning.
    const double strength = 0.35 + 0.65 * ramp(5, -30, p.y);
    const double width = 1 + 0.022 * strength * lobes * ramp(0, 14, r);
    const double drop = 0.9 * lobes * ramp(2, 12, r) * ramp(26, 14, r) * ramp(-18, -30, p.y);
    return apple().profile.distance(r / width, p.y + drop);
}

double calyx(const Point& p) {
    double d = capsule(p, {0, -26, 0}, {0, -30.2, 0}, 2.6, 1.6); // no gap is left between the sepals
    for (int i = 0; i < 5; ++i) {
        const double angle = kTurn * i / 5;
        const Point out(std::cos(angle), 0, std::sin(angle));
        d = blend(d, capsule(p, Point(0, -28, 0) + 1.6 * out, Point(0, -32.4, 0) + 3.4 * out, 1.0, 0.65),
                  1.0);
    }
    return d;
}

glm::u8vec3 colour(const Point& p) {
    const double r = std::hypot(p.x, p.z), angle = std::atan2(p.z, p.x);
    const double skin = body(p), fine = noise(p / 1.7), broad = layeredNoise(p / 24.0 + 3.0, 2);
    Colour c;
    if (skin < -0.6) { // cut: flesh, paler about the core, which has five cells
        const Colour flesh(246, 232, 180), core(226, 204, 138), husk(196, 158, 92);
        c = mix(flesh, core, 0.8 * (1 - ramp(8, 11, std::hypot(r, 0.7 * (p.y + 6)))));
        const double cell = std::hypot(r - 4.0, 0.45 * (p.y + 6)) - 2.6 * std::cos(2.5 * angle);
        c = mix(c, husk, 1 - ramp(-0.4, 0.5, cell));
        c = mix(Colour(240, 226, 150), c, ramp(-0.6, -1.6, skin));
    } else {
        // Streaks run along the meridians: noise on a cylinder, stretched in height.
        const Point round(14 * std::cos(angle), p.y / 16, 14 * std::sin(angle));
        const double streak = 0.6 * noise(round) + 0.4 * noise(2.3 * round + 5.0);
        const double sun = 0.5 + 0.5 * std::cos(angle - 1.0); // one cheek faces the sun
        const double blush =
            ramp(0.05, 0.75, 0.34 + 0.34 * sun + 0.30 * streak + 0.22 * broad + 0.10 * ramp(-30, 10, p.y));
        const Colour green(206, 200, 84), yellow(232, 204, 92), red(178, 26, 34), dark(128, 12, 28);
        c = mix(mix(yellow, green, 0.5 + 0.5 * broad), mix(red, dark, 0.5 + 0.5 * streak), blush);
        // Lenticels.
        const Cells dots = cells(p / 5.2, 0.9);
        c = mix(c, Colour(238, 206, 140), 0.3 * (1 - ramp(0.06, 0.18, dots.nearest)));
        // Both hollows are greener, with russet about the stem.
        c = mix(c, green, 0.75 * ramp(13, 5, r + 2 * fine));
        c = mix(c, Colour(164, 128, 66), p.y > 0 ? 0.8 * ramp(9, 3, r + 1.5 * fine) : 0.3 * ramp(8, 3, r));
    }
    const Colour wood = mix(Colour(94, 62, 34), Colour(126, 96, 52), 0.5 + 0.5 * fine);
    c = mix(c, wood, ramp(0.9, 0.1, apple().stem.distance(p)) * ramp(-0.3, 0.4, skin));
    c = mix(c, Colour(70, 50, 30) + 18.0 * fine, ramp(0.7, 0.1, calyx(p)) * ramp(-0.3, 0.4, skin));
    return toBytes(c);
}

} // namespace

double appleDistance(const Point& p, AppleKind kind) {
    const double flesh = body(p);
    double d = blend(flesh, apple().stem.distance(p), 2.0);
    if (p.y < -20)
        d = blend(d, calyx(p), 1.0);
    if (kind != AppleKind::solid)
        d = carve(d, flesh + (kind == AppleKind::thick ? kThickWall : kHollowWall), 0.0);
    return d;
}

const Solid& appleSolid(AppleKind kind) {
    static const auto make = [](AppleKind of) {
        Solid s{.name = "apple", .source = {}, .colour = colour, .fewest = 4000, .most = 600000};
        s.source.distance = [of](const Point& p) { return appleDistance(p, of); };
        s.source.lowest = kLowest;
        s.source.highest = kHighest;
        s.source.thinnest = 1.3; // tips of the calyx
        s.source.size = [](const Point& p) {
            const double small = std::min(apple().stem.distance(p), p.y < -20 ? calyx(p) : 1e9);
            return 0.45 + 0.55 * ramp(0.5, 5, small);
        };
        return s;
    };
    static const Solid solid = make(AppleKind::solid), hollow = make(AppleKind::hollow),
                       thick = make(AppleKind::thick);
    return kind == AppleKind::solid ? solid : kind == AppleKind::hollow ? hollow : thick;
}

Result<sim::TriangleMesh> makeApple(std::size_t faces) {
    return meshSolid(appleSolid(), faces);
}

} // namespace serosa::models
