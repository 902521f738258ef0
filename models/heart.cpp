// Puts anatomy, coronaries and colours together and shifts them about the origin.
#include "models/heart.h"

#include "models/heart_anatomy.h"
#include "models/heart_colour.h"
#include "models/heart_coronaries.h"
#include "models/mesher.h"

namespace serosa::models {
namespace {

using Anatomy = HeartAnatomy;

const Point kCentre(6, 16, -8); // of the vessels and muscle together, in the anatomy's frame, mm
const Point kLowest(-60, -82, -62), kHighest(78, 108, 58);
constexpr std::size_t kFewest = 12000, kMost = 1050000; // faces; fewer would not resolve 2 mm walls

struct Heart {
    Anatomy anatomy;
    Coronaries coronaries = layCoronaries(anatomy);
};

const Heart& heart() {
    static const Heart made;
    return made;
}

double solid(const Point& p) {
    const Anatomy::Distances d = heart().anatomy.distances(p);
    double outside = Anatomy::outside(d);
    if (std::abs(outside) < TubeTree::kReach)
        outside =
            blend(outside,
                  blend(heart().coronaries.arteries.distance(p), heart().coronaries.veins.distance(p), 0.5),
                  Coronaries::kFillet);
    return carve(outside, Anatomy::lumens(d), 1.5);
}

double wantedSize(const Point& p) {
    const Anatomy::Distances d = heart().anatomy.distances(p);
    if (std::abs(Anatomy::lumens(d)) < 0.5)
        return 1.5;
    const double coronary =
        std::min(heart().coronaries.arteries.distance(p), heart().coronaries.veins.distance(p));
    return 0.55 + 0.45 * ramp(0.5, 4.0, coronary);
}

/// First change of sign from `from` along `direction`, mm.
double cross(const Point& from, const Point& direction, double most) {
    double previous = solid(from), t = 0;
    while (t < most) {
        const double next = solid(from + (t + 0.05) * direction);
        if ((next < 0) != (previous < 0))
            return t + 0.05 * previous / (previous - next);
        previous = next;
        t += 0.05;
    }
    return most;
}

} // namespace

double heartDistance(const glm::dvec3& p) {
    return solid(p + kCentre);
}

std::vector<WallProbe> heartWallProbes() {
    struct Place {
        const char* wall;
        Point inside, towards; // in the lumen; direction to the wall
        bool local;            // in the heart-axis frame
        double expected;
    };
    using Walls = HeartWalls;
    const Place places[] = {
        {"left ventricle", {10, -20, -8}, {1, 0, -0.55}, true, Walls::kLeftVentricle},
        {"left ventricle", {10, -32, -8}, {0.8, 0, -0.75}, true, Walls::kLeftVentricle},
        {"left ventricle", {10, -45, -8}, {0.3, -0.1, -1}, true, Walls::kLeftVentricle},
        {"right ventricle", {-22, -24, 14}, {-0.4, 0, 1}, true, Walls::kRightVentricle},
        {"right ventricle", {-24, -34, 12}, {-0.5, 0, 1}, true, Walls::kRightVentricle},
        {"right ventricle", {-28, -24, 4}, {-1, 0, 0.25}, true, Walls::kRightVentricle},
        {"left atrium", {3, 10, -34}, {0, 0.1, -1}, false, Walls::kAtrium},
        {"left atrium", {6, 12, -34}, {0.1, 0.35, -1}, false, Walls::kAtrium},
        {"right atrium", {-36, 2, -4}, {-1, 0.1, 0.1}, false, Walls::kAtrium},
        {"right atrium", {-36, -2, -4}, {-1, -0.1, 0.25}, false, Walls::kAtrium},
        {"aorta", {-11, 40, 4}, {-0.6, 0, 1}, false, Walls::kVessel},
        {"aorta", {6, 64, -17}, {0.5, 0.6, 0.5}, false, Walls::kVessel},
        {"aorta", {-10, 48, 2}, {0, 0, 1}, false, Walls::kVessel},
        {"pulmonary trunk", {16, 27, 12}, {0.5, 0.3, 0.8}, false, Walls::kVessel},
        {"superior vena cava", {-40, 44, -1}, {-1, 0, 0.4}, false, Walls::kVessel},
    };
    std::vector<WallProbe> probes;
    for (const Place& place : places) {
        const Anatomy& anatomy = heart().anatomy;
        const Point from = place.local ? anatomy.toWorld(place.inside) : place.inside;
        const Point out = glm::normalize(place.local ? anatomy.toWorld(place.towards) : place.towards);
        const double inner = cross(from, out, 60);
        const double outer = inner + 0.2 + cross(from + (inner + 0.2) * out, out, 60);
        const Point p = from + outer * out;
        constexpr double e = 0.01;
        const Point normal = glm::normalize(Point(solid(p + Point(e, 0, 0)) - solid(p - Point(e, 0, 0)),
                                                  solid(p + Point(0, e, 0)) - solid(p - Point(0, e, 0)),
                                                  solid(p + Point(0, 0, e)) - solid(p - Point(0, 0, e))));
        probes.push_back({place.wall, p - kCentre, -normal, place.expected});
    }
    return probes;
}

std::vector<HeartLumen> heartLumens() {
    const Anatomy& a = heart().anatomy;
    return {{"left ventricle", a.toWorld({10, -30, -8}) - kCentre},
            {"right ventricle", a.toWorld({-20, -25, 14}) - kCentre},
            {"left atrium", Point(4, 10, -31) - kCentre},
            {"right atrium", Point(-34, 2, -4) - kCentre},
            {"aorta", Point(-11, 34, 5) - kCentre},
            {"pulmonary trunk", Point(16, 30, 9) - kCentre}};
}

HeartSection heartFourChamberSection() {
    const Anatomy& a = heart().anatomy;
    const Point apex = a.toWorld({10, -70, -8}), left(4, 10, -31), right(-34, 2, -4);
    Point normal = glm::normalize(glm::cross(left - apex, right - apex));
    if (normal.z < 0)
        normal = -normal;
    return {apex - kCentre, normal};
}

double heartMuscleLength() {
    // The muscle's support along the axis, both ways: climb over its surface from the poles' neighbourhood.
    const Anatomy& a = heart().anatomy;
    const auto reach = [&](double sign, Point from) {
        // Highest point that holds muscle, by a search over a narrowing grid of columns.
        double best = 0, width = 40;
        for (int round = 0; round < 5; ++round, width *= 0.4) {
            const Point centre = from;
            for (int i = -6; i <= 6; ++i)
                for (int k = -6; k <= 6; ++k) {
                    const Point at(centre.x + i * width / 6, 0, centre.z + k * width / 6);
                    double height = 100;
                    while (height > best) {
                        const double away =
                            Anatomy::muscle(a.distances(a.toWorld(at + Point(0, sign * height, 0))));
                        if (away < 1e-3)
                            break;
                        height -= std::max(0.8 * away, 1e-3);
                    }
                    if (height > best) {
                        best = height;
                        from = at;
                    }
                }
        }
        return best;
    };
    return reach(1, {-10, 0, -10}) + reach(-1, {10, 0, -8});
}

Result<sim::TriangleMesh> makeHeart(std::size_t faces) {
    if (faces < kFewest || faces > kMost)
        return Error{"the heart phantom has from " + std::to_string(kFewest) + " to " +
                     std::to_string(kMost) + " faces (its thinnest walls are 2 mm), not " +
                     std::to_string(faces)};
    MeshSource source;
    source.distance = solid;
    source.size = wantedSize;
    source.lowest = kLowest;
    source.highest = kHighest;
    source.thinnest = 2.0;
    SEROSA_ASSIGN(sim::TriangleMesh mesh, meshShape(source, faces));
    for (Point& p : mesh.positions) {
        const auto d = heart().anatomy.distances(p);
        mesh.colours.push_back(
            heartColour(p, d, heart().coronaries.arteries.distance(p), heart().coronaries.veins.distance(p)));
        p -= kCentre;
    }
    return mesh;
}

} // namespace serosa::models
