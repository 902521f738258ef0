// Mixes colours in sRGB by how near the point is to each part.
#include "models/heart_colour.h"

namespace serosa::models {
namespace {

using Anatomy = HeartAnatomy;
using Colour = glm::dvec3; // 0 to 255

const Colour kVentricle(134, 38, 32), kVentricleDark(104, 26, 26), kAtrium(150, 62, 58), kFat(226, 186, 98),
    kArtery(196, 28, 24), kVein(88, 62, 104), kAorta(214, 142, 130), kPulmonary(178, 128, 150),
    kCava(118, 104, 146), kPulmonaryVein(190, 110, 112), kEndocardium(172, 74, 72), kIntima(222, 168, 152),
    kCut(160, 58, 50);

Colour mix(const Colour& a, const Colour& b, double t) {
    return a + (b - a) * t;
}

} // namespace

glm::u8vec3 heartColour(const Point& p, const HeartAnatomy::Distances& d, double arteries, double veins) {
    const double broad = 0.5 + 0.5 * noise(p / 17.0), fine = 0.5 + 0.5 * noise(p / 6.0 + 31.0);
    const double outside = std::abs(Anatomy::outside(d)), inside = std::abs(Anatomy::lumens(d));
    Colour colour;
    if (inside < outside && inside < 0.3) {
        int nearest = 0;
        for (int i = 1; i < Anatomy::kParts; ++i)
            if (d.lumen[i] < d.lumen[nearest])
                nearest = i;
        const bool chamber = nearest <= Anatomy::rightAtrium;
        colour =
            chamber ? mix(kEndocardium, kVentricle, 0.35 * broad) : mix(kIntima, kEndocardium, 0.25 * broad);
        if (nearest == Anatomy::cavae)
            colour = mix(kCava, kEndocardium, 0.5);
    } else {
        colour = mix(kVentricle, kVentricleDark, 0.75 * broad);
        const double ventricles = Anatomy::ventricles(d);
        const double atria = blend(d.outer[Anatomy::leftAtrium], d.outer[Anatomy::rightAtrium], 8);
        colour = mix(colour, mix(kAtrium, kVentricle, 0.4 * broad), ramp(-1.5, 1.5, ventricles - atria));
        const double muscle = std::min(ventricles, atria);
        // Vessels begin where they leave the muscle.
        const auto vessel = [&](double distance, const Colour& own) {
            colour = mix(colour, mix(own, own * 0.86, fine),
                         ramp(-0.6, 1.8, muscle - distance) * (1 - ramp(0.6, 2.5, distance)));
        };
        vessel(d.outer[Anatomy::veins], kPulmonaryVein);
        vessel(d.outer[Anatomy::cavae], kCava);
        vessel(d.outer[Anatomy::pulmonary], kPulmonary);
        if (d.outer[Anatomy::aorta] < d.outer[Anatomy::pulmonary])
            vessel(d.outer[Anatomy::aorta], kAorta);
        // Fat fills the grooves, lies about the roots of the great vessels and along the coronaries.
        const double between = std::max(d.outer[Anatomy::leftVentricle], d.outer[Anatomy::rightVentricle]);
        const double crown = std::max(ventricles, atria);
        const double roots = std::max(muscle, std::min(d.outer[Anatomy::aorta], d.outer[Anatomy::pulmonary]));
        const double uneven = 2.2 * (fine - 0.5) + 1.6 * (broad - 0.5);
        double fat = 1 - ramp(1.8, 4.8, between + uneven);
        fat = std::max(fat, 1 - ramp(3.0, 6.0, crown + uneven));
        fat = std::max(fat, 1 - ramp(1.2, 3.6, std::min(roots, d.fat) + uneven));
        fat = std::max(fat, 0.75 * (1 - ramp(0.6, 2.6, std::min(arteries, veins) + 0.6 * uneven)));
        colour = mix(colour, mix(kFat, kFat * 0.88, broad), 0.92 * fat);
        colour = mix(colour, kVein, 1 - ramp(0.15, 0.75, veins));
        colour = mix(colour, kArtery, 1 - ramp(0.15, 0.75, arteries));
        // The rims of the cut stumps.
        colour = mix(colour, kCut, 0.5 * (1 - ramp(0.8, 1.6, inside)) * ramp(0.2, 0.6, inside));
    }
    colour *= 0.95 + 0.1 * (0.5 + 0.5 * noise(p / 11.0 + 7.0));
    return glm::u8vec3(glm::clamp(glm::round(colour), 0.0, 255.0));
}

} // namespace serosa::models
