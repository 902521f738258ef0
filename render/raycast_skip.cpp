// See render/raycast_skip.h.
#include "render/raycast_skip.h"

#include "render/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace serosa::render {

namespace {

constexpr int kReach = 3;           // texels of the coarsest axis, in which the wider bound holds
constexpr double kMostBound = 1000; // what a jump has: no skipping
constexpr double kEverywhere = 1e9; // m2: nothing is kept along this line

/// A grid of numbers, and work along its lines.
struct Grid {
    glm::ivec3 size;
    std::vector<float> values;

    std::size_t index(const glm::ivec3& at) const {
        return std::size_t(at.x) +
               std::size_t(size.x) * (std::size_t(at.y) + std::size_t(size.y) * std::size_t(at.z));
    }
    glm::ivec3 placeOf(std::size_t i) const {
        return {int(i % std::size_t(size.x)), int(i / std::size_t(size.x) % std::size_t(size.y)),
                int(i / std::size_t(size.x) / std::size_t(size.y))};
    }
    /// line(values of it): in and out.
    template <class Line>
    void along(int axis, const Line& line) {
        const int other = (axis + 1) % 3, third = (axis + 2) % 3;
        parallelFor(std::size_t(size[other]) * std::size_t(size[third]),
                    [&](std::size_t begin, std::size_t end) {
                        std::vector<double> one(std::size_t(size[axis]));
                        for (std::size_t i = begin; i < end; ++i) {
                            glm::ivec3 at(0);
                            at[other] = int(i % std::size_t(size[other]));
                            at[third] = int(i / std::size_t(size[other]));
                            for (at[axis] = 0; at[axis] < size[axis]; ++at[axis])
                                one[std::size_t(at[axis])] = values[index(at)];
                            line(one);
                            for (at[axis] = 0; at[axis] < size[axis]; ++at[axis])
                                values[index(at)] = float(one[std::size_t(at[axis])]);
                        }
                    });
    }
};

/// The largest within `reach` places.
void spread(std::vector<double>& line, int reach) {
    const std::vector<double> from = line;
    const int count = int(line.size());
    for (int i = 0; i < count; ++i)
        for (int k = std::max(i - reach, 0); k <= std::min(i + reach, count - 1); ++k)
            line[std::size_t(i)] = std::max(line[std::size_t(i)], from[std::size_t(k)]);
}

/// min over k of (step (i - k))^2 + line[k]: parabolas' lower envelope (Felzenszwalb & Huttenlocher 2012).
void nearest(std::vector<double>& line, double step) {
    const std::vector<double> from = line;
    const int count = int(line.size());
    std::vector<int> roots;
    std::vector<double> starts;
    for (int k = 0; k < count; ++k) {
        double start = -std::numeric_limits<double>::infinity();
        while (!roots.empty()) {
            const int last = roots.back();
            start = 0.5 * (k + last) +
                    (from[std::size_t(k)] - from[std::size_t(last)]) / (2.0 * step * step * (k - last));
            if (start > starts.back())
                break;
            roots.pop_back();
            starts.pop_back();
            start = -std::numeric_limits<double>::infinity();
        }
        roots.push_back(k);
        starts.push_back(start);
    }
    std::size_t piece = 0;
    for (int i = 0; i < count; ++i) {
        while (piece + 1 < roots.size() && starts[piece + 1] < i)
            ++piece;
        const double way = step * (i - roots[piece]);
        line[std::size_t(i)] = way * way + from[std::size_t(roots[piece])];
    }
}

} // namespace

double largestStretch(const glm::dmat3& map) {
    // Largest eigenvalue of a symmetric matrix in closed form (Smith 1961).
    const glm::dmat3 s = glm::transpose(map) * map;
    const double mean = (s[0][0] + s[1][1] + s[2][2]) / 3;
    const double off = s[1][0] * s[1][0] + s[2][0] * s[2][0] + s[2][1] * s[2][1];
    const glm::dvec3 d = glm::dvec3(s[0][0], s[1][1], s[2][2]) - mean;
    const double p = std::sqrt((glm::dot(d, d) + 2 * off) / 6);
    if (p < 1e-12 * mean)
        return std::sqrt(mean);
    const double r = 0.5 * glm::determinant((s - glm::dmat3(mean)) / p);
    return std::sqrt(mean + 2 * p * std::cos(std::acos(std::clamp(r, -1.0, 1.0)) / 3));
}

double leastStretch(const glm::dmat3& map) {
    return 1 / largestStretch(glm::inverse(map));
}

RaycastSkip RaycastSkip::of(const DeformationTexture& texture, double cylinderRadius) {
    const glm::ivec3 size = texture.size();
    const glm::dvec3 step = texture.texelSize();
    double coarsest = 0, diagonal2 = 0; // of the axes that are sampled at all: it is constant along others
    for (int axis = 0; axis < 3; ++axis)
        if (size[axis] > 1) {
            coarsest = std::max(coarsest, step[axis]);
            diagonal2 += step[axis] * step[axis];
        }
    Grid bounds{size, {}}, ways{size, {}};
    const std::size_t count = std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
    bounds.values.resize(count);
    ways.values.resize(count);
    std::vector<glm::dvec4> texels(count);
    parallelFor(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            texels[i] = texture.sample((glm::dvec3(bounds.placeOf(i)) + 0.5) * step - texture.half());
    });
    std::vector<float> slopes(count);
    parallelFor(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::ivec3 at = bounds.placeOf(i);
            glm::dvec4 slope[3][2]; // towards the lower and the higher texel of each axis
            double steepest = 0;
            for (int axis = 0; axis < 3; ++axis) {
                for (const int side : {0, 1}) {
                    glm::ivec3 to = at;
                    to[axis] = std::clamp(at[axis] + 2 * side - 1, 0, size[axis] - 1);
                    slope[axis][side] =
                        (2.0 * side - 1) * (texels[bounds.index(to)] - texels[i]) / step[axis];
                }
                const double most = std::max(std::abs(slope[axis][0].w), std::abs(slope[axis][1].w));
                steepest += most * most;
            }
            slopes[i] = float(std::sqrt(steepest));
            glm::dvec3 before(1), after(1); // what winding does to lengths at q and at q + D
            if (cylinderRadius > 0) {
                const double x = (at.x + 0.5) * step.x - texture.half().x;
                before.z = std::max(1 + x / cylinderRadius, 1e-6);
                after.z = std::max(1 + (x + texels[i].x) / cylinderRadius, 0.0);
            }
            double most = 0;
            for (int corner = 0; corner < 8; ++corner) {
                glm::dmat3 j(1);
                for (int axis = 0; axis < 3; ++axis) {
                    j[axis] += glm::dvec3(slope[axis][corner >> axis & 1]);
                    j[axis] = j[axis] * after / before[axis];
                }
                most = std::max(most, largestStretch(j));
            }
            bounds.values[i] = float(std::min(most, kMostBound));
            ways.values[i] = texels[i].w >= 0.5 ? 0 : float(kEverywhere);
        }
    });
    RaycastSkip made;
    made.nearReach = coarsest;
    made.reach = kReach * coarsest;
    made.maskSlope = std::max(double(*std::max_element(slopes.begin(), slopes.end())), 1e-6);
    Grid near = bounds;
    for (int axis = 0; axis < 3; ++axis)
        if (size[axis] > 1) {
            // A place lies up to half a texel from its nearest one, and a texel knows the cells up to one
            // away.
            const auto widen = [by = step[axis]](double reach) {
                return
                    [to = int(std::ceil(reach / by - 0.5))](std::vector<double>& line) { spread(line, to); };
            };
            near.along(axis, widen(made.nearReach));
            bounds.along(axis, widen(made.reach));
            ways.along(axis, [by = step[axis]](std::vector<double>& line) { nearest(line, by); });
        }
    // A place that is kept lies in a cell that has a kept corner, and the one that asks half of a cell's
    // diagonal from its texel.
    const double margin = 1.5 * std::sqrt(diagonal2);
    made.texels.resize(count);
    for (std::size_t i = 0; i < count; ++i)
        made.texels[i] = {near.values[i], bounds.values[i],
                          std::max(std::sqrt(ways.values[i]) - margin, 0.0)};
    return made;
}

} // namespace serosa::render
