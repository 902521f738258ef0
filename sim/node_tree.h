#pragma once
// A hierarchy of nodes on the GPU (MS05 3.6): boxes over the triangles of a lattice's boundary, or over what
// cuts left of it. Picking, ray tests and contact candidates are answered there, and nothing but the answer
// is read back.
//
// What is below what is fixed once, from the rest positions: triangles in Morton order of their centres, four
// a leaf, eight nodes below a node, level for level in one buffer (shaders/node_tree.glsl walks it without a
// stack). Boxes are refit to the positions in one pass a level. Tissue deforms, but neighbours stay
// neighbours: the order remains good; a cut that changes the triangles makes a new one (rebuild).

#include "base/result.h"
#include "gpu/program.h"
#include "shaders/shared_constants.h"
#include "sim/lattice.h"
#include "sim/state_textures.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace serosa::sim {

/// What is below what: no GL.
struct NodeTreeShape {
    std::vector<std::uint32_t> order; // indices of triangles, leaf by leaf
    std::vector<int> counts;          // nodes a level, leaves first; the last one at most SRS_TREE_WIDTH
    std::vector<int> starts; // first box of each level; levels but the last are padded to whole widths
    int boxes = 0;           // of all levels

    static NodeTreeShape make(const Lattice& lattice, const std::vector<glm::uvec3>& triangles);
};

/// Lattice units throughout, but for pick().
class NodeTree {
public:
    struct Ray {
        glm::dvec3 origin{0}, direction{0, 0, 1};               // not null
        double reach = std::numeric_limits<double>::infinity(); // in lengths of `direction`
    };
    struct Sphere {
        glm::dvec3 centre{0};
        double radius = 0;
    };
    struct Box {
        glm::dvec3 lowest{0}, highest{0};
    };
    struct Hit {
        std::uint32_t triangle = 0; // of triangles()
        glm::dvec3 weights{0};      // of its three nodes, in its order; sum 1
        double distance = 0;        // along the ray in lengths of `direction`; or from the point
    };
    /// Where a ray from the world meets the organ.
    struct Pick {
        std::uint32_t triangle = 0;
        glm::uvec3 nodes{0};
        glm::dvec3 weights{0};
        glm::dvec3 at{0};    // m, world
        double distance = 0; // m from the ray's origin
    };

    /// Over lattice.boundary; the lattice is not kept. Needs a current context. Errors: of the shaders.
    static Result<NodeTree> create(const Lattice& lattice, const TextureLayout& layout);
    /// Over these from now on: what cuts left (boundaryLeft of sim/pieces.h). Refit before the next query.
    void rebuild(const Lattice& lattice, const std::vector<glm::uvec3>& triangles);
    const std::vector<glm::uvec3>& triangles() const { return triangles_; }

    /// Boxes around the triangles at the state's positions. \param sweep boxes hold the way of the last
    /// `sweep` steps, as increments have it: x - sweep u to x
    void refit(const StateTextures& state, float sweep = 0);
    /// Of all triangles as the boxes were last refit; reads back (stalls). Of none: lowest above highest.
    Box bounds() const;
    /// Sets what shaders/node_tree.glsl reads, in a program that includes it.
    void bind(gpu::Program& program) const;

    // Queries to the boxes as they were last refit. They wait for the answers.

    /// First triangle on a ray in the world, seen from either side. `direction` has any length but 0.
    Result<std::optional<Pick>> pick(const StateTextures& state, const glm::dvec3& origin,
                                     const glm::dvec3& direction);
    /// The same for many rays in lattice units: one answer a ray.
    Result<std::vector<std::optional<Hit>>> cast(const StateTextures& state, const std::vector<Ray>& rays);
    /// Closest triangle to each centre, no further than the radius.
    Result<std::vector<std::optional<Hit>>> closest(const StateTextures& state,
                                                    const std::vector<Sphere>& points);
    /// Triangles whose own boxes overlap each box (touching counts): the first SRS_TREE_CANDIDATES in the
    /// tree's order, and how many there are.
    struct Candidates {
        std::vector<std::uint32_t> triangles;
        std::uint32_t found = 0;
    };
    Result<std::vector<Candidates>> overlapping(const StateTextures& state, const std::vector<Box>& boxes);
    /// The same for spheres.
    Result<std::vector<Candidates>> overlapping(const StateTextures& state,
                                                const std::vector<Sphere>& spheres);

private:
    NodeTree() = default;
    /// Runs queries of a kind. \param words of an answer
    Result<std::vector<std::uint32_t>> ask(const StateTextures& state, int kind,
                                           const std::vector<glm::vec4>& queries, std::size_t words);
    Result<std::vector<std::optional<Hit>>> hits(const StateTextures& state, int kind,
                                                 const std::vector<glm::vec4>& queries);
    Result<std::vector<Candidates>> candidates(const StateTextures& state, int kind,
                                               const std::vector<glm::vec4>& queries);

    double spacing_ = 0;   // m
    glm::dvec3 origin_{0}; // m
    std::vector<glm::uvec2> texelOfNode_;
    std::vector<glm::uvec3> triangles_;
    NodeTreeShape shape_;
    gpu::Buffer boxes_, ordered_; // two vec4 a box; a uvec4 a triangle in tree order
    gpu::Buffer queries_, answers_;
    gpu::Program refitProgram_;
    std::array<gpu::Program, 4> queryPrograms_; // made when first needed
};

} // namespace serosa::sim
