// The shapes of sdf.h that need more than a line.
#include "models/sdf.h"

#include <cstdint>

namespace serosa::models {

double ellipsoid(const Point& p, const Point& e, double reach) {
    const double away = glm::length(p) - std::max({e.x, e.y, e.z});
    if (away > reach)
        return away; // a lower bound is enough
    const Point y = glm::max(glm::abs(p), 1e-9);
    const Point e2 = e * e, ey = e * y;
    double t = std::max({ey.x - e2.x, ey.y - e2.y, ey.z - e2.z});
    for (int step = 0; step < 60; ++step) {
        const Point r = ey / (e2 + t);
        const Point r2 = r * r;
        const double f = r2.x + r2.y + r2.z - 1;
        const Point slope = r2 / (e2 + t);
        if (f < 1e-13) // not a short step: those are short beside the pole at t = -e^2 too
            break;
        t += f / (2 * (slope.x + slope.y + slope.z));
    }
    const Point closest = e2 * y / (e2 + t);
    const double distance = glm::length(closest - y);
    return t < 0 ? -distance : distance;
}

namespace {

double latticeValue(std::int64_t x, std::int64_t y, std::int64_t z) {
    std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ull ^
                      static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4Full ^
                      static_cast<std::uint64_t>(z) * 0x165667B19E3779F9ull;
    h ^= h >> 29;
    h *= 0xBF58476D1CE4E5B9ull;
    h ^= h >> 32;
    return static_cast<double>(h >> 11) * 0x1.0p-52 - 1.0;
}

} // namespace

double noise(const Point& p) {
    const Point base = glm::floor(p);
    const Point f = p - base;
    const Point s = f * f * (3.0 - 2.0 * f);
    const auto x = static_cast<std::int64_t>(base.x), y = static_cast<std::int64_t>(base.y),
               z = static_cast<std::int64_t>(base.z);
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const int cx = corner & 1, cy = corner >> 1 & 1, cz = corner >> 2;
        sum += (cx ? s.x : 1 - s.x) * (cy ? s.y : 1 - s.y) * (cz ? s.z : 1 - s.z) *
               latticeValue(x + cx, y + cy, z + cz);
    }
    return sum;
}

double layeredNoise(const Point& p, int octaves) {
    double sum = 0, height = 1, most = 0;
    for (int i = 0; i < octaves; ++i, height *= 0.5) {
        sum += height * noise(p / height + 17.0 * i);
        most += height;
    }
    return sum / most;
}

Cells cells(const Point& p, double jitter) {
    const Point base = glm::floor(p);
    Cells found{1e9, 1e9, 0};
    for (int dz = -1; dz <= 1; ++dz)
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const Point cube = base + Point(dx, dy, dz);
                const auto x = static_cast<std::int64_t>(cube.x), y = static_cast<std::int64_t>(cube.y),
                           z = static_cast<std::int64_t>(cube.z);
                const Point shift(latticeValue(x, y, z), latticeValue(x + 7919, y, z),
                                  latticeValue(x, y + 7919, z));
                const double d = glm::length(cube + 0.5 + 0.5 * jitter * shift - p);
                if (d < found.nearest) {
                    found = {d, found.nearest, 0.5 + 0.5 * latticeValue(x, y, z + 7919)};
                } else {
                    found.second = std::min(found.second, d);
                }
            }
    return found;
}

} // namespace serosa::models
