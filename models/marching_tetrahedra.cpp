// Marching tetrahedra on the BCC lattice, which has the best-shaped tetrahedra that tile space (all alike,
// dihedral angles of 60 and 90 degrees; the lattice of Labelle & Shewchuk 2007, Isosurface stuffing,
// section 3.1). Values are computed only where the Lipschitz bound lets the surface pass; elsewhere a sign is
// enough.
#include "models/marching_tetrahedra.h"

#include "base/check.h"

#include <array>
#include <cstdint>
#include <unordered_map>

namespace serosa::models {
namespace {

constexpr double kFar = 1e9;
constexpr double kLipschitz = 1.15;

/// Grid of n cubes; each owns its lowest corner (kind 0) and its centre (kind 1).
class Lattice {
public:
    Lattice(const MeshSource& source, double cell)
        : source_(source), cell_(cell), origin_(source.lowest - 2.02 * cell),
          n_(glm::ivec3((source.highest - source.lowest) / cell) + 6) {
        value_.assign(2 * static_cast<std::size_t>(n_.x) * n_.y * n_.z, kFar);
        fill(glm::ivec3(0), n_);
    }
    glm::ivec3 cubes() const { return n_; }
    std::uint32_t index(const glm::ivec3& c, int kind) const {
        return static_cast<std::uint32_t>(2 * ((static_cast<std::size_t>(c.z) * n_.y + c.y) * n_.x + c.x) +
                                          kind);
    }
    double value(std::uint32_t i) const { return value_[i]; }
    Point at(std::uint32_t i) const {
        const std::uint32_t c = i / 2;
        const Point p(c % n_.x, c / n_.x % n_.y, c / n_.x / n_.y);
        return origin_ + cell_ * (p + (i % 2 ? 0.5 : 0.0));
    }

private:
    /// Halves the block [from, to) until it is small or the surface is too far to matter: then one sign
    /// serves all.
    void fill(const glm::ivec3& from, const glm::ivec3& to) {
        const glm::ivec3 extent = to - from;
        if (extent.x * extent.y * extent.z > 1) {
            const Point lo = origin_ + cell_ * Point(from), hi = origin_ + cell_ * (Point(to) - 0.5);
            const double d = source_.distance(0.5 * (lo + hi));
            if (std::abs(d) > kLipschitz * (0.5 * glm::length(hi - lo) + 1.01 * cell_)) {
                for (int z = from.z; z < to.z; ++z)
                    for (int y = from.y; y < to.y; ++y)
                        for (int x = from.x; x < to.x; ++x)
                            for (int kind = 0; kind < 2; ++kind)
                                value_[index({x, y, z}, kind)] = d < 0 ? -kFar : kFar;
                return;
            }
            const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
            glm::ivec3 middle = to, start = from;
            middle[axis] = start[axis] = from[axis] + extent[axis] / 2;
            fill(from, middle);
            fill(start, to);
            return;
        }
        for (int kind = 0; kind < 2; ++kind) {
            const std::uint32_t i = index(from, kind);
            value_[i] = source_.distance(at(i));
        }
    }

    const MeshSource& source_;
    double cell_;
    Point origin_;
    glm::ivec3 n_;
    std::vector<double> value_;
};

class Marcher {
public:
    Marcher(const Lattice& lattice, const MeshSource& source) : lattice_(lattice), source_(source) {}

    sim::TriangleMesh run() {
        const glm::ivec3 n = lattice_.cubes();
        for (int z = 1; z + 1 < n.z; ++z)
            for (int y = 1; y + 1 < n.y; ++y)
                for (int x = 1; x + 1 < n.x; ++x)
                    for (int axis = 0; axis < 3; ++axis)
                        pair({x, y, z}, axis);
        return std::move(mesh_);
    }

private:
    /// The four tetrahedra around the link of two neighbouring cube centres, one for each edge of the shared
    /// face.
    void pair(const glm::ivec3& c, int axis) {
        glm::ivec3 next = c, u(0), v(0);
        ++next[axis];
        u[(axis + 1) % 3] = 1;
        v[(axis + 2) % 3] = 1;
        const std::uint32_t low = lattice_.index(c, 1), high = lattice_.index(next, 1);
        const std::array<std::uint32_t, 4> ring = {lattice_.index(next, 0), lattice_.index(next + u, 0),
                                                   lattice_.index(next + u + v, 0),
                                                   lattice_.index(next + v, 0)};
        for (int k = 0; k < 4; ++k)
            tetrahedron({low, high, ring[k], ring[(k + 1) % 4]}); // positively oriented
    }

    void tetrahedron(const std::array<std::uint32_t, 4>& t) {
        int inside = 0;
        for (int i = 0; i < 4; ++i)
            inside += lattice_.value(t[i]) < 0;
        if (inside == 0 || inside == 4)
            return;
        // Even permutations that bring the odd corner (or the first inside pair) to the front keep the
        // orientation.
        static constexpr int even[12][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 0, 3, 2},
                                            {1, 3, 2, 0}, {1, 2, 0, 3}, {2, 0, 1, 3}, {2, 1, 3, 0},
                                            {2, 3, 0, 1}, {3, 0, 2, 1}, {3, 2, 1, 0}, {3, 1, 0, 2}};
        const auto in = [&](int i) { return lattice_.value(t[i]) < 0; };
        for (const auto& p : even) {
            const std::uint32_t a = t[p[0]], b = t[p[1]], c = t[p[2]], d = t[p[3]];
            if (inside == 1 && in(p[0])) {
                face(cut(a, b), cut(a, c), cut(a, d));
                return;
            }
            if (inside == 3 && !in(p[0])) {
                face(cut(a, b), cut(a, d), cut(a, c));
                return;
            }
            if (inside == 2 && in(p[0]) && in(p[1])) {
                const std::uint32_t ac = cut(a, c), ad = cut(a, d), bd = cut(b, d), bc = cut(b, c);
                const auto& q = mesh_.positions;
                if (glm::length(q[ac] - q[bd]) <= glm::length(q[ad] - q[bc])) {
                    face(ac, ad, bd);
                    face(ac, bd, bc);
                } else {
                    face(ad, bd, bc);
                    face(ad, bc, ac);
                }
                return;
            }
        }
    }

    void face(std::uint32_t a, std::uint32_t b, std::uint32_t c) { mesh_.faces.push_back({a, b, c}); }

    /// The vertex of a cut edge, made on first use: a few steps of the Illinois method. The map is only
    /// looked up, never walked, so its order cannot show.
    std::uint32_t cut(std::uint32_t a, std::uint32_t b) {
        if (a > b)
            std::swap(a, b);
        const std::uint64_t key = static_cast<std::uint64_t>(a) << 32 | b;
        const auto [entry, isNew] =
            vertices_.try_emplace(key, static_cast<std::uint32_t>(mesh_.positions.size()));
        if (isNew) {
            const Point p = lattice_.at(a), q = lattice_.at(b);
            double lo = 0, hi = 1, flo = lattice_.value(a), fhi = lattice_.value(b), t = 0.5;
            for (int step = 0; step < 4; ++step) {
                t = lo + (hi - lo) * flo / (flo - fhi);
                const double f = source_.distance(p + t * (q - p));
                if (std::abs(f) < 1e-4)
                    break;
                if ((f < 0) == (flo < 0)) {
                    lo = t, flo = f, fhi *= 0.5;
                } else {
                    hi = t, fhi = f, flo *= 0.5;
                }
            }
            mesh_.positions.push_back(p + std::clamp(t, 0.02, 0.98) * (q - p));
        }
        return entry->second;
    }

    const Lattice& lattice_;
    const MeshSource& source_;
    sim::TriangleMesh mesh_;
    std::unordered_map<std::uint64_t, std::uint32_t> vertices_;
};

} // namespace

double latticePoints(const MeshSource& source, double cell) {
    const Point n = (source.highest - source.lowest) / cell + 6.0;
    return 2 * n.x * n.y * n.z;
}

sim::TriangleMesh marchTetrahedra(const MeshSource& source, double cell) {
    const Lattice lattice(source, cell);
    return Marcher(lattice, source).run();
}

} // namespace serosa::models
