#include "render/surface_passes.h"

#include "base/check.h"
#include "gpu/gl.h"
#include "render/baked_occlusion.h"
#include "render/surface_vertices.h"
#include "shaders/shared_constants.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace serosa::render {

namespace {

using sim::SurfaceColour;

constexpr SurfaceStage kStages[] = {SurfaceStage::undeformed, SurfaceStage::constant, SurfaceStage::corrected,
                                    SurfaceStage::nodes};
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

/// \param bare linear colour of a mesh without colours; null: flesh
std::vector<glm::u8vec4> vertexColours(const sim::TriangleMesh& mesh, const glm::vec3* bare) {
    const std::vector<float> open = bakeOcclusion(mesh);
    std::vector<glm::u8vec4> colours;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        colours.push_back(vertexColour(mesh.colours.empty() ? kFlesh : mesh.colours[v], open[v]));
        for (int c = 0; c < 3 && bare && mesh.colours.empty(); ++c)
            colours.back()[c] = std::uint8_t(std::lround(255 * std::sqrt(double((*bare)[c]))));
    }
    return colours;
}

constexpr SurfaceColour kColours[] = {SurfaceColour::tissue, SurfaceColour::dynamicNormal,
                                      SurfaceColour::plain};

void addColour(std::vector<gpu::ShaderDefine>& defines, SurfaceColour colour) {
    if (colour == SurfaceColour::dynamicNormal)
        defines.push_back({"SURFACE_NORMAL_COLOURS", ""});
    if (colour == SurfaceColour::plain)
        defines.push_back({"SURFACE_PLAIN", ""});
}

gpu::ShaderDefine stageDefine(SurfaceStage stage) {
    return stage == SurfaceStage::nodes        ? gpu::ShaderDefine{"SURFACE_NODES", ""}
           : stage == SurfaceStage::undeformed ? gpu::ShaderDefine{"SURFACE_STATIC", ""}
                                               : gpu::ShaderDefine{"SURFACE_MAPPED", ""};
}

} // namespace

std::vector<gpu::ShaderDefine> SurfacePasses::defines(SurfaceStage stage) const {
    const bool corrected = stage == SurfaceStage::corrected;
    std::vector<gpu::ShaderDefine> all = {stageDefine(stage),
                                          {"MAPPING_BASIS", !corrected     ? "0"
                                                            : anyConstant_ ? "2"
                                                                           : "1"}};
    if (stage != SurfaceStage::nodes && usesRest())
        all.push_back({"SURFACE_REST", ""});
    if (stage != SurfaceStage::nodes && mask_)
        all.push_back({"SURFACE_CUT", ""});
    if (stage != SurfaceStage::nodes && textures_)
        all.push_back({"SURFACE_TEXTURED", ""});
    if (stage != SurfaceStage::nodes && textures_ && !drawn_.textures.empty())
        all.push_back({"SURFACE_UV", ""});
    return all;
}

Result<SurfacePasses::Programs> SurfacePasses::compile(const gpu::ShaderLibrary& library) const {
    Programs programs;
    for (const SurfaceStage stage : kStages)
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
    for (const SurfaceStage stage : {SurfaceStage::constant, SurfaceStage::corrected}) {
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
    for (const SurfaceStage stage : {SurfaceStage::constant, SurfaceStage::corrected}) {
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
    for (const SurfaceStage stage : kStages) {
        SEROSA_ASSIGN(gpu::Program capture, gpu::Program::create(gpu::ShaderLibrary(), {"surface.vert"},
                                                                 defines(stage), {"v_position", "v_normal"}));
        captures_.emplace(stage, std::move(capture));
    }
    return {};
}

void SurfacePasses::setMapped(SurfaceStage stage, const std::vector<MappedVertex>& vertices) {
    Geometry& geometry = geometry_[stage];
    geometry.vertices = gpu::Buffer("mapped surface", std::span<const MappedVertex>(vertices));
    if (!geometry.array)
        geometry.array = gpu::VertexArray("mapped surface");
    const int stride = sizeof(MappedVertex);
    geometry.array.integerAttribute(0, geometry.vertices, 3, GL_UNSIGNED_INT, stride,
                                    offsetof(MappedVertex, texels));
    geometry.array.attribute(1, geometry.vertices, 2, GL_UNSIGNED_SHORT, true, stride,
                             offsetof(MappedVertex, weights));
    geometry.array.attribute(2, geometry.vertices, 3, GL_FLOAT, false, stride,
                             offsetof(MappedVertex, offset));
    geometry.array.integerAttribute(3, geometry.vertices, 1, GL_UNSIGNED_INT, stride,
                                    offsetof(MappedVertex, normal));
    geometry.array.attribute(4, geometry.vertices, 4, GL_UNSIGNED_BYTE, true, stride,
                             offsetof(MappedVertex, colour));
}

void SurfacePasses::setRest(SurfaceStage stage, const std::vector<RestVertex>& vertices) {
    Geometry& geometry = geometry_.at(stage);
    geometry.rest = gpu::Buffer("surface at rest", std::span<const RestVertex>(vertices));
    const int stride = sizeof(RestVertex);
    geometry.array.attribute(7, geometry.rest, 4, GL_UNSIGNED_SHORT, true, stride,
                             offsetof(RestVertex, position));
    geometry.array.integerAttribute(8, geometry.rest, 2, GL_UNSIGNED_INT, stride,
                                    offsetof(RestVertex, normal));
}

void SurfacePasses::createRest(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                               const SurfaceBinding& binding) {
    restBox_ = restBox(lattice, metres);
    for (const sim::Mapping mapping : {sim::Mapping::triangle, sim::Mapping::curvature}) {
        const SurfaceBinding other =
            mapping == binding.mapping ? binding : expressBinding(binding, lattice, metres, mapping);
        setRest(mapping == sim::Mapping::triangle ? SurfaceStage::constant : SurfaceStage::corrected,
                inBuffers(restVertices(lattice, restBox_, metres, &other)));
    }
    setRest(SurfaceStage::undeformed, inBuffers(restVertices(lattice, restBox_, metres, nullptr)));
}

void SurfacePasses::setIndices(const std::vector<std::uint32_t>& indices) {
    levels_.clear();
    levels_.push_back({gpu::Buffer("surface indices", std::span<const std::uint32_t>(indices)),
                       int(indices.size()),
                       0,
                       {},
                       {}});
}

void SurfacePasses::createGeometry(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                                   const SurfaceBinding& binding, const sim::TextureLayout& layout) {
    const CacheOrder order = cacheOrder(drawn_.faces, drawn_.origin.size());
    newIndex_ = order.newIndex;
    const glm::vec3 mean = textures_ ? 1.0F / textures_->albedoScale : glm::vec3(0);
    colours_ = vertexColours(metres, textures_ ? &mean : nullptr);
    for (const sim::Mapping mapping : {sim::Mapping::triangle, sim::Mapping::curvature}) {
        const bool given = mapping == binding.mapping;
        setMapped(
            mapping == sim::Mapping::triangle ? SurfaceStage::constant : SurfaceStage::corrected,
            inBuffers(mappedVertices(given ? binding : expressBinding(binding, lattice, metres, mapping),
                                     layout, colours_)));
    }

    const auto still = inBuffers(staticVertices(lattice, metres, colours_));
    Geometry& geometry = geometry_[SurfaceStage::undeformed];
    geometry.vertices = gpu::Buffer("undeformed surface", std::span<const StaticVertex>(still));
    geometry.array = gpu::VertexArray("undeformed surface");
    const int stride = sizeof(StaticVertex);
    geometry.array.attribute(2, geometry.vertices, 3, GL_FLOAT, false, stride,
                             offsetof(StaticVertex, position));
    geometry.array.integerAttribute(3, geometry.vertices, 1, GL_UNSIGNED_INT, stride,
                                    offsetof(StaticVertex, normal));
    geometry.array.attribute(4, geometry.vertices, 4, GL_UNSIGNED_BYTE, true, stride,
                             offsetof(StaticVertex, colour));
    setIndices(order.indices);
    createLevels(lattice, metres);
    createNodes(lattice.boundary, layout);
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
                                            const SurfaceBinding& binding, const sim::TextureLayout& layout,
                                            const SurfaceDetail* detail) {
    SEROSA_CHECK(binding.vertices.size() == metres.positions.size(), "the binding is of another mesh");
    SurfacePasses passes;
    passes.bounds_ = restBox(lattice, metres);
    passes.meshVertices_ = metres.positions.size();
    passes.noShadow_ = gpu::Texture2D("no shadow", GL_DEPTH_COMPONENT32F, 1, 1);
    passes.noOcclusion_ = gpu::Texture2D("no occlusion", GL_R8, 1, 1);
    if (detail)
        passes.createTextures(*detail, lattice);
    sim::TriangleMesh plain; // without texture there are no seams
    plain.positions = metres.positions;
    plain.faces = metres.faces;
    passes.drawn_ = drawnVertices(detail ? metres : plain, metres.vertexNormals());
    const bool corrected = binding.mapping == sim::Mapping::curvature;
    passes.anyConstant_ = !corrected || binding.constantVertices > 0;
    SEROSA_ASSIGN(passes.programs_, passes.compile(gpu::ShaderLibrary()));
    SEROSA_TRY(passes.createCaptures());
    passes.createGeometry(lattice, metres, binding, layout);
    if (detail) {
        passes.createRest(lattice, metres, binding);
        passes.createUvs();
    }
    return passes;
}

void SurfacePasses::setVertexInputs(gpu::Program& program, const sim::StateTextures* state,
                                    const Frame& frame, SurfaceStage stage) const {
    if (blends(stage))
        setBlendUniforms(program);
    program.set("u_clipFromLattice", frame.clipFromLattice);
    program.set("u_section", frame.section);
    if (stage != SurfaceStage::undeformed)
        program.texture("t_positions", state->positions());
    if (usesRest() && stage != SurfaceStage::nodes)
        program.set("u_restFrom", restBox_.from).set("u_restExtent", restBox_.extent);
    if (stage == SurfaceStage::nodes)
        program.set("u_colour", glm::vec4(0, 0, 0, 1));
}

gpu::Program& SurfacePasses::prepare(const sim::StateTextures& state, const Frame& frame, SurfaceStage stage,
                                     SurfaceColour colour, const glm::vec3& bare) {
    // Colours of materials are those of the vertices, as the tissue's are.
    gpu::Program& program =
        (blends(stage) ? blendPrograms_ : programs_)
            .at({stage, colour == SurfaceColour::material ? SurfaceColour::tissue : colour});
    setVertexInputs(program, &state, frame, stage);
    if (mask_ && stage != SurfaceStage::nodes) {
        mask_->bind(program);
        program.set("u_blood", frame.blood ? 1 : 0);
    }
    if (textures_ && stage != SurfaceStage::nodes) {
        program.texture("t_albedo", textures_->albedo).texture("t_relief", textures_->relief);
        program.set("u_albedoScale", textures_->albedoScale).set("u_tiles", textures_->tiles);
        program.set("u_tileShift", textures_->shift).set("u_relief", textures_->relief_);
    }
    if (stage == SurfaceStage::nodes)
        program.set("u_colour", glm::vec4(glm::sqrt(bare), 1));
    frame.setLight(program);
    program.set("u_shadows", frame.shadow ? 1 : 0).set("u_occlusion", frame.occlusion ? 1 : 0);
    program.texture("t_shadow", frame.shadow ? *frame.shadow : noShadow_);
    program.texture("t_occlusion", frame.occlusion ? *frame.occlusion : noOcclusion_);
    program.set("u_shadowFromLattice", frame.shadowFromLattice).set("u_shadowTexel", frame.shadowTexel);
    std::array<glm::vec4, SRS_MAX_TOOLS> tools{};
    for (std::size_t i = 0; i < tools.size() && i < frame.shades.size(); ++i)
        tools[i] = frame.shades[i];
    program.set("u_tools", std::span<const glm::vec4>(tools));
    program.set("u_toolCount", int(std::min(tools.size(), frame.shades.size())));
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
    setVertexInputs(program, &state, frame, stage);
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
    if (sectioned || mask_)
        glDisable(GL_CULL_FACE); // inner sides show as cut tissue
    const std::size_t level = stage == SurfaceStage::nodes ? 0 : levelFor(frame);
    lastLevel_ = level;
    lastCulled_.reset();
    const bool mapped = stage == SurfaceStage::constant || stage == SurfaceStage::corrected;
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
    glDrawArrays(GL_POINTS, 0, GLsizei(newIndex_.size()));
    glEndTransformFeedback();
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    glDisable(GL_RASTERIZER_DISCARD);
}

gpu::Buffer SurfacePasses::shown(const sim::StateTextures& state, SurfaceStage stage) {
    SEROSA_CHECK(stage != SurfaceStage::nodes, "node positions are in the state texture already");
    gpu::Program& program = (blends(stage) ? blendCaptures_ : captures_).at(stage);
    setVertexInputs(program, &state, Frame{}, stage);
    gpu::Buffer captured("captured vertices", newIndex_.size() * kCapturedBytes, nullptr);
    feedBack(stage, program, captured);
    return captured;
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
    program.texture("t_positions", state.positions());
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
    for (std::size_t v = 0; v < meshVertices_; ++v) {
        result.positions.push_back(items[newIndex_[v]].position);
        result.normals.push_back(items[newIndex_[v]].normal);
    }
    return result;
}

} // namespace serosa::render
