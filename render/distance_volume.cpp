// See render/distance_volume.h.
#include "render/distance_volume.h"

#include "gpu/program.h"
#include "render/distance_tree.h"
#include "render/parallel.h"
#include "shaders/raycast_constants.h"
#include "sim/node_depths.h"
#include "sim/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace serosa::render {

namespace {

constexpr int kNarrowBand = 2;    // voxels
constexpr int kMostVoxels = 1023; // along a side: jump flooding packs a place in ten bits an axis

/// Angle-weighted normals: of faces, of the three edges of each (0-1, 1-2, 2-0), of vertices; not normalized.
struct PseudoNormals {
    std::vector<glm::vec4> faces, edges, vertices;
};

Result<PseudoNormals> pseudoNormals(const std::vector<glm::dvec3>& positions,
                                    const std::vector<glm::uvec3>& triangles) {
    PseudoNormals normals;
    std::map<std::pair<std::uint32_t, std::uint32_t>, glm::dvec3> edges;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
    std::vector<glm::dvec3> vertices(positions.size(), glm::dvec3(0)), faces;
    for (const glm::uvec3& face : triangles) {
        const glm::dvec3 &a = positions[face.x], &b = positions[face.y], &c = positions[face.z];
        const glm::dvec3 area = glm::cross(b - a, c - a);
        const double twice = glm::length(area);
        const glm::dvec3 n = twice > 0 ? area / twice : glm::dvec3(0);
        faces.push_back(n);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t from = face[k], to = face[(k + 1) % 3], before = face[(k + 2) % 3];
            edges[std::minmax(from, to)] += n;
            balance[std::minmax(from, to)] += from < to ? 1 : -1;
            const glm::dvec3 e = positions[to] - positions[from], g = positions[before] - positions[from];
            vertices[from] += n * std::atan2(glm::length(glm::cross(e, g)), glm::dot(e, g));
        }
    }
    for (const auto& [edge, sum] : balance)
        if (sum != 0)
            return Error{"the mesh is open at the edge of vertices " + std::to_string(edge.first) + " and " +
                         std::to_string(edge.second) +
                         ": a distance field has an inside; close it first (serosa repair)"};
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        normals.faces.emplace_back(faces[i], 0);
        for (int k = 0; k < 3; ++k)
            normals.edges.emplace_back(edges[std::minmax(triangles[i][k], triangles[i][(k + 1) % 3])], 0);
    }
    for (const glm::dvec3& n : vertices)
        normals.vertices.emplace_back(n, 0);
    return normals;
}

} // namespace

Result<DistanceVolume> DistanceVolume::create(const sim::TriangleMesh& mesh, const VolumeGrid& grid,
                                              double band, const std::vector<glm::u8vec4>& colours) {
    if (mesh.faces.empty())
        return Error{"a distance field of a mesh without faces"};
    if (std::max({grid.size.x, grid.size.y, grid.size.z}) > kMostVoxels)
        return Error{"a distance field of " +
                     std::to_string(std::max({grid.size.x, grid.size.y, grid.size.z})) +
                     " voxels along a side: at most " + std::to_string(kMostVoxels)};
    std::vector<glm::vec4> positions;
    for (const glm::dvec3& p : mesh.positions)
        positions.emplace_back(glm::vec3((p - grid.lowest) / grid.step), 0);
    const DistanceTree tree = DistanceTree::create(positions, mesh.faces);
    std::vector<glm::uvec3> faces; // in the tree's order
    std::vector<glm::uvec4> triangles;
    for (const std::uint32_t face : tree.order) {
        faces.push_back(mesh.faces[face]);
        triangles.emplace_back(mesh.faces[face], 0);
    }
    SEROSA_ASSIGN(const PseudoNormals normals, pseudoNormals(mesh.positions, faces));
    const gpu::Buffer vertexBuffer("vertices of a distance field", std::span<const glm::vec4>(positions)),
        triangleBuffer("triangles of a distance field", std::span<const glm::uvec4>(triangles)),
        treeBuffer("boxes of a distance field", std::span<const DistanceTree::Node>(tree.nodes)),
        faceBuffer("normals of faces", std::span<const glm::vec4>(normals.faces)),
        edgeBuffer("normals of edges", std::span<const glm::vec4>(normals.edges)),
        cornerBuffer("normals of corners", std::span<const glm::vec4>(normals.vertices));

    DistanceVolume volume;
    volume.grid_ = grid;
    volume.texture_ = gpu::Texture3D("signed distance", GL_R16F, grid.size);
    gpu::Texture3D least("least distance", GL_R32UI, grid.size),
        owner("nearest triangle", GL_R32UI, grid.size);
    gpu::Texture3D seeds("nearest voxel of the band", GL_R32UI, grid.size),
        next("nearest voxel of the band, next", GL_R32UI, grid.size);
    const gpu::ShaderLibrary library;
    const auto program = [&](const char* file, const std::vector<gpu::ShaderDefine>& defines) {
        return gpu::Program::create(library, {file}, defines);
    };
    SEROSA_ASSIGN(gpu::Program splat, program("distance_splat.comp", {}));
    SEROSA_ASSIGN(gpu::Program claim, program("distance_splat.comp", {{"DISTANCE_CLAIM", "1"}}));
    SEROSA_ASSIGN(gpu::Program begin, program("distance_flood.comp", {{"FLOOD_BEGIN", "1"}}));
    SEROSA_ASSIGN(gpu::Program flood, program("distance_flood.comp", {}));
    SEROSA_ASSIGN(gpu::Program nearest, program("distance_nearest.comp", {}));
    SEROSA_ASSIGN(gpu::Program finish, program("distance_finish.comp", {}));
    const auto barrier = [] {
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                        GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
    };
    least.clear(0x7f800000u); // infinity
    owner.clear(0xffffffffu);
    for (gpu::Program* one : {&splat, &claim}) {
        one->set("u_size", grid.size)
            .set("u_band", float(kNarrowBand))
            .set("u_triangles", int(triangles.size()));
        one->buffer("b_vertices", vertexBuffer).buffer("b_triangles", triangleBuffer);
        one->image("i_least", least, GL_READ_WRITE);
        if (one == &claim)
            one->image("i_owner", owner, GL_READ_WRITE);
        one->dispatch({int(triangles.size()), SRS_SPLAT_SLICES, 1});
        barrier();
    }
    begin.set("u_size", grid.size)
        .image("i_owner", owner, GL_READ_ONLY)
        .image("i_next", seeds, GL_WRITE_ONLY);
    begin.dispatch(grid.size);
    barrier();
    int stride = 1;
    while (2 * stride < std::max({grid.size.x, grid.size.y, grid.size.z}))
        stride *= 2;
    for (const int last : {0, 1}) // once more with the smallest strides: JFA+2
        for (int step = last ? std::min(2, stride) : stride; step >= 1; step /= 2) {
            flood.set("u_size", grid.size).set("u_stride", step);
            flood.image("i_seeds", seeds, GL_READ_ONLY).image("i_next", next, GL_WRITE_ONLY);
            flood.dispatch(grid.size);
            barrier();
            std::swap(seeds, next);
        }
    nearest.set("u_size", grid.size).set("u_band", float(band / grid.step));
    nearest.set("u_nodes", int(tree.nodes.size())).buffer("b_tree", treeBuffer);
    nearest.buffer("b_vertices", vertexBuffer).buffer("b_triangles", triangleBuffer);
    nearest.image("i_owner", owner, GL_READ_ONLY).image("i_seeds", seeds, GL_READ_ONLY);
    nearest.image("i_nearest", least, GL_WRITE_ONLY); // what it held is no longer needed
    nearest.dispatch(grid.size);
    barrier();
    finish.set("u_size", grid.size);
    finish.buffer("b_vertices", vertexBuffer).buffer("b_triangles", triangleBuffer);
    finish.buffer("b_faceNormals", faceBuffer).buffer("b_edgeNormals", edgeBuffer);
    finish.buffer("b_cornerNormals", cornerBuffer);
    finish.image("i_owner", owner, GL_READ_ONLY).image("i_seeds", seeds, GL_READ_ONLY);
    finish.image("i_nearest", least, GL_READ_ONLY);
    finish.image("i_distance", volume.texture_, GL_WRITE_ONLY);
    finish.dispatch(grid.size);
    barrier();
    if (!colours.empty()) {
        std::vector<std::uint32_t> packed;
        for (const glm::u8vec4& c : colours)
            packed.push_back(std::uint32_t(c.r) | std::uint32_t(c.g) << 8 | std::uint32_t(c.b) << 16 |
                             std::uint32_t(c.a) << 24);
        const gpu::Buffer colourBuffer("colours of a distance field", std::span<const std::uint32_t>(packed));
        SEROSA_ASSIGN(gpu::Program colour, program("distance_colour.comp", {}));
        volume.colours_.emplace("colours of the nearest surface", grid.size);
        colour.set("u_size", grid.size).buffer("b_colours", colourBuffer);
        colour.buffer("b_vertices", vertexBuffer).buffer("b_triangles", triangleBuffer);
        colour.image("i_nearest", least, GL_READ_ONLY).image("i_colour", *volume.colours_, GL_WRITE_ONLY);
        colour.dispatch(grid.size);
        barrier();
        glFinish();
    }
    glFinish(); // the buffers die here
    volume.blocks_ = FieldBlocks(grid, volume.read());
    return volume;
}

std::vector<float> DistanceVolume::read() const {
    std::vector<float> values(std::size_t(grid_.size.x) * std::size_t(grid_.size.y) *
                              std::size_t(grid_.size.z));
    texture_.download(GL_RED, GL_FLOAT, values.size() * sizeof(float), values.data());
    for (float& value : values)
        value = float(value * grid_.step);
    return values;
}

std::vector<double> distanceOnGrid(const sim::TriangleMesh& mesh, const VolumeGrid& grid) {
    const sim::TriangleTree tree(mesh.positions, mesh.faces);
    const double reach =
        2 * grid.step * glm::length(glm::dvec3(grid.size)) + 2 * glm::distance(mesh.lowest(), mesh.highest());
    std::vector<double> values(std::size_t(grid.size.x) * std::size_t(grid.size.y) *
                               std::size_t(grid.size.z));
    parallelFor(values.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 at(double(i % std::size_t(grid.size.x)),
                                double(i / std::size_t(grid.size.x) % std::size_t(grid.size.y)),
                                double(i / std::size_t(grid.size.x) / std::size_t(grid.size.y)));
            const glm::dvec3 p = grid.lowest + grid.step * at;
            const double apart = std::sqrt(tree.closest(p).distance2);
            values[i] = sim::isInside(tree, p, reach) ? -apart : apart;
        }
    });
    return values;
}

} // namespace serosa::render
