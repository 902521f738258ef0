// See app/vector_image.h. ITK writes by name only, and its MetaImage writer does not tell a full disk from
// success: it writes to a temporary of the same folder, whose length is checked, and whose bytes then go the
// way of all files (base/atomic_file.h).
#include "app/vector_image.h"

#include "base/atomic_file.h"

#include <itkImage.h>
#include <itkImageFileWriter.h>
#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkVector.h>
#include <itkVersion.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
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

template <class Pixel, class Value>
Status writeImage(const sim::DisplacementGrid& grid, const std::vector<Value>& values, const fs::path& file) {
    static_assert(sizeof(Pixel) == sizeof(Value), "pixels are copied as they are");
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
        spacing[axis] = grid.spacing;
        origin[axis] = grid.origin[int(axis)];
    }
    image->SetRegions(typename Image::RegionType(size));
    image->SetSpacing(spacing);
    image->SetOrigin(origin);
    image->Allocate();
    std::copy_n(reinterpret_cast<const Pixel*>(values.data()), values.size(), image->GetBufferPointer());

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

} // namespace

Status writeDisplacementImage(const sim::DisplacementGrid& grid, const fs::path& file) {
    return writeImage<itk::Vector<float, 3>>(grid, grid.vectors, file);
}

const char* imageLibraryVersion() {
    return itk::Version::GetITKVersion();
}

Status writeNodeMask(const sim::DisplacementGrid& grid, const fs::path& file) {
    return writeImage<unsigned char>(grid, grid.hasNode, file);
}

} // namespace serosa::app
