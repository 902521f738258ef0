// See render/cut_mask.h. design.md's alpha mask; CSC06 3 and CS07 3 read theirs in the same space.
#include "render/cut_mask.h"

#include "base/check.h"
#include "gpu/gl.h"
#include "shaders/shared_constants.h"
#include "sim/byte_stream.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace serosa::render {

namespace {

constexpr std::size_t kMostBytes = std::size_t(24) << 20;
constexpr int kMostVoxels = 8, kFewestVoxels = 2; // a spacing
constexpr int kMostCells = 1021;                  // along a side: 10 bits, with one around

struct MaskCell { // as shaders/cut_mask_cells.glsl
    std::uint32_t grid, open;
    std::array<std::uint32_t, 8> texels, nodes;
};
static_assert(sizeof(MaskCell) == 72);

std::uint32_t texelWord(const sim::TextureLayout& layout, std::size_t node) {
    return layout.texelOfNode[node].y << 16 | layout.texelOfNode[node].x;
}

std::vector<MaskCell> maskCells(const sim::Lattice& lattice, const sim::TextureLayout& layout) {
    const glm::ivec3 dims = lattice.nodeDims - 1;
    std::vector<bool> filled(std::size_t(dims.x) * std::size_t(dims.y) * std::size_t(dims.z), false);
    const auto place = [&dims](const glm::ivec3& at) {
        return std::size_t(at.x) +
               std::size_t(dims.x) * (std::size_t(at.y) + std::size_t(dims.y) * std::size_t(at.z));
    };
    for (const sim::LatticeCell& cell : lattice.cells)
        filled[place(cell.grid)] = true;
    std::vector<MaskCell> cells;
    cells.reserve(lattice.cells.size());
    for (const sim::LatticeCell& cell : lattice.cells) {
        MaskCell item{};
        item.grid = std::uint32_t(cell.grid.x | cell.grid.y << 10 | cell.grid.z << 20);
        for (int i = 0; i < 27; ++i) {
            const glm::ivec3 at = cell.grid + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
            const bool inside =
                glm::all(glm::greaterThanEqual(at, glm::ivec3(0))) && glm::all(glm::lessThan(at, dims));
            item.open |= inside && filled[place(at)] ? 0U : 1U << i;
        }
        for (int c = 0; c < 8; ++c) {
            const auto node = std::size_t(lattice.nodeAt(cell.grid + sim::cornerOffset(c)));
            item.texels[std::size_t(c)] = texelWord(layout, node);
            item.nodes[std::size_t(c)] = std::uint32_t(node);
        }
        cells.push_back(item);
    }
    return cells;
}

} // namespace

Result<CutMask> CutMask::create(const sim::Lattice& lattice, const sim::TextureLayout& layout) {
    const glm::ivec3 cells = lattice.nodeDims + 1; // with one around
    const int most = std::max({cells.x, cells.y, cells.z});
    const int limit = gpu::Texture3D::mostTexels();
    CutMask mask;
    for (mask.voxels_ = kMostVoxels; mask.voxels_ > kFewestVoxels; --mask.voxels_) {
        const double voxels = double(cells.x) * cells.y * cells.z * std::pow(mask.voxels_, 3);
        if (4 * voxels <= double(kMostBytes) && most * mask.voxels_ <= limit)
            break;
    }
    if (most - 2 > kMostCells || most * mask.voxels_ > limit)
        return Error{"a lattice of " + std::to_string(most - 2) +
                     " cells along a side is too long for the mask that cuts need; raise spacing"};

    const gpu::ShaderLibrary library;
    SEROSA_ASSIGN(mask.find_, gpu::Program::create(library, {"cut_mask_find.comp"}));
    SEROSA_ASSIGN(mask.paint_, gpu::Program::create(library, {"cut_mask_paint.comp"}));
    SEROSA_ASSIGN(mask.nodes_, gpu::Program::create(library, {"cut_mask_nodes.comp"}));
    mask.origin_ = -glm::vec3(lattice.centre);
    mask.volume_ = gpu::Texture3D("cut mask", cells * mask.voxels_);
    const std::vector<MaskCell> items = maskCells(lattice, layout);
    mask.cells_ = gpu::Buffer("cells of the cut mask", std::span<const MaskCell>(items));
    mask.list_ = gpu::Buffer("cells near a stroke", 16 + 4 * items.size(), nullptr);
    std::vector<std::uint32_t> texels;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        texels.push_back(texelWord(layout, node));
    mask.nodeTexels_ = gpu::Buffer("nodes of the cut mask", std::span<const std::uint32_t>(texels));
    mask.sides_ = gpu::Buffer("sides of nodes", 4 * texels.size(), nullptr);
    mask.cellCount_ = items.size();
    mask.nodeCount_ = texels.size();
    mask.clear();
    return mask;
}

void CutMask::clear() {
    volume_.clear(SRS_MASK_KEPT);
    const std::vector<float> far(nodeCount_, float(SRS_MASK_FAR));
    sides_.upload(0, 4 * nodeCount_, far.data());
    lastNormal_ = glm::vec3(0);
    facing_ = 1;
    layers_.clear();
}

void CutMask::setStroke(gpu::Program& program, const sim::StateTextures& state,
                        const sim::LatticeStroke& stroke) {
    std::array<glm::vec4, 4> corners;
    for (std::size_t i = 0; i < 4; ++i)
        corners[i] = glm::vec4(stroke.corners[i], 0);
    program.texture("t_positions", state.positions());
    program.set("u_corners", std::span<const glm::vec4>(corners));
    program.set("u_kind", int(stroke.kind)).set("u_size", stroke.size).set("u_facing", facing_);
}

void CutMask::paint(const sim::StateTextures& state, const sim::Lattice& lattice, const sim::Stroke& stroke,
                    bool undoable) {
    const bool tears = stroke.kind == sim::StrokeKind::tear;
    if (undoable && !stroke.continues)
        layers_.push_back(tears ? std::string() : saveLayer());
    if (tears)
        return;
    const sim::LatticeStroke local = sim::toLattice(stroke, lattice);
    const bool blade = local.kind == sim::StrokeKind::blade;
    glm::vec3 low = local.corners[0], high = low;
    if (blade) {
        const auto& c = local.corners;
        for (const glm::vec3& corner : c) {
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
        // A blade that saws to and fro must not count its sides anew each time it turns.
        const glm::vec3 normal = glm::cross(c[1] - c[0] + c[3] - c[2], c[2] - c[0] + c[3] - c[1]);
        facing_ = stroke.continues && glm::dot(normal, lastNormal_) < 0 ? -1.0F : 1.0F;
        if (glm::length(normal) > 0)
            lastNormal_ = facing_ * normal;
    }
    const float around = float(SRS_MASK_SIDES) + (blade ? 0.0F : local.size);

    const std::array<std::uint32_t, 4> none = {0, 1, 1, 0};
    list_.upload(0, sizeof none, none.data());
    find_.texture("t_positions", state.positions()).buffer("b_cells", cells_).buffer("b_list", list_);
    find_.set("u_lowest", low - around).set("u_highest", high + around).set("u_cellCount", int(cellCount_));
    glMemoryBarrier(GL_ALL_BARRIER_BITS); // of whatever wrote the state
    find_.dispatch({int(cellCount_), 1, 1});
    glMemoryBarrier(GL_ALL_BARRIER_BITS);

    setStroke(paint_, state, local);
    paint_.set("u_voxels", voxels_).set("u_origin", origin_).image("i_mask", volume_, GL_READ_WRITE);
    paint_.buffer("b_cells", cells_).buffer("b_list", list_).buffer("b_sides", sides_);
    paint_.dispatchIndirect(list_, 0);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    if (!blade)
        return;
    setStroke(nodes_, state, local);
    nodes_.buffer("b_nodes", nodeTexels_).buffer("b_sides", sides_).set("u_nodeCount", int(nodeCount_));
    nodes_.dispatch({int(nodeCount_), 1, 1});
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

std::vector<float> CutMask::nodeSides() const {
    std::vector<float> sides(nodeCount_);
    sides_.download(0, 4 * nodeCount_, sides.data());
    return sides;
}

void CutMask::bind(gpu::Program& program) const {
    program.texture("t_cutMask", volume_);
    program.set("u_maskFrom", origin_ - 1.0F).set("u_maskScale", float(voxels_) / glm::vec3(volume_.size()));
}

bool CutMask::undo() {
    if (layers_.empty())
        return false;
    const std::string layer = std::move(layers_.back());
    layers_.pop_back();
    sim::ByteReader in(layer, 0);
    if (const std::optional<Layer> before = layer.empty() ? std::nullopt : readLayer(in))
        apply(*before);
    return true;
}

std::string CutMask::save() const {
    sim::ByteWriter out;
    out.raw(saveLayer());
    out.u64(layers_.size());
    for (const std::string& layer : layers_)
        out.text(layer);
    return out.take();
}

bool CutMask::restore(std::string_view bytes) {
    sim::ByteReader in(bytes, 0);
    const std::optional<Layer> now = readLayer(in);
    if (!now)
        return false;
    // Earlier versions ended here: nothing to be undone.
    std::vector<std::string> layers(in.left() > 0 ? in.count(in.u64(), 4) : 0);
    for (std::string& layer : layers) {
        layer = in.text();
        sim::ByteReader inLayer(layer, 0);
        if (!layer.empty() && (!readLayer(inLayer) || inLayer.left() > 0))
            return false;
    }
    if (in.failed() || in.left() > 0)
        return false;
    apply(*now);
    layers_ = std::move(layers);
    return true;
}

void CutMask::apply(const Layer& layer) {
    volume_.upload(layer.texels);
    sides_.upload(0, 4 * nodeCount_, layer.sides.data());
    lastNormal_ = layer.lastNormal;
}

std::string CutMask::saveLayer() const {
    const std::vector<std::uint32_t> texels = volume_.download();
    sim::ByteWriter out;
    out.u32(std::uint32_t(voxels_));
    out.u64(texels.size());
    for (std::size_t at = 0; at < texels.size();) { // runs of kept voxels, then of others
        const std::size_t begin = at;
        while (at < texels.size() && texels[at] == SRS_MASK_KEPT)
            ++at;
        std::size_t end = at;
        while (end < texels.size() && texels[end] != SRS_MASK_KEPT)
            ++end;
        out.u64(at - begin);
        out.u64(end - at);
        for (; at < end; ++at)
            out.u32(texels[at]);
    }
    for (const float side : nodeSides())
        out.f32(side);
    for (int axis = 0; axis < 3; ++axis)
        out.f32(lastNormal_[axis]);
    return out.take();
}

std::optional<CutMask::Layer> CutMask::readLayer(sim::ByteReader& in) const {
    Layer layer;
    layer.texels.assign(volume_.bytes() / 4, SRS_MASK_KEPT);
    if (in.u32() != std::uint32_t(voxels_) || in.u64() != layer.texels.size())
        return {};
    for (std::size_t at = 0; at < layer.texels.size() && !in.failed();) {
        const std::uint64_t kept = in.u64(), other = in.u64();
        if (kept > layer.texels.size() - at || other > layer.texels.size() - at - kept || kept + other == 0)
            return {};
        at += kept;
        for (const std::size_t end = at + other; at < end; ++at)
            layer.texels[at] = in.u32();
    }
    layer.sides.resize(nodeCount_);
    for (float& side : layer.sides)
        side = in.f32();
    for (int axis = 0; axis < 3; ++axis)
        layer.lastNormal[axis] = in.f32();
    if (in.failed())
        return {};
    return layer;
}

} // namespace serosa::render
