// A dragon curled round itself in the manner of the scanned statue that MS05 bends: long body in an S, head
// raised at one end, tail back over the other, four legs, a crest of spikes. Its extents fill 2 x 2 x 1 cells
// of 60 mm.
#include "models/dragon.h"

#include "models/mesher.h"
#include "models/tube.h"

namespace serosa::models {
namespace {

using Colour = glm::dvec3;

const Point kLowest(-64, -64, -34), kHighest(64, 64, 34);
constexpr std::size_t kFewest = 2000, kMost = 400000;

struct Dragon {
    std::vector<Tube> body, limbs, horns, spikes;
    Dragon();
};

Dragon::Dragon() {
    // Drawn freely, then fitted to the box: places are scaled, radii are not.
    const auto fit = [](std::vector<TubePoint> control) {
        for (TubePoint& c : control)
            c.at = Point(-1.6, 0.8, 0) + Point(0.87, 1, 1.13) * c.at;
        return control;
    };
    const auto tube = [&](std::vector<Tube>& group, const std::vector<TubePoint>& control) {
        group.emplace_back(spline(fit(control), 3.0));
    };
    // From the neck over the back to the hips, and the tail up behind.
    const std::vector<TubePoint> spine = {{{-35, 33, 3}, 9.5},  {{-44, 18, 1}, 11},  {{-36, 0, -2}, 14},
                                          {{-17, -8, -3}, 17},  {{3, -4, 0}, 17.5},  {{20, -10, 5}, 16.5},
                                          {{35, -20, 4}, 13.5}, {{49, -14, -4}, 10}, {{51, 4, -10}, 8},
                                          {{41, 20, -10}, 6.6}, {{27, 30, -4}, 5.4}, {{27, 44, 4}, 4.4},
                                          {{39, 52, 8}, 3.4},   {{51, 46, 6}, 2.2}};
    tube(body, spine);
    // Skull, snout and jaw, open.
    tube(body, {{{-36, 38, 3}, 10.5}, {{-28, 44, 5}, 11}, {{-18, 43, 6}, 9}});
    tube(body, {{{-24, 42, 5}, 8}, {{-10, 41, 8}, 6.2}, {{-1, 42, 9}, 5.4}});
    tube(body, {{{-28, 36, 4}, 6}, {{-16, 30, 6}, 4.2}, {{-6, 27, 7}, 3}});
    // Legs: shoulder or hip, knee, ankle, foot.
    tube(limbs, {{{-27, -8, 12}, 9.5},
                 {{-38, -26, 17}, 7},
                 {{-30, -42, 17}, 5.2},
                 {{-32, -53, 18}, 5},
                 {{-42, -55, 20}, 4}});
    tube(limbs, {{{-27, -6, -14}, 9.5},
                 {{-20, -27, -18}, 7},
                 {{-27, -42, -18}, 5.2},
                 {{-23, -53, -18}, 5},
                 {{-33, -55, -19}, 4}});
    tube(limbs, {{{25, -16, 14}, 11},
                 {{13, -30, 18}, 8},
                 {{26, -43, 17}, 5.6},
                 {{22, -53, 18}, 5.2},
                 {{10, -55, 20}, 4}});
    tube(limbs, {{{29, -17, -10}, 11},
                 {{40, -34, -16}, 8},
                 {{46, -45, -17}, 5.6},
                 {{43, -53, -18}, 5.2},
                 {{31, -55, -19}, 4}});
    // Horns and whiskers.
    tube(horns, {{{-34, 46, 8}, 4.2}, {{-45, 54, 13}, 3.2}, {{-54, 55, 17}, 1.8}});
    tube(horns, {{{-34, 46, -1}, 4.2}, {{-45, 54, -7}, 3.2}, {{-54, 55, -12}, 1.8}});
    tube(horns, {{{-22, 49, 10}, 2.8}, {{-20, 51, 11}, 2.4}});
    tube(horns, {{{-22, 49, 1}, 2.8}, {{-20, 51, 0}, 2.4}});
    // The crest stands on the outer side of the spine, away from the middle of the curl.
    const std::vector<TubePoint> line = spline(fit(spine), 2.0);
    for (std::size_t i = 3; i + 12 < line.size(); i += 5) {
        const Point along = glm::normalize(line[i + 1].at - line[i - 1].at);
        Point out(-along.y, along.x, 0);
        const double sign = out.x * line[i].at.x + out.y * (line[i].at.y + 45) > 0 ? 1 : -1;
        out = glm::normalize(sign * out);
        const double r = line[i].radius;
        const double height = 4 + 0.35 * r;
        spikes.emplace_back(std::vector<TubePoint>{{line[i].at + (r - 3) * out, 3.0 + 0.08 * r},
                                                   {line[i].at + (r + height) * out + 2.5 * along, 1.1}});
    }
}

const Dragon& dragon() {
    static const Dragon made;
    return made;
}

double nearest(const std::vector<Tube>& tubes, const Point& p, double k) {
    double d = tubes.front().distance(p);
    for (std::size_t i = 1; i < tubes.size(); ++i)
        d = blend(d, tubes[i].distance(p), k);
    return d;
}

double solid(const Point& p) {
    const Dragon& made = dragon();
    double d = nearest(made.body, p, 4);
    d = blend(d, nearest(made.limbs, p, 3), 6);
    d = blend(d, nearest(made.horns, p, 1), 2.5);
    return blend(d, nearest(made.spikes, p, 1), 2.5);
}

glm::u8vec3 colourAt(const Point& p) {
    const Dragon& made = dragon();
    const double broad = 0.5 + 0.5 * noise(p / 13.0);
    Colour colour = Colour(58, 122, 84) + (Colour(92, 150, 88) - Colour(58, 122, 84)) * broad;
    colour += (Colour(196, 178, 112) - colour) * (1 - ramp(-1, 2.5, nearest(made.horns, p, 1)));
    colour += (Colour(176, 84, 52) - colour) * (1 - ramp(-1, 2.0, nearest(made.spikes, p, 1)));
    colour += (Colour(120, 130, 74) - colour) * (0.6 * (1 - ramp(-1, 3, nearest(made.limbs, p, 3))));
    return glm::u8vec3(glm::clamp(glm::round(colour), 0.0, 255.0));
}

} // namespace

Result<sim::TriangleMesh> makeDragon(std::size_t faces) {
    if (faces < kFewest || faces > kMost)
        return Error{"the dragon phantom has from " + std::to_string(kFewest) + " to " +
                     std::to_string(kMost) + " faces, not " + std::to_string(faces)};
    MeshSource source;
    source.distance = solid;
    source.lowest = kLowest;
    source.highest = kHighest;
    source.thinnest = 2.5;
    SEROSA_ASSIGN(sim::TriangleMesh mesh, meshShape(source, faces));
    for (const Point& p : mesh.positions)
        mesh.colours.push_back(colourAt(p));
    return mesh;
}

} // namespace serosa::models
