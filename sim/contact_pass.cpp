// See sim/contact_pass.h.
#include "sim/contact_pass.h"

#include "base/check.h"
#include "shaders/shared_constants.h"
#include "sim/contact_surface.h"
#include "sim/tissue_field.h"

#include <algorithm>
#include <array>

namespace serosa::sim {

static_assert(SRS_CONTACT_ITERATIONS <= 4, "two bits of a stamp say which round");
static_assert(SRS_MAX_COLLIDERS <= 16 && SRS_MAX_TOOLS <= int(SRS_HELD_MASK), "bits for each");

namespace {

constexpr std::uint32_t kStamps = 1u << 26; // of steps; with the round below 2^28 (contact_triangles.comp)

// As in shaders/contact_nodes.glsl, contact_faces.glsl and contact_work.glsl.
struct GpuNode {
    std::uint32_t firstCorner = 0, corners = 0;
    float mass = 0;
    std::uint32_t spare = 0;
};
struct GpuTriangle {
    std::uint32_t nodes[3];
    std::uint32_t depths;
    float inverseMasses[3];
    std::uint32_t spare;
};
struct GpuList {
    std::uint32_t groups = 0, one = 1, another = 1, count = 0;
};
struct GpuHeld { // contact_grasp.glsl, before the list of nodes
    GpuList list;
    std::uint32_t masses[3 * 8] = {};
};

template <class Item>
gpu::Buffer bufferOf(const char* label, const std::vector<Item>& items) {
    return gpu::Buffer(label, items.size() * sizeof(Item), items.data());
}

} // namespace

Status ContactPass::initialize(const SolverSetup& setup, const StateTextures& textures,
                               const gpu::Buffer& loads, Purpose purpose) {
    setup_ = setup;
    asking_ = purpose == Purpose::asks;
    colliders_ = ContactColliders(setup);
    if (empty())
        return {};
    pushes_ = !setup.bodies.empty();
    for (const Tool& tool : setup.tools) {
        (tool.mode == ToolMode::push ? pushes_ : grasps_) = true;
        triangles_ = triangles_ || (tool.mode == ToolMode::push && tool.shape.kind != ShapeKind::halfSpace);
    }
    keeps_ = grasps_ && setup.method == StepMethod::implicit;
    for (const Body& body : setup.bodies)
        triangles_ = triangles_ || body.shape.kind != ShapeKind::halfSpace;
    mass_ = TissueField(*setup.lattice, setup.tissue).massShares();
    connections_ = setup.lattice->connections;
    SEROSA_TRY(createPrograms(textures.layout()));
    const std::size_t texels = textures.layout().texels();
    work_ = bufferOf("contact lists", std::vector<GpuList>(2 * SRS_CONTACT_LISTS));
    listed_ = bufferOf("contact near, by node", std::vector<std::uint32_t>(pushes_ ? texels : 1, 0));
    near_ = gpu::Buffer("contact near", (pushes_ ? texels : 1) * 2 * sizeof(std::uint32_t), nullptr);
    heldNodes_ =
        gpu::Buffer("held nodes", sizeof(GpuHeld) + (grasps_ ? texels : 0) * sizeof(std::uint32_t), nullptr);
    marks_ = bufferOf("contact marks", std::vector<std::uint32_t>(triangles_ ? texels : 1, 0));
    movers_ = gpu::Buffer("contact movers", (triangles_ ? texels : 1) * sizeof(std::uint32_t), nullptr);
    createTriangles(textures);
    for (gpu::Program* program : {&held_, &move_, &push_})
        if (*program && !asking_)
            program->buffer("b_loads", loads);
    return {};
}

Status ContactPass::createPrograms(const TextureLayout& layout) {
    const bool grid = layout.kind == SRS_LAYOUT_GRID;
    std::vector<gpu::ShaderDefine> defines = colliders_.defines();
    defines.push_back({"SRS_GROUP_X", grid ? "16" : "64"});
    defines.push_back({"SRS_GROUP_Y", grid ? "8" : "1"});
    if (asking_)
        defines.push_back({"SRS_ASKS", "1"});
    if (keeps_)
        defines.push_back({"SRS_KEEPS_HELD", "1"});
    const gpu::ShaderLibrary library;
    const auto create = [&](gpu::Program& program, const char* stage) -> Status {
        SEROSA_ASSIGN(program, gpu::Program::create(library, {stage}, defines));
        program.set("u_width", layout.width);
        return {};
    };
    if (grasps_ && !asking_) {
        SEROSA_TRY(create(close_, "contact_close.comp"));
        SEROSA_TRY(create(held_, "contact_held.comp"));
    }
    if (triangles_) {
        SEROSA_TRY(create(cull_, "contact_cull.comp"));
        SEROSA_TRY(create(triangle_, "contact_triangles.comp"));
        SEROSA_TRY(create(move_, "contact_moves.comp"));
    }
    if (pushes_) {
        SEROSA_TRY(create(listNear_, "contact_near.comp"));
        SEROSA_TRY(create(push_, "contact_push.comp"));
    }
    return {};
}

void ContactPass::createTriangles(const StateTextures& textures) {
    const Lattice& lattice = *setup_.lattice;
    const auto numberOf = [&](std::uint32_t node) { return std::uint32_t(textures.linearTexel(node)); };
    std::vector<glm::uvec3> triangles;
    if (triangles_)
        triangles = contactSurface(lattice, connections_).triangles;
    triangleCount_ = triangles.size();

    std::vector<GpuNode> nodes(textures.layout().texels());
    for (std::uint32_t node = 0; node < lattice.nodeCount(); ++node)
        nodes[numberOf(node)].mass = float(mass_[node]);
    std::vector<GpuTriangle> data;
    for (const glm::uvec3& t : triangles) {
        GpuTriangle triangle{};
        for (int k = 0; k < 3; ++k) {
            const bool fixed = !setup_.fixed.empty() && setup_.fixed[t[k]];
            triangle.nodes[k] = numberOf(t[k]);
            triangle.depths |= std::uint32_t(lattice.depthSteps[t[k]]) << (8 * k);
            triangle.inverseMasses[k] = fixed ? 0.0f : float(1 / mass_[t[k]]);
            ++nodes[triangle.nodes[k]].corners;
        }
        data.push_back(triangle);
    }
    std::uint32_t first = 0;
    for (GpuNode& node : nodes) {
        node.firstCorner = first;
        first += node.corners;
        node.corners = 0;
    }
    std::vector<std::uint32_t> corners(first);
    for (std::uint32_t triangle = 0; triangle < data.size(); ++triangle)
        for (std::uint32_t k = 0; k < 3; ++k) {
            GpuNode& node = nodes[data[triangle].nodes[k]];
            corners[node.firstCorner + node.corners++] = 3 * triangle + k;
        }
    nodes_ = bufferOf("contact nodes", nodes);
    for (gpu::Program* program : {&close_, &held_, &move_, &push_})
        if (*program)
            program->buffer("b_nodes", nodes_);
    for (gpu::Program* program : {&close_, &held_})
        if (*program)
            program->buffer("b_held", heldNodes_);
    for (gpu::Program* program : {&listNear_, &push_, &move_})
        if (*program)
            program->buffer("b_work", work_).buffer("b_nearList", near_);
    for (gpu::Program* program : {&listNear_, &move_})
        if (*program)
            program->buffer("b_listed", listed_);
    if (!triangles_)
        return;
    trianglesData_ = bufferOf("contact triangles", data);
    corners_ = bufferOf("contact corners", corners);
    candidates_ = gpu::Buffer("contact candidates", data.size() * 2 * sizeof(std::uint32_t), nullptr);
    asks_ = gpu::Buffer("contact asks", data.size() * 3 * 4 * sizeof(std::uint32_t), nullptr);
    asks_.clear(); // of no stamp
    cull_.set("u_triangles", int(triangleCount_));
    cull_.buffer("b_triangles", trianglesData_)
        .buffer("b_work", work_)
        .buffer("b_candidateList", candidates_);
    triangle_.buffer("b_triangles", trianglesData_)
        .buffer("b_work", work_)
        .buffer("b_candidateList", candidates_)
        .buffer("b_asks", asks_)
        .buffer("b_marks", marks_)
        .buffer("b_moverList", movers_);
    move_.buffer("b_corners", corners_).buffer("b_asks", asks_).buffer("b_moverList", movers_);
}

void ContactPass::connect(const StateTextures& textures, const std::vector<std::uint32_t>& connections) {
    stale_ = false;
    if (!triangles_ || connections == connections_)
        return;
    connections_ = connections;
    createTriangles(textures);
}

void ContactPass::prepare(const StateTextures& textures, std::int64_t step, int count) {
    if (empty())
        return;
    if (stale_)
        connect(textures, textures.downloadConnections());
    colliders_.prepare(step, count);
}

void ContactPass::run(StateTextures& textures, std::int64_t step) {
    if (empty())
        return;
    if (idle(step)) {
        recount_ = true;
        return;
    }
    bind(step);
    if (grasps_)
        runGrasps(textures, step);
    if (pushes_)
        runPushes(textures);
}

/// A hand that rests costs nothing.
bool ContactPass::idle(std::int64_t step) const {
    const std::vector<ToolMotion>& motions = colliders_.motions(step);
    return std::all_of(motions.begin(), motions.end(), [](const ToolMotion& motion) {
        return motion.mode == SRS_TOOL_NONE && !motion.opens;
    });
}

void ContactPass::close(const StateTextures& textures, std::int64_t step) {
    if (empty() || !grasps_ || idle(step))
        return;
    bind(step);
    recount_ = true; // nobody counts from step to step
    closeGrasps(textures.positions(), textures, step);
}

void ContactPass::push(StateTextures& textures, std::int64_t step) {
    if (empty() || !pushes_ || idle(step))
        return;
    bind(step);
    runPushes(textures);
}

void ContactPass::bind(std::int64_t step) {
    using enum ContactColliders::Precision;
    for (gpu::Program* program : {&close_, &held_, &triangle_, &move_, &push_})
        if (*program)
            colliders_.bind(*program, step, exact, program != &move_);
    for (gpu::Program* program : {&listNear_, &cull_})
        if (*program)
            colliders_.bind(*program, step, single, true);
    // Of whatever made the positions, a render target or an image.
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

void ContactPass::setPositions(gpu::Program& program, const StateTextures& textures, bool moves) const {
    program.image("i_start", textures.positions_[1 - textures.current_], GL_READ_ONLY);
    program.image("i_positions", textures.positions(), moves ? GL_READ_WRITE : GL_READ_ONLY);
    if (moves || (asking_ && &program == &triangle_))
        program.image("i_increments", textures.increments(), moves ? GL_READ_WRITE : GL_READ_ONLY);
}

void ContactPass::closeGrasps(const gpu::Texture2D& start, const StateTextures& textures, std::int64_t step) {
    const std::vector<ToolMotion>& motions = colliders_.motions(step);
    unsigned opens = 0, closes = 0;
    bool holds = false;
    for (std::size_t tool = 0; tool < setup_.tools.size(); ++tool) {
        opens |= motions[tool].opens ? 1u << tool : 0u;
        closes |= motions[tool].closes ? 1u << tool : 0u;
        holds = holds || motions[tool].mode == SRS_TOOL_GRASP;
    }
    const glm::ivec3 items(textures.layout().width, textures.layout().height, 1);
    const int now = int(step % 3);
    if (opens || closes || (holds && recount_)) {
        const GpuHeld none;
        heldNodes_.upload(0, sizeof none, &none);
        close_.set("u_opens", opens).set("u_closes", closes).set("u_now", now);
        close_.image("i_start", start, GL_READ_ONLY);
        close_.image("i_nodeInfo", textures.nodeInfo(), GL_READ_WRITE);
        close_.dispatch(items);
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                        GL_COMMAND_BARRIER_BIT);
    }
    recount_ = !holds; // the next grasp begins with a count
}

void ContactPass::runGrasps(const StateTextures& textures, std::int64_t step) {
    closeGrasps(textures.positions_[1 - textures.current_], textures, step);
    if (recount_)
        return; // nothing is held
    const int now = int(step % 3);
    held_.set("u_now", now);
    setPositions(held_, textures, true);
    held_.image("i_nodeInfo", textures.nodeInfo(), GL_READ_WRITE);
    held_.dispatchIndirect(heldNodes_, 0);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

void ContactPass::runPushes(const StateTextures& textures) {
    const int set = set_ = 1 - set_;
    const auto list = [set](int kind) {
        return std::size_t(set * SRS_CONTACT_LISTS + kind) * sizeof(GpuList);
    };
    const auto wait = [](GLbitfield also) { glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | also); };
    for (gpu::Program* program : {&listNear_, &cull_, &triangle_, &move_, &push_})
        if (*program)
            program->set("u_set", set);
    stamp_ = stamp_ + 1 < kStamps ? stamp_ + 1 : 1;
    listNear_.set("u_step", unsigned(stamp_));
    setPositions(listNear_, textures, false);
    listNear_.dispatch({textures.layout().width, textures.layout().height, 1});
    const bool triangles = triangleCount_ > 0;
    if (triangles) {
        setPositions(cull_, textures, false);
        cull_.dispatch({int(triangleCount_), 1, 1});
        setPositions(triangle_, textures, false);
        if (keeps_)
            triangle_.image("i_nodeInfo", textures.nodeInfo(), GL_READ_ONLY);
        setPositions(move_, textures, true);
        move_.set("u_step", unsigned(stamp_));
    }
    wait(GL_COMMAND_BARRIER_BIT);
    for (int round = 0; round < SRS_CONTACT_ITERATIONS && triangles; ++round) {
        const unsigned stamp = unsigned(stamp_) * 4 + unsigned(round);
        triangle_.set("u_round", round).set("u_stamp", stamp);
        triangle_.dispatchIndirect(work_, list(round == 0 ? SRS_LIST_CANDIDATES : SRS_LIST_AGAIN));
        wait(GL_COMMAND_BARRIER_BIT);
        move_.set("u_round", round).set("u_stamp", stamp);
        move_.dispatchIndirect(work_, list(SRS_LIST_MOVERS + round));
        wait(GL_COMMAND_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    }
    setPositions(push_, textures, true);
    push_.image("i_nodeInfo", textures.nodeInfo(), GL_READ_ONLY);
    push_.dispatchIndirect(work_, list(SRS_LIST_NEAR));
    wait(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

std::size_t ContactPass::bytes() const {
    std::size_t sum = colliders_.bytes();
    for (const gpu::Buffer* buffer : {&nodes_, &trianglesData_, &corners_, &candidates_, &asks_, &marks_,
                                      &movers_, &work_, &listed_, &near_, &heldNodes_})
        sum += buffer->bytes();
    return sum;
}

} // namespace serosa::sim
