// A loft for the trunk; shoulders, arms, neck and the large muscles are blended onto it; what lies closer
// under the skin (collar bones, ribs, belly muscles) and the navel are low relief.
#include "models/torso.h"

#include "models/colour.h"
#include "models/loft.h"
#include "models/shaping.h"
#include "models/tube.h"

namespace serosa::models {
namespace {

const Point kLowest(-262, -306, -150), kHighest(262, 304, 170);
constexpr double kHips = -300, kNeck = 292; // y of the flat ends

struct Torso {
    // Axis along y: a section's x is the torso's x, its y the torso's z.
    Loft trunk{{{-330, {0, -6}, {172, 112}, 2.3},
                {-270, {0, -6}, {169, 108}, 2.3},
                {-200, {0, -3}, {153, 99}, 2.25},
                {-130, {0, 0}, {138, 94}, 2.2},
                {-70, {0, 1}, {139, 98}, 2.2},
                {-10, {0, 2}, {149, 107}, 2.2},
                {50, {0, 1}, {160, 112}, 2.25},
                {100, {0, -4}, {165, 110}, 2.25},
                {145, {0, -12}, {156, 98}, 2.2},
                {180, {0, -20}, {132, 82}, 2.1},
                {208, {0, -26}, {92, 66}, 2}},
               30,
               24};
    PlaneCurve collar{{{14, 196}, {40, 203}, {72, 207}, {105, 214}, {135, 222}, {160, 218}}, 2.0};
    PlaneCurve arch{{{6, 18}, {26, 6}, {52, -20}, {78, -54}, {104, -84}, {128, -98}}, 2.0};
    PlaneCurve groin{{{158, -190}, {132, -218}, {100, -248}, {66, -280}, {40, -310}}, 2.0};
    PlaneCurve flank{{{76, -30}, {74, -70}, {70, -120}, {66, -170}, {58, -225}, {44, -275}}, 2.0};
    PlaneCurve neckMuscle{{{16, 206}, {25, 228}, {38, 255}, {52, 296}}, 2.0};
};

const Torso& torso() {
    static const Torso made;
    return made;
}

/// To the side of x >= 0, without a crease in the middle.
Point mirrored(const Point& p) {
    return {std::sqrt(p.x * p.x + 25), p.y, p.z};
}

double turnedEllipsoid(const Point& p, const Frame& frame, const Point& semi) {
    return ellipsoid(frame.local(p), semi, 150);
}

double arm(const Point& m) {
    static const Point shoulder(168, 168, -20), cut(226, 44, -14);
    static const Point along = glm::normalize(cut - shoulder);
    double d = capsule(m, shoulder, cut + 40.0 * along, 50, 41);
    static const Frame deltoid({184, 158, -18}, -along, {0, 0, 1});
    d = blend(d, turnedEllipsoid(m, deltoid, {49, 76, 53}), 20);
    static const Frame biceps({209, 66, 4}, -along, {0, 0, 1});
    d = blend(d, turnedEllipsoid(m, biceps, {34, 70, 40}), 20);
    return common(d, halfSpace(m, cut, along), 4);
}

double bodyOf(const Point& p, const Point& m) {
    double d = torso().trunk.distance({p.x, p.z, p.y});
    // Neck and the slope from it to the shoulders.
    d = blend(d, capsule(p, {0, 170, -30}, {0, 320, 0}, 64, 58), 26);
    d = blend(d, capsule(m, {10, 232, -42}, {158, 184, -26}, 40, 34), 30);
    d = blend(d, arm(m), 32);
    // Chest, shoulder blades, the broad back muscle, buttocks.
    static const Frame chest({80, 92, 74}, {-0.34, 1, 0}, {0.30, 0.04, 1});
    d = blend(d, turnedEllipsoid(m, chest, {88, 62, 37}), 24);
    static const Frame blade({88, 108, -88}, {0.2, 1, 0.2}, {0.2, 0, -1});
    d = blend(d, turnedEllipsoid(m, blade, {54, 80, 26}), 34);
    static const Frame latissimus({142, 40, -34}, {0.22, 1, -0.05}, {0, 0, 1});
    d = blend(d, turnedEllipsoid(m, latissimus, {30, 110, 62}), 34);
    static const Frame column({34, -60, -88}, {0, 1, 0.04}, {0, 0, -1});
    d = blend(d, turnedEllipsoid(m, column, {26, 170, 20}), 26);
    static const Frame buttock({78, -318, -70}, {0, 1, 0}, {0, 0, -1});
    return blend(d, turnedEllipsoid(m, buttock, {76, 90, 66}), 36);
}

/// Bumps (negative) and hollows (positive) in mm.
double relief(const Point& m) {
    const Torso& t = torso();
    const glm::dvec2 front(m.x, m.y);
    double r = 0;
    const double forward = ramp(-10, 30, m.z);
    if (m.y > 150) {
        const auto bone = t.collar.foot(front);
        const double on = ramp(0, 0.12, bone.along) * ramp(1, 0.6, bone.along) * ramp(-45, -15, m.z);
        r -= 5.5 * bell(bone.distance / 16) * on;
        r += 5 * bell(glm::length(front - glm::dvec2(72, 232)) / 30) * ramp(-30, 0, m.z); // above it
        r += 3 * bell(glm::length(front - glm::dvec2(108, 188)) / 34) * forward;          // below it
        r += 8 * bell(glm::length(front - glm::dvec2(2, 206)) / 20) * forward;            // throat's pit
        const auto muscle = t.neckMuscle.foot(front);
        r -= 4.5 * bell(muscle.distance / 15) * forward * ramp(0, 0.15, muscle.along);
        r -= 5 * bell(std::hypot(m.x, 0.55 * (m.y - 268)) / 16) * forward; // larynx
    }
    if (m.z > 0) {
        // Breast bone, arch of the ribs, the straight belly muscle with its bands.
        r += 2.5 * bell(m.x / 20) * ramp(185, 150, m.y) * ramp(5, 40, m.y) * forward;
        const auto rib = t.arch.foot(front);
        const double side = m.y - (20 - 1.05 * m.x); // above the arch: > 0
        r += 3.2 * bell(rib.distance / 26) * ramp(0, 0.12, rib.along) * ramp(1, 0.7, rib.along) *
             ramp(14, -10, side) * forward;
        const double belly = ramp(25, -5, m.y) * ramp(-300, -230, m.y) * forward;
        r += 2.2 * bell(m.x / 16) * belly * ramp(-260, -150, m.y);
        const auto edge = t.flank.foot(front);
        r += 2.4 * bell(edge.distance / 28) * ramp(0, 0.15, edge.along) * ramp(1, 0.75, edge.along) * forward;
        for (const double y : {-28.0, -78.0, -127.0})
            r += 1.6 * bell((m.y - y - 0.1 * m.x) / 15) * ramp(70, 45, m.x) * ramp(2, 16, m.x) * belly;
        const auto line = t.groin.foot(front);
        r += 3.5 * bell(line.distance / 28) * ramp(0, 0.25, line.along) * forward;
        // Saw-toothed muscle and ribs at the side.
        for (int i = 0; i < 4; ++i) {
            const glm::dvec2 at(142 - 5.0 * i, 18 - 33.0 * i), q = front - at;
            const glm::dvec2 turned(0.82 * q.x + 0.57 * q.y, -0.57 * q.x + 0.82 * q.y);
            r -= 2.2 * bell(glm::length(turned / glm::dvec2(38, 17))) * ramp(0, 25, m.z);
        }
        // Navel: a pit with a soft rim, and a nipple.
        const glm::dvec2 navel(m.x - 5, m.y + 162); // m.x is 5 in the middle
        const double round = std::hypot(navel.x, 0.8 * navel.y);
        r += 7.5 * bell(round / 13) + 2.5 * bell(round / 26) - 1.2 * bell((round - 15) / 8);
        const double tip = glm::length(front - glm::dvec2(104, 64));
        r -= forward * (2.6 * bell(tip / 7.5) + 1.4 * bell(tip / 17));
    } else {
        r += 6 * bell(m.x / 36) * ramp(-270, -190, m.y) * ramp(215, 150, m.y) * ramp(-10, -50, m.z);
        const glm::dvec2 dimple(m.x - 42, m.y + 232);
        r += 3 * bell(glm::length(dimple) / 20) * ramp(-10, -50, m.z);
        r += 12 * bell(m.x / 26) * ramp(-240, -300, m.y) * ramp(-40, -80, m.z); // cleft
    }
    return r;
}

double solid(const Point& p) {
    const Point m = mirrored(p);
    double d = bodyOf(p, m);
    if (std::abs(d) < 40)
        d += relief(m) * ramp(40, 10, std::abs(d));
    return common(d, std::max(kHips - p.y, p.y - kNeck), 4);
}

/// On one of the four flat ends.
bool onCut(const Point& p) {
    static const Point cut(226, 44, -14), along = glm::normalize(cut - Point(168, 168, -20));
    return p.y < kHips + 0.8 || p.y > kNeck - 0.8 ||
           (std::abs(p.x) > 180 && halfSpace(mirrored(p), cut, along) > -0.8);
}

glm::u8vec3 colour(const Point& p) {
    const Point m = mirrored(p);
    const double fine = noise(p / 9.0), broad = layeredNoise(p / 60.0 + 2.0, 2);
    const double depth = -bodyOf(p, m);
    if (onCut(p) || solid(p) < -3) { // skin, fat, flesh, bone
        Colour c = mix(Colour(222, 168, 142), Colour(236, 206, 140), ramp(2, 3.5, depth));
        c = mix(c, Colour(150, 46, 42) + 10.0 * fine, ramp(8, 11, depth + 2 * fine));
        double bone = std::hypot(p.x, 0.9 * (p.z + (p.y > 200 ? 14 : 62))) - (p.y > 200 ? 15 : 27);
        if (m.x > 170)
            bone = 44 - depth - 12; // in the middle of the arm
        c = mix(c, Colour(236, 224, 196), ramp(1.5, -1, bone));
        return toBytes(c);
    }
    const Colour skin(200, 142, 112), red(182, 94, 76), shade(150, 88, 66);
    Colour c = mix(skin, red, 0.12 + 0.14 * broad);
    const double hollow = relief(m);
    c = mix(c, shade, 0.30 * ramp(1, 7, hollow));
    c = mix(c, red, 0.15 * ramp(-1, -5, hollow));
    if (p.z > 0) {
        const double tip = glm::length(glm::dvec2(m.x - 104, m.y - 64));
        c = mix(c, Colour(164, 92, 78), 0.8 * ramp(16, 12, tip + 1.5 * fine));
        c = mix(c, Colour(140, 76, 66), 0.8 * ramp(7, 4, tip));
        c = mix(c, Colour(150, 88, 70), 0.8 * ramp(10, 4, std::hypot(p.x, 0.8 * (p.y + 162))));
    }
    return toBytes(c + 2.5 * fine);
}

double wantedSize(const Point& p) {
    if (p.z < 0)
        return onCut(p) ? 1.3 : 1.1;
    const Point m = mirrored(p);
    const double navel = std::hypot(p.x, p.y + 162), tip = std::hypot(m.x - 104, m.y - 64);
    const double collar = torso().collar.foot({m.x, m.y}).distance;
    double size = 0.9;
    size = std::min(size, 0.45 + 0.45 * ramp(12, 40, navel));
    size = std::min(size, 0.5 + 0.4 * ramp(12, 35, tip));
    return std::min(size, 0.7 + 0.2 * ramp(10, 30, collar));
}

} // namespace

double torsoDistance(const Point& p) {
    return solid(p);
}

const Solid& torsoSolid() {
    static const Solid made = [] {
        Solid s{.name = "torso", .source = {}, .colour = colour, .fewest = 4000, .most = 600000};
        s.source.distance = solid;
        s.source.lowest = kLowest;
        s.source.highest = kHighest;
        s.source.thinnest = 12; // between arm and chest
        s.source.size = wantedSize;
        return s;
    }();
    return made;
}

Result<sim::TriangleMesh> makeTorso(std::size_t faces) {
    return meshSolid(torsoSolid(), faces);
}

} // namespace serosa::models
