#include "render/mapping_measures.h"

#include "render/basis_choice.h"
#include "render/mapped_stage.h"
#include "render/triangle_basis.h"
#include "render/triangle_choice.h"
#include "sim/packed_normal.h"
#include "sim/solver.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace serosa::render {

namespace {

constexpr double kFree = 1e-5;       // of the size: what a rigid motion may cost either basis
constexpr double kTranslation = 8;   // spacings, each axis
constexpr unsigned kSeed = 20050527; // of the random motions

struct RigidMotion {
    glm::dmat3 turn{1};
    glm::dvec3 shift{0};
    glm::dvec3 operator()(const glm::dvec3& q) const { return turn * q + shift; }
};

std::vector<RigidMotion> randomMotions(int count) {
    std::mt19937 random(kSeed);
    // Own transforms of the raw numbers: the standard's distributions differ between libraries.
    const auto uniform = [&] { return random() / 4294967296.0 * 2 - 1; };
    std::vector<RigidMotion> motions;
    while (int(motions.size()) < count) {
        const glm::dquat q(uniform(), uniform(), uniform(), uniform());
        if (const double length = glm::length(q); length < 0.2 || length > 1)
            continue; // even over all turns
        motions.push_back(
            {glm::mat3_cast(glm::normalize(q)), kTranslation * glm::dvec3(uniform(), uniform(), uniform())});
    }
    return motions;
}

double largestExtent(const sim::TriangleMesh& mesh) {
    const glm::dvec3 extent = mesh.highest() - mesh.lowest();
    return std::max({extent.x, extent.y, extent.z});
}

/// NaN wins and stays: it must never pass for small.
void grow(double& largest, double value) {
    if (std::isnan(value) || value > largest)
        largest = value;
}

double largestDistance(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        grow(largest, glm::distance(a[i], b[i]));
    return largest;
}

/// What the GPU is given: float32 positions.
std::vector<glm::dvec3> rounded(const sim::LatticeState& state) {
    std::vector<glm::dvec3> positions;
    for (const glm::dvec3& p : state.positions)
        positions.emplace_back(glm::vec3(p));
    return positions;
}

glm::dvec3 evenStretch(const glm::dvec3& q) {
    return glm::dvec3(1.25, 0.875, 1.125) * q;
}

double offsetLength(const SurfaceBinding& binding, std::size_t vertex) {
    return std::max(double(glm::length(binding.vertices[vertex].offset)), 1e-9);
}

SurfaceBinding withoutOffsets(SurfaceBinding binding) {
    for (VertexBinding& vertex : binding.vertices)
        vertex.offset = glm::vec3(0);
    for (NormalOffset& along : binding.alongNormal)
        along.distance = 0;
    return binding;
}

/// Does it say what becomes of an offset in an even stretch? (The axes of the others turn with their
/// triangles.)
bool keepsOffsets(sim::Mapping mapping) {
    return mapping == sim::Mapping::nodeFrames || mapping == sim::Mapping::trilinear;
}

std::vector<glm::dvec3> stretchedReferences(const sim::Lattice& lattice, const SurfaceBinding& binding) {
    std::vector<glm::dvec3> points = referencePoints(binding, sim::restState(lattice).positions);
    for (glm::dvec3& point : points)
        point = evenStretch(point);
    return points;
}

/// Of mappings that keep offsets: trilinear stretches all of the surface, node frames leave the offsets.
std::vector<glm::dvec3> stretchedSurface(const sim::Lattice& lattice, const SurfaceBinding& binding) {
    std::vector<glm::dvec3> points = stretchedReferences(lattice, binding);
    for (std::size_t v = 0; v < points.size() && binding.mapping == sim::Mapping::nodeFrames; ++v)
        points[v] += glm::dvec3(binding.vertices[v].offset);
    return points;
}

std::vector<glm::dvec3> inLattice(const sim::Lattice& lattice, const sim::TriangleMesh& metres) {
    std::vector<glm::dvec3> q;
    for (const glm::dvec3& p : metres.positions)
        q.push_back(lattice.toLattice(p));
    return q;
}

} // namespace

sim::LatticeState deformedState(const sim::Lattice& lattice,
                                const std::function<glm::dvec3(const glm::dvec3&)>& move,
                                NodeNormals normals) {
    sim::LatticeState state = sim::restState(lattice);
    for (glm::dvec3& position : state.positions)
        position = move(position);
    if (normals == NodeNormals::current)
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
            glm::dvec3 sum(0); // eq. 3
            for (int d = 0; d < int(sim::kNeighbourOffsets.size()); ++d)
                if (const std::int64_t other = lattice.neighbour(node, d); other >= 0)
                    sum += glm::normalize(state.positions[node] - state.positions[std::size_t(other)]);
            state.normals[node] = sim::packNormal(glm::vec3(sum));
        }
    return state;
}

glm::dvec3 bend(const glm::dvec3& q, const glm::dvec3& middle, double radius) {
    const glm::dvec3 p = q - middle;
    const double angle = p.x / radius, r = radius + p.y;
    return middle + glm::dvec3(r * std::sin(angle), r * std::cos(angle) - radius, p.z);
}

Result<MappingErrors> measureMapping(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                     sim::Mapping mapping, int motions, NodeNormals normals) {
    const SurfaceBinding binding = bindSurface(lattice, metres, mapping);
    SEROSA_ASSIGN(MappedStage stage, MappedStage::create(lattice, metres, binding));
    const std::vector<glm::dvec3> rest = inLattice(lattice, metres), restNormals = metres.vertexNormals();
    const double size = largestExtent(metres) / lattice.spacing;
    MappingErrors errors;
    errors.rest = largestDistance(stage.positions(), rest) / size;

    for (const RigidMotion& motion : randomMotions(motions)) {
        const sim::LatticeState state = deformedState(lattice, motion, normals);
        stage.upload(state);
        const std::vector<glm::dvec3> mapped = stage.positions(), turned = stage.normals();
        for (std::size_t v = 0; v < rest.size(); ++v) {
            const double distance = glm::distance(mapped[v], motion(rest[v]));
            grow(errors.rigid, distance / size);
            grow(errors.rigidBeyond, (distance - kFree * size) / offsetLength(binding, v));
            const double chord = glm::distance(turned[v], motion.turn * restNormals[v]);
            grow(errors.normal, 2 * std::asin(std::min(1.0, 0.5 * chord)));
        }
        grow(errors.twin, largestDistance(mapped, mapSurface(binding, rounded(state), state.normals)) / size);
    }
    const sim::LatticeState bent = deformedState(
        lattice, [&](const glm::dvec3& q) { return bend(q, glm::dvec3(0), 2 * size); }, normals);
    stage.upload(bent);
    grow(errors.twin,
         largestDistance(stage.positions(), mapSurface(binding, rounded(bent), bent.normals)) / size);

    // Without offsets the vertex stage gives the reference points.
    const SurfaceBinding bare = withoutOffsets(binding);
    SEROSA_ASSIGN(MappedStage points, MappedStage::create(lattice, metres, bare));
    const sim::LatticeState stretched = deformedState(lattice, evenStretch, normals);
    points.upload(stretched);
    errors.stretch = largestDistance(points.positions(), stretchedReferences(lattice, bare)) / size;
    if (keepsOffsets(mapping)) {
        stage.upload(stretched);
        grow(errors.stretch, largestDistance(stage.positions(), stretchedSurface(lattice, binding)) / size);
    }
    return errors;
}

MappingErrors measureMappingTwin(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                 sim::Mapping mapping, int motions) {
    const SurfaceBinding binding = bindSurface(lattice, metres, mapping);
    const std::vector<glm::dvec3> rest = inLattice(lattice, metres);
    const double size = largestExtent(metres) / lattice.spacing;
    const auto mapped = [&](const sim::LatticeState& state, const SurfaceBinding& of) {
        return mapSurface(of, rounded(state), state.normals);
    };
    MappingErrors errors;
    errors.rest = largestDistance(mapped(sim::restState(lattice), binding), rest) / size;
    for (const RigidMotion& motion : randomMotions(motions)) {
        const std::vector<glm::dvec3> moved = mapped(deformedState(lattice, motion), binding);
        for (std::size_t v = 0; v < rest.size(); ++v) {
            const double distance = glm::distance(moved[v], motion(rest[v]));
            grow(errors.rigid, distance / size);
            grow(errors.rigidBeyond, (distance - kFree * size) / offsetLength(binding, v));
        }
    }
    const SurfaceBinding bare = withoutOffsets(binding);
    const sim::LatticeState stretched = deformedState(lattice, evenStretch);
    errors.stretch = largestDistance(mapped(stretched, bare), stretchedReferences(lattice, bare)) / size;
    if (keepsOffsets(mapping))
        grow(errors.stretch,
             largestDistance(mapped(stretched, binding), stretchedSurface(lattice, binding)) / size);
    return errors;
}

namespace {

/// A step across the plane between two cells that an edge of the boundary lies in; 0: it lies in none.
glm::dvec3 besideCells(const sim::Lattice& lattice, std::uint32_t a, std::uint32_t b) {
    constexpr double kStep = 1e-7; // lattice units
    for (int axis = 0; axis < 3; ++axis) {
        const int at = lattice.nodes[a][axis];
        if (at == lattice.nodes[b][axis] && at > 0 && at + 1 < lattice.nodeDims[axis]) {
            glm::dvec3 step(0);
            step[axis] = kStep;
            return step;
        }
    }
    return glm::dvec3(0);
}

} // namespace

Result<EdgeGaps> measureBendGaps(sim::Mapping mapping, double height, NodeNormals normals) {
    constexpr std::uint8_t kFull = 255;
    constexpr double kRadius = 3; // spacings
    const sim::Lattice lattice = sim::latticeFromCells(
        {{{0, 0, 0}, kFull}, {{1, 0, 0}, kFull}, {{0, 1, 0}, kFull}, {{1, 1, 0}, kFull}}, 1.0, glm::dvec3(0));

    const ControlNodes control = controlNodes(lattice);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> sharing;
    for (std::uint32_t t = 0; t < lattice.boundary.size(); ++t)
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = lattice.boundary[t][i], b = lattice.boundary[t][(i + 1) % 3];
            sharing[{std::min(a, b), std::max(a, b)}].push_back(t);
        }
    const auto normalOf = [&](std::uint32_t t) {
        const glm::uvec3& n = lattice.boundary[t];
        return glm::normalize(
            triangleNormal(lattice.restPosition(n.x), lattice.restPosition(n.y), lattice.restPosition(n.z)));
    };

    // Two vertices an edge, at the same place, bound to the triangle on either side, or in the cell.
    const RestNormals rest(lattice);
    sim::TriangleMesh points;
    SurfaceBinding binding;
    binding.mapping = mapping;
    for (const auto& [edge, triangles] : sharing) {
        // At a third of the edge: 1/3 and 2/3 are multiples of 1/65535, so that both triangles say the same
        // point.
        const glm::dvec3 middle =
            lattice.restPosition(edge.first) / 3.0 + lattice.restPosition(edge.second) * (2 / 3.0);
        glm::dvec3 up = glm::normalize(normalOf(triangles.at(0)) + normalOf(triangles.at(1))), beside(0);
        if (mapping == sim::Mapping::normalOffset) // what goes over the edge lies on the normal there
            up = glm::normalize(rest.normal(edge.first) / 3.0 + rest.normal(edge.second) * (2 / 3.0));
        if (mapping == sim::Mapping::trilinear) {
            beside = besideCells(lattice, edge.first, edge.second);
            if (beside == glm::dvec3(0))
                continue;
        }
        for (const std::uint32_t t : {triangles[0], triangles[1]}) {
            VertexBinding vertex{};
            const int first = diagonalStart(control, lattice.boundary[t]);
            for (int i = 0; i < 3; ++i)
                vertex.nodes[i] = lattice.boundary[t][(first + i) % 3];
            for (int i = 0; i < 3; ++i)
                vertex.weights[i] = vertex.nodes[i] == edge.first    ? float(1 / 3.0)
                                    : vertex.nodes[i] == edge.second ? float(2 / 3.0)
                                                                     : 0.0F;
            binding.vertices.push_back(vertex);
            binding.triangles.push_back(t);
            points.positions.push_back(
                lattice.toWorld(middle + height * up + (t == triangles[0] ? 1.0 : -1.0) * beside));
        }
    }
    const auto count = std::uint32_t(points.positions.size());
    for (std::uint32_t v = 0; v + 2 < count; ++v)
        points.faces.emplace_back(v, v + 1, v + 2);

    SEROSA_ASSIGN(MappedStage stage,
                  MappedStage::create(lattice, points, expressBinding(binding, lattice, points, mapping)));
    const glm::dvec3 centre = 0.5 * (lattice.restPosition(0) + lattice.restPosition(lattice.nodeCount() - 1));
    stage.upload(deformedState(
        lattice, [&](const glm::dvec3& q) { return bend(q, centre, kRadius); }, normals));
    const std::vector<glm::dvec3> mapped = stage.positions();
    EdgeGaps gaps;
    gaps.edges = points.positions.size() / 2;
    for (std::size_t e = 0; e < gaps.edges; ++e) {
        const double gap = glm::distance(mapped[2 * e], mapped[2 * e + 1]);
        grow(gaps.largest, gap);
        gaps.rms += gap * gap / double(gaps.edges);
    }
    gaps.rms = std::sqrt(gaps.rms);
    return gaps;
}

} // namespace serosa::render
