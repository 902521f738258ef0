// Two lobes under one dome, hollowed from below and behind by the viscera. What hangs there (gallbladder,
// vessels of the porta) is drawn roughly and then laid onto the tissue's surface.
#include "models/liver.h"

#include "models/colour.h"
#include "models/stump.h"

namespace serosa::models {
namespace {

const Point kLowest(-106, -96, -86), kHighest(108, 92, 76);

Point slope(const Point& p) {
    constexpr double e = 0.01;
    const double d = liverTissueDistance(p);
    return Point(liverTissueDistance(p + Point(e, 0, 0)) - d, liverTissueDistance(p + Point(0, e, 0)) - d,
                 liverTissueDistance(p + Point(0, 0, e)) - d) /
           e;
}

/// `p` moved along the gradient until it is `height` outside the tissue.
Point laid(Point p, double height) {
    for (int step = 0; step < 40; ++step) {
        const Point g = slope(p);
        const double length = std::max(glm::length(g), 0.3);
        p -= std::clamp((liverTissueDistance(p) - height) / length, -4.0, 4.0) * g / length;
    }
    return p;
}

struct Parts {
    Tube gallbladder, cysticDuct, fossa;
    Stump portal, artery, bileDuct, upperCava, lowerCava;
    Point padFrom = laid({-2, -16, -19}, 0), padTo = laid({20, -12, -20}, 0); // fat at the porta
    Parts();
};

/// The gallbladder from its fundus, which looks out under the border, to its neck at the porta.
std::vector<TubePoint> gallbladderLine(double out, double grow) {
    struct Place {
        Point at;
        double radius, height;
    };
    const Place places[] = {{{-36, -57, 37}, 11.0, 3}, {{-31, -50, 27}, 14.0, 1}, {{-25, -41, 15}, 13.5, 0},
                            {{-19, -31, 3}, 10.5, 0},  {{-12, -22, -8}, 6.6, 1},  {{-6, -17, -14}, 4.2, 2}};
    std::vector<TubePoint> line;
    for (const Place& place : places)
        line.push_back({laid(place.at, place.height + out), place.radius + grow});
    return line;
}

std::vector<TubePoint> ductLine() {
    const TubePoint neck = gallbladderLine(0, 0).back();
    return {{neck.at, 3.8},
            {laid(neck.at + Point(4, 1, -4), 3), 2.7},
            {laid(neck.at + Point(9, -3, -6), 3.5), 2.6},
            {laid(neck.at + Point(14, 0, -9), 3.5), 2.5}};
}

std::vector<TubePoint> hung(const Point& root, const std::vector<Point>& offsets, double radius) {
    std::vector<TubePoint> line{{root, radius}};
    for (const Point& offset : offsets)
        line.push_back({root + offset, radius});
    return line;
}

Parts::Parts()
    : gallbladder(spline(gallbladderLine(0, 0), 1.0)), cysticDuct(spline(ductLine(), 1.0)),
      fossa(spline(gallbladderLine(9, 4), 2.0)),
      portal(hung(laid({12, -12, -24}, -6), {{2, -10, -4}, {4, -20, -6}, {5, -29, -7}}, 7.2), 1.9, 8),
      artery(hung(laid({22, -10, -18}, -5), {{2, -10, 1}, {1, -20, 1}, {0, -31, 0}}, 3.7), 1.8, 5),
      bileDuct(hung(laid({2, -13, -22}, -5), {{3, -10, -1}, {5, -21, 0}, {5, -32, 0}}, 3.9), 1.8, 5),
      upperCava({{{2, 10, -47}, 12}, {{-1, 32, -44}, 12.5}, {{-4, 54, -39}, 12.5}}, 2.0, 10),
      lowerCava({{{2, 10, -47}, 12}, {{3, -8, -50}, 12}, {{4, -20, -53}, 11.5}}, 2.0, 10) {}

const Parts& parts() {
    static const Parts made;
    return made;
}

/// Where the falciform ligament is attached: x at height y of the front.
double ligamentAt(double y) {
    return 14 - 0.10 * y + 3 * std::sin(y / 26);
}

double ligament(const Point& p, double tissue) {
    const double front = -p.z + 6 - 0.35 * p.y; // only over the front and the top
    const double band = common(std::abs(p.x - ligamentAt(p.y)) - 1.4, tissue - 2.8, 1.2);
    return common(band, front, 8);
}

double porta(const Point& p) {
    const double pad = capsule(p, parts().padFrom, parts().padTo, 8.5, 7.5);
    return 0.85 * (pad + 0.8 * noise(p / 7.0 + 60.0));
}

double cava(const Point& p) {
    return std::min(parts().upperCava.outer(p), parts().lowerCava.outer(p));
}

double hanging(const Point& p) {
    const Parts& made = parts();
    return std::min({made.portal.outer(p), made.artery.outer(p), made.bileDuct.outer(p)});
}

double lumens(const Point& p) {
    const Parts& made = parts();
    return std::min({made.portal.lumen(p), made.artery.lumen(p), made.bileDuct.lumen(p),
                     made.upperCava.lumen(p), made.lowerCava.lumen(p)});
}

double tissueWithFossa(const Point& p) {
    return carve(liverTissueDistance(p), parts().fossa.distance(p), 6);
}

double distance(const Point& p) {
    const double tissue = tissueWithFossa(p);
    double d = blend(tissue, ligament(p, tissue), 3);
    d = blend(d, cava(p), 6);
    d = blend(d, porta(p), 5);
    d = blend(d, gallbladderDistance(p), 3);
    d = blend(d, hanging(p), 3);
    return carve(d, lumens(p), 0.8);
}

glm::u8vec3 colour(const Point& p) {
    const Parts& made = parts();
    const double tissue = tissueWithFossa(p);
    const double broad = 0.5 + 0.5 * layeredNoise(p / 34.0, 3), fine = 0.5 + 0.5 * noise(p / 3.0 + 9.0);
    const double middle = 0.5 + 0.5 * noise(p / 9.0 + 30.0);
    Colour c = mix(Colour(104, 42, 34), Colour(76, 28, 27), 0.85 * broad);
    c = mix(c, Colour(122, 58, 42), 0.25 * middle);
    c *= 0.97 + 0.06 * fine;
    const auto paint = [&](double own, const Colour& a, const Colour& b, double t, double edge) {
        c = mix(c, mix(a, b, t), ramp(edge, 0.15 * edge, own));
    };
    paint(ligament(p, tissue) + 0.6 * (fine - 0.5), {206, 160, 128}, {182, 122, 96}, middle, 1.2);
    paint(cava(p), {98, 90, 130}, {84, 74, 112}, middle, 1.6);
    paint(porta(p) + fine - 0.5, {226, 192, 116}, {206, 164, 92}, fine, 1.6);
    const double bile = gallbladderDistance(p);
    paint(bile, {94, 106, 66}, {58, 74, 50}, 0.2 + 0.7 * middle, 1.2);
    paint(made.portal.outer(p), {98, 88, 132}, {86, 74, 116}, fine, 1.0);
    paint(made.artery.outer(p), {192, 54, 46}, {170, 44, 40}, fine, 0.8);
    paint(made.bileDuct.outer(p), {122, 126, 76}, {104, 108, 62}, fine, 0.8);
    c = mix(c, Colour(84, 22, 26), ramp(0.35, 0.05, lumens(p)));
    return toBytes(c);
}

} // namespace

double liverTissueDistance(const Point& p) {
    // The dome: right lobe, and the left lobe that thins towards its tip.
    constexpr double far = 60; // mm: beyond the widest blend
    const double right = ellipsoid(p - Point(-38, -3, -8), {64, 78, 64}, far);
    const double left = ellipsoid(p - Point(26, 24, 2), {48, 40, 46}, far);
    const double tip = ellipsoid(p - Point(66, 26, 6), {38, 20, 30}, far);
    double d = blend(right, blend(left, tip, 40), 40);
    // The viscera press in from below, behind and the left.
    const Point viscera = glm::normalize(Point(0.45, -0.73, -0.52));
    d = carve(d, sphere(p, Point(-8, -25, 8) + 168.0 * viscera, 168), 11);
    d = carve(d, ellipsoid(p - Point(66, -18, -28), {46, 30, 34}, far), 18);  // stomach
    d = carve(d, ellipsoid(p - Point(-52, -52, -56), {30, 42, 26}, far), 18); // right kidney
    d = carve(d, ellipsoid(p - Point(-56, -100, 30), {40, 30, 34}, far), 20); // colon
    // Caudate lobe, between cava and porta.
    d = blend(d, ellipsoid(p - Point(12, 8, -42), {14, 24, 15}, far), 10);
    // The round ligament's fissure notches the border and runs under to the porta; the falciform ligament
    // continues it upward in a faint valley.
    d = carve(d, capsule(p, {15, -44, 56}, {17, -8, -10}, 9, 4), 9);
    const double across = (p.x - ligamentAt(p.y)) / 9;
    d += 1.8 * std::exp(-across * across) * ramp(-10, 20, p.z + 0.35 * p.y);
    d += 1.1 * noise(p / 31.0 + 4.0) + 0.3 * noise(p / 11.0 + 70.0);
    return 0.92 * d;
}

double gallbladderDistance(const Point& p) {
    return blend(parts().gallbladder.distance(p), parts().cysticDuct.distance(p), 2);
}

const Solid& liverSolid() {
    static const Solid solid = [] {
        Solid s{.name = "liver", .source = {}, .colour = colour, .fewest = 8000, .most = 600000};
        s.source.distance = distance;
        s.source.lowest = kLowest;
        s.source.highest = kHighest;
        s.source.thinnest = 1.8; // walls of the stumps
        s.source.size = [](const Point& p) {
            const double small = std::min({hanging(p), porta(p), parts().cysticDuct.distance(p)});
            const double fair = std::min(parts().gallbladder.distance(p), cava(p));
            const double band = ligament(p, liverTissueDistance(p));
            return std::min({0.4 + 0.6 * ramp(0.5, 10, small), 0.6 + 0.4 * ramp(0.5, 8, fair),
                             0.5 + 0.5 * ramp(1, 6, band)});
        };
        return s;
    }();
    return solid;
}

Result<sim::TriangleMesh> makeLiver(std::size_t faces) {
    return meshSolid(liverSolid(), faces);
}

} // namespace serosa::models
