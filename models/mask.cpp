// A face from blended ellipsoids and tubes, made into a shell, cut off behind and pierced at the eyes.
#include "models/mask.h"

#include "models/colour.h"
#include "models/shaping.h"
#include "models/tube.h"

namespace serosa::models {
namespace {

/// Where the face lies in the torso: it leans back as the chest does.
const Frame& place() {
    static const Frame frame({0, 70, 54}, {0, 1, -0.16}, {0, 0, 1});
    return frame;
}
const Point kLowest(-66, -20, 10), kHighest(66, 160, 120);
constexpr double kBack = -20; // z of the rim

struct Face {
    Tube nose{spline({{{0, 24, 24}, 7}, {{0, 10, 29}, 6.5}, {{0, -4, 35}, 8}, {{0, -13, 38.5}, 9.5}}, 1.0)};
    // Of the side x >= 0.
    Tube brow{
        spline({{{5, 23, 21.8}, 4.4}, {{17, 28, 21.8}, 5.9}, {{32, 27, 15.8}, 5.4}, {{46, 17, 2}, 3}}, 1.0)};
    Tube upperLip{spline({{{-24, -42, 16.4}, 1.3},
                          {{-13, -38.5, 23.4}, 3.7},
                          {{-5, -35.8, 26.9}, 4.3},
                          {{0, -37, 26.9}, 4.3},
                          {{5, -35.8, 26.9}, 4.3},
                          {{13, -38.5, 23.4}, 3.7},
                          {{24, -42, 16.4}, 1.3}},
                         1.0)};
    Tube lowerLip{spline({{{-24, -42, 15.8}, 1.3},
                          {{-13, -45.5, 21.8}, 4.3},
                          {{0, -47.5, 24.8}, 5.7},
                          {{13, -45.5, 21.8}, 4.3},
                          {{24, -42, 15.8}, 1.3}},
                         1.0)};
    Tube slit{spline({{{-18.5, -41.8, 20.5}, 1.1},
                      {{-12, -41.5, 27.5}, 1.28},
                      {{0, -41.8, 31.5}, 1.37},
                      {{12, -41.5, 27.5}, 1.28},
                      {{18.5, -41.8, 20.5}, 1.1}},
                     1.0)};
    Outline eye{{{10.5, 5}, {15, 10}, {23, 13.2}, {31, 12.2}, {39.5, 7.2}, {33, 4}, {24.5, 2.2}, {16, 2.8}}};
};

const Face& face() {
    static const Face made;
    return made;
}

Point mirrored(const Point& p) { // without a crease in the middle
    return {std::sqrt(p.x * p.x + 4), p.y, p.z};
}

double head(const Point& q, const Point& m) {
    double d = ellipsoid(q - Point(0, 10, -30), {55, 70, 58}, 80);
    d = blend(d, ellipsoid(q - Point(0, -48, -12), {32, 32, 34}, 80), 34); // jaw and chin
    d = blend(d, ellipsoid(q - Point(0, -60, 14), {13, 10, 9}, 40), 14);
    d = blend(d, ellipsoid(m - Point(33, -12, 6), {17, 14, 14}, 40), 18); // cheek
    d = carve(d, ellipsoid(m - Point(25, 8, 32), {19, 11.5, 15}, 40), 12);
    return d;
}

double skin(const Point& q) {
    const Face& f = face();
    const Point m = mirrored(q);
    double d = head(q, m);
    d = blend(d, f.brow.distance(m), 9);
    double nose = f.nose.distance(q);
    nose = blend(nose, ellipsoid(m - Point(9.5, -14.5, 29), {6.2, 5.6, 8}, 30), 5);
    nose = carve(nose, ellipsoid(m - Point(6.5, -21.5, 32), {3, 3.6, 5}, 20), 2);
    d = blend(d, nose, 9);
    d = carve(d, capsule(q, {0, -23, 33}, {0, -32, 33.5}, 2.2, 2.8), 4); // under the nose
    d = blend(d, blend(f.upperLip.distance(q), f.lowerLip.distance(q), 1), 4);
    return carve(d, f.slit.distance(q), 3);
}

double eyeHole(const Point& m) {
    return face().eye.distance({m.x, m.y});
}

double shell(const Point& p) {
    const Point q = place().local(p), m = mirrored(q);
    // The inside is that of a plain head, so that the wall is thicker under nose, brows and lips only.
    double d = carve(skin(q), head(q, m) + kMaskWall, 1.5);
    d = common(d, kBack - q.z, 2.5);
    return carve(d, eyeHole(m), 2);
}

glm::u8vec3 colour(const Point& p) {
    const Point q = place().local(p), m = mirrored(q);
    const double fine = noise(p / 2.5), broad = layeredNoise(p / 18.0, 2);
    const Colour gold(188, 132, 44), pale(208, 160, 76), dark(92, 54, 22), red(132, 30, 28);
    Colour c = mix(gold, pale, 0.4 + 0.4 * broad);
    if (skin(q) < -1.2) // behind
        return toBytes(mix(dark, gold, 0.25) + 4.0 * fine);
    c = mix(c, dark, 0.75 * ramp(3.4, 1.0, std::abs(eyeHole(m))) * ramp(-5, 5, q.z));
    c = mix(c, dark, 0.7 * ramp(1.5, -1.5, face().brow.distance(m) - 0.5));
    const double lips = std::min(face().upperLip.distance(q), face().lowerLip.distance(q));
    c = mix(c, red, 0.85 * ramp(0.9, -0.1, lips));
    const double gap = std::hypot(std::max(0.0, std::abs(q.x) - 15), q.y + 41.8); // between the lips
    c = mix(c, red, ramp(4, 2.5, gap) * ramp(12, 18, q.z));
    c = mix(c, mix(red, dark, 0.5), 0.8 * ramp(2.2, 0.6, face().slit.distance(q)));
    return toBytes(c + 3.0 * fine);
}

double wantedSize(const Point& p) {
    const Point q = place().local(p), m = mirrored(q);
    const double lips = std::min(face().upperLip.distance(q), face().lowerLip.distance(q));
    const double fine = std::min({std::abs(eyeHole(m)), lips, face().nose.distance(q)});
    if (q.z < -15)
        return 1;
    return std::min(0.6 + 0.6 * ramp(1, 14, fine), 0.4 + 0.6 * ramp(1, 8, face().slit.distance(q)));
}

} // namespace

double maskDistance(const Point& p) {
    return shell(p);
}

const Solid& maskSolid() {
    static const Solid made = [] {
        Solid s{.name = "mask", .source = {}, .colour = colour, .fewest = 4000, .most = 400000};
        s.source.distance = shell;
        s.source.lowest = kLowest;
        s.source.highest = kHighest;
        s.source.thinnest = 3.4;
        s.source.size = wantedSize;
        return s;
    }();
    return made;
}

Result<sim::TriangleMesh> makeMask(std::size_t faces) {
    return meshSolid(maskSolid(), faces);
}

} // namespace serosa::models
