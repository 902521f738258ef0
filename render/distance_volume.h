#pragma once
// Signed distance of a closed mesh in a 3D texture, made on the GPU (CS07 sections 3 and 6): negative inside.
//
// 1. Every triangle goes over the voxels that lie within two voxels of it and leaves its distance (an atomic
//    minimum over the bits of a positive float), then its index where that distance was the least.
// 2. A voxel of this narrow band takes the distance to that triangle again; its sign is that of the
//    angle-weighted normal of the face, edge or corner that is nearest (Baerentzen & Aanaes 2005, Signed
//    distance computation using the angle weighted pseudonormal).
// 3. All others take the triangle of the nearest voxel of the narrow band, found by jump flooding (Rong & Tan
//    2006), and its sign: the straight way there stays on one side. Their distances are too large by at most
//    half of a voxel's diagonal, what flooding misses apart.
// 4. Where a wider band is asked for, its voxels start from that bound and walk a tree of boxes for what is
//    nearer (render/distance_tree.h): taking triangles from neighbours instead leaves a quarter of a voxel
//    where faces are smaller than voxels.
//
// Exact (to float32 and the texture's half float) within the band. Lengths in voxels; voxel (i, j, k) has its
// middle at lowest() + (i, j, k) step().

#include "base/result.h"
#include "gpu/sampled_texture.h"
#include "render/field_blocks.h"
#include "render/volume_grid.h"
#include "sim/triangle_mesh.h"

#include <optional>
#include <vector>

namespace serosa::render {

class DistanceVolume {
public:
    /// \param mesh m, closed, wound outward. \param grid the whole mesh or a part of it.
    /// \param band m: distances are exact to here; at least two voxels are.
    /// Errors: a mesh that is open (with an edge of it), 0 faces, of the shaders.
    /// \param colours one a vertex, RGBA8 of any meaning: near the surface the volume of them is what it has
    /// there; empty: none is made
    static Result<DistanceVolume> create(const sim::TriangleMesh& mesh, const VolumeGrid& grid, double band,
                                         const std::vector<glm::u8vec4>& colours = {});

    const VolumeGrid& grid() const { return grid_; }
    /// R16F, voxels.
    const gpu::Texture3D& texture() const { return texture_; }
    /// RGBA8; null where there are none.
    const gpu::Texture3D* colours() const { return colours_ ? &*colours_ : nullptr; }
    /// Where the body is.
    const FieldBlocks& blocks() const { return blocks_; }
    /// As the texture holds them, m, x fastest. Waits.
    std::vector<float> read() const;

private:
    VolumeGrid grid_;
    gpu::Texture3D texture_;
    std::optional<gpu::Texture3D> colours_;
    FieldBlocks blocks_;
};

/// The same in double on the processor: exact everywhere (sim/triangle_tree.h), m.
std::vector<double> distanceOnGrid(const sim::TriangleMesh& mesh, const VolumeGrid& grid);

} // namespace serosa::render
