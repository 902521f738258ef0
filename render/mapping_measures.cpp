#include "render/mapping_measures.h"

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

/// A surface on the GPU with the state it is drawn from; positions in lattice units.
class Stage {
public:
    static Result<Stage> create(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                const SurfaceBinding& binding) {
        SEROSA_ASSIGN(sim::StateTextures state, sim::StateTextures::create(lattice, {}));
        SEROSA_ASSIGN(SurfaceRenderer renderer,
                      SurfaceRenderer::create(lattice, metres, binding, state, kPixels, kPixels));
        return Stage(lattice, binding.mapping, std::move(state), std::move(renderer));
    }
    void upload(const sim::LatticeState& state) { state_.upload(state); }
    std::vector<glm::dvec3> positions() {
        std::vector<glm::dvec3> q;
        for (const glm::dvec3& metres : renderer_.readDeformedPositions(state_, mapping_))
            q.push_back(lattice_->toLattice(metres));
        return q;
    }
    std::vector<glm::dvec3> normals() { return renderer_.readDeformedNormals(state_, mapping_); }

private:
    static constexpr int kPixels = 8; // nothing is drawn
    Stage(const sim::Lattice& lattice, sim::Mapping mapping, sim::StateTextures state,
          SurfaceRenderer renderer)
        : lattice_(&lattice), mapping_(mapping), state_(std::move(state)), renderer_(std::move(renderer)) {}
    const sim::Lattice* lattice_;
    sim::Mapping mapping_;
    sim::StateTextures state_;
    SurfaceRenderer renderer_;
};

/// What the GPU is given: float32 positions.
std::vector<glm::dvec3> rounded(const sim::LatticeState& state) {
    std::vector<glm::dvec3> positions;
    for (const glm::dvec3& p : state.positions)
        positions.emplace_back(glm::vec3(p));
    return positions;
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
    SEROSA_ASSIGN(Stage stage, Stage::create(lattice, metres, binding));
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
            const double offset = std::max(double(glm::length(binding.vertices[v].offset)), 1e-9);
            grow(errors.rigid, distance / size);
            grow(errors.rigidBeyond, (distance - kFree * size) / offset);
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
    SurfaceBinding bare = binding;
    for (VertexBinding& vertex : bare.vertices)
        vertex.offset = glm::vec3(0);
    SEROSA_ASSIGN(Stage points, Stage::create(lattice, metres, bare));
    const glm::dvec3 stretch(1.25, 0.875, 1.125);
    points.upload(deformedState(
        lattice, [&](const glm::dvec3& q) { return stretch * q; }, normals));
    std::vector<glm::dvec3> expected = referencePoints(bare, sim::restState(lattice).positions);
    for (glm::dvec3& point : expected)
        point *= stretch;
    errors.stretch = largestDistance(points.positions(), expected) / size;
    return errors;
}

Result<EdgeGaps> measureBendGaps(sim::Mapping mapping, double height, NodeNormals normals) {
    constexpr std::uint8_t kFull = 255;
    constexpr double kRadius = 3; // spacings
    const sim::Lattice lattice = sim::latticeFromCells(
        {{{0, 0, 0}, kFull}, {{1, 0, 0}, kFull}, {{0, 1, 0}, kFull}, {{1, 1, 0}, kFull}}, 1.0, glm::dvec3(0));

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

    // Two vertices an edge, at the same place, bound to the triangle on either side.
    sim::TriangleMesh points;
    SurfaceBinding binding;
    binding.mapping = mapping;
    for (const auto& [edge, triangles] : sharing) {
        const glm::dvec3 middle =
            0.5 * (lattice.restPosition(edge.first) + lattice.restPosition(edge.second));
        const glm::dvec3 up = glm::normalize(normalOf(triangles.at(0)) + normalOf(triangles.at(1)));
        for (const std::uint32_t t : {triangles[0], triangles[1]}) {
            VertexBinding vertex{};
            const int first = diagonalStart(lattice, lattice.boundary[t]);
            for (int i = 0; i < 3; ++i)
                vertex.nodes[i] = lattice.boundary[t][(first + i) % 3];
            // 1/2 is not a multiple of 1/65535; the remainder lies on the third node, along the same edge or
            // to its corner
            for (int i = 0; i < 3; ++i)
                if (vertex.nodes[i] == edge.first || vertex.nodes[i] == edge.second)
                    vertex.weights[i] = i < 2 ? float(32768 / 65535.0) : 0.5F;
            if (vertex.weights.x > 0 && vertex.weights.y > 0)
                vertex.weights.y = float(32767 / 65535.0);
            binding.vertices.push_back(vertex);
            binding.triangles.push_back(t);
            points.positions.push_back(lattice.toWorld(middle + height * up));
        }
    }
    const auto count = std::uint32_t(points.positions.size());
    for (std::uint32_t v = 0; v + 2 < count; ++v)
        points.faces.emplace_back(v, v + 1, v + 2);

    SEROSA_ASSIGN(Stage stage,
                  Stage::create(lattice, points, expressBinding(binding, lattice, points, mapping)));
    const glm::dvec3 centre = 0.5 * (lattice.restPosition(0) + lattice.restPosition(lattice.nodeCount() - 1));
    stage.upload(deformedState(
        lattice, [&](const glm::dvec3& q) { return bend(q, centre, kRadius); }, normals));
    const std::vector<glm::dvec3> mapped = stage.positions();
    EdgeGaps gaps;
    gaps.edges = sharing.size();
    for (std::size_t e = 0; e < gaps.edges; ++e) {
        const double gap = glm::distance(mapped[2 * e], mapped[2 * e + 1]);
        grow(gaps.largest, gap);
        gaps.rms += gap * gap / double(gaps.edges);
    }
    gaps.rms = std::sqrt(gaps.rms);
    return gaps;
}

} // namespace serosa::render
