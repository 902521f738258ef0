#include "render/surface_passes.h"

#include "base/check.h"
#include "gpu/gl.h"
#include "render/basis_choice.h"
#include "render/surface_vertices.h"
#include "render/vertex_colours.h"
#include "shaders/mapping_constants.h"
#include "shaders/shared_constants.h"

#include <algorithm>
#include <cstddef>
#include <string>

namespace serosa::render {

namespace {

using sim::SurfaceColour;

constexpr int kCapturedBytes = 24; // position and normal of a vertex

constexpr SurfaceColour kColours[] = {SurfaceColour::tissue, SurfaceColour::dynamicNormal,
                                      SurfaceColour::plain};

void addColour(std::vector<gpu::ShaderDefine>& defines, SurfaceColour colour) {
    if (colour == SurfaceColour::dynamicNormal)
        defines.push_back({"SURFACE_NORMAL_COLOURS", ""});
    if (colour == SurfaceColour::plain)
        defines.push_back({"SURFACE_PLAIN", ""});
}

/// The define MAPPING of a stage.
int mappingOf(SurfaceStage stage, bool anyConstant) {
    switch (stage) {
    case SurfaceStage::corrected:
        return anyConstant ? SRS_MAP_EITHER : SRS_MAP_CORRECTED;
    case SurfaceStage::chosen:
        return SRS_MAP_BLENDED;
    case SurfaceStage::alongNormal:
        return SRS_MAP_NORMAL;
    case SurfaceStage::nodeFrames:
        return SRS_MAP_FRAMES;
    case SurfaceStage::inCells:
        return SRS_MAP_CELLS;
    default:
        return SRS_MAP_CONSTANT;
    }
}

bool isMapped(SurfaceStage stage) {
    return stage != SurfaceStage::undeformed && stage != SurfaceStage::nodes;
}

} // namespace

SurfaceStage stageOf(sim::Mapping mapping) {
    switch (mapping) {
    case sim::Mapping::oneToOne:
        return SurfaceStage::nodes;
    case sim::Mapping::triangle:
        return SurfaceStage::constant;
    case sim::Mapping::chosen:
        return SurfaceStage::chosen;
    case sim::Mapping::normalOffset:
        return SurfaceStage::alongNormal;
    case sim::Mapping::trilinear:
        return SurfaceStage::inCells;
    case sim::Mapping::nodeFrames:
        return SurfaceStage::nodeFrames;
    case sim::Mapping::curvature:
        break;
    }
    return SurfaceStage::corrected;
}

std::vector<SurfaceStage> SurfacePasses::mappedStages() const {
    std::vector<SurfaceStage> stages;
    for (const auto& [stage, geometry] : geometry_)
        if (isMapped(stage))
            stages.push_back(stage);
    return stages;
}

std::vector<gpu::ShaderDefine> SurfacePasses::defines(SurfaceStage stage) const {
    std::vector<gpu::ShaderDefine> all;
    if (stage == SurfaceStage::nodes)
        return {{"SURFACE_NODES", ""}};
    if (stage == SurfaceStage::undeformed)
        all.push_back({"SURFACE_STATIC", ""});
    else
        all.push_back({"MAPPING", std::to_string(mappingOf(stage, anyConstant_))});
    if (usesRest())
        all.push_back({"SURFACE_REST", ""});
    if (mask_)
        all.push_back({"SURFACE_CUT", ""});
    if (box_)
        all.push_back({"SURFACE_BOX", ""});
    if (textures_)
        all.push_back({"SURFACE_TEXTURED", ""});
    if (textures_ && !drawn_.textures.empty())
        all.push_back({"SURFACE_UV", ""});
    return all;
}

Result<SurfacePasses::Programs> SurfacePasses::compile(const gpu::ShaderLibrary& library) const {
    Programs programs;
    for (const auto& [stage, geometry] : geometry_)
        for (const SurfaceColour colour : kColours) {
            std::vector<gpu::ShaderDefine> all = defines(stage);
            addColour(all, colour);
            SEROSA_ASSIGN(gpu::Program program,
                          gpu::Program::create(library, {"surface.vert", "surface.frag"}, all));
            programs.emplace(std::pair(stage, colour), std::move(program));
        }
    return programs;
}

Result<SurfacePasses::Programs> SurfacePasses::compileBlend(const gpu::ShaderLibrary& library) const {
    Programs programs;
    for (const SurfaceStage stage : mappedStages()) {
        for (const SurfaceColour colour : kColours) {
            std::vector<gpu::ShaderDefine> all = defines(stage);
            all.push_back({"SURFACE_BLEND", ""});
            addColour(all, colour);
            SEROSA_ASSIGN(gpu::Program program,
                          gpu::Program::create(library, {"surface.vert", "surface.frag"}, all));
            programs.emplace(std::pair(stage, colour), std::move(program));
        }
    }
    return programs;
}

// As compile and createCaptures.
Status SurfacePasses::prepareBlend() {
    if (!blendStarts_.empty())
        return {};
    const gpu::ShaderLibrary library;
    SEROSA_ASSIGN(blendPrograms_, compileBlend(library));
    for (const SurfaceStage stage : mappedStages()) {
        std::vector<gpu::ShaderDefine> all = defines(stage);
        SEROSA_ASSIGN(gpu::Program start,
                      gpu::Program::create(library, {"lod_blend.vert"}, all, {"v_offset", "v_normal"}));
        blendStarts_.emplace(stage, std::move(start));
        all.push_back({"SURFACE_BLEND", ""});
        SEROSA_ASSIGN(gpu::Program capture,
                      gpu::Program::create(library, {"surface.vert"}, all, {"v_position", "v_normal"}));
        blendCaptures_.emplace(stage, std::move(capture));
    }
    return {};
}

Status SurfacePasses::createCaptures() {
    for (const auto& [stage, geometry] : geometry_) {
        SEROSA_ASSIGN(gpu::Program capture, gpu::Program::create(gpu::ShaderLibrary(), {"surface.vert"},
                                                                 defines(stage), {"v_position", "v_normal"}));
        captures_.emplace(stage, std::move(capture));
    }
    return {};
}

void SurfacePasses::setIndices(const std::vector<std::uint32_t>& indices) {
    levels_.clear();
    levels_.push_back({gpu::Buffer("surface indices", std::span<const std::uint32_t>(indices)),
                       int(indices.size()),
                       0,
                       {},
                       {}});
}

Status SurfacePasses::recompile() {
    const gpu::ShaderLibrary library;
    SEROSA_ASSIGN(programs_, compile(library));
    depthPrograms_.clear();
    blendDepthPrograms_.clear();
    captures_.clear();
    SEROSA_TRY(createCaptures());
    if (blendStarts_.empty())
        return {};
    blendStarts_.clear();
    blendCaptures_.clear();
    return prepareBlend();
}

Status SurfacePasses::createGeometry(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                     const std::vector<SurfaceBinding>& bindings,
                                     const sim::TextureLayout& layout) {
    const CacheOrder order = cacheOrder(drawn_.faces, drawn_.origin.size());
    newIndex_ = order.newIndex;
    const glm::vec3 mean = textures_ ? 1.0F / textures_->albedoScale : glm::vec3(0);
    colours_ = vertexColours(metres, textures_ ? &mean : nullptr);
    restBox_ = restBox(lattice, metres);
    for (const SurfaceBinding& one : bindings)
        SEROSA_TRY(createMapped(one, layout));
    if (textures_) {
        const RestNormals rest(lattice);
        for (const SurfaceBinding& one : bindings)
            createRest(one, lattice, metres, rest);
    }
    createStatic(lattice, metres);
    setIndices(order.indices);
    createLevels(lattice, metres);
    createNodes(lattice.boundary, layout);
    return {};
}

/// One-to-one: the boundary's triangles, one vertex a surface node.
void SurfacePasses::createNodes(const std::vector<glm::uvec3>& boundary, const sim::TextureLayout& layout) {
    std::vector<std::uint32_t> vertexOfNode(layout.texelOfNode.size(), ~0U), nodeIndices, texels;
    for (const glm::uvec3& t : boundary)
        for (int i = 0; i < 3; ++i) {
            if (vertexOfNode[t[i]] == ~0U) {
                vertexOfNode[t[i]] = std::uint32_t(texels.size());
                texels.push_back(layout.texelOfNode[t[i]].y << 16 | layout.texelOfNode[t[i]].x);
            }
            nodeIndices.push_back(vertexOfNode[t[i]]);
        }
    Geometry& nodes = geometry_[SurfaceStage::nodes];
    nodes.vertices = gpu::Buffer("surface nodes", std::span<const std::uint32_t>(texels));
    nodeIndices_ = gpu::Buffer("surface node indices", std::span<const std::uint32_t>(nodeIndices));
    nodeIndexCount_ = int(nodeIndices.size());
    nodes.array = gpu::VertexArray("surface nodes");
    nodes.array.integerAttribute(0, nodes.vertices, 1, GL_UNSIGNED_INT, sizeof(std::uint32_t), 0);
    nodes.array.indices(nodeIndices_);
}

Result<SurfacePasses> SurfacePasses::create(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                            const std::vector<SurfaceBinding>& bindings,
                                            const sim::TextureLayout& layout, const SurfaceDetail* detail) {
    SurfacePasses passes;
    passes.bounds_ = restBox(lattice, metres);
    passes.meshVertices_ = metres.positions.size();
    passes.none_ = gpu::Texture2D("no map", GL_R8, 1, 1);
    if (detail)
        passes.createTextures(*detail, lattice);
    sim::TriangleMesh plain; // without texture there are no seams
    plain.positions = metres.positions;
    plain.faces = metres.faces;
    passes.drawn_ = drawnVertices(detail ? metres : plain, metres.vertexNormals());
    for (const SurfaceBinding& binding : bindings) {
        SEROSA_CHECK(binding.vertices.size() == metres.positions.size(), "the binding is of another mesh");
        passes.anyConstant_ = passes.anyConstant_ ||
                              (binding.mapping == sim::Mapping::curvature && binding.constantVertices > 0);
    }
    SEROSA_TRY(passes.createGeometry(lattice, metres, bindings, layout));
    SEROSA_ASSIGN(passes.programs_, passes.compile(gpu::ShaderLibrary()));
    SEROSA_TRY(passes.createCaptures());
    if (detail)
        passes.createUvs();
    return passes;
}

void SurfacePasses::setNodes(gpu::Program& program, const sim::StateTextures& state, SurfaceStage stage) {
    if (stage == SurfaceStage::undeformed)
        return;
    program.texture("t_positions", state.positions());
    if (stage == SurfaceStage::inCells)
        program.texture("t_cells", cells_);
    if (mask_ && isMapped(stage))
        program.texture("t_above", sideNodes_->above()).texture("t_below", sideNodes_->below());
    if (mask_ && isMapped(stage) && stage != SurfaceStage::inCells)
        program.texture("t_carried", carried_);
    if (stage == SurfaceStage::nodeFrames)
        program.texture("t_frames", frames_->frames());
}

void SurfacePasses::follow(const sim::StateTextures& state, SurfaceStage stage) {
    if (mask_ && !copies_.empty() && isMapped(stage)) // copies alone read them
        sideNodes_->update(state, *mask_);
    if (stage == SurfaceStage::nodeFrames)
        frames_->run(state.positions());
}

void SurfacePasses::setVertexInputs(gpu::Program& program, const sim::StateTextures& state,
                                    const Frame& frame, SurfaceStage stage) {
    if (blends(stage))
        setBlendUniforms(program);
    program.set("u_clipFromLattice", frame.clipFromLattice);
    program.set("u_section", frame.section);
    setNodes(program, state, stage);
    if (usesRest() && stage != SurfaceStage::nodes)
        program.set("u_restFrom", restBox_.from).set("u_restExtent", restBox_.extent);
    if (stage == SurfaceStage::nodes)
        program.set("u_colour", glm::vec4(0, 0, 0, 1));
}

gpu::Program& SurfacePasses::prepare(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage,
                                     SurfaceColour colour, const glm::vec3& bare) {
    SEROSA_CHECK(draws(stage), "a mapping that was prepared");
    // Colours of materials are those of the vertices, as the tissue's are.
    gpu::Program& program =
        (blends(stage) ? blendPrograms_ : programs_)
            .at({stage, colour == SurfaceColour::material ? SurfaceColour::tissue : colour});
    setVertexInputs(program, state, frame, stage);
    if (mask_ && stage != SurfaceStage::nodes) {
        mask_->bind(program);
        program.set("u_blood", frame.blood ? 1 : 0);
    }
    if (box_ && stage != SurfaceStage::nodes)
        box_->set(program, origin_, unit_);
    if (textures_ && stage != SurfaceStage::nodes) {
        program.texture("t_albedo", textures_->albedo).texture("t_relief", textures_->relief);
        program.set("u_albedoScale", textures_->albedoScale).set("u_tiles", textures_->tiles);
        program.set("u_tileShift", textures_->shift).set("u_relief", textures_->relief_);
    }
    if (stage == SurfaceStage::nodes)
        program.set("u_colour", glm::vec4(glm::sqrt(bare), 1));
    frame.setTissueLight(program, none_);
    return program;
}

void SurfacePasses::drawDepth(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage) {
    const bool blend = blends(stage);
    gpu::Program& program = (blend ? blendDepthPrograms_ : depthPrograms_)[stage];
    if (!program) {
        std::vector<gpu::ShaderDefine> all = defines(stage);
        if (blend)
            all.push_back({"SURFACE_BLEND", ""});
        Result<gpu::Program> made =
            gpu::Program::create(gpu::ShaderLibrary(), {"surface.vert", "surface_depth.frag"}, all);
        SEROSA_CHECK(made.ok(), "the vertex stage compiled before");
        program = std::move(made).value();
    }
    setVertexInputs(program, state, frame, stage);
    if (mask_ && stage != SurfaceStage::nodes)
        mask_->bind(program);
    program.use();
    const bool sectioned = frame.section != glm::vec4(0);
    if (sectioned)
        glEnable(GL_CLIP_DISTANCE0);
    drawTriangles(stage, 0);
    glDisable(GL_CLIP_DISTANCE0);
}

void SurfacePasses::drawTriangles(SurfaceStage stage, std::size_t level) {
    gpu::VertexArray& array = geometry_.at(stage).array;
    if (stage != SurfaceStage::nodes)
        array.indices(levels_[level].indices);
    glBindVertexArray(array.id());
    glDrawElements(GL_TRIANGLES, stage == SurfaceStage::nodes ? nodeIndexCount_ : levels_[level].count,
                   GL_UNSIGNED_INT, nullptr);
}

void SurfacePasses::draw(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage,
                         SurfaceColour colour, const glm::vec3& bare) {
    gpu::Program& program = prepare(state, frame, stage, colour, bare);
    program.use();
    const bool sectioned = frame.section != glm::vec4(0);
    if (sectioned)
        glEnable(GL_CLIP_DISTANCE0);
    if (sectioned || mask_ || !copies_.empty())
        glDisable(GL_CULL_FACE); // inner sides show as cut tissue
    const std::size_t level = stage == SurfaceStage::nodes ? 0 : levelFor(frame);
    lastLevel_ = level;
    lastCulled_.reset();
    const bool mapped =
        isMapped(stage) && stage != SurfaceStage::inCells; // cells do not keep an offset's length
    if (frame.cull && !sectioned && mapped && !blends(stage) && !levels_.empty() && levels_[level].clusters)
        drawClusters(state, frame, stage, level, program);
    else
        drawTriangles(stage, level);
    glEnable(GL_CULL_FACE);
    glDisable(GL_CLIP_DISTANCE0);
}

void SurfacePasses::drawDiscarded(const sim::StateTextures& state, SurfaceStage stage) {
    prepare(state, Frame{}, stage, SurfaceColour::tissue, kFleshColour).use();
    glEnable(GL_RASTERIZER_DISCARD);
    drawTriangles(stage, 0);
    glDisable(GL_RASTERIZER_DISCARD);
}

void SurfacePasses::setBlendUniforms(gpu::Program& program) const {
    program.set("u_blendFrames", blendFrame_).set("u_blendStep", blendStep_);
}

void SurfacePasses::feedBack(SurfaceStage stage, const gpu::Program& program, const gpu::Buffer& into) {
    program.use();
    glBindVertexArray(geometry_.at(stage).array.id());
    glEnable(GL_RASTERIZER_DISCARD);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, into.id());
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, GLsizei(vertexCount()));
    glEndTransformFeedback();
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    glDisable(GL_RASTERIZER_DISCARD);
}

gpu::Buffer SurfacePasses::shown(const sim::StateTextures& state, SurfaceStage stage) {
    SEROSA_CHECK(stage != SurfaceStage::nodes, "node positions are in the state texture already");
    gpu::Program& program = (blends(stage) ? blendCaptures_ : captures_).at(stage);
    follow(state, stage);
    setVertexInputs(program, state, Frame{}, stage);
    gpu::Buffer captured("captured vertices", vertexCount() * kCapturedBytes, nullptr);
    feedBack(stage, program, captured);
    return captured;
}

Result<std::vector<glm::mat3>> SurfacePasses::captureAxes(const sim::StateTextures& state,
                                                          SurfaceStage stage) {
    SEROSA_CHECK(isMapped(stage) && draws(stage), "a mapping that was prepared");
    SEROSA_ASSIGN(gpu::Program program,
                  gpu::Program::create(gpu::ShaderLibrary(), {"mapped_axes.vert"}, defines(stage),
                                       {"v_tangent", "v_axis", "v_bitangent"}));
    follow(state, stage);
    setNodes(program, state, stage);
    std::vector<glm::mat3> captured(vertexCount()), axes;
    const gpu::Buffer buffer("captured axes", captured.size() * sizeof captured[0], nullptr);
    feedBack(stage, program, buffer);
    buffer.download(0, buffer.bytes(), captured.data());
    for (std::size_t v = 0; v < meshVertices_; ++v)
        axes.push_back(captured[newIndex_[v]]);
    return axes;
}

void SurfacePasses::attachBlend(SurfaceStage stage, const gpu::Buffer& buffer) {
    gpu::VertexArray& array = geometry_.at(stage).array;
    array.attribute(5, buffer, 3, GL_FLOAT, false, kCapturedBytes, 0);
    array.attribute(6, buffer, 3, GL_FLOAT, false, kCapturedBytes, kCapturedBytes / 2);
}

void SurfacePasses::startBlend(const sim::StateTextures& state, SurfaceStage stage, const gpu::Buffer& shown,
                               float scale, const glm::vec3& shift, float step) {
    gpu::Program& program = blendStarts_.at(stage);
    attachBlend(stage, shown);
    program.set("u_shownScale", scale).set("u_shownShift", shift);
    follow(state, stage);
    setNodes(program, state, stage);
    blend_ = gpu::Buffer("switch of detail", vertexCount() * kCapturedBytes, nullptr);
    feedBack(stage, program, blend_);
    attachBlend(stage, blend_);
    blendStage_ = stage;
    blendFrame_ = 0;
    blendStep_ = step;
}

std::vector<float> SurfacePasses::blend() const {
    std::vector<float> values;
    if (!blendStage_)
        return values;
    values.resize(blend_.bytes() / sizeof(float));
    blend_.download(0, blend_.bytes(), values.data());
    return values;
}

void SurfacePasses::setBlend(SurfaceStage stage, const std::vector<float>& blend, float step) {
    blendStage_.reset();
    if (blend.size() * sizeof(float) != vertexCount() * kCapturedBytes)
        return;
    blend_ = gpu::Buffer("switch of detail", std::span<const float>(blend));
    attachBlend(stage, blend_);
    blendStage_ = stage;
    blendStep_ = step;
}

void SurfacePasses::setBlendFrame(float frames) {
    blendFrame_ = frames;
    if (frames >= float(SRS_BLEND_MOST_FRAMES))
        blendStage_.reset();
}

SurfacePasses::Captured SurfacePasses::capture(const sim::StateTextures& state, SurfaceStage stage) {
    struct Item {
        glm::vec3 position, normal;
    };
    static_assert(sizeof(Item) == kCapturedBytes, "two outputs");
    std::vector<Item> items(vertexCount());
    shown(state, stage).download(0, items.size() * sizeof(Item), items.data());

    Captured result;
    for (std::size_t v = 0; v < meshVertices_; ++v) {
        result.positions.push_back(items[newIndex_[v]].position);
        result.normals.push_back(items[newIndex_[v]].normal);
    }
    return result;
}

} // namespace serosa::render
