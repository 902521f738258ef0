// See render/deformation_map.h. Formulas are templates over the number, so that Eigen's automatic
// differentiation gives exact Jacobians.
#include "render/deformation_map.h"

#include "render/deformation_cuts-inl.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/AutoDiff>

namespace serosa::render {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRolled = 1.25 * kPi; // of a peel, then straight on

/// 0 below 0, 1 above 1, smooth.
template <class T>
T smooth(const T& t) {
    if (t <= 0.0)
        return T(0.0);
    if (t >= 1.0)
        return T(1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// From 0 at the lowest face to 1 at the top.
template <class T>
T rise(const DeformationMap& map, const T& y) {
    return smooth(T((y + map.half.y) / (2 * map.half.y)));
}

/// 1 in the middle, 0 from `end` on, within its last fifth.
template <class T>
T window(const T& r, double end) {
    return 1.0 - smooth(T((r - 0.8 * end) / (0.2 * end)));
}

double lateral(const DeformationMap& map) {
    return std::min(map.half.x, map.half.z);
}

template <class T>
T twistAngle(const DeformationMap& map, const Point<T>& q) {
    return map.amount * rise(map, q.y) * window(radiusOf(q.x, q.z), lateral(map));
}

template <class T>
Point<T> turned(const Point<T>& q, const T& angle) {
    using std::cos;
    using std::sin;
    const T c = cos(angle), s = sin(angle);
    return {q.x * c + q.z * s, q.y, q.z * c - q.x * s};
}

/// How far a pull or a wave lifts the column of a point at the top.
template <class T>
T lift(const DeformationMap& map, const T& x, const T& z) {
    using std::exp;
    using std::sin;
    if (map.kind == MapKind::wave) {
        using std::abs;
        return map.amount * sin(T(2 * kPi / map.extent * x)) * window(T(abs(x)), map.half.x) *
               window(T(abs(z)), map.half.z);
    }
    const T r = radiusOf(x, z);
    if (map.profile == PullProfile::narrow) {
        const T share = r / map.radius;
        const T left = 1.0 - share * share;
        return share >= 1.0 ? T(0.0) : T(map.amount * left * left * left);
    }
    return map.amount * exp(T(-r * r / (2 * map.radius * map.radius))) * window(r, lateral(map));
}

/// Where the layer's ground lies.
double groundOf(const DeformationMap& map) {
    return -map.half.y + map.depth;
}

/// How thick the layer is that rolls off: what lies higher would pass the roll's axis.
double layerOf(const DeformationMap& map) {
    return std::min(2 * map.half.y - map.depth, 0.95 * map.radius);
}

template <class T>
struct Unrolled {
    Point<T> rest;
    bool any = false; // it may lie on the flap
};

/// The place in the flat layer of a point on the rolled one.
template <class T>
Unrolled<T> unroll(const DeformationMap& map, const Point<T>& shown) {
    using std::atan2;
    using std::cos;
    using std::sin;
    const double r = map.radius, ground = groundOf(map);
    const T dx = shown.x - map.amount, dy = ground + r - shown.y;
    // Straight on: t along the end of the roll, n from its ground to its outer side.
    const double c = std::cos(kRolled), s = std::sin(kRolled);
    const T along = (dx - r * s) * c + (r * c - dy) * s, // dy of the end is r c
        above = r - dx * s - dy * c;
    if (along > 0.0)
        return {{T(map.amount + r * kRolled + along), T(ground + above), shown.z}, true};
    T angle = atan2(dx, dy);
    if (angle < 0.0)
        angle = angle + 2 * kPi;
    if (angle > kRolled)
        return {shown, false};
    const T from = radiusOf(dx, dy);
    return {{T(map.amount + r * angle), T(ground + r - from), shown.z}, true};
}

/// How far inside the flap's layer a place in the flat layer lies, its hinge and its top apart.
template <class T>
T insideLayer(const DeformationMap& map, const Point<T>& rest) {
    using std::abs;
    const T low = rest.y - groundOf(map), high = layerOf(map) - low;
    const T side = 0.5 * map.width - abs(rest.z), end = map.half.x - rest.x;
    T least = low < side ? low : side;
    least = end < least ? end : least;
    return high < least ? high : least;
}

/// The same of what stays where it is to the right of the line.
template <class T>
T onGround(const DeformationMap& map, const Point<T>& shown) {
    using std::abs;
    const T below = groundOf(map) - shown.y, beside = abs(shown.z) - 0.5 * map.width;
    return below > beside ? below : beside;
}

/// Left of the line: does the flap lie here, or less than `near` away?
template <class T>
bool rolledOver(const DeformationMap& map, const Unrolled<T>& flap, double near) {
    return flap.any && flap.rest.x > map.amount + 0.5 * kPi * map.radius &&
           insideLayer(map, flap.rest) > -near;
}

/// Of a point left of the line to which the layer is peeled, or of its ground.
bool leftOfLine(const DeformationMap& map, double x) {
    return x <= map.amount;
}

template <class T>
Point<T> rest(const DeformationMap& map, const Point<T>& shown);

template <class T>
Point<T> bendBack(const DeformationMap& map, const Point<T>& shown) {
    using std::atan2;
    using std::cos;
    using std::sin;
    if (map.amount == 0)
        return shown;
    const double k = std::abs(map.amount) / map.extent, low = -0.5 * map.extent, most = std::abs(map.amount),
                 side = map.amount < 0 ? -1 : 1;
    const T x = side * shown.x, dy = shown.y - low;
    T angle = atan2(dy, T(1 / k - x)); // about (1/k, low)
    if (dy <= 0.0 && angle > -kPi / 2)
        return shown; // below the range
    if (angle < 0.0)
        angle = angle + 2 * kPi;
    const double c = std::cos(most), s = std::sin(most);
    if (angle > most) { // above it, as a whole
        const T ex = x - 1 / k, up = ex * s + dy * c, across = -(ex * c - dy * s);
        return {T(side * (1 / k - across)), T(low + map.extent + up), shown.z};
    }
    const T from = radiusOf(T(1 / k - x), dy);
    return {T(side * (1 / k - from)), T(low + angle / k), shown.z};
}

template <class T>
Point<T> rest(const DeformationMap& map, const Point<T>& shown) {
    switch (map.kind) {
    case MapKind::twist:
        return turned(shown, T(-twistAngle(map, shown)));
    case MapKind::bend:
        return bendBack(map, shown);
    case MapKind::pull:
    case MapKind::wave:
        return {shown.x, T(shown.y - lift(map, shown.x, shown.z) * rise(map, shown.y)), shown.z};
    case MapKind::knife:
    case MapKind::seam:
        return closed(map, shown);
    case MapKind::incision:
        return closedAlong(map, shown);
    case MapKind::peel: {
        const Unrolled<T> flap = unroll(map, shown);
        if (!flap.any)
            return shown;
        const T onFlap = insideLayer(map, flap.rest);
        const bool isFlap = shown.x > map.amount ? onFlap > onGround(map, shown) : rolledOver(map, flap, 0.0);
        return isFlap ? flap.rest : shown;
    }
    default:
        return shown;
    }
    return shown;
}

/// y' of a column that is lifted by `up` at the top: y' - up rise(y') = y, by Newton's steps within a
/// bracket.
double lifted(const DeformationMap& map, double y, double up) {
    double low = std::min(y, y + up), high = std::max(y, y + up), at = y;
    for (int i = 0; i < 200; ++i) {
        const double e = at - up * rise(map, at) - y;
        (e < 0 ? low : high) = at;
        const double t = (at + map.half.y) / (2 * map.half.y),
                     slope = t > 0 && t < 1 ? 1 - up * 6 * t * (1 - t) / (2 * map.half.y) : 1;
        double next = at - e / slope;
        if (!(next > low && next < high))
            next = 0.5 * (low + high);
        if (std::abs(next - at) < 1e-16 * (std::abs(at) + map.half.y))
            break;
        at = next;
    }
    return at;
}

} // namespace

const char* nameOf(MapKind kind) {
    static const char* const kNames[] = {"twist",    "bend",   "pull", "peel",   "wave",  "knife",  "seam",
                                         "incision", "sphere", "box",  "points", "image", "texture"};
    return kNames[int(kind)];
}

std::optional<MapKind> parseMapKind(std::string_view name) {
    for (int i = 0; i <= int(MapKind::box); ++i)
        if (name == nameOf(MapKind(i)))
            return MapKind(i);
    return std::nullopt;
}

std::string problemOf(const DeformationMap& map) {
    if (!(map.half.x > 0 && map.half.y > 0 && map.half.z > 0))
        return "its box has no size";
    const double tall = 2 * map.half.y;
    switch (map.kind) {
    case MapKind::twist:
        return std::abs(map.amount) <= 100 ? "" : "it turns by more than 100 radians";
    case MapKind::bend:
        if (!(map.extent > 0 && map.extent <= tall))
            return "its extent must be more than 0 and at most the box's height";
        return std::abs(map.amount) <= 1.5 * kPi ? "" : "it bends by more than 270 degrees, onto itself";
    case MapKind::pull:
    case MapKind::wave:
        if (!(map.kind == MapKind::pull ? map.radius > 0 : map.extent > 0))
            return map.kind == MapKind::pull ? "its radius must be more than 0"
                                             : "its extent, the length of a wave, must be more than 0";
        return 1.5 * std::abs(map.amount) < tall
                   ? ""
                   : "it folds: its amount must be below 2/3 of the box's height";
    case MapKind::knife:
    case MapKind::seam:
        if (!(map.depth > 0 && map.extent > 0))
            return "its depth and its extent must be more than 0";
        return map.amount >= 0 && map.amount < 0.9 * map.half.x
                   ? ""
                   : "its amount, half of the opening, must be between 0 and 0.9 of the box's half width";
    case MapKind::peel:
        if (!(map.depth > 0 && map.depth < tall && map.width > 0))
            return "its depth must lie within the box, and its width be more than 0";
        return map.radius > 0 ? "" : "its radius must be more than 0";
    case MapKind::incision:
        if (!(map.depth > 0 && map.width > 0) || map.path.size() < 2)
            return "its depth and its width must be more than 0, and its path have two places";
        for (const glm::dvec2& at : map.path)
            if (std::abs(at.x) > map.half.x || std::abs(at.y) > map.half.z)
                return "its path leaves its box";
        return map.amount >= 0 && map.amount < 0.45 * map.width
                   ? ""
                   : "its amount, half of the opening, must be between 0 and 0.45 of its width";
    case MapKind::sphere:
        return map.radius > 0 ? "" : "its radius must be more than 0";
    case MapKind::box: {
        const glm::dvec3 size = cutBox(map);
        return std::min({size.x, size.y, size.z}) > 0 ? ""
                                                      : "its extent, depth and width must be more than 0";
    }
    default:
        return "it is no closed-form map";
    }
}

glm::dvec3 inverseDisplacement(const DeformationMap& map, const glm::dvec3& shown) {
    const Point<double> at = rest(map, Point<double>{shown.x, shown.y, shown.z});
    return glm::dvec3(at.x, at.y, at.z) - shown;
}

glm::dmat3 inverseJacobian(const DeformationMap& map, const glm::dvec3& shown) {
    using Number = Eigen::AutoDiffScalar<Eigen::Vector3d>;
    const auto variable = [&](int axis) { return Number(shown[axis], 3, axis); };
    const Point<Number> at = rest(map, Point<Number>{variable(0), variable(1), variable(2)});
    const Number* const rows[] = {&at.x, &at.y, &at.z};
    glm::dmat3 jacobian(0);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3 && rows[i]->derivatives().size() == 3; ++j)
            jacobian[j][i] = rows[i]->derivatives()[j];
    return jacobian;
}

glm::dvec3 forward(const DeformationMap& map, const glm::dvec3& at) {
    switch (map.kind) {
    case MapKind::twist: {
        const Point<double> q{at.x, at.y, at.z}, turnedPoint = turned(q, twistAngle(map, q));
        return {turnedPoint.x, turnedPoint.y, turnedPoint.z};
    }
    case MapKind::bend: {
        const double low = -0.5 * map.extent;
        if (at.y <= low || map.amount == 0)
            return at;
        const double k = std::abs(map.amount) / map.extent, side = map.amount < 0 ? -1 : 1, x = side * at.x,
                     angle = std::min(k * (at.y - low), std::abs(map.amount)),
                     over = std::max(at.y - low - map.extent, 0.0), c = std::cos(angle), s = std::sin(angle);
        return {side * (1 / k - (1 / k - x) * c + over * s), low + (1 / k - x) * s + over * c, at.z};
    }
    case MapKind::pull:
    case MapKind::wave:
        return {at.x, lifted(map, at.y, lift(map, at.x, at.z)), at.z};
    case MapKind::knife:
    case MapKind::seam: {
        const double open = opening(map, at.y, at.z), w = map.half.x, far = std::abs(at.x);
        if (open <= 0 || far >= w)
            return at;
        return {std::copysign(open + far * (1 - open / w), at.x), at.y, at.z};
    }
    case MapKind::incision: {
        const OnPath<double> near = nearestOnPath(map.path, at.x, at.z);
        const double open = openingAlong(map, at.y, near.along), w = 0.5 * map.width;
        if (open <= 0 || near.far >= w)
            return at;
        const double share = 1 - open / w + open / near.far;
        return {near.x + share * (at.x - near.x), at.y, near.z + share * (at.z - near.z)};
    }
    case MapKind::peel: {
        const double ground = groundOf(map), r = map.radius;
        if (leftOfLine(map, at.x) || insideLayer(map, Point<double>{at.x, at.y, at.z}) <= 0)
            return at;
        const double angle = std::min((at.x - map.amount) / r, kRolled),
                     over = std::max(at.x - map.amount - r * kRolled, 0.0), from = r - (at.y - ground);
        return {map.amount + from * std::sin(angle) + over * std::cos(angle),
                ground + r - from * std::cos(angle) + over * std::sin(angle), at.z};
    }
    default:
        return at;
    }
}

double kept(const DeformationMap& map, const glm::dvec3& shown, double gap) {
    const double big = 2 * glm::length(map.half);
    const Point<double> q{shown.x, shown.y, shown.z};
    if (map.kind == MapKind::knife || map.kind == MapKind::seam)
        return std::abs(shown.x) - opening(map, shown.y, shown.z);
    if (map.kind == MapKind::incision) {
        const OnPath<double> at = nearestOnPath(map.path, q.x, q.z);
        return at.far - openingAlong(map, q.y, at.along);
    }
    if (map.kind == MapKind::sphere)
        return glm::length(shown) - map.radius;
    if (map.kind == MapKind::box) {
        const glm::dvec3 out = glm::abs(shown) - 0.5 * cutBox(map);
        return glm::length(glm::max(out, glm::dvec3(0))) + std::min(std::max({out.x, out.y, out.z}), 0.0);
    }
    if (map.kind != MapKind::peel)
        return big;
    const Unrolled<double> flap = unroll(map, q);
    const double onFlap = flap.any ? insideLayer(map, flap.rest) : -big;
    if (leftOfLine(map, shown.x)) // the layer that lies still, and above it what has rolled over
        return rolledOver(map, flap, 0.5 * map.radius) ? std::abs(onFlap) - gap : big;
    return std::max(onFlap, onGround(map, q));
}

double largestDisplacement(const DeformationMap& map, int samples) {
    double most = 0;
    for (int z = 0; z < samples; ++z)
        for (int y = 0; y < samples; ++y)
            for (int x = 0; x < samples; ++x) {
                const glm::dvec3 share = (2.0 * glm::dvec3(x, y, z) + 1.0) / double(samples) - 1.0;
                most = std::max(most, glm::length(inverseDisplacement(map, share * map.half)));
            }
    return most;
}

BoxFaces zeroFaces(const DeformationMap& map) {
    switch (map.kind) {
    case MapKind::twist:
    case MapKind::pull:
    case MapKind::wave:
        return {{true, true, true, false, true, true}};
    case MapKind::bend:
        return {{false, false, true, false, false, false}};
    case MapKind::knife:
        return {{true, true, map.depth <= 2 * map.half.y, false, map.extent <= 2 * map.half.z,
                 map.extent <= 2 * map.half.z}};
    case MapKind::seam:
        return {{true, true, map.depth <= 2 * map.half.y, false, map.extent <= 2 * map.half.z, false}};
    case MapKind::peel:
        return {{map.amount > -map.half.x, false, true, false, map.width <= 2 * map.half.z,
                 map.width <= 2 * map.half.z}};
    case MapKind::incision: {
        glm::dvec2 most(0);
        for (const glm::dvec2& at : map.path)
            most = glm::max(most, glm::abs(at));
        const bool x = most.x + 0.5 * map.width <= map.half.x, z = most.y + 0.5 * map.width <= map.half.z;
        return {{x, x, map.depth <= 2 * map.half.y, false, z, z}};
    }
    case MapKind::sphere:
    case MapKind::box: {
        const glm::dvec3 reach = map.kind == MapKind::sphere ? glm::dvec3(map.radius) : 0.5 * cutBox(map);
        const glm::bvec3 within = glm::lessThan(reach, map.half);
        return {{within.x, within.x, within.y, within.y, within.z, within.z}};
    }
    default:
        return {};
    }
}

} // namespace serosa::render
