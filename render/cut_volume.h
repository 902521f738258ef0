#pragma once
// A CT or a map of labels that colours the faces of cuts, read at the rest position: the volume is cut with
// the tissue and moves with it (shaders/cut_volume.glsl). Grey values go linearly from voxel to voxel and
// then under a window, and so do colours; labels are those of the nearest voxel.

#include "base/result.h"
#include "gpu/program.h"
#include "gpu/sampled_texture.h"
#include "shaders/raycast_constants.h"

#include <glm/glm.hpp>

#include <utility>
#include <vector>

namespace serosa::render {

struct VoxelValues {
    glm::ivec3 size{0};
    glm::dmat4 worldFromVoxel{1}; // m; the middle of voxel (0, 0, 0) lies at 0
    std::vector<float> values;    // x fastest; of colours three a voxel
};

class CutVolume {
public:
    /// \param level middle of the window. \param width from black to white, more than 0
    /// Errors: values that are not finite (with their voxel), axes that span no space, more voxels along an
    /// axis than a texture has.
    static Result<CutVolume> grey(const VoxelValues& voxels, double level, double width);
    /// \param colours value, sRGB; where there is none, tissue keeps its own
    static Result<CutVolume> labels(const VoxelValues& voxels,
                                    const std::vector<std::pair<int, glm::ivec3>>& colours);

    /// \param voxels three values a voxel, sRGB from 0 to 255: what a photographed or made section shows.
    /// Errors: also a value out of that range.
    static Result<CutVolume> colours(const VoxelValues& voxels);

    /// Does it meet this box, m?
    bool meets(const glm::dvec3& lowest, const glm::dvec3& highest) const;
    /// RAYCAST_VOLUME
    int kind() const { return kind_; }
    /// \param worldFromObject of the program's positions
    void set(gpu::Program& program, const glm::dmat4& worldFromObject) const;

private:
    CutVolume() = default;
    static Result<CutVolume> of(const VoxelValues& voxels);

    int kind_ = SRS_VOLUME_GREY;
    gpu::Texture3D texture_;
    glm::dmat4 voxelFromWorld_{1}, worldFromVoxel_{1};
    glm::vec2 window_{0, 1};
};

} // namespace serosa::render
