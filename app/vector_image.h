#pragma once
// Images of displacements for and from medical image programs, through ITK, which the program alone is
// linked with: no library of ours and no header needs it.

#include "base/result.h"
#include "models/solid.h"
#include "sim/displacement.h"

#include <filesystem>
#include <vector>

namespace serosa::app {

/// Three float32 components a node of the grid, mm, in the format that the extension names: .nrrd, or .mha
/// (MetaImage); not compressed. The file's axes are the world's, without a turn: ITK calls them left,
/// posterior, superior, whatever they are. Errors: unknown extension; of the file (folder, permission, disk).
Status writeDisplacementImage(const sim::DisplacementGrid& grid, const std::filesystem::path& file);

/// The same grid with one byte a node: 1 where the lattice has a node, 0 elsewhere.
Status writeNodeMask(const sim::DisplacementGrid& grid, const std::filesystem::path& file);

/// An image of vectors, its axes those of the world without a turn; x fastest.
struct VectorImage {
    glm::ivec3 size{0};
    glm::dvec3 spacing{1}, origin{0}; // mm; origin: of the first voxel's middle
    int components = 3;
    std::vector<float> values; // `components` a voxel
};

/// Three or four components, as above. Errors: as writeDisplacementImage; another number of components.
Status writeVectorImage(const VectorImage& image, const std::filesystem::path& file);
/// Numbers of any type, .nrrd or .mha. Errors: of the file; not of three dimensions; one component; turned
/// axes.
Result<VectorImage> readVectorImage(const std::filesystem::path& file);

/// A volume of one number a voxel, such as a CT or a map of labels, or of three, which are colours; x
/// fastest.
struct VoxelVolume {
    glm::ivec3 size{0};
    glm::dmat4 placeFromVoxel{
        1}; // mm, ITK's axes: left, posterior, superior; voxel (0, 0, 0) has its middle at 0
    int components = 1;
    std::vector<float> values;
};
/// Numbers of any type, .nrrd, .mha, .nii or .nii.gz. Errors: of the file; not of three dimensions; neither
/// one nor three numbers a voxel.
Result<VoxelVolume> readVoxelVolume(const std::filesystem::path& file);
/// Bytes. Errors: as writeDisplacementImage.
Status writeColourVolume(const models::ColourVolume& volume, const std::filesystem::path& file);

/// ITK's, such as "5.2.1".
const char* imageLibraryVersion();

} // namespace serosa::app
