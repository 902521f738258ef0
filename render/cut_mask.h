#pragma once
// The alpha mask of an organ: a volume over its lattice in rest space, finer than the lattice, which strokes
// paint (1 kept, 0 cut, threshold 0.5) and drawing passes read at the rest position of what they draw.
//
// A stroke cuts the organ as it lies now (sim/blade.h). The very same surface in rest space: each voxel is
// carried to where it lies now by the corners of its cell (trilinear), and its distance to what the stroke
// swept there is painted. It is known on which side of a cut a voxel lies, so that of a cell that an earlier
// stroke parted only the corners on the voxel's side carry it.
//
// Departure from the plain mask of 0 and 1: the words hold distances, so that linear filtering finds the
// cut's border between voxels (smooth lips), and a signed one that tells the two sides apart, for triangles
// that cross the cut. A tear sweeps nothing and paints nothing.

#include "base/result.h"
#include "gpu/program.h"
#include "gpu/sampled_texture.h"
#include "sim/blade.h"
#include "sim/byte_stream.h"
#include "sim/lattice.h"
#include "sim/state_textures.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace serosa::render {

class CutMask {
public:
    /// 8 voxels a spacing or fewer, so that the volume takes 24 MiB at most (4 bytes a voxel), with one empty
    /// cell around the lattice's grid; at least 2, whatever it takes. Needs a current context. Errors: of the
    /// shaders; a grid of more than 1,021 cells along a side, or more voxels there than the context has
    /// texels.
    static Result<CutMask> create(const sim::Lattice& lattice, const sim::TextureLayout& layout);

    /// Paints a stroke, with the organ as `state` has it: before or after the lattice is cut. A tear paints
    /// nothing. \param undoable what was there before it is kept: reads the volume back (stalls) when a
    /// stroke begins
    void paint(const sim::StateTextures& state, const sim::Lattice& lattice, const sim::Stroke& stroke,
               bool undoable = false);
    /// Takes back what the last stroke (with the parts that continue it) painted, as sim::CutList::undo does
    /// of springs. False: none was kept.
    bool undo();
    /// Nothing is cut any more, nor to be undone.
    void clear();

    /// Signed distance of each node to the nearest cut, spacings; SRS_MASK_FAR where none came near. Reads
    /// back.
    std::vector<float> nodeSides() const;
    /// The same on the GPU: a float a node.
    const gpu::Buffer& sides() const { return sides_; }
    /// Sets what shaders/cut_mask.glsl asks for.
    void bind(gpu::Program& program) const;

    int voxelsPerSpacing() const { return voxels_; }
    /// Of the volume, on the GPU.
    std::size_t bytes() const { return volume_.bytes(); }
    const gpu::Texture3D& volume() const { return volume_; }

    /// All of it, with what undo() needs, for snapshots (reads back, stalls), and set again. False: not of
    /// this mask.
    std::string save() const;
    bool restore(std::string_view bytes);

private:
    CutMask() = default;
    struct Layer { // what undo() sets again
        std::vector<std::uint32_t> texels;
        std::vector<float> sides;
        glm::vec3 lastNormal{0};
    };
    std::string saveLayer() const;
    std::optional<Layer> readLayer(sim::ByteReader& in) const;
    void apply(const Layer& layer);
    void setStroke(gpu::Program& program, const sim::StateTextures& state, const sim::LatticeStroke& stroke);

    int voxels_ = 0;
    glm::vec3 origin_{0}; // lattice coordinate of the grid's lowest corner
    gpu::Texture3D volume_;
    gpu::Program find_, paint_, nodes_;
    gpu::Buffer cells_, list_, nodeTexels_, sides_;
    std::size_t cellCount_ = 0, nodeCount_ = 0;
    glm::vec3 lastNormal_{0}; // of the stroke's part before, as its sides are counted
    float facing_ = 1;
    std::vector<std::string>
        layers_; // before each stroke, oldest first; empty: a tear, which changed nothing
};

} // namespace serosa::render
