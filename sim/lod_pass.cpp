// See sim/lod_pass.h. Both halves of the target's textures are written: the gathered motion into the one that
// is not current, and from there, with momentum and normals, into the current one.
#include "sim/lod_pass.h"

#include "base/check.h"
#include "shaders/shared_constants.h"

#include <algorithm>
#include <bit>
#include <string>

namespace serosa::sim {

namespace {

constexpr std::uint32_t kFixed = 0x8000; // shaders/lod.glsl

std::uint32_t wordOf(const TextureLayout& layout, std::size_t node) {
    return layout.texelOfNode[node].y << 16 | layout.texelOfNode[node].x;
}

glm::uvec4 placed(const glm::dvec3& rest, std::uint32_t word) {
    const glm::vec3 r(rest);
    return {std::bit_cast<std::uint32_t>(r.x), std::bit_cast<std::uint32_t>(r.y),
            std::bit_cast<std::uint32_t>(r.z), word};
}

std::vector<glm::uvec2> massItems(const TextureLayout& layout, const std::vector<double>& masses) {
    std::vector<glm::uvec2> items;
    for (std::size_t node = 0; node < masses.size(); ++node)
        items.emplace_back(wordOf(layout, node), std::bit_cast<std::uint32_t>(float(masses[node])));
    return items;
}

int groupsOf(std::size_t nodes) {
    return int((nodes + SRS_LOD_RUN - 1) / SRS_LOD_RUN);
}

} // namespace

Result<LodPass::Way> LodPass::makeWay(const SolverSetup& from, const TextureLayout& fromLayout,
                                      const SolverSetup& to, const TextureLayout& toLayout) {
    Way way;
    way.transfer = LodTransfer::make(from, to);
    const LodTransfer& transfer = way.transfer;
    std::vector<glm::uvec4> sources, targets;
    for (std::size_t node = 0; node < transfer.sourceRest.size(); ++node)
        sources.push_back(placed(transfer.sourceRest[node], wordOf(fromLayout, node)));
    // Places' entries, then those of velocities that have rows of their own.
    std::vector<LodEntry> entries = transfer.places.entries;
    std::uint32_t shift = 0;
    if (!transfer.finer) {
        shift = std::uint32_t(entries.size());
        entries.insert(entries.end(), transfer.velocities.entries.begin(), transfer.velocities.entries.end());
    }
    for (std::size_t node = 0; node < transfer.targetRest.size(); ++node) {
        targets.push_back(placed(transfer.targetRest[node],
                                 wordOf(toLayout, node) | (transfer.targetFixed[node] ? kFixed : 0)));
        targets.emplace_back(transfer.places.starts[node], transfer.places.starts[node + 1],
                             shift + transfer.velocities.starts[node],
                             shift + transfer.velocities.starts[node + 1]);
    }
    static_assert(sizeof(LodEntry) == 8, "a uvec2 of the shader");
    way.sources = gpu::Buffer("lod sources", std::span<const glm::uvec4>(sources));
    way.targets = gpu::Buffer("lod targets", std::span<const glm::uvec4>(targets));
    way.entries = gpu::Buffer("lod entries", std::span<const LodEntry>(entries));
    const auto sourceMasses = massItems(fromLayout, transfer.sourceMasses),
               targetMasses = massItems(toLayout, transfer.targetMasses);
    way.sourceMasses = gpu::Buffer("lod masses", std::span<const glm::uvec2>(sourceMasses));
    way.targetMasses = gpu::Buffer("lod masses", std::span<const glm::uvec2>(targetMasses));
    way.sourceGroups = groupsOf(sourceMasses.size());
    way.targetGroups = groupsOf(targetMasses.size());
    SEROSA_ASSIGN(
        way.finish,
        gpu::Program::create(gpu::ShaderLibrary(), {"lod_finish.comp"},
                             {{"SRS_LAYOUT", std::to_string(toLayout.kind)},
                              {"SRS_GRID_NY", std::to_string(toLayout.gridStride.z)},
                              {"SRS_ROW_LOG2", std::to_string(std::countr_zero(unsigned(toLayout.width)))}}));
    return way;
}

Result<LodPass> LodPass::create(const SolverSetup& fine, const TextureLayout& fineLayout,
                                const SolverSetup& coarse, const TextureLayout& coarseLayout) {
    LodPass pass;
    SEROSA_ASSIGN(pass.toCoarser_, makeWay(fine, fineLayout, coarse, coarseLayout));
    SEROSA_ASSIGN(pass.toFiner_, makeWay(coarse, coarseLayout, fine, fineLayout));
    const gpu::ShaderLibrary library;
    SEROSA_ASSIGN(pass.gather_, gpu::Program::create(library, {"lod_gather.comp"}));
    SEROSA_ASSIGN(pass.sums_, gpu::Program::create(library, {"lod_sums.comp"}));
    SEROSA_ASSIGN(pass.correct_, gpu::Program::create(library, {"lod_correct.comp"}));
    SEROSA_ASSIGN(pass.detailProgram_, gpu::Program::create(library, {"lod_detail.comp"}));
    const int groups = pass.toFiner_.sourceGroups + pass.toFiner_.targetGroups;
    pass.partialSums_ =
        gpu::Buffer("lod sums", std::size_t(groups) * SRS_LOD_SUMS * sizeof(glm::vec4), nullptr);
    pass.motion_ = gpu::Buffer("lod rigid motion", 3 * sizeof(glm::vec4), nullptr);
    pass.detail_ = gpu::Buffer("lod detail", fine.lattice->nodeCount() * sizeof(glm::vec4), nullptr);
    return pass;
}

void LodPass::sum(const gpu::Buffer& masses, int nodes, int firstGroup, int groups,
                  const StateTextures& state, int half) {
    sums_.buffer("b_masses", masses).buffer("b_sums", partialSums_);
    sums_.set("u_nodes", nodes).set("u_first", firstGroup);
    sums_.texture("t_positions", state.positions_[half]).texture("t_increments", state.increments_[half]);
    sums_.texture("t_before", state.increments_[1 - half]);
    sums_.dispatch({groups * sums_.groupSize().x, 1, 1});
}

void LodPass::run(Way& way, const StateTextures& from, StateTextures& to, float lead) {
    const LodTransfer& transfer = way.transfer;
    const int nodes = int(transfer.targetRest.size()), current = to.current_, other = 1 - current;
    const float lengthScale = float(transfer.lengthScale),
                velocityScale = float(transfer.lengthScale * transfer.stepScale);
    // Of whatever wrote the source last, a render target or an image.
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    to.nodeInfo_[to.currentInfo_].upload(to.info_.data());
    gather_.buffer("b_sources", way.sources).buffer("b_targets", way.targets);
    gather_.buffer("b_entries", way.entries).buffer("b_detail", detail_);
    gather_.set("u_nodes", nodes).set("u_lengthScale", lengthScale).set("u_velocityScale", velocityScale);
    gather_.set("u_lead", lead).set("u_detailed", transfer.finer && hasDetail_ ? 1 : 0);
    gather_.texture("t_positions", from.positions()).texture("t_increments", from.increments());
    gather_.texture("t_before", from.increments_[1 - from.current_]);
    gather_.image("i_newPositions", to.positions_[other], GL_WRITE_ONLY);
    gather_.image("i_newIncrements", to.increments_[other], GL_WRITE_ONLY);
    gather_.dispatch({nodes, 1, 1});
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);

    sums_.set("u_lengthScale", lengthScale).set("u_velocityScale", velocityScale).set("u_lead", lead);
    sum(way.sourceMasses, int(transfer.sourceRest.size()), 0, way.sourceGroups, from, from.current_);
    sums_.set("u_lengthScale", 1.0F).set("u_velocityScale", 1.0F).set("u_lead", 0.0F);
    sum(way.targetMasses, nodes, way.sourceGroups, way.targetGroups, to, other);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    correct_.buffer("b_sums", partialSums_).buffer("b_motion", motion_);
    correct_.set("u_groups", glm::ivec2(way.sourceGroups, way.targetGroups));
    correct_.dispatch({1, 1, 1});
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);

    way.finish.buffer("b_masses", way.targetMasses).buffer("b_motion", motion_).set("u_nodes", nodes);
    way.finish.image("i_nodeInfo", to.nodeInfo(), GL_READ_ONLY);
    if (to.layout_.kind == SRS_LAYOUT_ROWS) {
        way.finish.image("i_rowOffsetsA", to.rowOffsets_[0], GL_READ_ONLY);
        way.finish.image("i_rowOffsetsB", to.rowOffsets_[1], GL_READ_ONLY);
    }
    way.finish.texture("t_positions", to.positions_[other]).texture("t_increments", to.increments_[other]);
    way.finish.image("i_newPositions", to.positions_[current], GL_WRITE_ONLY);
    way.finish.image("i_newIncrements", to.increments_[current], GL_WRITE_ONLY);
    way.finish.dispatch({nodes, 1, 1});
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

void LodPass::toCoarser(const StateTextures& fine, StateTextures& coarse, double lead) {
    run(toCoarser_, fine, coarse, float(lead));
    const LodTransfer& transfer = toFiner_.transfer;
    const int nodes = int(transfer.targetRest.size());
    detailProgram_.buffer("b_sources", toFiner_.sources).buffer("b_targets", toFiner_.targets);
    detailProgram_.buffer("b_entries", toFiner_.entries).buffer("b_detail", detail_);
    detailProgram_.set("u_nodes", nodes).set("u_lengthScale", float(transfer.lengthScale));
    detailProgram_.texture("t_coarse", coarse.positions()).texture("t_fine", fine.positions());
    detailProgram_.dispatch({nodes, 1, 1});
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    hasDetail_ = true;
}

void LodPass::toFiner(const StateTextures& coarse, StateTextures& fine, double lead) {
    run(toFiner_, coarse, fine, float(lead));
    hasDetail_ = false;
}

LodDetail LodPass::detail() const {
    LodDetail detail;
    if (!hasDetail_)
        return detail;
    std::vector<glm::vec4> items(detail_.bytes() / sizeof(glm::vec4));
    detail_.download(0, detail_.bytes(), items.data());
    for (const glm::vec4& item : items)
        detail.emplace_back(item);
    return detail;
}

void LodPass::setDetail(const LodDetail& detail) {
    hasDetail_ = !detail.empty();
    if (!hasDetail_)
        return;
    SEROSA_CHECK(detail.size() * sizeof(glm::vec4) == detail_.bytes(), "a vector a fine node");
    std::vector<glm::vec4> items;
    for (const glm::dvec3& item : detail)
        items.emplace_back(glm::vec3(item), 0);
    detail_.upload(0, detail_.bytes(), items.data());
}

} // namespace serosa::sim
