// An ellipsoid bent about the hilum, which a vertical slit opens; fat, vessels and the pelvis fill it.
#include "models/kidney.h"

#include "models/colour.h"
#include "models/stump.h"

namespace serosa::models {
namespace {

const Point kLowest(-38, -60, -28), kHighest(62, 60, 28);

struct Kidney {
    // From front to back, as a surgeon meets them: vein, artery, pelvis with the ureter going down.
    Stump vein{{{{16, 1, 3}, 6.0}, {{27, 1, 8}, 6.4}, {{38, 4, 10}, 6.2}, {{48, 7, 9.5}, 6.2}}, 1.1, 7};
    Stump artery{{{{16, 7, -1}, 3.6}, {{28, 10, -2}, 3.6}, {{39, 13, -2}, 3.5}, {{51, 15, -3}, 3.5}}, 1.2, 6};
    Stump ureter{{{{14, -2, -4}, 8.0},
                  {{25, -4, -6}, 8.6},
                  {{34, -9, -7}, 6.6},
                  {{39, -18, -7}, 4.2},
                  {{40, -30, -5.5}, 3.1},
                  {{39, -42, -4}, 2.9},
                  {{38.5, -50, -3.5}, 2.9}},
                 1.1,
                 6};
    Tube tributary{spline({{{14, -12, 4}, 4.2}, {{25, -7, 8}, 4.4}, {{35, 1, 10}, 4.8}}, 2.0)};
    Tube segmental{spline({{{14, 18, -1}, 2.6}, {{25, 16, 0}, 2.7}, {{36, 12.6, -1.6}, 2.9}}, 2.0)};
};

const Kidney& kidney() {
    static const Kidney made;
    return made;
}

double fat(const Point& p) {
    const double lump = 0.9 * noise(p / 6.0 + 40.0);
    return 0.9 * (ellipsoid(p - Point(19, 0, -0.5), {13, 20, 12}) + lump);
}

double vessels(const Point& p) {
    const Kidney& k = kidney();
    const double vein = blend(k.vein.outer(p), k.tributary.distance(p), 4);
    const double artery = blend(k.artery.outer(p), k.segmental.distance(p), 3);
    return std::min({vein, artery, k.ureter.outer(p)});
}

double lumens(const Point& p) {
    const Kidney& k = kidney();
    return std::min({k.vein.lumen(p), k.artery.lumen(p), k.ureter.lumen(p)});
}

double distance(const Point& p) {
    double d = blend(kidneyBodyDistance(p), fat(p), 3);
    d = blend(d, vessels(p), 2.5);
    return carve(d, lumens(p), 0.8);
}

/// A cut through the kidney: cortex, pyramids that point at the sinus with columns between them.
Colour inside(const Point& p, double depth) {
    const Colour cortex(158, 84, 64), pyramid(112, 40, 38), column(170, 100, 76);
    const double angle = std::atan2(p.y, 21 - p.x), turn = std::atan2(p.z, std::hypot(p.y, 21 - p.x));
    const double rays = std::cos(7 * angle) + 0.6 * std::cos(5 * turn) + 0.3 * noise(p / 5.0);
    const Colour medulla = mix(column, pyramid, ramp(-0.35, 0.1, rays));
    return mix(cortex, medulla, ramp(6.5, 8.0, depth + 0.8 * noise(p / 4.0)));
}

glm::u8vec3 colour(const Point& p) {
    const Kidney& k = kidney();
    const double body = kidneyBodyDistance(p), lump = fat(p);
    const double vein = blend(k.vein.outer(p), k.tributary.distance(p), 4);
    const double artery = blend(k.artery.outer(p), k.segmental.distance(p), 3);
    const double ureter = k.ureter.outer(p);
    const double broad = 0.5 + 0.5 * layeredNoise(p / 19.0, 3), fine = 0.5 + 0.5 * noise(p / 3.5 + 9.0);

    Colour c;
    if (body < -1) {
        c = inside(p, -body);
    } else {
        const Colour capsule(120, 50, 40), dark(88, 32, 30);
        c = mix(capsule, dark, 0.85 * broad);
        // Stellate veins under the capsule.
        const Point warped =
            p / 11.0 + 0.25 * Point(noise(p / 6.0), noise(p / 6.0 + 20.0), noise(p / 6.0 + 50.0));
        const Cells net = cells(warped, 0.8);
        c = mix(c, Colour(86, 30, 36), 0.32 * (1 - ramp(0.02, 0.16, net.second - net.nearest)));
        c *= 0.96 + 0.08 * fine;
    }
    const Colour yellow = mix(Colour(228, 192, 112), Colour(208, 164, 88), fine);
    c = mix(c, yellow,
            ramp(1.6, -0.4, lump - std::min(body, 0.0) + 1.2 * (fine - 0.5)) * ramp(-2.5, 0.0, body));
    const auto paint = [&](double own, const Colour& a) {
        c = mix(c, mix(a, 0.86 * a, fine), ramp(1.1, 0.2, own));
    };
    paint(ureter, Colour(222, 186, 148));
    paint(artery, Colour(188, 52, 46));
    paint(vein, Colour(92, 84, 128));
    c = mix(c, Colour(92, 22, 26), ramp(0.35, 0.05, lumens(p)));
    return toBytes(c);
}

} // namespace

double kidneyBodyDistance(const Point& p) {
    // The middle line bends towards the hilum, quadratically up to the poles and straight beyond.
    constexpr double bend = 20.0, half = 53.0;
    const double y = std::clamp(p.y, -half, half);
    const double slope = 2 * bend * y / (half * half);
    const double middle = bend * y * y / (half * half) + slope * (p.y - y);
    // The upper pole is broader and leans forward less.
    const double width = 1 + 0.06 * p.y / half * ramp(90, 60, std::abs(p.y));
    const Point straight((p.x - middle + 5.5) / width, p.y, (p.z - 0.02 * p.y) / width);
    double d = ellipsoid(straight, {27, half - 1, 21.5});
    for (const double pole : {-29.5, 29.5}) // both poles are fuller than an ellipsoid's
        d = blend(d, ellipsoid(straight - Point(-1, pole, 0), {24.5, 23, 19.5}), 10);
    d /= std::sqrt(1 + 1.2 * slope * slope);
    // Faint lobes remain from before birth.
    d += 0.7 * noise(p / 17.0 + 2.0) + 0.25 * noise(p / 7.0 + 80.0);
    const double slit = ellipsoid(p - Point(30, 0, -0.5), {20, 19, 9});
    return 0.86 * carve(d, slit, 11);
}

const Solid& kidneySolid() {
    static const Solid solid = [] {
        Solid s{.name = "kidney", .source = {}, .colour = colour, .fewest = 6000, .most = 600000};
        s.source.distance = distance;
        s.source.lowest = kLowest;
        s.source.highest = kHighest;
        s.source.thinnest = 1.1; // walls of the stumps
        s.source.size = [](const Point& p) { return 0.5 + 0.5 * ramp(0.5, 6, std::min(vessels(p), fat(p))); };
        return s;
    }();
    return solid;
}

Result<sim::TriangleMesh> makeKidney(std::size_t faces) {
    return meshSolid(kidneySolid(), faces);
}

} // namespace serosa::models
