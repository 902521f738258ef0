// See sim/pair_contact_skin.h.
#include "sim/pair_contact_skin.h"

#include "base/check.h"
#include "shaders/shared_constants.h"
#include "sim/cell_volumes.h"
#include "sim/node_depths.h"
#include "sim/pieces.h"
#include "sim/tissue_field.h"
#include "sim/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

namespace serosa::sim {

namespace {

constexpr double kThickest = 4; // spacings: more is as good as this

glm::dvec3 unit(const glm::dvec3& v, const glm::dvec3& otherwise) {
    const double length = glm::length(v);
    return length > 1e-9 ? v / length : otherwise;
}

/// The skin of one organ at rest, in lattice units.
struct RestSkin {
    std::vector<std::uint32_t> nodes;  // ascending
    std::vector<glm::uvec3> triangles; // over `nodes`
    std::vector<glm::dvec3> normals, points;
    std::vector<double> depths, thickness, flatness;
};

/// Sums of a value over each triangle, at its three nodes.
template <class Value>
std::vector<glm::dvec3> gather(const RestSkin& skin, const Value& value) {
    std::vector<glm::dvec3> sums(skin.nodes.size(), glm::dvec3(0));
    for (const glm::uvec3& t : skin.triangles) {
        const glm::dvec3 v = value(t);
        for (int corner = 0; corner < 3; ++corner)
            sums[t[corner]] += v;
    }
    return sums;
}

glm::dvec3 areaNormal(const std::vector<glm::dvec3>& points, const glm::uvec3& t) {
    return glm::cross(points[t.y] - points[t.x], points[t.z] - points[t.x]);
}

/// Normals of the stairs, smoothed over neighbours, then twice those of the skin that they make: where its
/// triangles vanish (the rise of a stair) the old ones stay.
void findNormals(RestSkin& skin, const std::vector<glm::dvec3>& lattice) {
    constexpr int kRounds = 2;
    constexpr double kKeep = 0.3; // of the old direction beside the areas, spacings^2
    const std::vector<glm::dvec3> stairs =
        gather(skin, [&](const glm::uvec3& t) { return areaNormal(lattice, t); });
    const std::vector<glm::dvec3> smooth =
        gather(skin, [&](const glm::uvec3& t) { return stairs[t.x] + stairs[t.y] + stairs[t.z]; });
    skin.points = lattice;
    for (std::size_t i = 0; i < skin.nodes.size(); ++i)
        skin.normals.push_back(unit(smooth[i], unit(stairs[i], glm::dvec3(0, 1, 0))));
    for (int round = 0; round <= kRounds; ++round) {
        for (std::size_t i = 0; i < skin.nodes.size(); ++i)
            skin.points[i] = lattice[i] + skin.depths[i] * skin.normals[i];
        const std::vector<glm::dvec3> areas =
            gather(skin, [&](const glm::uvec3& t) { return areaNormal(skin.points, t); });
        if (round == kRounds) {
            const std::vector<glm::dvec3> sizes = gather(skin, [&](const glm::uvec3& t) {
                return glm::dvec3(glm::length(areaNormal(skin.points, t)), 0, 0);
            });
            for (std::size_t i = 0; i < skin.nodes.size(); ++i) {
                const double even = std::min(1.0, glm::length(areas[i]) / std::max(sizes[i].x, 1e-9));
                skin.flatness.push_back(1 / ((1.01 - even) * (1.01 - even)));
            }
            break;
        }
        for (std::size_t i = 0; i < skin.nodes.size(); ++i)
            skin.normals[i] = unit(areas[i] + kKeep * skin.normals[i], skin.normals[i]);
    }
}

/// How far below each node of the skin the organ ends.
void findThickness(RestSkin& skin) {
    constexpr double kBeyond = 0.02; // spacings: the triangles around the node itself
    const TriangleTree tree(skin.points, skin.triangles);
    skin.thickness.assign(skin.nodes.size(), kThickest);
    for (std::size_t i = 0; i < skin.nodes.size(); ++i)
        tree.allHits(skin.points[i], -skin.normals[i], kThickest, [&](const TriangleTree::Hit& hit) {
            if (!hit.front && hit.t > kBeyond)
                skin.thickness[i] = std::min(skin.thickness[i], hit.t);
        });
}

/// Bits of the three coordinates, in turn: near points have near codes, mostly.
std::uint64_t mortonCode(const glm::dvec3& point) {
    std::uint64_t code = 0;
    const glm::dvec3 cell = glm::clamp(glm::floor(point * 2.0) + 1048576.0, 0.0, 2097151.0);
    const std::uint64_t x = std::uint64_t(cell.x), y = std::uint64_t(cell.y), z = std::uint64_t(cell.z);
    for (int bit = 0; bit < 21; ++bit)
        code |=
            (x >> bit & 1) << (3 * bit) | (y >> bit & 1) << (3 * bit + 1) | (z >> bit & 1) << (3 * bit + 2);
    return code;
}

/// The cells that carry the skin, one flag a cell: those filled at least half as much as any around them.
std::vector<bool> carryingCells(const Lattice& lattice) {
    std::vector<std::uint8_t> most(lattice.nodeCount()); // fill around a node
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        most[node] = *std::max_element(lattice.fills[node].begin(), lattice.fills[node].end());
    std::vector<bool> flags;
    for (const LatticeCell& cell : lattice.cells) {
        int around = 0;
        for (const std::uint32_t corner : cornersOf(lattice, cell))
            around = std::max<int>(around, most[corner]);
        flags.push_back(2 * cell.fill >= around);
    }
    return flags;
}

RestSkin restSkin(const Lattice& lattice, const std::vector<std::uint32_t>& connections) {
    RestSkin skin;
    std::vector<bool> cells = carryingCells(lattice);
    std::vector<bool> outer(lattice.nodeCount(), false);
    std::vector<glm::uvec3> boundary = boundaryOf(lattice, cells);
    for (const glm::uvec3& t : boundary)
        for (int corner = 0; corner < 3; ++corner)
            outer[t[corner]] = true;
    if (!connections.empty()) {
        const std::vector<bool> whole = wholeCells(lattice, connections);
        for (std::size_t i = 0; i < cells.size(); ++i)
            cells[i] = cells[i] && whole[i];
        boundary = boundaryOf(lattice, cells);
    }
    std::vector<std::int32_t> place(lattice.nodeCount(), -1);
    for (const glm::uvec3& t : boundary)
        for (int corner = 0; corner < 3; ++corner)
            place[t[corner]] = 0;
    std::vector<glm::dvec3> points;
    for (std::uint32_t node = 0; node < lattice.nodeCount(); ++node) {
        if (place[node] < 0)
            continue;
        place[node] = std::int32_t(skin.nodes.size());
        skin.nodes.push_back(node);
        points.push_back(lattice.restPosition(node));
        // A cut lays bare nodes themselves.
        skin.depths.push_back(outer[node] ? depthOfContact(lattice.restDepth(node)) : 0);
    }
    std::vector<std::pair<std::uint64_t, std::size_t>> order;
    for (std::size_t i = 0; i < boundary.size(); ++i) {
        const glm::uvec3& t = boundary[i];
        order.emplace_back(
            mortonCode((lattice.restPosition(t.x) + lattice.restPosition(t.y) + lattice.restPosition(t.z)) /
                       3.0),
            i);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [code, i] : order)
        skin.triangles.emplace_back(place[boundary[i].x], place[boundary[i].y], place[boundary[i].z]);
    findNormals(skin, points);
    findThickness(skin);
    return skin;
}

/// Adds the nodes of the skin within reach of each of its nodes along the springs (Dijkstra).
void addNear(const Lattice& lattice, const std::vector<std::uint32_t>& connections, const RestSkin& skin,
             std::uint32_t firstNode, CoupledGroup& group) {
    std::vector<std::int32_t> place(lattice.nodeCount(), -1);
    for (std::size_t i = 0; i < skin.nodes.size(); ++i)
        place[skin.nodes[i]] = std::int32_t(i);
    constexpr double kFar = std::numeric_limits<double>::infinity();
    std::vector<double> distance(lattice.nodeCount(), kFar);
    std::vector<std::uint32_t> reached;
    using Entry = std::pair<double, std::uint32_t>;
    for (const std::uint32_t start : skin.nodes) {
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
        distance[start] = 0;
        reached.assign(1, start);
        open.emplace(0, start);
        while (!open.empty()) {
            const auto [so, node] = open.top();
            open.pop();
            for (int d = 0; d < SRS_NEIGHBOURS && so == distance[node]; ++d) {
                if (!(connections[node] >> d & 1u))
                    continue;
                const auto other = std::uint32_t(lattice.neighbour(node, d));
                const double there = so + (d < 6 ? 1.0 : std::sqrt(2.0));
                if (there > SRS_SELF_REACH + 1e-9 || there >= distance[other])
                    continue;
                if (distance[other] == kFar)
                    reached.push_back(other);
                distance[other] = there;
                open.emplace(there, other);
            }
        }
        std::sort(reached.begin(), reached.end());
        for (const std::uint32_t node : reached) {
            distance[node] = kFar;
            if (place[node] >= 0)
                group.near.push_back(firstNode + std::uint32_t(place[node]));
        }
        group.nearFirst.push_back(std::uint32_t(group.near.size()));
    }
}

void addOrgan(const CoupledMember& member, const glm::dvec3& origin, CoupledGroup& group) {
    const SolverSetup& setup = *member.setup;
    const Lattice& lattice = *setup.lattice;
    const std::vector<std::uint32_t>& connections =
        member.connections.empty() ? lattice.connections : member.connections;
    CoupledOrgan organ;
    organ.lattice = &lattice;
    organ.scale = lattice.spacing / group.length;
    organ.shift = (lattice.origin - origin) / group.length;
    organ.touches = member.touches;
    organ.touchesItself = member.touchesItself;
    organ.firstNode = std::uint32_t(group.nodeCount());
    organ.firstTriangle = std::uint32_t(group.triangles.size());

    const RestSkin skin =
        member.touches || member.touchesItself ? restSkin(lattice, member.connections) : RestSkin();
    // The skin's nodes, then others: of the caller, and neighbours along the axes.
    std::vector<std::int32_t> number(lattice.nodeCount(), -1);
    std::vector<std::uint32_t> rest;
    for (std::size_t i = 0; i < skin.nodes.size(); ++i)
        number[skin.nodes[i]] = std::int32_t(organ.firstNode + i);
    const auto take = [&](std::uint32_t node) {
        if (number[node] == -1) {
            number[node] = -2;
            rest.push_back(node);
        }
    };
    for (const std::uint32_t node : member.others)
        take(node);
    for (const std::uint32_t node : skin.nodes)
        for (int d = 0; d < 6; ++d)
            if (connections[node] >> d & 1u)
                take(std::uint32_t(lattice.neighbour(node, d)));
    std::sort(rest.begin(), rest.end());
    for (std::size_t i = 0; i < rest.size(); ++i)
        number[rest[i]] = std::int32_t(organ.firstNode + skin.nodes.size() + i);
    organ.skinNodes = std::uint32_t(skin.nodes.size());
    organ.nodes = std::uint32_t(skin.nodes.size() + rest.size());

    const TissueField field(lattice, setup.tissue);
    const double mass = setup.tissue.nodeMass(lattice.spacing) / group.mass;
    std::vector<std::uint32_t> all = skin.nodes;
    all.insert(all.end(), rest.begin(), rest.end());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::uint32_t node = all[i];
        const bool fixed = !setup.fixed.empty() && setup.fixed[node], ofSkin = i < skin.nodes.size();
        group.latticeNode.push_back(node);
        group.organOf.push_back(std::uint32_t(group.organs.size()));
        group.inverseMass.push_back(fixed ? 0 : 1 / (mass * field.massShare(node)));
        group.restNormal.push_back(ofSkin ? skin.normals[i] : glm::dvec3(0));
        group.depth.push_back(ofSkin ? organ.scale * skin.depths[i] : 0);
        group.thickness.push_back(ofSkin ? organ.scale * skin.thickness[i] : 0);
        group.flatness.push_back(ofSkin ? skin.flatness[i] : 0);
        std::array<std::int32_t, 6> beside{-1, -1, -1, -1, -1, -1};
        for (int d = 0; d < 6 && ofSkin; ++d)
            if (connections[node] >> d & 1u)
                beside[std::size_t(d)] = number[std::size_t(lattice.neighbour(node, d))];
        group.beside.push_back(beside);
    }
    if (member.touchesItself)
        addNear(lattice, connections, skin, organ.firstNode, group);
    group.nearFirst.resize(group.nodeCount() + 1, std::uint32_t(group.near.size()));

    for (const glm::uvec3& t : skin.triangles)
        group.triangles.push_back(t + organ.firstNode);
    organ.triangles = std::uint32_t(skin.triangles.size());
    group.organs.push_back(organ);
}

} // namespace

std::int64_t CoupledGroup::find(std::size_t organ, std::uint32_t node) const {
    const CoupledOrgan& o = organs[organ];
    const auto begin = latticeNode.begin() + o.firstNode, skinEnd = begin + o.skinNodes,
               end = begin + o.nodes;
    for (const auto& [from, to] : {std::pair(begin, skinEnd), std::pair(skinEnd, end)})
        if (const auto at = std::lower_bound(from, to, node); at != to && *at == node)
            return at - latticeNode.begin();
    return -1;
}

CoupledGroup coupleOrgans(const std::vector<CoupledMember>& members) {
    SEROSA_CHECK(!members.empty(), "organs to couple");
    CoupledGroup group;
    group.length = group.mass = 0;
    for (const CoupledMember& member : members) {
        const double spacing = member.setup->lattice->spacing;
        group.length = std::max(group.length, spacing);
        group.mass = std::max(group.mass, member.setup->tissue.nodeMass(spacing));
    }
    group.organs.reserve(members.size());
    group.nearFirst.push_back(0);
    for (const CoupledMember& member : members)
        addOrgan(member, members.front().setup->lattice->origin, group);
    return group;
}

void placeSkin(const CoupledGroup& group, const std::vector<glm::dvec3>& positions,
               std::vector<glm::dvec3>& offsets, std::vector<glm::dvec3>& normals) {
    offsets.assign(group.nodeCount(), glm::dvec3(0));
    normals.assign(group.nodeCount(), glm::dvec3(0));
    for (const CoupledOrgan& organ : group.organs)
        for (std::size_t i = organ.firstNode; i < organ.firstNode + organ.skinNodes; ++i) {
            const glm::dvec3& rest = group.restNormal[i];
            const std::array<std::int32_t, 6>& beside = group.beside[i];
            glm::dmat3 columns(1); // the deformation gradient
            for (int axis = 0; axis < 3; ++axis) {
                const std::int32_t up = beside[std::size_t(2 * axis)],
                                   down = beside[std::size_t(2 * axis + 1)];
                const double spacings = (up >= 0 ? 1 : 0) + (down >= 0 ? 1 : 0);
                if (spacings > 0)
                    columns[axis] = (positions[up >= 0 ? std::size_t(up) : i] -
                                     positions[down >= 0 ? std::size_t(down) : i]) /
                                    (spacings * organ.scale);
            }
            const glm::dvec3 moved = rest.x * glm::cross(columns[1], columns[2]) +
                                     rest.y * glm::cross(columns[2], columns[0]) +
                                     rest.z * glm::cross(columns[0], columns[1]);
            normals[i] = unit(moved, rest);
            offsets[i] = group.depth[i] * normals[i];
        }
}

} // namespace serosa::sim
