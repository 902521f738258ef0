// Shapes and places of the chambers and vessels. Numbers are millimetres, chosen to look like an adult heart
// in diastole; the wall thicknesses are HeartWalls'.
#include "models/heart_anatomy.h"

#include <glm/gtc/matrix_transform.hpp>

namespace serosa::models {
namespace {

using Walls = HeartWalls;
constexpr double kSpline = 2.0; // mm between samples of a centre line

} // namespace

HeartAnatomy::Vessel HeartAnatomy::vessel(const std::vector<TubePoint>& lumen, Tube::End start,
                                          Tube::End finish) const {
    std::vector<TubePoint> inner = spline(lumen, kSpline), outer = inner;
    for (TubePoint& p : outer)
        p.radius += Walls::kVessel;
    return {Tube(outer, start, finish, 2.0), Tube(inner, start, finish, 9.0)};
}

HeartAnatomy::HeartAnatomy() {
    // The apex points down, to the patient's left and forward.
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1), glm::radians(-20.0), glm::dvec3(1, 0, 0)) *
                            glm::rotate(glm::dmat4(1), glm::radians(38.0), glm::dvec3(0, 0, 1));
    worldFromLocal_ = glm::dmat3(turn);
    constexpr auto round = Tube::End::round, flat = Tube::End::flat;
    // Aorta: root, arch, descending stump; brachiocephalic, left carotid and left subclavian stumps.
    aorta_.push_back(vessel({{{-4, 4, 2}, 11.5},
                             {{-7, 16, 4}, 12.5},
                             {{-11, 32, 5}, 11.5},
                             {{-10, 48, 2}, 11.5},
                             {{-4, 60, -6}, 11.2},
                             {{6, 64, -17}, 10.8},
                             {{14, 60, -30}, 10.4},
                             {{17.5, 52, -38}, 10},
                             {{18, 47, -40}, 9.8}},
                            round, flat));
    aorta_.push_back(vessel({{{-8, 56, -2}, 5}, {{-14, 72, 2}, 5}, {{-18, 80, 3}, 5}}, round, flat));
    aorta_.push_back(vessel({{{0, 62, -10}, 3.4}, {{-1, 76, -9}, 3.4}, {{-2, 84, -8}, 3.4}}, round, flat));
    aorta_.push_back(vessel({{{9, 62, -22}, 4}, {{11, 75, -23}, 4}, {{14, 82, -24}, 4}}, round, flat));
    // Pulmonary trunk: in front of the aorta and to its left, then its two arteries.
    pulmonary_.push_back(vessel({{{10, 12, 21}, 10.8},
                                 {{15, 22, 16}, 11.2},
                                 {{17, 31, 8}, 10.6},
                                 {{15, 38, -3}, 9.6},
                                 {{6, 41, -15}, 8},
                                 {{-10, 41, -24}, 7.2},
                                 {{-28, 40, -25}, 7},
                                 {{-42, 38, -25}, 6.6}},
                                round, flat));
    pulmonary_.push_back(vessel({{{16, 36, 2}, 9.5}, {{25, 42, -7}, 8}, {{36, 43, -14}, 7.4}}, round, flat));
    // Venae cavae.
    cavae_.push_back(vessel({{{-36, 12, -4}, 8}, {{-40, 34, -1}, 8}, {{-40, 50, 0}, 8}}, round, flat));
    cavae_.push_back(vessel({{{-34, -6, -12}, 9}, {{-35, -20, -16}, 9}, {{-35, -27, -17}, 9}}, round, flat));
    // Pulmonary veins: left upper, left lower, right upper, right lower.
    veins_.push_back(vessel({{{18, 15, -34}, 5}, {{31, 19, -37}, 5}, {{38, 21, -39}, 5}}, round, flat));
    veins_.push_back(vessel({{{18, 4, -36}, 5}, {{31, 0, -41}, 5}, {{38, -2, -44}, 5}}, round, flat));
    veins_.push_back(vessel({{{-14, 15, -36}, 5}, {{-31, 18, -39}, 5}, {{-39, 20, -41}, 5}}, round, flat));
    veins_.push_back(vessel({{{-12, 5, -37}, 5}, {{-30, 1, -43}, 5}, {{-38, -1, -45}, 5}}, round, flat));
    // Outflow tract of the right ventricle and the auricles (cavities).
    conus_.emplace_back(
        spline({{toWorld({-8, -20, 18}), 14}, {{4, 1, 24}, 12.5}, {{10, 12, 21}, 11}}, kSpline));
    leftAuricle_.emplace_back(spline(
        {{{18, 14, -27}, 9}, {{31, 24, -19}, 8}, {{37, 30, -8}, 7}, {{36, 28, 3}, 6}, {{32, 22, 11}, 4}},
        kSpline));
    rightAuricle_.emplace_back(
        spline({{{-34, 11, 2}, 12}, {{-28, 18, 11}, 10.5}, {{-20, 19, 17}, 8}, {{-12, 16, 21}, 5}}, kSpline));
}

double HeartAnatomy::outerOf(const std::vector<Vessel>& vessels, const Point& p, double k) {
    double d = vessels.front().outer.distance(p);
    for (std::size_t i = 1; i < vessels.size(); ++i)
        d = blend(d, vessels[i].outer.distance(p), k);
    return d;
}

double HeartAnatomy::lumenOf(const std::vector<Vessel>& vessels, const Point& p, double k) {
    double d = vessels.front().lumen.distance(p);
    for (std::size_t i = 1; i < vessels.size(); ++i)
        d = blend(d, vessels[i].lumen.distance(p), k);
    return d;
}

HeartAnatomy::Distances HeartAnatomy::distances(const Point& p) const {
    const Point l = toLocal(p);
    Distances d;
    // Left ventricle: prolate, closed by the plane of its valves, with the outflow below the aortic valve.
    const double leftBody = ellipsoid(l - Point(10, -20.5, -8), {20, 45.5, 20});
    const double outflow = capsule(l, {7, -18, -4}, {0, 0, 4}, 10, 10);
    const double lv = common(blend(leftBody, outflow, 5), l.y + 3, 6);
    // Right ventricle: wraps around the septum; its cone rises to the pulmonary valve.
    const double rightBody = common(ellipsoid(l - Point(-11, -14, 8), {31, 42, 24}), l.y + 2, 8);
    const double conus = conus_[0].distance(p);
    const double rv = blend(rightBody, conus, 8);
    const double la = blend(blend(ellipsoid(p - Point(1, 10, -30), {26, 13, 15}),
                                  capsule(p, {6, 9, -27}, toWorld({13, 0, -11}), 11, 13), 6),
                            leftAuricle_[0].distance(p), 4);
    const double ra = blend(blend(ellipsoid(p - Point(-34, 3, -5), {16.5, 20, 16.5}),
                                  capsule(p, {-32, 2, -4}, toWorld({-20, 0, 4}), 12, 14), 6),
                            rightAuricle_[0].distance(p), 5);
    const double aortaLumen = lumenOf(aorta_, p, 2), pulmonaryLumen = lumenOf(pulmonary_, p, 2);

    d.outer[leftVentricle] = common(lv - Walls::kLeftVentricle, l.y - 4, 6);
    d.outer[rightVentricle] = common(rightBody - Walls::kRightVentricle, l.y - 3, 5);
    d.outer[rightVentricle] = blend(d.outer[rightVentricle], conus - Walls::kRightVentricle, 8);
    d.outer[leftAtrium] = la - Walls::kAtrium;
    d.outer[rightAtrium] = ra - Walls::kAtrium;
    d.outer[aorta] = outerOf(aorta_, p, 3);
    d.outer[pulmonary] = outerOf(pulmonary_, p, 3);
    d.outer[cavae] = std::min(cavae_[0].outer.distance(p), cavae_[1].outer.distance(p));
    d.outer[veins] = outerOf(veins_, p, 3);

    // Fat about the roots of the great vessels closes what would be tunnels narrower than a simulation's
    // cell.
    d.fat = std::min(capsule(p, {-10, 14, 10}, {12, 18, 8}, 9, 9),
                     capsule(p, {-8, 12, -8}, {12, 17, -12}, 10, 10));
    d.fat = std::min(d.fat, capsule(p, {3, 5, 17}, {8, 10, 14}, 8, 8));
    d.fat = std::min(d.fat, capsule(p, {20, 25, 6}, {29, 24, -2}, 8, 7));
    d.fat = std::min(d.fat, capsule(p, toWorld({-8, 5, -22}), toWorld({-4, 7, 2}), 8, 9));

    constexpr double k = 2; // rounding of the cavities' corners
    d.lumen[leftVentricle] = lv;
    d.lumen[aorta] = carve(aortaLumen, lv - Walls::kValve, k);
    d.lumen[rightVentricle] = carve(carve(rv, lv - Walls::kLeftVentricle, k), d.lumen[aorta] - 3.5, k);
    d.lumen[pulmonary] = carve(carve(pulmonaryLumen, rv - Walls::kValve, k), d.lumen[aorta] - 3.5, k);
    const auto clear = [&](double cavity) { // room for the walls of what was placed before
        cavity = carve(cavity, lv - Walls::kValve, k);
        cavity = carve(cavity, rv - Walls::kValve, k);
        cavity = carve(cavity, d.lumen[aorta] - 3.0, k);
        return carve(cavity, d.lumen[pulmonary] - 3.0, k);
    };
    d.lumen[leftAtrium] = clear(la);
    d.lumen[veins] = lumenOf(veins_, p, 2);
    d.lumen[leftAtrium] = blend(d.lumen[leftAtrium], d.lumen[veins], 2);
    d.lumen[rightAtrium] = carve(clear(ra), d.lumen[leftAtrium] - Walls::kAtrium, k);
    d.lumen[cavae] = std::min(cavae_[0].lumen.distance(p), cavae_[1].lumen.distance(p));
    d.lumen[rightAtrium] =
        blend(d.lumen[rightAtrium], carve(d.lumen[cavae], d.lumen[leftAtrium] - Walls::kAtrium, k), 2);
    return d;
}

double HeartAnatomy::ventricles(const Distances& d) {
    return blend(d.outer[leftVentricle], d.outer[rightVentricle], 10);
}

double HeartAnatomy::muscle(const Distances& d) {
    return blend(ventricles(d), blend(d.outer[leftAtrium], d.outer[rightAtrium], 8), 9);
}

double HeartAnatomy::outside(const Distances& d) {
    double all = blend(muscle(d), blend(d.outer[aorta], d.outer[pulmonary], 6), 4);
    all = blend(all, d.fat, 5);
    all = blend(all, d.outer[cavae], 4);
    return blend(all, d.outer[veins], 4);
}

double HeartAnatomy::lumens(const Distances& d) {
    double nearest = d.lumen[0];
    for (double lumen : d.lumen)
        nearest = std::min(nearest, lumen);
    return nearest;
}

} // namespace serosa::models
