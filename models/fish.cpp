// A loft for the body, plates within drawn outlines for the fins; scales, gill cover, mouth and fin rays in
// low relief. Both sides are one: all is a function of |z|.
#include "models/fish.h"

#include "models/colour.h"
#include "models/loft.h"
#include "models/shaping.h"
#include "models/tube.h"

namespace serosa::models {
namespace {

const Point kLowest(-98, -50, -34), kHighest(98, 60, 34);
const Point kEye(-67.5, 7.0, 14); // near it, on the side of z > 0

/// A fin: a plate about the plane z = 0 of its own frame, its rays spread from `fan`.
struct Fin {
    Outline outline;
    glm::dvec2 fan;
    double rays; // a radian
    bool spines; // a stiff front fin: rays stand out strongly

    double distance(const Point& q) const {
        const double inside = outline.distance(glm::dvec2(q));
        if (inside > 8)
            return std::max(inside, std::abs(q.z) - 2);
        const double thick = 0.95 + 0.9 * ramp(0, -14, inside) + (spines ? 0.30 : 0.24) * ray(q);
        return common(inside, std::abs(q.z) - thick, 1.2);
    }
    double ray(const Point& q) const { // 1 on a ray, -1 between
        const glm::dvec2 d = glm::dvec2(q) - fan;
        return std::cos(rays * std::atan2(d.y, d.x)) * ramp(4, 12, glm::length(d));
    }
};

struct Fish {
    // Axis along x: a section's x is the fish's y, its y the fish's z.
    Loft body{{{-84.5, {-3.5, 0}, {8.0, 6.0}},
               {-80.5, {-2.7, 0}, {10.0, 7.3}},
               {-76, {-1.9, 0}, {12.4, 8.8}},
               {-68, {-0.6, 0}, {17.2, 11.4}},
               {-56, {0.8, 0}, {21.8, 13.6}},
               {-40, {2.5, 0}, {26.5, 15.2}},
               {-18, {3, 0}, {28.5, 15.6}},
               {5, {2.5, 0}, {26.5, 14}},
               {25, {2.5, 0}, {20.5, 10.6}},
               {42, {3, 0}, {13.5, 7}},
               {54, {3.5, 0}, {9.8, 4.6}},
               {68, {4, 0}, {8.0, 1.5}}},
              7,
              10};
    Fin spiny{Outline({{-38, 20},
                       {-36, 38},
                       {-33, 46},
                       {-29.5, 44.5},
                       {-26, 49.5},
                       {-22.5, 47.5},
                       {-18.5, 50.5},
                       {-15, 47.5},
                       {-11, 49},
                       {-8, 45.5},
                       {-4, 45.5},
                       {-2, 41.5},
                       {2, 40.5},
                       {4, 36.5},
                       {7, 34},
                       {8, 24},
                       {-14, 12}}),
              {-16, -60},
              75,
              true};
    Fin soft{Outline({{11, 18},
                      {10, 34},
                      {12.5, 41.5},
                      {18, 41},
                      {26, 36.5},
                      {34, 30},
                      {40, 24.5},
                      {40.5, 20},
                      {36, 10}}),
             {6, -40},
             95,
             false};
    Fin caudal{Outline({{56, 5},
                        {62, 13},
                        {70, 22},
                        {80, 31},
                        {90, 36.5},
                        {93.5, 35},
                        {91, 27},
                        {87.5, 18},
                        {85.5, 9},
                        {85, 4},
                        {85.5, -1},
                        {87.5, -10},
                        {91, -19},
                        {93.5, -27},
                        {90, -28.5},
                        {80, -23},
                        {70, -14},
                        {62, -5}}),
               {42, 4},
               34,
               false};
    Fin anal{Outline({{16, -10},
                      {15.5, -24},
                      {18, -33.5},
                      {22, -35.5},
                      {27, -31},
                      {33, -24},
                      {38, -17},
                      {40, -11},
                      {34, -4}}),
             {10, 30},
             75,
             false};
    Fin paired{Outline({{-3, -3},
                        {4, -6.5},
                        {14, -8},
                        {23, -7},
                        {29, -3},
                        {30.5, 2},
                        {27, 6},
                        {18, 8},
                        {8, 6.5},
                        {-3, 3}}),
               {-12, 0},
               30,
               false}; // of pelvic and pectoral fins, in their frames
    // The paired fins' frames: x along the fin, z out of its plane; at z > 0.
    Frame pectoral{{-41, -8.5, 13.2}, {-0.25, 1, 0.28}, {-0.62, -0.25, 0.8}};
    Frame pelvic{{-31, -21.5, 7}, {0.72, 0.62, 0.42}, {-0.2, -0.42, 1}};
    PlaneCurve mouth{{{-93, -5.2}, {-85, -5.6}, {-80, -6.8}, {-75.5, -9.4}}};
    PlaneCurve lateral{{{-46, 10}, {-30, 13.5}, {-10, 14}, {15, 11}, {40, 6.5}, {62, 4}}};
    PlaneCurve cover{{{-52, 20}, {-46, 14}, {-42, 5}, {-41.5, -3}, {-46, -12}, {-55, -19}, {-66, -21}}};
    PlaneCurve cheek{{{-57, 11}, {-54, 4}, {-54, -5}, {-59, -12}, {-67, -14.5}}};
    Frame eye{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}; // on the skin, z outwards
    Fish() {
        const auto skin = [&](const Point& p) { return body.distance({p.y, p.z, p.x}); };
        const Point at = onto(skin, kEye);
        eye = Frame(at, {0, 1, 0}, gradient(skin, at));
    }
};

const Fish& fish() {
    static const Fish made;
    return made;
}

/// Scales in staggered rows: `height` 0 to 1 rises towards a scale's hind edge, `rim` is 1 at that edge.
struct Scale {
    double height = 0, rim = 0;
};
Scale scaleAt(double x, double y) {
    constexpr double along = 3.1, across = 5.6, reach = 4.6; // between rows, within a row, a scale's radius
    const double row = std::floor(x / along);
    // The foremost scale that covers the point lies on top; at its edge the next one shows.
    double top = -1, under = 0;
    for (int step = -3; step <= 1; ++step) {
        const double r = row + step, shift = std::fmod(std::abs(r), 2.0) * 0.5;
        const double cy = (std::round(y / across - shift) + shift) * across;
        const double edge = reach - std::hypot(x - r * along, 1.25 * (y - cy));
        if (edge <= 0)
            continue;
        if (top >= 0) {
            under = 1 - std::min(edge / reach, 1.0);
            break;
        }
        top = edge;
    }
    if (top < 0)
        return {};
    const double share = ramp(0.0, 1.0, top);
    return {under + (1 - std::min(top / reach, 1.0) - under) * share, 1 - share};
}

/// Where scales are: behind the gill cover, off the back and belly edges and the tail's root.
double scaled(const Point& p) {
    const LoftSection section = fish().body.at(p.x);
    const double high = std::abs(p.y - section.centre.x) / section.half.x;
    const double behind = p.x + 41 + 0.028 * (p.y + 1) * (p.y + 1);
    return ramp(1, 5, behind) * ramp(1.0, 0.86, high) * ramp(66, 58, p.x);
}

double trunk(const Point& m) {
    const Fish& f = fish();
    double d = f.body.distance({m.y, m.z, m.x});
    if (std::abs(d) > 8)
        return d;
    const glm::dvec2 side(m.x, m.y);
    if (m.x < -35) {
        // The gill cover stands over the body behind it; the cheek's edge lies before it.
        const auto edge = f.cover.foot(side);
        const double front = std::hypot((m.x + 66) / 24.5, (m.y - 0.5) / 22) - 1; // < 0 before the edge
        const double lip = bell(edge.distance / 7) * ramp(0, 0.12, edge.along) * ramp(1, 0.85, edge.along);
        d -= 1.1 * lip * ramp(0.07, -0.02, front) - 0.5 * lip * ramp(-0.02, 0.1, front);
        const auto inner = f.cheek.foot(side);
        d += 0.55 * bell(inner.distance / 1.8) * ramp(0, 0.15, inner.along) * ramp(1, 0.8, inner.along);
        // Lips about a slit.
        const auto slit = f.mouth.foot(side);
        d -= 0.7 * bell(slit.distance / 3.6) * ramp(1, 0.75, slit.along);
        d += 1.5 * bell(slit.distance / 1.6) * ramp(1, 0.85, slit.along);
        // Nostril.
        d += 0.8 * bell(glm::length(side - glm::dvec2(-77.5, 5.5)) / 1.3);
    }
    const double cover = scaled(m);
    if (cover > 0)
        d -= 0.36 * cover * (scaleAt(m.x, m.y).height - 0.5);
    if (m.x > -46) {
        const auto line = f.lateral.foot(side);
        d += 0.3 * bell(line.distance / 1.5) * ramp(0, 0.1, line.along) * ramp(66, 50, m.x);
    }
    return d;
}

double eyeball(const Point& m) {
    return ellipsoid(fish().eye.local(m), {5.9, 5.9, 2.6});
}
double socket(const Point& m) { // a shallow groove round the eye
    return torus(fish().eye.local(m), Point(0, 0, 0.9), {0, 0, 1}, 6.6, 1.2);
}

double pairedFin(const Point& m, const Frame& frame, double longer) {
    // In the frame, y is up: turn so that the fin's length runs along x.
    const Point q = frame.local(m);
    return longer * fish().paired.distance(Point(q.x, q.y, q.z) / longer);
}

double medianFins(const Point& p) {
    const Fish& f = fish();
    return std::min({f.spiny.distance(p), f.soft.distance(p), f.caudal.distance(p), f.anal.distance(p)});
}

double pairedFins(const Point& m) {
    if (m.x > 16 || m.y > 14)
        return 4;
    return std::min({4.0, pairedFin(m, fish().pectoral, 1.0), pairedFin(m, fish().pelvic, 0.92)});
}

double solid(const Point& p) {
    const Point m(p.x, p.y, std::abs(p.z));
    double d = trunk(m);
    if (m.x < -55) {
        d = carve(d, socket(m), 1.0);
        d = blend(d, eyeball(m), 0.7);
    }
    d = blend(d, medianFins(p), 3.5);
    return blend(d, pairedFins(m), 2.5);
}

glm::u8vec3 colour(const Point& p) {
    const Fish& f = fish();
    const Point m(p.x, p.y, std::abs(p.z));
    const double skin = solid(p);
    const double fine = noise(p / 1.8), broad = layeredNoise(p / 14.0, 2);
    if (skin < -0.7) { // cut: pale flesh, a red line along the side, the spine in the middle
        const double spine = std::hypot(p.y - 6, p.z);
        Colour flesh(236, 208, 192);
        flesh = mix(flesh, Colour(206, 120, 106), ramp(4, 1, std::hypot(p.y - 5, std::max(0.0, m.z - 6))));
        return toBytes(mix(flesh + 6.0 * fine, Colour(244, 236, 216), ramp(3.6, 2.8, spine)));
    }
    const LoftSection section = f.body.at(p.x);
    const double high = (p.y - section.centre.x) / section.half.x; // -1 belly, 1 back
    const Colour back(58, 78, 48), flank(158, 160, 88), belly(240, 228, 196), dark(36, 50, 36);
    Colour c = mix(mix(belly, flank, ramp(-0.85, -0.2, high + 0.12 * broad)), back,
                   ramp(0.1, 0.85, high + 0.18 * broad));
    // Six dark bars that taper downwards, behind the head.
    double bars = 0;
    for (int i = 0; i < 6; ++i) {
        const double middle = -33 + 17.5 * i + 1.5 * std::sin(2.1 * i) - 3.0 * high;
        const double width = (4.6 - 0.25 * i) * (0.55 + 0.45 * ramp(-0.7, 0.6, high));
        bars = std::max(bars, ramp(width + 2.2, width - 2.0, std::abs(p.x - middle) + 2.0 * broad));
    }
    c = mix(c, dark, 0.72 * bars * ramp(-0.72, -0.25, high));
    const double cover = scaled(m);
    if (cover > 0) {
        const Scale scale = scaleAt(m.x, m.y);
        c = mix(c, mix(c, Colour(248, 240, 196), 0.35), cover * ramp(0.35, 0.9, scale.height));
        c *= 1 - 0.30 * cover * scale.rim;
    }
    const glm::dvec2 side(m.x, m.y);
    if (p.x < -35) {
        const double sheen = ramp(14, 3, std::hypot(p.x + 55, p.y + 3));
        c = mix(c, Colour(206, 190, 116), 0.4 * sheen); // of the gill cover
        c *= 1 - 0.35 * bell(f.cover.foot(side).distance / 1.6) -
             0.25 * bell(f.cheek.foot(side).distance / 1.6);
        c = mix(c, Colour(90, 58, 48), 0.8 * bell(f.mouth.foot(side).distance / 1.5));
        c *= 1 - 0.6 * bell(glm::length(side - glm::dvec2(-77.5, 5.5)) / 1.3);
    }
    // Fins: dorsal ones olive with dark spots, the others red.
    const double skinOnly = trunk(m), plate = medianFins(p), pair = pairedFins(m);
    const double onFin = std::max(ramp(1.2, 4.0, skinOnly), ramp(61, 68, p.x + 0.012 * p.y * p.y));
    if (std::min(plate, pair) < 0.8 && onFin > 0) {
        const bool dorsal = p.y > 12 && p.x < 48;
        const Fin& fin = dorsal ? (p.x < 9 ? f.spiny : f.soft) : p.x > 48 ? f.caudal : f.anal;
        double ray = pair < plate ? 0 : fin.ray(p);
        if (pair < plate) {
            const Frame& frame =
                pairedFin(m, f.pectoral, 1) < pairedFin(m, f.pelvic, 0.92) ? f.pectoral : f.pelvic;
            ray = f.paired.ray(frame.local(m));
        }
        const bool pectoral = pair < plate && pairedFin(m, f.pectoral, 1) < 0.8;
        Colour web = dorsal ? Colour(112, 112, 70) : pectoral ? Colour(222, 160, 84) : Colour(214, 76, 40);
        web = mix(web, web * 0.72, 0.5 - 0.5 * ray);
        if (dorsal && p.x > -6 && p.x < 9) // the black spot at the spiny fin's end
            web = mix(web, Colour(30, 32, 30), ramp(7, 3.5, std::hypot(p.x - 1.5, p.y - 35)));
        c = mix(c, web, onFin);
    }
    if (p.x < -55) {
        const Point q = f.eye.local(m);
        const double ball = eyeball(m), r = std::hypot(q.x, q.y);
        if (ball < 0.35) {
            Colour eye = mix(Colour(14, 14, 18), Colour(232, 178, 52), ramp(2.9, 3.3, r));
            eye = mix(eye, Colour(96, 66, 30), ramp(4.7, 5.6, r));
            eye = mix(eye, Colour(245), ramp(1.1, 0.8, glm::length(glm::dvec2(q) - glm::dvec2(-1.4, 1.4))));
            c = mix(c, eye, ramp(0.35, 0.1, ball));
        }
    }
    return toBytes(c + 4.0 * fine);
}

double wantedSize(const Point& p) {
    const Point m(p.x, p.y, std::abs(p.z));
    const double eye = p.x < -55 ? std::abs(eyeball(m)) : 9;
    const double slit = p.x < -70 ? fish().mouth.foot({m.x, m.y}).distance : 9;
    return 0.55 + 0.45 * ramp(0.5, 4, std::min(eye, slit));
}

} // namespace

double fishDistance(const Point& p) {
    return solid(p);
}

const Solid& fishSolid() {
    static const Solid made = [] {
        Solid s{.name = "fish", .source = {}, .colour = colour, .fewest = 20000, .most = 600000};
        s.source.distance = solid;
        s.source.lowest = kLowest;
        s.source.highest = kHighest;
        s.source.thinnest = 1.5; // of the fins
        s.source.size = wantedSize;
        return s;
    }();
    return made;
}

Result<sim::TriangleMesh> makeFish(std::size_t faces) {
    return meshSolid(fishSolid(), faces);
}

} // namespace serosa::models
