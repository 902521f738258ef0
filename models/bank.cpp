// A round body that runs into the head, hollowed to an even wall; snout, ears, legs and tail are put on
// solid.
#include "models/bank.h"

#include "models/colour.h"
#include "models/shaping.h"
#include "models/tube.h"

namespace serosa::models {
namespace {

constexpr double kTurn = 2 * 3.14159265358979323846;
const Point kLowest(-98, -70, -58), kHighest(102, 78, 58);

double body(const Point& p) {
    const double trunk = ellipsoid(p - Point(8, -2, 0), {66, 53, 53}, 60);
    const double head = ellipsoid(p - Point(-44, 8, 0), {38, 39, 40}, 60);
    return blend(trunk, head, 30);
}

/// What is put onto the body. The two sides are mirror images: `mirrored` is at z >= 0.
struct Pig {
    Tube tail, mouth;
    Point eye;
    Frame ear{{-36, 40, 25}, {-0.22, 1, 0.5}, {-1, -0.35, 0.42}};
    Pig();
};

std::vector<TubePoint> curl() {
    std::vector<TubePoint> out{{{66, 12, 0}, 4.6}, {{73, 14, 0}, 4.2}};
    for (int i = 0; i <= 26; ++i) {
        const double t = i / 26.0, angle = kTurn * (1.55 * t - 0.25);
        const double ring = 9.5 - 2.5 * t;
        out.push_back(
            {{78 + 17.5 * t, 23.5 + ring * std::sin(angle), ring * std::cos(angle)}, 3.9 - 1.3 * t});
    }
    return out;
}

std::vector<TubePoint> smile() {
    std::vector<TubePoint> out;
    for (int i = -12; i <= 12; ++i) {
        const double z = i * 1.75;
        out.push_back({onto(body, {-78, -15 + 0.021 * z * z, z}), 1.5 - 0.0013 * z * z});
    }
    return out;
}

Pig::Pig() : tail(spline(curl(), 1.0)), mouth(smile()), eye(onto(body, {-74, 25, 18})) {}

const Pig& pig() {
    static const Pig made;
    return made;
}

Point mirrored(const Point& p) {
    return {p.x, p.y, std::abs(p.z)};
}

double snout(const Point& p) {
    const Point q(p.x, (p.y - 4) / 0.9, p.z); // a little wider than high
    const double radius = std::hypot(q.y, q.z), flare = 17.5 + 2.2 * ramp(-78, -92, p.x);
    double d = common(0.9 * (radius - flare), std::abs(p.x + 78) - 15, 7);
    const Point nostril = mirrored(p) - Point(-94, 4.5, 6.6);
    d = carve(d, ellipsoid(nostril, {5.5, 4.8, 3.1}), 1.6);
    return d;
}

/// A pointed leaf: two spheres give the outline, a dish of even thickness the leaf.
double ear(const Point& m) {
    const Point q = pig().ear.local(m);
    const Point outline(std::abs(q.x), q.y, 0);
    const double leaf = glm::length(outline - Point(-24, 9, 0)) - 43;
    const double bowl = glm::length(q - Point(0, 12, 34)) - 37;
    return common(common(leaf, std::abs(bowl) - 3.0, 3.5), q.z - 18, 0); // without the dish's far side
}

double earHollow(const Point& m) { // on the side that the dish opens to
    const Point q = pig().ear.local(m);
    return glm::length(q - Point(0, 12, 34)) - 37;
}

double legs(const Point& m) {
    double d = 1e9;
    for (const double x : {-30.0, 42.0}) {
        const double out = x < 0 ? -3 : 3;
        double leg = capsule(m, {x, -28, 23}, {x + out, -62, 28}, 17, 12.5);
        leg = common(leg, -66 - m.y, 4);
        const Point q = m - Point(x + out - 14.0, -67, 28); // the cleft of the hoof
        leg = carve(leg, ellipsoid(q, {6, 12, 2.2}), 1.5);
        d = std::min(d, leg);
    }
    return d;
}

double eye(const Point& m) {
    const Frame f(pig().eye, {0, 1, 0}, gradient(body, pig().eye));
    return ellipsoid(f.local(m), {5.0, 6.6, 3.2});
}

double slot(const Point& p) {
    return box(p, {12, 52, 0}, {19, 14, 2.1}, 2.0);
}

double outside(const Point& p) {
    const Point m = mirrored(p);
    double d = blend(body(p), legs(m), 9);
    if (p.x < 0) {
        d = blend(d, snout(p), 6);
        d = blend(d, ear(m), 6);
        d = carve(d, pig().mouth.distance(p), 1.6);
        d = blend(d, eye(m), 0.8);
    } else {
        d = blend(d, pig().tail.distance(p), 4);
    }
    return d;
}

glm::u8vec3 colour(const Point& p) {
    const Point m = mirrored(p);
    const double skin = outside(p);
    const double fine = noise(p / 2.1), broad = layeredNoise(p / 30.0, 2);
    const Colour clay(214, 176, 148), rose(238, 152, 164), pale(246, 184, 188), deep(222, 112, 132);
    if (skin < -0.7) // the bare earthenware of the inside and of cuts
        return toBytes(clay + 5.0 * fine + 8.0 * broad);
    Colour c = mix(rose, pale, 0.5 + 0.5 * broad);
    c = mix(c, pale, 0.5 * ramp(-10, -50, p.y));
    c = mix(c, deep, 0.5 * ramp(22, 6, glm::length(m - Point(-68, -2, 34)))); // cheeks
    if (p.x < 0) {
        c = mix(c, mix(rose, deep, 0.45), ramp(2.0, -1.0, snout(p)) * ramp(-80, -84, p.x));
        c = mix(c, Colour(150, 62, 80), ramp(1.0, -0.6, ellipsoid(m - Point(-94, 4.5, 6.6), {6, 5, 3.3})));
        c = mix(c, deep,
                0.85 * ramp(1.5, -0.5, ear(m)) * ramp(0.5, -2.0, earHollow(m)) *
                    ramp(2, 9, pig().ear.local(m).y));
        c = mix(c, Colour(150, 60, 80), ramp(1.0, -0.4, pig().mouth.distance(p)));
        const double black = eye(m);
        c = mix(c, Colour(28, 22, 26), ramp(0.5, 0.1, black));
        const Point glint = pig().eye + Point(-2.6, 2.6, -1.2);
        c = mix(c, Colour(250), ramp(0.4, 0.1, black) * ramp(2.1, 1.6, glm::length(m - glint)));
    }
    c = mix(c, Colour(176, 92, 104), 0.9 * ramp(-56.5, -57.5, p.y)); // hooves
    c = mix(c, clay, 0.8 * ramp(-65.2, -65.9, p.y));                 // unglazed underneath
    return toBytes(c);
}

double wantedSize(const Point& p) {
    const Point m = mirrored(p);
    double fine = std::abs(slot(p));
    if (p.x < 0)
        fine = std::min({fine, std::abs(eye(m)), std::abs(pig().mouth.distance(p)),
                         std::abs(ellipsoid(m - Point(-94, 4.5, 6.6), {5.5, 4.8, 3.1})), ear(m)});
    else
        fine = std::min(fine, pig().tail.distance(p));
    return (0.5 + 0.5 * ramp(1, 7, fine)) * (1 + 0.5 * ramp(0.5, -1, bankCavityDistance(p) - 0.5));
}

} // namespace

double bankCavityDistance(const Point& p) {
    return body(p) + kBankWall;
}

double bankDistance(const Point& p) {
    return carve(carve(outside(p), bankCavityDistance(p), 0), slot(p), 1.2);
}

const Solid& bankSolid() {
    static const Solid solid = [] {
        Solid s{.name = "bank", .source = {}, .colour = colour, .fewest = 12000, .most = 600000};
        s.source.distance = bankDistance;
        s.source.lowest = kLowest;
        s.source.highest = kHighest;
        s.source.thinnest = 3.2; // half of it where the slot's rims are rounded
        s.source.size = wantedSize;
        return s;
    }();
    return solid;
}

Result<sim::TriangleMesh> makeBank(std::size_t faces) {
    return meshSolid(bankSolid(), faces);
}

} // namespace serosa::models
