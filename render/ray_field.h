#pragma once
// What a ray of the deformation shader asks for the undeformed body: the signed distance of a volume
// (render/distance_volume.h), or depth maps (render/depth_maps.h).

#include "gpu/sampled_texture.h"
#include "render/distance_volume.h"
#include "shaders/raycast_constants.h"

namespace serosa::render {

enum class FieldKind {
    distance = SRS_FIELD_DISTANCE,
    depth = SRS_FIELD_DEPTH,
    depthCube = SRS_FIELD_DEPTH_CUBE
};

struct RayField {
    FieldKind kind = FieldKind::distance;
    VolumeGrid grid;
    const gpu::Texture3D* values = nullptr;
    const gpu::Texture3D* colours = nullptr; // null: there are none
    int axis = 2;                            // of FieldKind::depth
    FieldBlocks blocks;                      // where the body is

    static RayField of(const DistanceVolume& volume) {
        return {FieldKind::distance, volume.grid(), &volume.texture(), volume.colours(), 2, volume.blocks()};
    }
};

} // namespace serosa::render
