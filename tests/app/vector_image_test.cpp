// Displacement images: read back through ITK, and independently the header and bytes of NRRD and MetaImage by
// hand, against the state.
#include "app/vector_image.h"
#include "models/phantom.h"
#include "sim/solver.h"
#include "tests/app/child.h"
#include "tests/sim/cut_strokes.h"

#include <gtest/gtest.h>
#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkImageFileWriter.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkVector.h>

#include <cstring>

namespace serosa::app {
namespace {

namespace fs = std::filesystem;

template <class Pixel>
typename itk::Image<Pixel, 3>::Pointer readImage(const fs::path& file) {
    const auto reader = itk::ImageFileReader<itk::Image<Pixel, 3>>::New();
    if (file.extension() == ".nrrd")
        reader->SetImageIO(itk::NrrdImageIO::New());
    else
        reader->SetImageIO(itk::MetaImageIO::New());
    reader->SetFileName(file.string());
    reader->Update();
    return reader->GetOutput();
}

class VectorImage : public ::testing::Test {
protected:
    VectorImage() : lattice_(test::hollowBall(7)), state_(sim::restState(lattice_)) {
        std::mt19937 random(11);
        for (glm::dvec3& position : state_.positions)
            position += glm::dvec3(test::number(random, -1, 1), test::number(random, -1, 1),
                                   test::number(random, -1, 1));
        grid_ = sim::displacementGrid(lattice_, state_);
    }
    /// Metres, from the state.
    glm::dvec3 moved(std::size_t node) const {
        return lattice_.toWorld(state_.positions[node]) - lattice_.toWorld(lattice_.restPosition(node));
    }
    TestFolder folder_;
    sim::Lattice lattice_;
    sim::LatticeState state_;
    sim::DisplacementGrid grid_;
};

TEST_F(VectorImage, readsBackThroughItk) {
    for (const char* extension : {".nrrd", ".mha"}) {
        const fs::path file = folder_.path() / (std::string("displacement") + extension),
                       maskFile = folder_.path() / (std::string("mask") + extension);
        ASSERT_TRUE(writeDisplacementImage(grid_, file).ok());
        ASSERT_TRUE(writeNodeMask(grid_, maskFile).ok());
        const auto image = readImage<itk::Vector<float, 3>>(file);
        const auto mask = readImage<unsigned char>(maskFile);
        std::size_t nodes = 0;
        const auto size = image->GetLargestPossibleRegion().GetSize();
        ASSERT_EQ(mask->GetLargestPossibleRegion().GetSize(), size);
        for (long z = 0; z < long(size[2]); ++z)
            for (long y = 0; y < long(size[1]); ++y)
                for (long x = 0; x < long(size[0]); ++x) {
                    const itk::Index<3> at{{x, y, z}};
                    const auto vector = image->GetPixel(at);
                    const std::int64_t node = lattice_.nodeAt({int(x), int(y), int(z)});
                    ASSERT_EQ(mask->GetPixel(at), node >= 0 ? 1 : 0);
                    nodes += node >= 0;
                    const glm::dvec3 expected = node >= 0 ? 1e3 * moved(std::size_t(node)) : glm::dvec3(0);
                    // Where ITK says that the pixel lies is where the node rests, in millimetres.
                    itk::Point<double, 3> place;
                    image->TransformIndexToPhysicalPoint(at, place);
                    for (unsigned axis = 0; axis < 3; ++axis) {
                        ASSERT_NEAR(vector[axis], expected[int(axis)], 1e-6 * 3);
                        if (node >= 0) {
                            ASSERT_NEAR(
                                place[axis],
                                1e3 * lattice_.toWorld(lattice_.restPosition(std::size_t(node)))[int(axis)],
                                1e-9);
                        }
                    }
                }
        EXPECT_EQ(nodes, lattice_.nodeCount());
    }
    EXPECT_EQ(folder_.names(),
              (std::set<std::string>{"displacement.nrrd", "displacement.mha", "mask.nrrd", "mask.mha"}));
}

TEST_F(VectorImage, hasTheBytesThatItsHeaderSays) {
    const fs::path file = folder_.path() / "a.nrrd";
    ASSERT_TRUE(writeDisplacementImage(grid_, file).ok());
    const std::string bytes = readWhole(file);
    const std::size_t end = bytes.find("\n\n");
    ASSERT_NE(end, std::string::npos);
    const std::string header = bytes.substr(0, end + 1);
    const glm::ivec3 size = lattice_.nodeDims;
    EXPECT_EQ(header.rfind("NRRD000", 0), 0u);
    for (const std::string& line :
         {std::string("type: float"), std::string("dimension: 4"), std::string("encoding: raw"),
          std::string("endian: little"), std::string("space: left-posterior-superior"),
          "sizes: 3 " + std::to_string(size.x) + " " + std::to_string(size.y) + " " + std::to_string(size.z),
          std::string("kinds: vector domain domain domain"),
          std::string("space directions: none (3,0,0) (0,3,0) (0,0,3)")})
        EXPECT_NE(header.find("\n" + line + "\n"), std::string::npos) << line << " is not in\n" << header;
    ASSERT_EQ(bytes.size() - end - 2, std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z) * 12);
    std::size_t checked = 0;
    for (std::size_t node = 0; node < lattice_.nodeCount(); ++node, ++checked) {
        const glm::ivec3 at = lattice_.nodes[node];
        float vector[3];
        std::memcpy(vector, bytes.data() + end + 2 + 12 * std::size_t((at.z * size.y + at.y) * size.x + at.x),
                    sizeof vector);
        for (int axis = 0; axis < 3; ++axis)
            ASSERT_NEAR(vector[axis], 1e3 * moved(node)[axis], 1e-6 * 3) << node;
    }
    EXPECT_GT(checked, 100u);

    ASSERT_TRUE(writeDisplacementImage(grid_, folder_.path() / "a.mha").ok());
    const std::string meta = readWhole(folder_.path() / "a.mha");
    const std::size_t data = meta.find("ElementDataFile = LOCAL\n");
    ASSERT_NE(data, std::string::npos);
    EXPECT_NE(meta.find("ElementNumberOfChannels = 3\n"), std::string::npos);
    EXPECT_NE(meta.find("ElementSpacing = 3 3 3\n"), std::string::npos);
    EXPECT_EQ(meta.substr(data + 24), bytes.substr(end + 2)) << "the same pixels in both formats";
}

TEST_F(VectorImage, isTheSameBytesTwice) {
    for (const char* name : {"a.nrrd", "b.nrrd", "a.mha", "b.mha"})
        ASSERT_TRUE(writeDisplacementImage(grid_, folder_.path() / name).ok());
    EXPECT_EQ(readWhole(folder_.path() / "a.nrrd"), readWhole(folder_.path() / "b.nrrd"));
    EXPECT_EQ(readWhole(folder_.path() / "a.mha"), readWhole(folder_.path() / "b.mha"));
}

TEST_F(VectorImage, errorsLeaveNothingBehind) {
    for (const char* name : {"no/such/folder.nrrd", "no/such/folder.mha", "a.nii"}) {
        const Status written = writeDisplacementImage(grid_, folder_.path() / name);
        ASSERT_FALSE(written.ok()) << name;
        EXPECT_NE(written.error().message.find(name), std::string::npos);
        EXPECT_EQ(written.error().message.find('\n'), std::string::npos) << written.error().message;
    }
    // A disk that fills up: files end at 1,000 bytes.
    signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{1000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    std::vector<Status> full;
    for (const char* name : {"a.nrrd", "a.mha"})
        full.push_back(writeDisplacementImage(grid_, folder_.path() / name));
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, SIG_DFL);
    for (const Status& written : full)
        EXPECT_FALSE(written.ok());
    EXPECT_EQ(folder_.names(), (std::set<std::string>{}));
}

/// Values that say their index, on axes that are turned and mirrored.
template <unsigned dimensions>
void writeNumbered(itk::ImageIOBase::Pointer io, const fs::path& file) {
    using Image = itk::Image<short, dimensions>;
    const auto image = Image::New();
    typename Image::SizeType size;
    size.Fill(2);
    size[0] = 4;
    size[1] = 3;
    image->SetRegions(typename Image::RegionType(size));
    image->Allocate();
    if constexpr (dimensions == 3) {
        const double c = std::cos(0.4), s = std::sin(0.4);
        const double axes[3][3] = {{-c, 0, s}, {0, -1, 0}, {s, 0, c}}, origin[3] = {-12.5, 40, 7},
                     spacing[3] = {1.5, 2.25, 4};
        typename Image::DirectionType direction;
        for (unsigned i = 0; i < 3; ++i)
            for (unsigned j = 0; j < 3; ++j)
                direction(i, j) = axes[i][j];
        image->SetDirection(direction);
        image->SetOrigin(origin);
        image->SetSpacing(spacing);
    }
    for (std::size_t i = 0; i < image->GetLargestPossibleRegion().GetNumberOfPixels(); ++i)
        image->GetBufferPointer()[i] = short(10 * i - 50);
    const auto writer = itk::ImageFileWriter<Image>::New();
    writer->SetImageIO(io);
    writer->SetFileName(file.string());
    writer->SetInput(image);
    writer->Update();
}

TEST_F(VectorImage, VolumesLieWhereItkSaysThatTheirVoxelsDo) {
    const std::pair<const char*, itk::ImageIOBase::Pointer> formats[] = {
        {"v.nrrd", itk::NrrdImageIO::New().GetPointer()},
        {"v.mha", itk::MetaImageIO::New().GetPointer()},
        {"v.nii", itk::NiftiImageIO::New().GetPointer()},
        {"v.nii.gz", itk::NiftiImageIO::New().GetPointer()}};
    for (const auto& [name, io] : formats) {
        SCOPED_TRACE(name);
        const fs::path file = folder_.path() / name;
        writeNumbered<3>(io, file);
        const auto read = readVoxelVolume(file);
        ASSERT_TRUE(read.ok()) << read.error().message;
        ASSERT_EQ(read->size, glm::ivec3(4, 3, 2));
        const double c = std::cos(0.4), s = std::sin(0.4);
        std::size_t i = 0;
        for (int z = 0; z < 2; ++z)
            for (int y = 0; y < 3; ++y)
                for (int x = 0; x < 4; ++x, ++i) {
                    EXPECT_EQ(read->values[i], float(10 * i) - 50);
                    const glm::dvec3 place(read->placeFromVoxel * glm::dvec4(x, y, z, 1)),
                        known(-12.5 - 1.5 * c * x + 4 * s * z, 40 - 2.25 * y, 7 + 1.5 * s * x + 4 * c * z);
                    EXPECT_LT(glm::distance(place, known), 1e-4); // NIfTI has float32
                }
    }
}

TEST_F(VectorImage, ColoursOfAPhantomComeBackFromItsFile) {
    const auto made = models::makePhantomVolume("kidney", 4);
    ASSERT_TRUE(made.ok()) << made.error().message;
    for (const char* name : {"c.nrrd", "c.mha"}) {
        ASSERT_TRUE(writeColourVolume(*made, folder_.path() / name).ok());
        const auto read = readVoxelVolume(folder_.path() / name);
        ASSERT_TRUE(read.ok()) << read.error().message;
        ASSERT_EQ(read->size, made->size);
        ASSERT_EQ(read->components, 3);
        for (std::size_t i = 0; i < made->voxels.size(); ++i)
            for (int c = 0; c < 3; ++c)
                ASSERT_EQ(read->values[3 * i + std::size_t(c)], float(made->voxels[i][c]));
        const glm::dvec3 last = glm::dvec3(made->size - 1), place(read->placeFromVoxel * glm::dvec4(last, 1));
        EXPECT_LT(glm::distance(place, made->lowest + 4.0 * last), 1e-6);
    }
}

TEST_F(VectorImage, WhatIsNoVolumeIsRefusedInOneLine) {
    writeNumbered<2>(itk::MetaImageIO::New().GetPointer(), folder_.path() / "flat.mha");
    folder_.write("pairs.nrrd",
                  "NRRD0004\ntype: short\ndimension: 4\nsizes: 2 2 1 1\nkinds: 2-vector space space space\n"
                  "space: left-posterior-superior\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\n"
                  "encoding: ascii\n\n1 2 3 4\n");
    folder_.write("text.nrrd", "no image\n");
    folder_.write("text.nii.gz", "no image\n");
    for (const auto& [name, says] : {std::pair{"flat.mha", "2 dimensions"},
                                     {"pairs.nrrd", "2 numbers a voxel"},
                                     {"text.nrrd", ""},
                                     {"text.nii.gz", ""},
                                     {"gone.mha", "no such file"},
                                     {"v.dcm", "unknown extension"}}) {
        const auto read = readVoxelVolume(folder_.path() / name);
        ASSERT_FALSE(read.ok()) << name;
        EXPECT_NE(read.error().message.find(name), std::string::npos);
        EXPECT_NE(read.error().message.find(says), std::string::npos) << read.error().message;
        EXPECT_EQ(read.error().message.find('\n'), std::string::npos) << read.error().message;
    }
}

} // namespace
} // namespace serosa::app
