// The inside's indicator along a line in x is the sum of the signs of the crossings at smaller x (+1 where
// the line enters). So a piece of surface whose signed yz-area is a and whose mean x is c fills its own cell
// [x0, x0+1] by a (x0 + 1 - c) and each cell at larger x by a. Each triangle is clipped to the cells it
// crosses; a running sum along each row of cells gives the fills, exact up to rounding for any closed surface
// (divergence theorem for the field (x, 0, 0)).
#include "sim/cell_fills.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace serosa::sim {

namespace {

/// A convex polygon: a triangle clipped by up to six planes has at most nine corners.
struct Polygon {
    std::array<glm::dvec3, 12> points;
    int size = 0;
    void push(const glm::dvec3& p) { points[std::size_t(size++)] = p; }
    const glm::dvec3& operator[](int i) const { return points[std::size_t(i)]; }
};

/// The part of `in` with coordinate `axis` at least (sign +1) or at most (sign -1) `limit`.
Polygon clip(const Polygon& in, int axis, double limit, double sign) {
    Polygon out;
    for (int i = 0; i < in.size; ++i) {
        const glm::dvec3& a = in[i];
        const glm::dvec3& b = in[i + 1 == in.size ? 0 : i + 1];
        const double da = sign * (a[axis] - limit), db = sign * (b[axis] - limit);
        if (da >= 0)
            out.push(a);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
            glm::dvec3 cut = a + (b - a) * (da / (da - db));
            cut[axis] = limit;
            out.push(cut);
        }
    }
    return out;
}

Polygon clipToSlab(const Polygon& in, int axis, int slab) {
    return clip(clip(in, axis, slab, 1), axis, slab + 1, -1);
}

/// First and last slab that a polygon touches along an axis, inside 0 .. count-1.
glm::ivec2 slabRange(const Polygon& polygon, int axis, int count) {
    double low = polygon[0][axis], high = low;
    for (int i = 1; i < polygon.size; ++i) {
        low = std::min(low, polygon[i][axis]);
        high = std::max(high, polygon[i][axis]);
    }
    const int first = std::clamp(int(std::floor(low)), 0, count - 1);
    return {first, std::clamp(int(std::ceil(high)) - 1, first, count - 1)};
}

} // namespace

CellGrid gridAround(const glm::dvec3& lowest, const glm::dvec3& highest, double spacing) {
    CellGrid grid;
    grid.spacing = spacing;
    const glm::dvec3 extent = highest - lowest;
    for (int axis = 0; axis < 3; ++axis)
        grid.dims[axis] = std::max(1, int(std::ceil(extent[axis] / spacing - 1e-6)));
    grid.origin = 0.5 * (lowest + highest) - 0.5 * spacing * glm::dvec3(grid.dims);
    return grid;
}

CellGrid gridThrough(const glm::dvec3& point, const glm::dvec3& lowest, const glm::dvec3& highest,
                     double spacing) {
    CellGrid grid;
    grid.spacing = spacing;
    const glm::dvec3 low = glm::floor((lowest - point) / spacing + 1e-6),
                     high = glm::ceil((highest - point) / spacing - 1e-6);
    grid.dims = glm::max(glm::ivec3(high - low), glm::ivec3(1));
    grid.origin = point + spacing * low;
    return grid;
}

std::vector<double> cellFills(const TriangleMesh& metres, const CellGrid& grid) {
    std::vector<double> fill(grid.count(), 0.0), beyond(grid.count(), 0.0);
    const glm::dvec3 top(grid.dims);
    for (const glm::uvec3& face : metres.faces) {
        Polygon triangle;
        for (int corner = 0; corner < 3; ++corner)
            triangle.push(glm::clamp((metres.positions[face[corner]] - grid.origin) / grid.spacing,
                                     glm::dvec3(0), top));
        const glm::dvec3 doubleArea = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
        if (doubleArea.x == 0)
            continue;
        const double sign =
            doubleArea.x < 0 ? 1 : -1; // entering along +x where the outward normal points to -x
        const glm::ivec2 zRange = slabRange(triangle, 2, grid.dims.z);
        for (int z = zRange.x; z <= zRange.y; ++z) {
            const Polygon inZ = zRange.x == zRange.y ? triangle : clipToSlab(triangle, 2, z);
            if (inZ.size < 3)
                continue;
            const glm::ivec2 yRange = slabRange(inZ, 1, grid.dims.y);
            for (int y = yRange.x; y <= yRange.y; ++y) {
                const Polygon inY = yRange.x == yRange.y ? inZ : clipToSlab(inZ, 1, y);
                if (inY.size < 3)
                    continue;
                const glm::ivec2 xRange = slabRange(inY, 0, grid.dims.x);
                for (int x = xRange.x; x <= xRange.y; ++x) {
                    const Polygon piece = xRange.x == xRange.y ? inY : clipToSlab(inY, 0, x);
                    double area = 0, moment = 0; // projected onto yz: of the piece, and of x over it
                    for (int i = 1; i + 1 < piece.size; ++i) {
                        const glm::dvec3 u = piece[i] - piece[0], v = piece[i + 1] - piece[0];
                        const double part = 0.5 * std::abs(u.y * v.z - u.z * v.y);
                        area += part;
                        moment += part * (piece[0].x + piece[i].x + piece[i + 1].x) / 3;
                    }
                    const std::size_t cell = grid.index(x, y, z);
                    fill[cell] += sign * (area * (x + 1) - moment);
                    beyond[cell] += sign * area;
                }
            }
        }
    }
    for (std::size_t row = 0; row < fill.size(); row += std::size_t(grid.dims.x)) {
        double inside = 0;
        for (std::size_t cell = row; cell < row + std::size_t(grid.dims.x); ++cell) {
            fill[cell] = std::clamp(fill[cell] + inside, 0.0, 1.0);
            inside += beyond[cell];
        }
    }
    return fill;
}

} // namespace serosa::sim
