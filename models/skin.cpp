// A block under a height field. On its sides the fat swells in lobules and the muscle in bundles, as on a
// fresh cut.
#include "models/skin.h"

#include "models/colour.h"

namespace serosa::models {
namespace {

constexpr double kHalf = kSkinSide / 2;
constexpr double kDepth[3] = {1.2, 4.5, 12.5};  // mean depths at which epidermis, dermis and fat end, mm
constexpr double kWave[3] = {0.16, 0.35, 0.8};  // heights of the interfaces' waves, mm
constexpr double kLength[3] = {1.5, 6.0, 13.0}; // and their lengths, mm

/// 1 in the furrows of the skin, 0 on the fields between them.
double furrow(double x, double z) {
    // Two sets of wavy lines cross at a slant and part the skin into rhombs, as they do on the back of a
    // hand.
    const double a = x + 0.9 * noise({x / 9, 3, z / 9}), b = z + 0.9 * noise({x / 9, 11, z / 9});
    const auto set = [&](double across, double spacing, double seed) {
        const double t = across / spacing + 0.22 * noise({a / 3.1, seed, b / 3.1});
        const double off = std::abs(t - std::floor(t) - 0.5) * 2; // 1 on the line
        return ramp(0.58, 1.0, off) * (0.65 + 0.35 * noise({a / 7.0, seed + 5, b / 7.0}));
    };
    return std::max(set(0.86 * a + 0.5 * b, 3.4, 21), set(-0.6 * a + 0.8 * b, 3.1, 37));
}

double dome(double x, double z) {
    return kSkinBottom + kSkinThickness - 0.0007 * x * x - 0.0004 * z * z + 0.25 * noise({x / 23, 7, z / 23});
}

/// Clusters of fat: distance from the walls between lobules, 0 to about 0.5 of their size.
Cells lobules(const Point& p) {
    const Point bent = p + 0.6 * Point(noise(p / 3.0), noise(p / 3.0 + 30.0), noise(p / 3.0 + 60.0));
    return cells(bent / Point(3.6, 2.9, 3.6), 0.9);
}

/// Depth under the surface, without the furrows, which do not reach the layers below.
double depthOf(const Point& p) {
    return dome(p.x, p.z) - p.y;
}

double interfaceDepth(int layer, double x, double z) {
    const double length = kLength[layer], seed = 50.0 + 10.0 * layer;
    return kDepth[layer] + kWave[layer] * (0.7 * noise({x / length, seed, z / length}) +
                                           0.3 * noise({2.3 * x / length, seed + 4, 2.3 * z / length}));
}

/// How far the sides stand out at p, mm.
double swelling(const Point& p) {
    const double depth = depthOf(p), dermis = interfaceDepth(1, p.x, p.z), fat = interfaceDepth(2, p.x, p.z);
    const double inFat = ramp(dermis - 0.2, dermis + 0.6, depth) * ramp(fat + 0.2, fat - 0.6, depth);
    const double apart = inFat > 0 ? lobules(p).nearest : 0;
    const double round = 0.45 - 1.1 * apart * apart;
    const double inMuscle = ramp(fat, fat + 1.0, depth);
    const double bundles = 0.18 * noise({p.x / 2.6, p.y / 1.7, p.z / 2.6});
    return (inFat * round + inMuscle * bundles) * ramp(kSkinBottom, kSkinBottom + 2, p.y);
}

double distance(const Point& p) {
    const double top = p.y - skinTop(std::clamp(p.x, -kHalf, kHalf), std::clamp(p.z, -kHalf, kHalf));
    double sides = box({p.x, 0, p.z}, Point(0), {kHalf - 0.3, 100, kHalf - 0.3}, 1.5);
    if (std::abs(sides) < 2 && std::abs(p.y) < 14)
        sides -= swelling(p);
    const double block = common(sides, kSkinBottom - p.y, 0.8);
    return 0.69 * common(block, top, 0.8);
}

Colour layerColour(const Point& p) {
    const double depth = depthOf(p), fine = 0.5 + 0.5 * noise(p / 1.3),
                 broad = 0.5 + 0.5 * noise(p / 6.0 + 8.0);
    const Colour epidermis = mix(Colour(120, 70, 54), Colour(104, 56, 46), fine);
    Colour dermis = mix(Colour(190, 138, 128), Colour(172, 112, 106), 0.6 * broad + 0.4 * fine);
    // Small vessels, mostly deep in the dermis.
    const Cells vessel = cells(p / 4.4 + 3.0, 0.9);
    dermis = mix(dermis, Colour(166, 50, 54), 0.8 * (1 - ramp(0.07, 0.14, vessel.nearest)));
    const Cells lobe = lobules(p);
    const Colour septum(198, 168, 132);
    Colour fat = mix(Colour(206, 158, 62), Colour(186, 130, 44), lobe.which);
    fat = mix(septum, fat, ramp(0.02, 0.16, lobe.second - lobe.nearest));
    // Fibres run along x: on the sides across z they are seen from their ends.
    const double fibre = 0.5 + 0.5 * noise({p.x / 9, p.y / 0.9, p.z / 0.9});
    Colour muscle = mix(Colour(126, 34, 34), Colour(90, 20, 24), fibre);
    const Cells bundle = cells({p.x / 16, p.y / 3.2, p.z / 3.6}, 0.8);
    muscle = mix(Colour(156, 82, 72), muscle, ramp(0.02, 0.12, bundle.second - bundle.nearest));

    const double end[3] = {interfaceDepth(0, p.x, p.z), interfaceDepth(1, p.x, p.z),
                           interfaceDepth(2, p.x, p.z)};
    Colour c = mix(epidermis, dermis, ramp(-0.15, 0.15, depth - end[0]));
    c = mix(c, fat, ramp(-0.2, 0.2, depth - end[1]));
    const double fascia = 1 - ramp(0.2, 0.5, std::abs(depth - end[2]));
    c = mix(c, muscle, ramp(-0.2, 0.2, depth - end[2]));
    return mix(c, Colour(200, 176, 164), 0.8 * fascia);
}

glm::u8vec3 colour(const Point& p) {
    const double top = skinTop(p.x, p.z) - p.y;
    Colour c = layerColour(p);
    const double broad = 0.5 + 0.5 * layeredNoise(p / 17.0, 3), fine = 0.5 + 0.5 * noise(p / 1.1 + 5.0);
    Colour skin = mix(Colour(184, 124, 98), Colour(162, 100, 80), 0.8 * broad + 0.2 * fine);
    skin = mix(skin, Colour(134, 76, 62), 0.6 * furrow(p.x, p.z));
    const Cells mole = cells({p.x / 19, 0.5, p.z / 19}, 0.9);
    skin = mix(skin, Colour(96, 56, 42), mole.which > 0.6 ? 0.6 * ramp(0.09, 0.05, mole.nearest) : 0.0);
    c = mix(skin, c, ramp(0.25, 0.5, top));
    return toBytes(c);
}

} // namespace

const char* skinLayerName(SkinLayer layer) {
    static constexpr const char* names[] = {"epidermis", "dermis", "fat", "muscle"};
    return names[static_cast<int>(layer)];
}

double skinTop(double x, double z) {
    return dome(x, z) - 0.32 * furrow(x, z);
}

double skinInterface(SkinLayer layer, double x, double z) {
    const double furrowed = dome(x, z) - skinTop(x, z);
    if (layer == SkinLayer::muscle)
        return skinTop(x, z) - kSkinBottom;
    return interfaceDepth(static_cast<int>(layer), x, z) - furrowed;
}

SkinLayer skinLayerAt(const Point& p) {
    const double depth = skinTop(p.x, p.z) - p.y;
    for (const SkinLayer layer : {SkinLayer::epidermis, SkinLayer::dermis, SkinLayer::fat})
        if (depth < skinInterface(layer, p.x, p.z))
            return layer;
    return SkinLayer::muscle;
}

const Solid& skinSolid() {
    static const Solid solid = [] {
        Solid s{.name = "skin", .source = {}, .colour = colour, .fewest = 20000, .most = 600000};
        s.source.distance = distance;
        s.source.lowest = Point(-kHalf - 1, kSkinBottom - 0.5, -kHalf - 1);
        s.source.highest = Point(kHalf + 1, kSkinBottom + kSkinThickness + 1, kHalf + 1);
        s.source.thinnest = 2.0; // width of a furrow
        s.source.size = [](const Point& p) {
            // The sides are fine, finest along the thin layers; the bottom is coarse.
            const double side = kHalf - std::max(std::abs(p.x), std::abs(p.z));
            if (p.y < kSkinBottom + 0.3)
                return 0.5 + 1.7 * ramp(1.5, 8, side);
            const double layers = 0.42 + 0.13 * ramp(4, 7, depthOf(p));
            return layers + (0.9 - layers) * ramp(1.0, 4.0, side);
        };
        return s;
    }();
    return solid;
}

Result<sim::TriangleMesh> makeSkin(std::size_t faces) {
    return meshSolid(skinSolid(), faces);
}

} // namespace serosa::models
