#include "render/surface_passes.h"

#include "base/check.h"
#include "gpu/gl.h"
#include "render/baked_occlusion.h"
#include "render/surface_vertices.h"
#include "shaders/mapping_constants.h"
#include "shaders/shared_constants.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

namespace serosa::render {

namespace {

using sim::SurfaceColour;

constexpr int kCapturedBytes = 24;         // position and normal of a vertex
constexpr glm::u8vec3 kFlesh{158, 62, 54}; // sRGB of kFleshColour, where the mesh has no colours

/// Square root of the linear value: the vertex stage squares it, and 8 bits suffice in the dark.
std::uint8_t rootOfLinear(std::uint8_t srgb) {
    const double s = srgb / 255.0;
    const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    return std::uint8_t(std::lround(255 * std::sqrt(linear)));
}

glm::u8vec4 vertexColour(const glm::u8vec3& srgb, float open) {
    return {rootOfLinear(srgb.r), rootOfLinear(srgb.g), rootOfLinear(srgb.b), std::lround(255 * open)};
}

std::vector<glm::u8vec4> vertexColours(const sim::TriangleMesh& mesh) {
    const std::vector<float> open = bakeOcclusion(mesh);
    std::vector<glm::u8vec4> colours;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        colours.push_back(vertexColour(mesh.colours.empty() ? kFlesh : mesh.colours[v], open[v]));
    return colours;
}

template <class T>
std::vector<T> inNewOrder(const std::vector<T>& items, const std::vector<std::uint32_t>& newIndex) {
    std::vector<T> ordered(items.size());
    for (std::size_t i = 0; i < items.size(); ++i)
        ordered[newIndex[i]] = items[i];
    return ordered;
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

/// Attributes from 3 on are those of all mapped vertices.
template <class Vertex, class Base = Vertex>
void attributesOf(gpu::VertexArray& array, const gpu::Buffer& buffer) {
    array.integerAttribute(3, buffer, 1, GL_UNSIGNED_INT, sizeof(Vertex), offsetof(Base, normal));
    array.attribute(4, buffer, 4, GL_UNSIGNED_BYTE, true, sizeof(Vertex), offsetof(Base, colour));
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
    if (stage == SurfaceStage::nodes)
        return {{"SURFACE_NODES", ""}};
    if (stage == SurfaceStage::undeformed)
        return {{"SURFACE_STATIC", ""}};
    return {{"MAPPING", std::to_string(mappingOf(stage, anyConstant_))}};
}

Result<SurfacePasses::Programs> SurfacePasses::compile(const gpu::ShaderLibrary& library) const {
    Programs programs;
    for (const auto& [stage, geometry] : geometry_)
        for (const SurfaceColour colour : {SurfaceColour::tissue, SurfaceColour::dynamicNormal}) {
            std::vector<gpu::ShaderDefine> all = defines(stage);
            if (colour == SurfaceColour::dynamicNormal)
                all.push_back({"SURFACE_NORMAL_COLOURS", ""});
            SEROSA_ASSIGN(gpu::Program program,
                          gpu::Program::create(library, {"surface.vert", "surface.frag"}, all));
            programs.emplace(std::pair(stage, colour), std::move(program));
        }
    return programs;
}

// As compile and createCaptures.
Status SurfacePasses::prepareBlend() {
    if (!blendStarts_.empty())
        return {};
    const gpu::ShaderLibrary library;
    for (const SurfaceStage stage : mappedStages()) {
        std::vector<gpu::ShaderDefine> all = defines(stage);
        SEROSA_ASSIGN(gpu::Program start,
                      gpu::Program::create(library, {"lod_blend.vert"}, all, {"v_offset", "v_normal"}));
        blendStarts_.emplace(stage, std::move(start));
        all.push_back({"SURFACE_BLEND", ""});
        SEROSA_ASSIGN(gpu::Program capture,
                      gpu::Program::create(library, {"surface.vert"}, all, {"v_position", "v_normal"}));
        blendCaptures_.emplace(stage, std::move(capture));
        for (const SurfaceColour colour : {SurfaceColour::tissue, SurfaceColour::dynamicNormal}) {
            if (colour == SurfaceColour::dynamicNormal)
                all.push_back({"SURFACE_NORMAL_COLOURS", ""});
            SEROSA_ASSIGN(gpu::Program program,
                          gpu::Program::create(library, {"surface.vert", "surface.frag"}, all));
            blendPrograms_.emplace(std::pair(stage, colour), std::move(program));
        }
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

/// The vertex buffer of the binding's mapping.
Status SurfacePasses::createMapped(const SurfaceBinding& binding, const sim::TextureLayout& layout) {
    const SurfaceStage stage = stageOf(binding.mapping);
    Geometry& geometry = geometry_[stage];
    geometry.array = gpu::VertexArray("mapped surface");
    const auto upload = [&](const auto& vertices) {
        using Vertex = typename std::decay_t<decltype(vertices)>::value_type;
        const std::vector<Vertex> ordered = inNewOrder(vertices, newIndex_);
        geometry.vertices = gpu::Buffer("mapped surface", std::span<const Vertex>(ordered));
        using Base = std::conditional_t<std::is_same_v<Vertex, ChosenVertex>, MappedVertex, Vertex>;
        attributesOf<Vertex, Base>(geometry.array, geometry.vertices);
    };
    if (stage == SurfaceStage::inCells) {
        upload(cellVertices(binding, colours_));
        constexpr int kStride = sizeof(CellVertex);
        geometry.array.integerAttribute(0, geometry.vertices, 1, GL_UNSIGNED_INT, kStride,
                                        offsetof(CellVertex, cell));
        geometry.array.attribute(2, geometry.vertices, 3, GL_FLOAT, false, kStride, offsetof(CellVertex, at));
        const std::vector<glm::uvec4> texels = cellTexels(binding.cells, layout);
        cells_ = gpu::Texture2D("cells", GL_RGBA32UI, SRS_TABLE_WIDTH, int(texels.size() / SRS_TABLE_WIDTH));
        cells_.upload(texels.data());
    } else if (stage == SurfaceStage::alongNormal) {
        upload(normalVertices(binding, layout, colours_));
        constexpr int kStride = sizeof(NormalVertex);
        geometry.array.integerAttribute(0, geometry.vertices, 3, GL_UNSIGNED_INT, kStride,
                                        offsetof(NormalVertex, texels));
        geometry.array.attribute(1, geometry.vertices, 2, GL_FLOAT, false, kStride,
                                 offsetof(NormalVertex, weights));
        geometry.array.attribute(2, geometry.vertices, 1, GL_FLOAT, false, kStride,
                                 offsetof(NormalVertex, distance));
    } else {
        const bool chosen = stage == SurfaceStage::chosen;
        const int stride = chosen ? sizeof(ChosenVertex) : sizeof(MappedVertex);
        if (chosen)
            upload(chosenVertices(binding, layout, colours_));
        else
            upload(mappedVertices(binding, layout, colours_));
        geometry.array.integerAttribute(0, geometry.vertices, 3, GL_UNSIGNED_INT, stride,
                                        offsetof(MappedVertex, texels));
        geometry.array.attribute(1, geometry.vertices, 2, GL_UNSIGNED_SHORT, true, stride,
                                 offsetof(MappedVertex, weights));
        geometry.array.attribute(2, geometry.vertices, 3, GL_FLOAT, false, stride,
                                 offsetof(MappedVertex, offset));
        if (chosen)
            geometry.array.attribute(7, geometry.vertices, 4, GL_UNSIGNED_BYTE, true, stride,
                                     sizeof(MappedVertex));
    }
    geometry.array.indices(indices_);
    if (stage == SurfaceStage::nodeFrames && frames_) {
        frames_->update(binding.frames, layout);
    } else if (stage == SurfaceStage::nodeFrames) {
        SEROSA_ASSIGN(FramePass pass, FramePass::create(binding.frames, layout));
        frames_.emplace(std::move(pass));
    }
    return {};
}

Status SurfacePasses::createGeometry(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                     const std::vector<SurfaceBinding>& bindings,
                                     const sim::TextureLayout& layout) {
    const CacheOrder order = cacheOrder(metres);
    newIndex_ = order.newIndex;
    indices_ = gpu::Buffer("surface indices", std::span<const std::uint32_t>(order.indices));
    indexCount_ = int(order.indices.size());
    colours_ = vertexColours(metres);

    for (const SurfaceBinding& binding : bindings)
        SEROSA_TRY(createMapped(binding, layout));

    const auto still = inNewOrder(staticVertices(lattice, metres, colours_), newIndex_);
    Geometry& geometry = geometry_[SurfaceStage::undeformed];
    geometry.vertices = gpu::Buffer("undeformed surface", std::span<const StaticVertex>(still));
    geometry.array = gpu::VertexArray("undeformed surface");
    const int stride = sizeof(StaticVertex);
    geometry.array.attribute(2, geometry.vertices, 3, GL_FLOAT, false, stride,
                             offsetof(StaticVertex, position));
    attributesOf<StaticVertex>(geometry.array, geometry.vertices);
    geometry.array.indices(indices_);

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

void SurfacePasses::show(const std::vector<glm::uvec3>& faces, const std::vector<bool>& left,
                         const std::vector<glm::uvec3>& boundary, const sim::TextureLayout& layout) {
    SEROSA_CHECK(left.size() == faces.size(), "one flag a face");
    std::vector<std::uint32_t> indices;
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (int i = 0; i < 3 && left[f]; ++i)
            indices.push_back(newIndex_[faces[f][i]]);
    indices_ = gpu::Buffer("surface indices", std::span<const std::uint32_t>(indices));
    indexCount_ = int(indices.size());
    for (auto& [stage, geometry] : geometry_)
        if (stage != SurfaceStage::nodes)
            geometry.array.indices(indices_);
    createNodes(boundary, layout);
}

Status SurfacePasses::rebind(const std::vector<SurfaceBinding>& bindings, const sim::TextureLayout& layout) {
    blendStage_.reset();
    bool anyConstant = anyConstant_;
    for (const SurfaceBinding& binding : bindings) {
        SEROSA_CHECK(draws(stageOf(binding.mapping)), "a mapping that was prepared");
        SEROSA_TRY(createMapped(binding, layout));
        anyConstant =
            anyConstant || (binding.mapping == sim::Mapping::curvature && binding.constantVertices > 0);
    }
    if (!std::exchange(anyConstant_, anyConstant) && anyConstant) { // the first to need it
        blendStarts_.clear();
        blendCaptures_.clear();
        blendPrograms_.clear();
        captures_.clear();
        SEROSA_ASSIGN(programs_, compile(gpu::ShaderLibrary()));
        SEROSA_TRY(createCaptures());
    }
    return {};
}

Result<SurfacePasses> SurfacePasses::create(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                            const std::vector<SurfaceBinding>& bindings,
                                            const sim::TextureLayout& layout) {
    SurfacePasses passes;
    for (const SurfaceBinding& binding : bindings) {
        SEROSA_CHECK(binding.vertices.size() == metres.positions.size(), "the binding is of another mesh");
        passes.anyConstant_ = passes.anyConstant_ ||
                              (binding.mapping == sim::Mapping::curvature && binding.constantVertices > 0);
    }
    SEROSA_TRY(passes.createGeometry(lattice, metres, bindings, layout));
    SEROSA_ASSIGN(passes.programs_, passes.compile(gpu::ShaderLibrary()));
    SEROSA_TRY(passes.createCaptures());
    return passes;
}

void SurfacePasses::setNodes(gpu::Program& program, const sim::StateTextures& state, SurfaceStage stage) {
    if (stage == SurfaceStage::undeformed)
        return;
    program.texture("t_positions", state.positions());
    if (stage == SurfaceStage::inCells)
        program.texture("t_cells", cells_);
    if (stage == SurfaceStage::nodeFrames) {
        frames_->run(state.positions());
        program.texture("t_frames", frames_->frames());
    }
}

gpu::Program& SurfacePasses::prepare(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage,
                                     SurfaceColour colour, const glm::vec3& bare) {
    SEROSA_CHECK(draws(stage), "a mapping that was prepared");
    // Colours of materials are those of the vertices, as the tissue's are.
    gpu::Program& program =
        (blends(stage) ? blendPrograms_ : programs_)
            .at({stage, colour == SurfaceColour::dynamicNormal ? colour : SurfaceColour::tissue});
    if (blends(stage))
        setBlendUniforms(program);
    program.set("u_clipFromLattice", frame.clipFromLattice);
    program.set("u_section", frame.section);
    setNodes(program, state, stage);
    if (stage == SurfaceStage::nodes)
        program.set("u_colour", glm::vec4(glm::sqrt(bare), 1));
    frame.setLight(program);
    std::array<glm::vec4, SRS_MAX_TOOLS> tools{};
    for (std::size_t i = 0; i < tools.size() && i < frame.shades.size(); ++i)
        tools[i] = frame.shades[i];
    program.set("u_tools", std::span<const glm::vec4>(tools));
    program.set("u_toolCount", int(std::min(tools.size(), frame.shades.size())));
    return program;
}

void SurfacePasses::drawTriangles(SurfaceStage stage) {
    glBindVertexArray(geometry_.at(stage).array.id());
    glDrawElements(GL_TRIANGLES, stage == SurfaceStage::nodes ? nodeIndexCount_ : indexCount_,
                   GL_UNSIGNED_INT, nullptr);
}

void SurfacePasses::draw(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage,
                         SurfaceColour colour, const glm::vec3& bare) {
    prepare(state, frame, stage, colour, bare).use();
    const bool sectioned = frame.section != glm::vec4(0);
    if (sectioned) {
        glEnable(GL_CLIP_DISTANCE0);
        glDisable(GL_CULL_FACE); // inner sides show as cut tissue
    }
    drawTriangles(stage);
    if (sectioned) {
        glEnable(GL_CULL_FACE);
        glDisable(GL_CLIP_DISTANCE0);
    }
}

void SurfacePasses::drawDiscarded(const sim::StateTextures& state, SurfaceStage stage) {
    prepare(state, Frame{}, stage, SurfaceColour::tissue, kFleshColour).use();
    glEnable(GL_RASTERIZER_DISCARD);
    drawTriangles(stage);
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
    glDrawArrays(GL_POINTS, 0, GLsizei(newIndex_.size()));
    glEndTransformFeedback();
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    glDisable(GL_RASTERIZER_DISCARD);
}

gpu::Buffer SurfacePasses::shown(const sim::StateTextures& state, SurfaceStage stage) {
    SEROSA_CHECK(stage != SurfaceStage::nodes, "node positions are in the state texture already");
    gpu::Program& program = (blends(stage) ? blendCaptures_ : captures_).at(stage);
    program.set("u_clipFromLattice", glm::mat4(1));
    program.set("u_section", glm::vec4(0));
    setNodes(program, state, stage);
    if (blends(stage))
        setBlendUniforms(program);
    gpu::Buffer captured("captured vertices", newIndex_.size() * kCapturedBytes, nullptr);
    feedBack(stage, program, captured);
    return captured;
}

Result<std::vector<glm::mat3>> SurfacePasses::captureAxes(const sim::StateTextures& state,
                                                          SurfaceStage stage) {
    SEROSA_CHECK(isMapped(stage) && draws(stage), "a mapping that was prepared");
    SEROSA_ASSIGN(gpu::Program program,
                  gpu::Program::create(gpu::ShaderLibrary(), {"mapped_axes.vert"}, defines(stage),
                                       {"v_tangent", "v_axis", "v_bitangent"}));
    setNodes(program, state, stage);
    std::vector<glm::mat3> captured(newIndex_.size()), axes;
    const gpu::Buffer buffer("captured axes", captured.size() * sizeof captured[0], nullptr);
    feedBack(stage, program, buffer);
    buffer.download(0, buffer.bytes(), captured.data());
    for (const std::uint32_t index : newIndex_)
        axes.push_back(captured[index]);
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
    setNodes(program, state, stage);
    blend_ = gpu::Buffer("switch of detail", newIndex_.size() * kCapturedBytes, nullptr);
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
    if (blend.empty())
        return;
    SEROSA_CHECK(blend.size() * sizeof(float) == newIndex_.size() * kCapturedBytes, "six floats a vertex");
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
    std::vector<Item> items(newIndex_.size());
    shown(state, stage).download(0, items.size() * sizeof(Item), items.data());

    Captured result;
    for (const std::uint32_t index : newIndex_) {
        result.positions.push_back(items[index].position);
        result.normals.push_back(items[index].normal);
    }
    return result;
}

} // namespace serosa::render
