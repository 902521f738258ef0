// See render/node_frames.h. Rotation of F: Horn 1987, Closed-form solution of absolute orientation using unit
// quaternions, J. Opt. Soc. Am. A 4, 629.
#include "render/node_frames.h"

#include "base/check.h"
#include "shaders/mapping_constants.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace serosa::render {

namespace {

constexpr std::uint32_t kOffset = 0x100000; // of 21 bits
constexpr double kFlat = 0.02; // least eigenvalue of the neighbours' spread over the largest: below, they
                               // have no extent that way (on the lattice it is 0, or 0.08 at least)

/// Vectors g_j with sum_j d_j g_j^T = 1 on the span of the neighbours' offsets d_j; empty where that is less
/// than a plane.
std::vector<glm::vec3> gradients(const std::vector<glm::dvec3>& offsets) {
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const glm::dvec3& d : offsets) {
        const Eigen::Vector3d v(d.x, d.y, d.z);
        spread += v * v.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread); // rising eigenvalues
    const Eigen::Vector3d values = solver.eigenvalues();
    if (!(values[1] > kFlat * values[2]))
        return {};
    std::vector<glm::vec3> result;
    for (const glm::dvec3& d : offsets) {
        Eigen::Vector3d g = Eigen::Vector3d::Zero();
        for (int k = 0; k < 3; ++k)
            if (values[k] > kFlat * values[2])
                g += solver.eigenvectors().col(k) *
                     (solver.eigenvectors().col(k).dot(Eigen::Vector3d(d.x, d.y, d.z)) / values[k]);
        result.emplace_back(g.x(), g.y(), g.z());
    }
    return result;
}

/// The terms of a node's F; empty where its neighbours span less than a plane.
std::vector<FrameStencil::Term> termsOf(const sim::Lattice& lattice, const std::vector<std::uint32_t>& bits,
                                        std::uint32_t node) {
    std::vector<glm::dvec3> offsets;
    std::vector<FrameStencil::Term> terms;
    for (int d = 0; d < int(sim::kNeighbourOffsets.size()); ++d)
        if (const std::int64_t other = lattice.neighbour(node, d); other >= 0 && (bits[node] >> d) & 1U) {
            offsets.emplace_back(sim::kNeighbourOffsets[std::size_t(d)]);
            terms.push_back({std::uint32_t(other), {}});
        }
    const std::vector<glm::vec3> g = gradients(offsets);
    terms.resize(g.size());
    for (std::size_t i = 0; i < g.size(); ++i)
        terms[i].gradient = g[i];
    return terms;
}

/// The nearest node at rest whose neighbours give a rotation; the node itself if there is none.
std::uint32_t nearestJoined(const sim::Lattice& lattice, const std::vector<std::uint32_t>& bits,
                            std::uint32_t node) {
    const glm::ivec3 at = lattice.nodes[node];
    std::uint32_t best = node;
    int nearest2 = std::numeric_limits<int>::max();
    const int most = std::max({lattice.nodeDims.x, lattice.nodeDims.y, lattice.nodeDims.z});
    for (int reach = 1; reach <= most && nearest2 > reach * reach; ++reach)
        for (int z = -reach; z <= reach; ++z)
            for (int y = -reach; y <= reach; ++y)
                for (int x = -reach; x <= reach; ++x) {
                    const int d2 = x * x + y * y + z * z;
                    if (std::max({std::abs(x), std::abs(y), std::abs(z)}) != reach || d2 > nearest2)
                        continue;
                    const std::int64_t other = lattice.nodeAt(at + glm::ivec3(x, y, z));
                    if (other < 0 || (d2 == nearest2 && std::uint32_t(other) > best) ||
                        termsOf(lattice, bits, std::uint32_t(other)).empty())
                        continue;
                    best = std::uint32_t(other);
                    nearest2 = d2;
                }
    return best;
}

} // namespace

glm::uvec2 packFrame(const glm::dquat& rotation) {
    const glm::dvec3 axis = rotation.w < 0 ? glm::dvec3(-rotation.x, -rotation.y, -rotation.z)
                                           : glm::dvec3(rotation.x, rotation.y, rotation.z);
    const glm::dvec3 m = axis / (1 + std::abs(rotation.w)) * SRS_FRAME_HALF_STEPS;
    const glm::uvec3 s = glm::uvec3(glm::ivec3(glm::floor(m + 0.5)) + int(kOffset));
    return {s.x | (s.z & 0x7ffU) << 21, s.y | s.z >> 11 << 21};
}

glm::dquat unpackFrame(const glm::uvec2& bits) {
    const glm::uvec3 s(bits.x & 0x1fffffU, bits.y & 0x1fffffU, bits.x >> 21 | (bits.y >> 21) << 11);
    const glm::dvec3 m = (glm::dvec3(s) - double(kOffset)) / SRS_FRAME_HALF_STEPS;
    const double s2 = glm::dot(m, m), scale = 1 / (1 + s2);
    return {(1 - s2) * scale, 2 * scale * m.x, 2 * scale * m.y, 2 * scale * m.z};
}

glm::dquat rotationOf(const glm::dmat3& f) {
    const double shift = std::sqrt((glm::dot(f[0], f[0]) + glm::dot(f[1], f[1]) + glm::dot(f[2], f[2])) / 3);
    if (shift < 1e-6)
        return {1, 0, 0, 0};
    const glm::dvec3 anti(f[1][2] - f[2][1], f[2][0] - f[0][2], f[0][1] - f[1][0]);
    const double xy = f[0][1] + f[1][0], xz = f[0][2] + f[2][0], yz = f[1][2] + f[2][1];
    const double xx = f[0][0], yy = f[1][1], zz = f[2][2];
    glm::dmat4 m(xx - yy - zz + shift, xy, xz, anti.x, //
                 xy, yy - xx - zz + shift, yz, anti.y, //
                 xz, yz, zz - xx - yy + shift, anti.z, //
                 anti.x, anti.y, anti.z, xx + yy + zz + shift);
    for (int i = 0; i < SRS_FRAME_SQUARINGS; ++i) {
        m = m * m;
        m *= 1 / (m[0][0] + m[1][1] + m[2][2] + m[3][3]);
    }
    int best = 0;
    for (int i = 1; i < 4; ++i)
        if (m[i][i] > m[best][best])
            best = i;
    const glm::dvec4 q = glm::normalize(m[best]);
    return {q.w, q.x, q.y, q.z};
}

FrameStencil frameStencil(const sim::Lattice& lattice, const std::vector<std::uint32_t>& connections) {
    SEROSA_CHECK(connections.empty() || connections.size() == lattice.nodeCount(),
                 "connections of all nodes");
    const std::vector<std::uint32_t>& bits = connections.empty() ? lattice.connections : connections;
    FrameStencil stencil;
    stencil.nodes = lattice.nodeCount();
    std::vector<bool> onBoundary(lattice.nodeCount());
    for (const glm::uvec3& triangle : lattice.boundary)
        for (int i = 0; i < 3; ++i)
            onBoundary[triangle[i]] = true;
    for (std::uint32_t node = 0; node < lattice.nodeCount(); ++node) {
        if (!onBoundary[node])
            continue;
        std::uint32_t centre = node;
        std::vector<FrameStencil::Term> terms = termsOf(lattice, bits, centre);
        if (terms.empty()) {
            centre = nearestJoined(lattice, bits, node);
            terms = termsOf(lattice, bits, centre);
        }
        stencil.rows.push_back(
            {node, centre, std::uint32_t(stencil.terms.size()), std::uint32_t(terms.size())});
        stencil.terms.insert(stencil.terms.end(), terms.begin(), terms.end());
    }
    return stencil;
}

FrameStencil frameStencil(const ControlNodes& nodes) {
    FrameStencil stencil;
    stencil.nodes = nodes.count();
    for (std::uint32_t node = 0; node < nodes.count(); ++node) {
        std::vector<glm::dvec3> offsets;
        const std::uint32_t begin = nodes.neighbourBegin[node], end = nodes.neighbourBegin[node + 1];
        for (std::uint32_t i = begin; i < end; ++i)
            offsets.push_back(nodes.rest[nodes.neighbours[i]] - nodes.rest[node]);
        const std::vector<glm::vec3> g = gradients(offsets);
        stencil.rows.push_back({node, node, std::uint32_t(stencil.terms.size()), std::uint32_t(g.size())});
        for (std::size_t i = 0; i < g.size(); ++i)
            stencil.terms.push_back({nodes.neighbours[begin + i], g[i]});
    }
    return stencil;
}

std::vector<glm::uvec2> nodeFrames(const FrameStencil& stencil, const std::vector<glm::dvec3>& positions) {
    SEROSA_CHECK(positions.size() == stencil.nodes, "positions of all nodes");
    std::vector<glm::uvec2> frames(stencil.nodes, packFrame({1, 0, 0, 0}));
    for (const FrameStencil::Row& row : stencil.rows) {
        glm::dmat3 f(0);
        for (std::uint32_t i = row.begin; i < row.begin + row.count; ++i) {
            const FrameStencil::Term& term = stencil.terms[i];
            f += glm::outerProduct(positions[term.node] - positions[row.centre], glm::dvec3(term.gradient));
        }
        frames[row.node] = packFrame(rotationOf(f));
    }
    return frames;
}

glm::dquat blendFrames(const glm::dquat& a, const glm::dquat& b, const glm::dquat& c, const glm::dvec3& w) {
    const glm::dquat& heaviest = w.x >= w.y && w.x >= w.z ? a : w.y >= w.z ? b : c;
    const auto part = [&heaviest](const glm::dquat& q, double weight) {
        return q * (glm::dot(q, heaviest) < 0 ? -weight : weight);
    };
    return glm::normalize(part(a, w.x) + part(b, w.y) + part(c, w.z));
}

} // namespace serosa::render
