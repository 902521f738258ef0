// See render/cut_volume.h.
#include "render/cut_volume.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>

namespace serosa::render {

namespace {

struct Box {
    glm::dvec3 lowest{1e300}, highest{-1e300};
};

/// Around the corners of a box that are carried elsewhere.
Box carried(const glm::dmat4& by, const glm::dvec3& low, const glm::dvec3& high) {
    Box box;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at(by * glm::dvec4(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                                            corner & 4 ? high.z : low.z, 1));
        box.lowest = glm::min(box.lowest, at);
        box.highest = glm::max(box.highest, at);
    }
    return box;
}

bool overlap(const Box& box, const glm::dvec3& low, const glm::dvec3& high) {
    return glm::all(glm::lessThan(box.lowest, high)) && glm::all(glm::lessThan(low, box.highest));
}

std::string voxelText(std::size_t index, const glm::ivec3& size) {
    const std::size_t x = std::size_t(size.x), y = std::size_t(size.y);
    return std::to_string(index % x) + ", " + std::to_string(index / x % y) + ", " +
           std::to_string(index / (x * y));
}

} // namespace

Result<CutVolume> CutVolume::of(const VoxelValues& voxels) {
    const glm::ivec3& size = voxels.size;
    const int most = gpu::Texture3D::mostTexels();
    for (int axis = 0; axis < 3; ++axis)
        if (size[axis] < 1 || size[axis] > most)
            return Error{"has " + std::to_string(size[axis]) +
                         " voxels along an axis, and textures here have 1 to " + std::to_string(most) +
                         ": resample it"};
    const std::size_t each =
        voxels.values.size() / (std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z));
    for (std::size_t i = 0; i < voxels.values.size(); ++i)
        if (!std::isfinite(voxels.values[i]))
            return Error{"voxel (" + voxelText(i / each, size) + ") is not a finite number: mend the file"};
    const double spans = std::abs(glm::determinant(glm::dmat3(voxels.worldFromVoxel)));
    if (!(spans > 1e-24 && spans < 1e24))
        return Error{"its axes span no space: look at its spacing and direction"};
    CutVolume made;
    made.worldFromVoxel_ = voxels.worldFromVoxel;
    made.voxelFromWorld_ = glm::inverse(voxels.worldFromVoxel);
    return made;
}

Result<CutVolume> CutVolume::grey(const VoxelValues& voxels, double level, double width) {
    SEROSA_ASSIGN(CutVolume made, of(voxels));
    made.window_ = glm::vec2(level - 0.5 * width, level + 0.5 * width);
    made.texture_ = gpu::Texture3D("volume of cut faces", GL_R32F, voxels.size);
    made.texture_.upload(GL_RED, GL_FLOAT, voxels.values.data());
    return made;
}

Result<CutVolume> CutVolume::labels(const VoxelValues& voxels,
                                    const std::vector<std::pair<int, glm::ivec3>>& colours) {
    SEROSA_ASSIGN(CutVolume made, of(voxels));
    made.kind_ = SRS_VOLUME_LABELS;
    std::map<int, std::uint32_t> words; // r in the lowest byte
    for (const auto& [value, colour] : colours)
        words[value] = std::uint32_t(colour.r) | std::uint32_t(colour.g) << 8 |
                       std::uint32_t(colour.b) << 16 | 0xff000000u;
    std::vector<std::uint32_t> texels;
    texels.reserve(voxels.values.size());
    for (const float value : voxels.values) {
        const auto found = words.find(int(std::lround(std::clamp(value, -1e9F, 1e9F))));
        texels.push_back(found == words.end() ? 0 : found->second);
    }
    made.texture_ = gpu::Texture3D("labels of cut faces", voxels.size);
    made.texture_.upload(texels);
    return made;
}

Result<CutVolume> CutVolume::colours(const VoxelValues& voxels) {
    SEROSA_ASSIGN(CutVolume made, of(voxels));
    made.kind_ = SRS_VOLUME_COLOURS;
    std::vector<std::uint32_t> texels;
    texels.reserve(voxels.values.size() / 3);
    for (std::size_t i = 0; i + 2 < voxels.values.size(); i += 3) {
        std::uint32_t word = 0xff000000u;
        for (std::size_t c = 0; c < 3; ++c) {
            const float value = voxels.values[i + c];
            if (value < 0 || value > 255)
                return Error{"voxel (" + voxelText(i / 3, voxels.size) +
                             ") has a colour outside of 0 to 255: scale its values"};
            word |= std::uint32_t(std::lround(value)) << (8 * c);
        }
        texels.push_back(word);
    }
    made.texture_ = gpu::Texture3D("colours of cut faces", voxels.size);
    made.texture_.upload(texels);
    return made;
}

bool CutVolume::meets(const glm::dvec3& lowest, const glm::dvec3& highest) const {
    const glm::dvec3 low(-0.5), high = glm::dvec3(texture_.size()) - 0.5; // voxels
    return overlap(carried(worldFromVoxel_, low, high), lowest, highest) &&
           overlap(carried(voxelFromWorld_, lowest, highest), low, high);
}

void CutVolume::set(gpu::Program& program, const glm::dmat4& worldFromObject) const {
    program.set("u_volumeFromObject", glm::mat4(voxelFromWorld_ * worldFromObject));
    program.texture("t_cutVolume", texture_);
    if (kind_ == SRS_VOLUME_GREY)
        program.set("u_window", window_);
}

} // namespace serosa::render
