// Bones are drawn as chains of joints; tubes and pads about them are blended into one skin. Creases,
// knuckles, tendons and nails are low relief.
#include "models/hand.h"

#include "models/colour.h"
#include "models/shaping.h"
#include "models/tube.h"

namespace serosa::models {
namespace {

const Point kLowest(-66, -106, -36), kHighest(92, 106, 42);
constexpr double kCut = -102; // y of the wrist's flat end

/// A finger: joints from the knuckle (or, for the thumb, the wrist) to the middle of the tip's ball.
struct Finger {
    Point joint[4];
    double radius[4];
    Point palmar; // where its palm side looks
    Frame last;   // of the last bone: origin at its joint, y along it, z to the palm side
    Tube flesh;

    Finger(const Point& a, const Point& b, const Point& c, const Point& d, double ra, double rb, double rc,
           double rd, const Point& palm)
        : joint{a, b, c, d}, radius{ra, rb, rc, rd}, palmar(glm::normalize(palm)), last(c, d - c, palm),
          flesh(skin()) {}

    double length() const { return glm::length(joint[3] - joint[2]); }
    double at(int i, const Point& p) const { // along bone i from its first joint, in bone lengths
        const Point bone = joint[i + 1] - joint[i];
        return glm::dot(p - joint[i], bone) / glm::dot(bone, bone);
    }
    double flex(const Point& p) const { return glm::dot(p - joint[1], palmar); }

    /// Cylinder of the bones, a little thicker at the joints, with soft pads on the palm side.
    double distance(const Point& p) const {
        double d = flesh.distance(p);
        if (d > 24) // farther than any blend looks
            return d;
        for (int i = 0; i < 3; ++i) {
            const Frame bone(0.5 * (joint[i] + joint[i + 1]), joint[i + 1] - joint[i], palmar);
            const double half = 0.5 * glm::length(joint[i + 1] - joint[i]);
            const double r = 0.5 * (radius[i] + radius[i + 1]);
            const double up = i == 2 ? 0.12 * half : 0;
            const Point q = bone.local(p) - Point(0, up, 0.26 * r);
            d = blend(d, ellipsoid(q, {0.86 * r, 0.92 * half, 0.86 * r}, 20), 4.5);
        }
        return d;
    }

private:
    std::vector<TubePoint> skin() const {
        std::vector<TubePoint> control;
        for (int i = 0; i < 3; ++i) {
            control.push_back({joint[i], radius[i]});
            const double waist = 0.5 * (radius[i] + radius[i + 1]) * 0.965;
            control.push_back({0.5 * (joint[i] + joint[i + 1]), waist});
        }
        control.push_back({joint[3], radius[3]});
        return spline(control, 1.0);
    }
};

struct Hand {
    Finger fingers[5] = {
        {{24, 2, -3}, {36, 42.5, 1}, {41, 66, 5.5}, {43.5, 83.5, 10.5}, 11.5, 9.6, 8.4, 7.2, {0.1, 0.16, 1}},
        {{5, 6, -4}, {7.5, 51, -0.5}, {8.2, 78.5, 3.5}, {8.4, 94.5, 7.8}, 11.5, 9.8, 8.6, 7.4, {0, 0.16, 1}},
        {{-13, 2, -3.5}, {-21, 44, 0.5}, {-25, 70, 5}, {-27, 86, 9.8}, 11, 9.3, 8.2, 7.1, {-0.06, 0.18, 1}},
        {{-29, -8, -1.5},
         {-43.5, 23, 2.5},
         {-50, 41, 6.5},
         {-54, 55, 11},
         10,
         8.2,
         7.1,
         6.2,
         {-0.1, 0.24, 1}},
        {{24, -74, 6},
         {47, -38, 14},
         {62, -10, 15},
         {70.5, 11, 14},
         15,
         11.6,
         10.2,
         8.2,
         {-0.62, 0.34, 0.72}},
    };
    PlaneCurve heart{{{-40, -16}, {-28, -14.5}, {-12, -9}, {2, -1.5}, {13, 8}, {17, 13}}};
    PlaneCurve head{{{38, -20}, {27, -21}, {12, -26}, {-6, -33}, {-22, -43}}};
    PlaneCurve life{{{37.5, -19.5}, {27, -24}, {15, -36}, {8, -52}, {6, -68}, {9, -82}}};
    PlaneCurve fate{{{1, -74}, {2, -54}, {1, -36}}};
    PlaneCurve wrist{{{-26, -89}, {-8, -86.5}, {8, -86.5}, {27, -88.5}}};
    Outline nail{{{-4.4, 2.2},
                  {-5.5, 6},
                  {-5.5, 10},
                  {-4.6, 13},
                  {-2.6, 14.6},
                  {0, 15},
                  {2.6, 14.6},
                  {4.6, 13},
                  {5.5, 10},
                  {5.5, 6},
                  {4.4, 2.2},
                  {0, 0}},
                 0.6};
};

const Hand& hand() {
    static const Hand made;
    return made;
}

double palm(const Point& p) {
    // Metacarpal slab: the knuckles' row, the middle, the wrist.
    double d = 1e9;
    const Point base[4] = {{14, -76, -3}, {4, -78, -4}, {-7, -77, -3.5}, {-17, -74, -1.5}};
    for (int i = 0; i < 4; ++i) {
        const Finger& f = hand().fingers[i];
        d = i == 0 ? capsule(p, base[i], f.joint[0], 15, f.radius[0] + 0.8)
                   : blend(d, capsule(p, base[i], f.joint[0], 15, f.radius[0] + 0.8), 9);
    }
    const Point forearm = p - Point(0, -98, -3);
    const double wrist =
        ellipsoid(Point(forearm.x, 0.5 * std::max(0.0, forearm.y), forearm.z), {28, 24, 19.5}, 28);
    d = blend(d, wrist, 14);
    // Balls of the thumb and of the little finger, pads before the knuckles.
    const Frame thenar({25, -53, 11}, {0.55, 1, 0.12}, {0.1, 0, 1});
    d = blend(d, ellipsoid(thenar.local(p), {15.5, 31, 14.5}, 26), 12);
    const Frame hypothenar({-24, -54, 6}, {-0.28, 1, 0}, {0, 0, 1});
    d = blend(d, ellipsoid(hypothenar.local(p), {13.5, 32, 13.5}, 26), 12);
    d = blend(d, ellipsoid(p - Point(17, 3, 5), {12, 10, 9}, 26), 9);
    d = blend(d, ellipsoid(p - Point(-4, 5, 5), {13, 10, 8.5}, 26), 9);
    d = blend(d, ellipsoid(p - Point(-24, -5, 5), {13, 11, 9}, 26), 9);
    return d;
}

/// The fold of skin between thumb and forefinger.
double web(const Point& p) {
    const Point a(27, -44, 3), b(41, -33, 7), c(26, -12, 0);
    const double d = std::min(capsule(p, a, b, 10, 7.5), capsule(p, a, c, 10, 9));
    return blend(d, capsule(p, 0.5 * (a + b), 0.5 * (a + c), 8, 7.5), 9);
}

double flesh(const Point& p) {
    double d = blend(palm(p), web(p), 10);
    double fingers = hand().fingers[0].distance(p);
    for (int i = 1; i < 4; ++i)
        fingers = blend(fingers, hand().fingers[i].distance(p), 3.5);
    d = blend(d, fingers, 9);
    return blend(d, hand().fingers[4].distance(p), 10);
}

/// The palm's lines, mm deep.
double palmLines(const Point& p) {
    const Hand& h = hand();
    const double front = ramp(-2, 6, p.z);
    if (p.y > 25 || front <= 0)
        return 0;
    const double wander = 0.7 * noise(p / 9.0 + 4.0) + 0.3 * noise(p / 3.0);
    const glm::dvec2 q(p.x + wander, p.y + wander);
    double r = 0;
    const auto crease = [&](const PlaneCurve& line, double depth, double width) {
        const auto foot = line.foot(q);
        const double fade = ramp(0, 0.2, foot.along) * ramp(1, 0.75, foot.along);
        r = std::max(r, depth * bell(foot.distance / width) * fade);
    };
    crease(h.heart, 0.75, 1.9);
    crease(h.head, 0.65, 1.8);
    crease(h.life, 0.8, 2.0);
    crease(h.fate, 0.25, 1.6);
    crease(h.wrist, 0.55, 1.7);
    return front * r;
}

/// Flexion creases and the folds over the joints' backs of one finger.
double fingerFolds(const Finger& f, bool thumb, const Point& p) {
    double r = 0;
    for (int k = 1; k < 3; ++k) {
        const Point along = glm::normalize(f.joint[k + 1] - f.joint[k - 1]);
        const Point d = p - f.joint[k];
        const double y = glm::dot(d, along), z = glm::dot(d, f.palmar);
        const double beside = glm::length(d - y * along);
        const double near = ramp(f.radius[k] + 7, f.radius[k] + 3, beside);
        if (near <= 0 || std::abs(y) > 13)
            continue;
        const double wander = 0.8 * noise(p / 4.0);
        const double palmSide = ramp(-2, 4, z), back = ramp(-0.35, -0.8, z / beside);
        if (k == 1 && thumb)
            r += near * palmSide * (0.4 * bell((y + wander) / 1.8) + 0.3 * bell((y - 4 + wander) / 1.7));
        else if (k == 1)
            r += near * palmSide *
                 (0.55 * bell((y + 1.3 + wander) / 1.6) + 0.35 * bell((y - 1.6 + wander) / 1.4));
        else
            r += near * palmSide * 0.6 * bell((y + wander) / 1.6);
        // Loose skin lies in folds about a flat oval.
        const double fade =
            bell(y / (k == 1 ? 9.5 : 7.0)) * (k == 1 ? 0.32 : 0.24) * (thumb && k == 1 ? 0.4 : 1);
        const double curved = y + (y > 0 ? -1 : 1) * 0.035 * z * z * ramp(0, 5, std::abs(y)) + 1.6 * wander;
        r += near * back * fade * (std::cos(1.75 * curved) - 0.1);
    }
    return r;
}

/// Bumps (negative) and grooves (positive) in mm, near the skin.
double relief(const Point& p) {
    const Hand& h = hand();
    double r = palmLines(p);
    for (int i = 0; i < 5; ++i) {
        const Finger& f = h.fingers[i];
        r += fingerFolds(f, i == 4, p);
        if (i == 4)
            break;
        const Point along = glm::normalize(f.joint[1] - f.joint[0]);
        const Point root = f.joint[0] + (i == 3 ? 20.0 : 22.5) * along;
        const double y = glm::dot(p - root, along), z = glm::dot(p - root, f.palmar);
        const double beside = glm::length(p - root - y * along);
        if (std::abs(y) < 3 && z > 0 && beside < 17)
            r += 0.6 * bell((y + 0.6 * noise(p / 4.0)) / 1.7) * ramp(0, 5, z) * ramp(17, 12, beside);
        // Knuckle and tendon on the back of the hand.
        if (p.z < 0) {
            r -= 2.4 * bell(glm::length(p - f.joint[0] - Point(0, -1, -f.radius[0])) / 13);
            const Point from(3 - 3.5 * i, -80, -18);
            const Point ab = f.joint[0] + Point(0, -6, -10) - from;
            const double t = std::clamp(glm::dot(p - from, ab) / glm::dot(ab, ab), 0.0, 1.0);
            const Point off = p - from - t * ab;
            r -= 0.9 * bell(std::hypot(off.x, 0.3 * off.y, 0.25 * off.z) / 4.5) * ramp(0.0, 0.5, t) *
                 ramp(-2, -8, p.z);
        }
    }
    return r;
}

/// In the nail's plane: x across, y from the cuticle to the tip; and how far the point looks to the back.
struct OnNail {
    double distance; // signed, negative on the nail
    double y;        // mm from the cuticle
    double back;     // 0 to 1
};
OnNail onNail(const Finger& f, const Point& p) {
    const Point q = f.last.local(p);
    const double scale = f.radius[3] / 7.4;
    const double roll = std::atan2(q.x, -q.z) * f.radius[3]; // wrapped round the finger
    const glm::dvec2 flat(roll / scale, (q.y - (f.length() - 8.5 * scale)) / scale + 2.0);
    return {scale * hand().nail.distance(flat), scale * flat.y, ramp(-0.1, -0.6, q.z / f.radius[3])};
}

double nails(const Point& p) {
    for (const Finger& f : hand().fingers) {
        if (glm::length(p - f.joint[3]) > 17)
            continue;
        const OnNail n = onNail(f, p);
        if (n.back <= 0 || n.distance > 3)
            return 0;
        // A groove all round, deepest at the sides; the plate stands out and over the tip.
        const double tip = ramp(10, 14, n.y);
        const double groove =
            0.6 * bell((n.distance - 0.2) / 1.3) * (1 - tip) * (0.6 + 0.4 * ramp(0, 5, n.y));
        const double plate = (0.2 + 0.5 * tip) * ramp(0.1, -0.9, n.distance);
        return n.back * (groove - plate);
    }
    return 0;
}

double solid(const Point& p) {
    double d = flesh(p);
    if (std::abs(d) < 10)
        d += (relief(p) + nails(p));
    return common(d, kCut - p.y, 1.5);
}

glm::u8vec3 colour(const Point& p) {
    const double skinDepth = solid(p);
    const double fine = noise(p / 1.6), mid = layeredNoise(p / 6.0, 2),
                 broad = layeredNoise(p / 22.0 + 9.0, 2);
    if (p.y < kCut + 0.3 || skinDepth < -0.7) { // cut: skin, fat, red flesh, two bones
        const double depth = -flesh(p);
        const double bones = std::min(ellipsoid({p.x - 11, 0, p.z + 4}, {11, 9, 8}, 40),
                                      ellipsoid({p.x + 14, 0, p.z + 4}, {7, 7, 6.5}, 40));
        Colour c =
            mix(Colour(236, 206, 140), Colour(158, 48, 44) + 14.0 * mid, ramp(2.2, 3.6, depth + 0.6 * mid));
        c = mix(Colour(222, 168, 142), c, ramp(0.8, 1.4, depth));
        if (p.y < -70)
            c = mix(c, mix(Colour(236, 224, 196), Colour(196, 120, 98), ramp(-1.5, -2.5, bones)),
                    ramp(0.5, -0.3, bones));
        return toBytes(c);
    }
    const Colour palmSkin(212, 148, 122), backSkin(190, 130, 100), red(190, 88, 76), crease(140, 70, 58);
    const double front = ramp(-6, 5, p.z);
    Colour c = mix(backSkin, palmSkin, front);
    c = mix(c, red, 0.16 * (0.5 + 0.5 * broad) + 0.05 * mid);
    // Balls of thumb and little finger and the pads are redder, and so are fingertips and knuckles.
    const Finger* fingers = hand().fingers;
    double warm = 0.35 * front * ramp(16, 22, p.z);
    for (int i = 0; i < 5; ++i) {
        warm = std::max(warm, 0.5 * ramp(17, 6, glm::length(p - fingers[i].joint[3])));
        for (int k = 1; k < 3; ++k)
            warm = std::max(warm, 0.28 * ramp(14, 6, glm::length(p - fingers[i].joint[k])) * (1 - front));
        if (i < 4)
            warm =
                std::max(warm, 0.32 * ramp(17, 8, glm::length(p - fingers[i].joint[0])) * ramp(0, -8, p.z));
    }
    c = mix(c, red, warm * (0.8 + 0.2 * mid));
    c = mix(c, crease, 0.5 * ramp(0.1, 0.8, relief(p)));
    for (const Finger& f : hand().fingers) {
        if (glm::length(p - f.joint[3]) > 17)
            continue;
        const OnNail n = onNail(f, p);
        Colour nail = mix(Colour(232, 176, 164), Colour(238, 198, 186),
                          ramp(3.8, 2.4, n.y - 0.2 * std::abs(f.last.local(p).x)));
        nail = mix(nail, Colour(240, 226, 208), ramp(13.0, 13.6, n.y * 7.4 / f.radius[3]));
        c = mix(c, nail, n.back * ramp(0.1, -0.5, n.distance));
    }
    return toBytes(c + 3.0 * fine);
}

double wantedSize(const Point& p) {
    double size = p.y < kCut + 1 ? 1.5 : 1.0;
    for (const Finger& f : hand().fingers)
        if (glm::length(p - f.joint[3]) < 17) {
            const OnNail n = onNail(f, p);
            if (n.back > 0)
                size = std::min(size, 0.5 + 0.5 * ramp(0.8, 3, std::abs(n.distance)));
        }
    return std::min(size, 1.0 - 0.4 * ramp(0.05, 0.35, relief(p)));
}

} // namespace

double handDistance(const Point& p) {
    return solid(p);
}

const Solid& handSolid() {
    static const Solid made = [] {
        Solid s{.name = "hand", .source = {}, .colour = colour, .fewest = 6000, .most = 600000};
        s.source.distance = solid;
        s.source.lowest = kLowest;
        s.source.highest = kHighest;
        s.source.thinnest = 6; // between two fingers, near their roots
        s.source.size = wantedSize;
        return s;
    }();
    return made;
}

Result<sim::TriangleMesh> makeHand(std::size_t faces) {
    return meshSolid(handSolid(), faces);
}

} // namespace serosa::models
