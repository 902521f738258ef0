#pragma once
// Depth maps as the implicit form of a mesh (CS07 section 6.1), made on the GPU: less memory than a distance
// field, and less of the shape.
//
// A map holds, for each texel of a plane, the depth H of the first surface along the plane's normal. Its
// function is f = H(p_x) - d(p), d the depth of p: positive before the surface. (The paper's f is positive
// inside, but eq. f = H - d is positive outside as it is printed, which is our sign.) One such map is open
// behind: ours come in pairs, from both ends of an axis.
//   depth       one pair: right where no line along the axis meets the body twice (a ball, a box, a leaf)
//   depth cube  three pairs, one an axis: the six planes of a cube. Right where each place of the surface is
//               seen along one of the six directions; hollows that none of them sees into are filled.
// Functions combine as the paper says: rho min(|f1|, |f2|), rho inside only where both are. That is no
// distance: nothing that asks for one (skipping, a search by threshold) may use it.
//
// Each pair is one orthographic drawing of the mesh from either end. Texels that it leaves empty go on from
// the nearest one that it does not, so that filtering finds the rim: in a cube a texel further out than what
// is known, for the other axes say where the body ends; alone half of a texel.
//
// Lengths in voxels of a grid, as in a distance field; a texel is a column of voxels.

#include "base/result.h"
#include "gpu/sampled_texture.h"
#include "render/ray_field.h"
#include "sim/triangle_mesh.h"

#include <glm/glm.hpp>

#include <optional>
#include <vector>

namespace serosa::render {

/// Which maps there are.
struct DepthPlan {
    FieldKind kind = FieldKind::depthCube; // or depth
    int axis = 2;                          // of depth: x, y, z

    int layers() const { return kind == FieldKind::depth ? 1 : 3; }
    int axisOf(int layer) const { return kind == FieldKind::depth ? axis : layer; }
};

/// Depths along the axis of a layer, of both ends; voxels from the middle of the grid's first one. Texel
/// (u, v) is the column of voxel u of the next axis, v of the one after. Row after row, `side` texels each.
struct DepthLayers {
    int side = 0;
    std::vector<std::vector<glm::dvec2>> layers;
};

class DepthMaps {
public:
    /// \param mesh m, within the grid. \param colours one a vertex, RGBA8 of any meaning; empty: none are
    /// kept Errors: a mesh without faces or beyond the grid, a grid beyond what the context has, of the
    /// shaders.
    static Result<DepthMaps> create(const sim::TriangleMesh& mesh, const VolumeGrid& grid,
                                    const DepthPlan& plan, const std::vector<glm::u8vec4>& colours = {});

    RayField field() const {
        return {plan_.kind, grid_, &depths_, colours_ ? &*colours_ : nullptr, plan_.axis, FieldBlocks(grid_)};
    }
    const VolumeGrid& grid() const { return grid_; }
    const DepthPlan& plan() const { return plan_; }
    /// Of the depths on the GPU: 4 a texel and map, 384 KB for a cube of 128 x 128.
    std::size_t bytes() const { return depths_.bytes(); }
    /// Waits.
    DepthLayers read() const;

private:
    DepthMaps() = default;

    DepthPlan plan_;
    VolumeGrid grid_;
    gpu::Texture3D depths_;                 // RG32F, a layer an axis
    std::optional<gpu::Texture3D> colours_; // RGBA8, two layers an axis
};

/// The same in double on the processor.
DepthLayers depthsOnGrid(const sim::TriangleMesh& mesh, const VolumeGrid& grid, const DepthPlan& plan);
/// The function of such maps at a place, m: the twin of shaders/raycast_depth.glsl.
double depthField(const DepthLayers& maps, const VolumeGrid& grid, const DepthPlan& plan,
                  const glm::dvec3& place);

} // namespace serosa::render
