#pragma once
// The cuts among the closed-form maps (render/deformation_map.h): knife, seam and incision, which open, and
// the box that is cut away. Templates over the number, as all of render/deformation_map.cpp.

#include "render/deformation_map.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace serosa::render {

template <class T>
struct Point {
    T x, y, z;
};

template <class T>
T radiusOf(const T& x, const T& z) {
    using std::sqrt;
    return sqrt(T(x * x + z * z + 1e-24)); // differentiable on the axis
}

/// Half of the opening of a knife's cut or a seam; negative: how far from opening, as a share of amount.
template <class T>
T opening(const DeformationMap& map, const T& y, const T& z) {
    const T down = 1.0 - (map.half.y - y) / map.depth;
    T along = z;
    if (map.kind == MapKind::knife)
        along = 1.0 - (2.0 * z / map.extent) * (2.0 * z / map.extent);
    else
        along = 1.0 - (map.half.z - z) / map.extent;
    const T both = down > 0.0 && along > 0.0 ? T(down * along) : (down < along ? down : along);
    return map.amount * both;
}

template <class T>
Point<T> closed(const DeformationMap& map, const Point<T>& shown) {
    const T open = opening(map, shown.y, shown.z);
    const double w = map.half.x;
    using std::abs;
    const T far = abs(shown.x);
    if (open <= 0.0 || far >= w)
        return shown;
    if (far <= open)
        return {T(0.0 * shown.x), shown.y, shown.z};
    const T rest = (far - open) * w / (w - open);
    return {shown.x < 0.0 ? T(-rest) : rest, shown.y, shown.z};
}

/// The place of a path that is nearest to a point.
template <class T>
struct OnPath {
    T x, z, far, along; // along: 0 where the path begins, 1 where it ends
};

template <class T>
OnPath<T> nearestOnPath(const std::vector<glm::dvec2>& path, const T& x, const T& z) {
    double whole = 0;
    for (std::size_t i = 1; i < path.size(); ++i)
        whole += glm::distance(path[i - 1], path[i]);
    OnPath<T> best{};
    bool any = false;
    double before = 0;
    for (std::size_t i = 1; i < path.size(); ++i) {
        const glm::dvec2 a = path[i - 1], by = path[i] - a;
        const double length = glm::length(by);
        T share = ((x - a.x) * by.x + (z - a.y) * by.y) / (length * length);
        share = share < 0.0 ? T(0.0 * share) : share > 1.0 ? T(1.0 + 0.0 * share) : share;
        const T nx = a.x + share * by.x, nz = a.y + share * by.y;
        const T far = radiusOf(T(x - nx), T(z - nz));
        if (!any || far < best.far)
            best = {nx, nz, far, T((before + share * length) / whole)};
        any = true;
        before += length;
    }
    return best;
}

/// Half of the opening of an incision: negative below it.
template <class T>
T openingAlong(const DeformationMap& map, const T& y, const T& along) {
    const T down = 1.0 - (map.half.y - y) / map.depth, lens = 4.0 * along * (1.0 - along);
    return map.amount * (down > 0.0 ? T(down * lens) : down);
}

template <class T>
Point<T> closedAlong(const DeformationMap& map, const Point<T>& shown) {
    const OnPath<T> at = nearestOnPath(map.path, shown.x, shown.z);
    const T open = openingAlong(map, shown.y, at.along);
    const double w = 0.5 * map.width;
    if (open <= 0.0 || at.far >= w)
        return shown;
    if (at.far <= open)
        return {at.x, shown.y, at.z};
    const T share = (at.far - open) * w / (w - open) / at.far;
    return {T(at.x + share * (shown.x - at.x)), shown.y, T(at.z + share * (shown.z - at.z))};
}

/// Lengths of the box that is cut away.
inline glm::dvec3 cutBox(const DeformationMap& map) {
    return {map.extent, map.depth, map.width};
}

} // namespace serosa::render
