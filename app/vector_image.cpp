// See app/vector_image.h. ITK writes by name only, and its MetaImage writer does not tell a full disk from
// success: it writes to a temporary of the same folder, whose length is checked, and whose bytes then go the
// way of all files (base/atomic_file.h).
#include "app/vector_image.h"

#include "base/atomic_file.h"

#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkImageFileWriter.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkRGBPixel.h>
#include <itkVector.h>
#include <itkVectorImage.h>
#include <itkVersion.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

namespace serosa::app {

namespace {

namespace fs = std::filesystem;

/// Removes a file at the end of its life.
struct Temporary {
    fs::path path;
    ~Temporary() {
        std::error_code ignored;
        fs::remove(path, ignored);
    }
};

itk::ImageIOBase::Pointer imageIo(const std::string& extension) {
    if (extension == ".nrrd")
        return itk::NrrdImageIO::New().GetPointer();
    if (extension == ".mha")
        return itk::MetaImageIO::New().GetPointer();
    return nullptr;
}

/// The first line of what ITK says, which names its classes and addresses in the others.
std::string firstLine(const std::string& text) {
    const std::size_t from = std::min(text.find_first_not_of('\n'), text.size());
    return text.substr(from, text.find('\n', from) - from);
}

struct Placed {
    glm::ivec3 size;
    glm::dvec3 spacing, origin; // mm
};
Placed placed(const sim::DisplacementGrid& grid) {
    return {grid.size, glm::dvec3(grid.spacing), grid.origin};
}

/// \param values components of the pixels
template <class Pixel, class Value>
Status writeImage(const Placed& grid, const std::vector<Value>& values, const fs::path& file) {
    static_assert(sizeof(Pixel) % sizeof(Value) == 0, "pixels are copied as they are");
    const std::string name = file.string();
    const itk::ImageIOBase::Pointer io = imageIo(file.extension().string());
    if (!io)
        return Error{name + ": unknown extension for an image; use .nrrd or .mha"};
    using Image = itk::Image<Pixel, 3>;
    const auto image = Image::New();
    typename Image::SizeType size;
    typename Image::SpacingType spacing;
    typename Image::PointType origin;
    for (unsigned axis = 0; axis < 3; ++axis) {
        size[axis] = itk::SizeValueType(grid.size[int(axis)]);
        spacing[axis] = grid.spacing[int(axis)];
        origin[axis] = grid.origin[int(axis)];
    }
    image->SetRegions(typename Image::RegionType(size));
    image->SetSpacing(spacing);
    image->SetOrigin(origin);
    image->Allocate();
    std::copy_n(reinterpret_cast<const Pixel*>(values.data()), values.size() * sizeof(Value) / sizeof(Pixel),
                image->GetBufferPointer());

    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const Temporary temporary{folder /
                              (".serosa-" + std::to_string(::getpid()) + "-" + file.filename().string())};
    try {
        const auto writer = itk::ImageFileWriter<Image>::New();
        writer->SetImageIO(io);
        writer->SetFileName(temporary.path.string());
        writer->SetInput(image);
        writer->UseCompressionOff();
        writer->Update();
    } catch (const itk::ExceptionObject& problem) {
        return Error{name + ": ITK cannot write it: " + firstLine(problem.GetDescription()) +
                     ": look at its folder and at the space on the disk"};
    }
    std::ifstream stream(temporary.path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (bytes.size() <= values.size() * sizeof(Value))
        return Error{name + ": cannot be written: the file came out short; free some space or choose another "
                            "disk"};
    return writeFileAtomically(file, std::string_view(bytes));
}

/// \param numbers fewest and most that a voxel may have. \param wanted "a volume ..."
template <class Image>
Result<typename Image::Pointer> readVolume(itk::ImageIOBase& io, const std::string& name,
                                           const std::array<unsigned, 2>& numbers,
                                           const std::string& wanted) {
    if (!fs::is_regular_file(name))
        return Error{name + ": no such file"};
    try {
        io.SetFileName(name);
        io.ReadImageInformation();
        const unsigned components = io.GetNumberOfComponents();
        if (io.GetNumberOfDimensions() != 3 || components < numbers[0] || components > numbers[1])
            return Error{name + ": has " + std::to_string(io.GetNumberOfDimensions()) + " dimensions and " +
                         std::to_string(components) + " numbers a voxel: give a volume " + wanted};
        const auto reader = itk::ImageFileReader<Image>::New();
        reader->SetImageIO(&io);
        reader->SetFileName(name);
        reader->Update();
        return typename Image::Pointer(reader->GetOutput());
    } catch (const itk::ExceptionObject& problem) {
        return Error{name + ": ITK cannot read it: " + firstLine(problem.GetDescription())};
    }
}

} // namespace

Status writeDisplacementImage(const sim::DisplacementGrid& grid, const fs::path& file) {
    return writeImage<itk::Vector<float, 3>>(placed(grid), grid.vectors, file);
}

Status writeVectorImage(const VectorImage& image, const fs::path& file) {
    const Placed grid{image.size, image.spacing, image.origin};
    if (image.components == 3)
        return writeImage<itk::Vector<float, 3>>(grid, image.values, file);
    if (image.components == 4)
        return writeImage<itk::Vector<float, 4>>(grid, image.values, file);
    return Error{file.string() + ": an image of " + std::to_string(image.components) +
                 " components a voxel is not written: three or four are"};
}

Result<VectorImage> readVectorImage(const fs::path& file) {
    const std::string name = file.string();
    const itk::ImageIOBase::Pointer io = imageIo(file.extension().string());
    if (!io)
        return Error{name + ": unknown extension for an image; use .nrrd or .mha"};
    using Image = itk::VectorImage<float, 3>;
    constexpr unsigned kAny = std::numeric_limits<unsigned>::max();
    SEROSA_ASSIGN(const Image::Pointer image, readVolume<Image>(*io, name, {2, kAny}, "of vectors"));
    VectorImage read;
    read.components = int(image->GetNumberOfComponentsPerPixel());
    std::size_t count = std::size_t(read.components);
    for (unsigned axis = 0; axis < 3; ++axis) {
        read.size[int(axis)] = int(image->GetLargestPossibleRegion().GetSize()[axis]);
        read.spacing[int(axis)] = image->GetSpacing()[axis];
        read.origin[int(axis)] = image->GetOrigin()[axis];
        count *= std::size_t(read.size[int(axis)]);
        for (unsigned other = 0; other < 3; ++other)
            if (std::abs(image->GetDirection()(axis, other) - (axis == other ? 1 : 0)) > 1e-6)
                return Error{name + ": its axes are turned or mirrored: resample it to axes along x, y, z"};
    }
    read.values.assign(image->GetBufferPointer(), image->GetBufferPointer() + count);
    return read;
}

Result<VoxelVolume> readVoxelVolume(const fs::path& file) {
    const std::string name = file.string();
    const bool nifti = name.ends_with(".nii") || name.ends_with(".nii.gz");
    const itk::ImageIOBase::Pointer io =
        nifti ? itk::ImageIOBase::Pointer(itk::NiftiImageIO::New().GetPointer())
              : imageIo(file.extension().string());
    if (!io)
        return Error{name + ": unknown extension for a volume; use .nrrd, .mha, .nii or .nii.gz"};
    using Image = itk::VectorImage<float, 3>;
    const std::string wanted = "of three dimensions with one, or with three that are colours";
    SEROSA_ASSIGN(const Image::Pointer image, readVolume<Image>(*io, name, {1, 3}, wanted));
    VoxelVolume read;
    read.components = int(image->GetNumberOfComponentsPerPixel());
    if (read.components == 2)
        return Error{name + ": has 2 numbers a voxel: give a volume " + wanted};
    std::size_t count = std::size_t(read.components);
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = unsigned(axis);
        read.size[axis] = int(image->GetLargestPossibleRegion().GetSize()[at]);
        count *= std::size_t(read.size[axis]);
        for (int row = 0; row < 3; ++row)
            read.placeFromVoxel[axis][row] =
                image->GetDirection()(unsigned(row), at) * image->GetSpacing()[at];
        read.placeFromVoxel[3][axis] = image->GetOrigin()[at];
    }
    read.values.assign(image->GetBufferPointer(), image->GetBufferPointer() + count);
    return read;
}

Status writeColourVolume(const models::ColourVolume& volume, const fs::path& file) {
    return writeImage<itk::RGBPixel<std::uint8_t>>({volume.size, glm::dvec3(volume.voxel), volume.lowest},
                                                   volume.voxels, file);
}

const char* imageLibraryVersion() {
    return itk::Version::GetITKVersion();
}

Status writeNodeMask(const sim::DisplacementGrid& grid, const fs::path& file) {
    return writeImage<unsigned char>(placed(grid), grid.hasNode, file);
}

} // namespace serosa::app
