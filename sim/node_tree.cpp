// See sim/node_tree.h. Morton 1966, A computer oriented geodetic data base: bits of the coordinates in turn.
#include "sim/node_tree.h"

#include "base/check.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <string>

namespace serosa::sim {

namespace {

constexpr int kBits = 21; // of a coordinate

std::uint64_t mortonCode(const glm::ivec3& at) {
    std::uint64_t code = 0;
    for (int bit = 0; bit < kBits; ++bit)
        for (int axis = 0; axis < 3; ++axis)
            code |= std::uint64_t(at[axis] >> bit & 1) << (3 * bit + axis);
    return code;
}

int roundUp(int count, int step) {
    return (count + step - 1) / step * step;
}

constexpr glm::vec4 kLowest(1e30F, 1e30F, 1e30F, 0), kHighest(-1e30F, -1e30F, -1e30F, 0); // an empty box

/// At least `bytes`; what it held is lost where it grows.
void makeRoom(gpu::Buffer& buffer, const std::string& label, std::size_t bytes) {
    if (buffer.bytes() < bytes)
        buffer = gpu::Buffer(label, bytes, nullptr);
}

} // namespace

NodeTreeShape NodeTreeShape::make(const Lattice& lattice, const std::vector<glm::uvec3>& triangles) {
    NodeTreeShape shape;
    std::vector<std::uint64_t> codes;
    for (const glm::uvec3& t : triangles) // three times the centre: grid coordinates are below 2^19
        codes.push_back(mortonCode(lattice.nodes[t.x] + lattice.nodes[t.y] + lattice.nodes[t.z]));
    shape.order.resize(triangles.size());
    std::iota(shape.order.begin(), shape.order.end(), 0u);
    std::sort(shape.order.begin(), shape.order.end(), [&codes](std::uint32_t a, std::uint32_t b) {
        return codes[a] != codes[b] ? codes[a] < codes[b] : a < b;
    });
    int count = (int(triangles.size()) + SRS_TREE_LEAF - 1) / SRS_TREE_LEAF;
    for (;;) {
        const bool last = count <= SRS_TREE_WIDTH;
        shape.starts.push_back(shape.boxes);
        shape.counts.push_back(count);
        shape.boxes += last ? count : roundUp(count, SRS_TREE_WIDTH);
        if (last)
            break;
        count = (count + SRS_TREE_WIDTH - 1) / SRS_TREE_WIDTH;
    }
    SEROSA_CHECK(shape.counts.size() <= SRS_TREE_MOST_LEVELS, "triangles for SRS_TREE_MOST_LEVELS levels");
    return shape;
}

Result<NodeTree> NodeTree::create(const Lattice& lattice, const TextureLayout& layout) {
    NodeTree tree;
    tree.spacing_ = lattice.spacing;
    tree.origin_ = lattice.origin;
    tree.texelOfNode_ = layout.texelOfNode;
    SEROSA_ASSIGN(tree.refitProgram_, gpu::Program::create(gpu::ShaderLibrary(), {"node_tree_refit.comp"}));
    tree.rebuild(lattice, lattice.boundary);
    return tree;
}

void NodeTree::rebuild(const Lattice& lattice, const std::vector<glm::uvec3>& triangles) {
    SEROSA_CHECK(lattice.nodeCount() == texelOfNode_.size(), "the lattice that the tree was made for");
    triangles_ = triangles;
    shape_ = NodeTreeShape::make(lattice, triangles);
    std::vector<glm::uvec4> ordered;
    for (const std::uint32_t index : shape_.order) {
        glm::uvec4 item(0, 0, 0, index);
        for (int i = 0; i < 3; ++i)
            item[i] = texelOfNode_[triangles[index][i]].y << 16 | texelOfNode_[triangles[index][i]].x;
        ordered.push_back(item);
    }
    while (ordered.empty() || ordered.size() % SRS_TREE_LEAF != 0)
        ordered.emplace_back(0, 0, 0, SRS_TREE_NONE);
    std::vector<glm::vec4> boxes;
    for (int i = 0; i < std::max(shape_.boxes, 1); ++i) {
        boxes.push_back(kLowest);
        boxes.push_back(kHighest);
    }
    boxes_ = gpu::Buffer("node tree boxes", std::span<const glm::vec4>(boxes));
    ordered_ = gpu::Buffer("node tree triangles", std::span<const glm::uvec4>(ordered));
    refitProgram_.buffer("b_treeBoxes", boxes_).buffer("b_treeTriangles", ordered_);
}

void NodeTree::refit(const StateTextures& state, float sweep) {
    refitProgram_.texture("t_positions", state.positions());
    refitProgram_.texture("t_increments", state.increments());
    refitProgram_.set("u_sweep", sweep);
    // Of whatever pass wrote the positions last, a render target or an image.
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    for (std::size_t level = 0; level < shape_.counts.size(); ++level) {
        refitProgram_.set("u_start", shape_.starts[level]);
        refitProgram_.set("u_startBelow", level == 0 ? -1 : shape_.starts[level - 1]);
        refitProgram_.set("u_count", shape_.counts[level]);
        if (shape_.counts[level] > 0)
            refitProgram_.dispatch({shape_.counts[level], 1, 1});
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
}

NodeTree::Box NodeTree::bounds() const {
    std::vector<glm::vec4> top(2 * std::size_t(shape_.counts.back()));
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    boxes_.download(2 * std::size_t(shape_.starts.back()) * sizeof top[0], top.size() * sizeof top[0],
                    top.data());
    Box all{glm::dvec3(kLowest), glm::dvec3(kHighest)};
    for (std::size_t i = 0; i < top.size(); i += 2)
        all = {glm::min(all.lowest, glm::dvec3(top[i])), glm::max(all.highest, glm::dvec3(top[i + 1]))};
    return all;
}

void NodeTree::bind(gpu::Program& program) const {
    std::vector<int> starts = shape_.starts;
    starts.resize(SRS_TREE_MOST_LEVELS, 0);
    program.set("u_treeStarts", std::span<const int>(starts));
    program.set("u_treeTop", glm::ivec2(int(shape_.counts.size()) - 1, shape_.counts.back()));
    program.buffer("b_treeBoxes", boxes_).buffer("b_treeTriangles", ordered_);
}

Result<std::vector<std::uint32_t>> NodeTree::ask(const StateTextures& state, int kind,
                                                 const std::vector<glm::vec4>& queries, std::size_t words) {
    const std::size_t count = queries.size() / 2;
    std::vector<std::uint32_t> answers(count * words);
    if (count == 0)
        return answers;
    gpu::Program& program = queryPrograms_[std::size_t(kind)];
    if (!program) {
        SEROSA_ASSIGN(program, gpu::Program::create(gpu::ShaderLibrary(), {"node_tree_query.comp"},
                                                    {{"SRS_TREE_QUERY", std::to_string(kind)}}));
    }
    const std::size_t bytes = answers.size() * sizeof answers[0];
    makeRoom(queries_, "node tree queries", queries.size() * sizeof queries[0]);
    makeRoom(answers_, "node tree answers", bytes);
    queries_.upload(0, queries.size() * sizeof queries[0], queries.data());
    bind(program);
    program.texture("t_positions", state.positions());
    program.buffer("b_queries", queries_).buffer("b_answers", answers_);
    program.set("u_queries", int(count));
    program.dispatch({int(count), 1, 1});
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    answers_.download(0, bytes, answers.data());
    return answers;
}

Result<std::vector<std::optional<NodeTree::Hit>>> NodeTree::hits(const StateTextures& state, int kind,
                                                                 const std::vector<glm::vec4>& queries) {
    SEROSA_ASSIGN(const std::vector<std::uint32_t> words, ask(state, kind, queries, 4));
    std::vector<std::optional<Hit>> all;
    for (std::size_t i = 0; i < words.size(); i += 4) {
        if (words[i] == SRS_TREE_NONE) {
            all.emplace_back();
            continue;
        }
        Hit hit;
        hit.triangle = words[i];
        const double w1 = std::bit_cast<float>(words[i + 1]), w2 = std::bit_cast<float>(words[i + 2]);
        hit.weights = {w1, w2, 1 - w1 - w2};
        hit.distance = std::bit_cast<float>(words[i + 3]);
        all.emplace_back(hit);
    }
    return all;
}

Result<std::vector<NodeTree::Candidates>> NodeTree::candidates(const StateTextures& state, int kind,
                                                               const std::vector<glm::vec4>& queries) {
    constexpr std::size_t kWords = 1 + SRS_TREE_CANDIDATES;
    SEROSA_ASSIGN(const std::vector<std::uint32_t> words, ask(state, kind, queries, kWords));
    std::vector<Candidates> all;
    for (std::size_t i = 0; i < words.size(); i += kWords) {
        const auto first = words.begin() + std::ptrdiff_t(i);
        const auto listed = std::ptrdiff_t(std::min<std::uint32_t>(*first, SRS_TREE_CANDIDATES));
        all.push_back({{first + 1, first + 1 + listed}, *first});
    }
    return all;
}

Result<std::vector<std::optional<NodeTree::Hit>>> NodeTree::cast(const StateTextures& state,
                                                                 const std::vector<Ray>& rays) {
    std::vector<glm::vec4> queries;
    for (const Ray& ray : rays) {
        SEROSA_CHECK(ray.direction != glm::dvec3(0), "a ray has a direction");
        queries.emplace_back(glm::vec3(ray.origin), float(ray.reach));
        queries.emplace_back(glm::vec3(ray.direction), 0.0F);
    }
    return hits(state, SRS_TREE_RAY, queries);
}

Result<std::optional<NodeTree::Pick>> NodeTree::pick(const StateTextures& state, const glm::dvec3& origin,
                                                     const glm::dvec3& direction) {
    const glm::dvec3 unit = glm::normalize(direction), from = (origin - origin_) / spacing_;
    SEROSA_ASSIGN(const std::vector<std::optional<Hit>> found, cast(state, {Ray{from, unit}}));
    if (!found.front())
        return std::optional<Pick>();
    const Hit& hit = *found.front();
    Pick picked;
    picked.triangle = hit.triangle;
    picked.nodes = triangles_[hit.triangle];
    picked.weights = hit.weights;
    picked.distance = hit.distance * spacing_;
    picked.at = origin + picked.distance * unit;
    return std::optional<Pick>(picked);
}

Result<std::vector<std::optional<NodeTree::Hit>>> NodeTree::closest(const StateTextures& state,
                                                                    const std::vector<Sphere>& points) {
    std::vector<glm::vec4> queries;
    for (const Sphere& point : points) {
        queries.emplace_back(glm::vec3(point.centre), float(point.radius));
        queries.emplace_back(0);
    }
    return hits(state, SRS_TREE_CLOSEST, queries);
}

Result<std::vector<NodeTree::Candidates>> NodeTree::overlapping(const StateTextures& state,
                                                                const std::vector<Box>& boxes) {
    std::vector<glm::vec4> queries;
    for (const Box& box : boxes) {
        queries.emplace_back(glm::vec3(box.lowest), 0.0F);
        queries.emplace_back(glm::vec3(box.highest), 0.0F);
    }
    return candidates(state, SRS_TREE_IN_BOX, queries);
}

Result<std::vector<NodeTree::Candidates>> NodeTree::overlapping(const StateTextures& state,
                                                                const std::vector<Sphere>& spheres) {
    std::vector<glm::vec4> queries;
    for (const Sphere& sphere : spheres) {
        queries.emplace_back(glm::vec3(sphere.centre), float(sphere.radius));
        queries.emplace_back(0);
    }
    return candidates(state, SRS_TREE_IN_SPHERE, queries);
}

} // namespace serosa::sim
