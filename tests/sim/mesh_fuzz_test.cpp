// Small files of each format with bytes flipped, cut out, put in and doubled at random (always the same
// random): the readers never crash, and what they return is a mesh that keeps its promises, or an error of
// one line.
#include "sim/mesh_check.h"
#include "sim/mesh_reader.h"
#include "sim/mesh_reader_detail.h"
#include "sim/mesh_repair.h"
#include "tests/sim/mesh_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace serosa::sim {
namespace {

/// One to four mutations of one kind or another.
std::string mutated(std::string bytes, std::mt19937& random) {
    const auto below = [&](std::size_t limit) {
        return static_cast<std::size_t>(random() % std::max<std::size_t>(limit, 1));
    };
    static const std::vector<std::string> kWords{"-1",
                                                 "0",
                                                 "4294967295",
                                                 "4294967296",
                                                 "1e999",
                                                 "nan",
                                                 "1,5",
                                                 "\n",
                                                 " ",
                                                 "#",
                                                 "\\\n",
                                                 "\xff\xff\xff\xff",
                                                 std::string(4, '\0'),
                                                 "list",
                                                 "vertex",
                                                 "end_header\n",
                                                 "9223372036854775808"};
    for (std::size_t count = 1 + below(4); count > 0 && !bytes.empty(); --count) {
        const std::size_t at = below(bytes.size());
        switch (below(6)) {
        case 0:
            bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
            break;
        case 1:
            bytes[at] = static_cast<char>(below(256));
            break;
        case 2:
            bytes.resize(at);
            break;
        case 3:
            bytes.erase(at, 1 + below(8));
            break;
        case 4:
            bytes.insert(at, kWords[below(kWords.size())]);
            break;
        default:
            bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(40)));
            break;
        }
    }
    return bytes;
}

struct Tally {
    int read = 0, refused = 0;
};

template <class Read>
Tally fuzz(const std::string& seed, unsigned number, int runs, const Read& read) {
    std::mt19937 random(number);
    Tally tally;
    for (int run = 0; run < runs; ++run) {
        const std::string bytes = mutated(seed, random);
        const Result<TriangleMesh> mesh = read(detail::MeshSource{"fuzzed", bytes});
        if (!mesh.ok()) {
            ++tally.refused;
            EXPECT_EQ(mesh.error().message.find("fuzzed"), 0u) << mesh.error().message;
            EXPECT_EQ(mesh.error().message.find('\n'), std::string::npos) << mesh.error().message;
            continue;
        }
        ++tally.read;
        EXPECT_FALSE(mesh->faces.empty());
        EXPECT_TRUE(mesh->colours.empty() || mesh->colours.size() == mesh->positions.size());
        for (const auto& p : mesh->positions)
            EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
        for (const auto& face : mesh->faces)
            EXPECT_LT(std::max({face.x, face.y, face.z}), mesh->positions.size());
        const bool solid =
            checkClosedSolid(*mesh, "fuzzed").ok(); // nor does what comes after the reader crash
        const MeshReport report = inspectMesh(*mesh, true);
        EXPECT_TRUE(!solid || (report.solids == 1 && report.volume > 0));
        const auto mended = repairMesh(*mesh, "fuzzed");
        EXPECT_TRUE(!solid || mended.ok());
        EXPECT_TRUE(mended.ok() ? checkClosedSolid(mended->mesh, "fuzzed").ok()
                                : mended.error().message.starts_with("fuzzed: "))
            << "run " << run;
    }
    EXPECT_GT(tally.read, 0);
    EXPECT_GT(tally.refused, runs / 10);
    return tally;
}

constexpr int kRuns = 5000;

/// TetGen's two files as one seed, cut at the first 'F'.
Result<TriangleMesh> readBothTetgen(const detail::MeshSource& source) {
    const std::size_t cut = std::min(source.bytes.find('F'), source.bytes.size());
    const std::string_view rest = source.bytes.substr(std::min(cut + 1, source.bytes.size()));
    return detail::readTetgen({source.name, source.bytes.substr(0, cut)}, {source.name, rest});
}

TEST(MeshFuzz, Obj) {
    fuzz(kObj, 1, kRuns, detail::readObj);
}
TEST(MeshFuzz, Off) {
    fuzz(kOff, 2, kRuns, detail::readOff);
}
TEST(MeshFuzz, PlyText) {
    fuzz(kPlyText, 3, kRuns, detail::readPly);
}
TEST(MeshFuzz, PlyLittleEndian) {
    fuzz(plyBinary(true), 4, kRuns, detail::readPly);
}
TEST(MeshFuzz, PlyBigEndian) {
    fuzz(plyBinary(false), 5, kRuns, detail::readPly);
}
TEST(MeshFuzz, PlyExtras) {
    fuzz(plyBinaryWithExtras(true), 9, kRuns, detail::readPly);
}
TEST(MeshFuzz, StlText) {
    fuzz(kStlText, 6, kRuns, detail::readStl);
}
TEST(MeshFuzz, VtkText) {
    fuzz(kVtkText, 10, kRuns, detail::readVtk);
}
TEST(MeshFuzz, VtkBinary) {
    fuzz(vtkBinary(), 11, kRuns, detail::readVtk);
}
TEST(MeshFuzz, VtkOffsets) {
    fuzz(vtkOffsets(true), 12, kRuns, detail::readVtk);
    fuzz(vtkOffsets(false), 13, kRuns, detail::readVtk);
}
TEST(MeshFuzz, Tetgen) {
    fuzz(kNode + "F" + kFace, 14, kRuns, readBothTetgen);
}
TEST(MeshFuzz, StlBinary) {
    fuzz(stlBinary(), 7, kRuns, detail::readStl);
}

// The same through the file, where the format has to be told first.
TEST_F(MeshFiles, FuzzedFilesOfAnyName) {
    std::mt19937 random(8);
    const std::vector<std::string> seeds{kObj,        kOff,     kPlyText,    plyBinary(true), kStlText,
                                         stlBinary(), kVtkText, vtkBinary(), kNode,           kFace};
    const std::vector<std::string> names{"a.obj",  "a.off",  "a.ply", "a.stl", "a.vtk",
                                         "a.node", "a.face", "a",     "a.xyz"};
    for (int run = 0; run < 100; ++run) {
        const auto path =
            file(names[random() % names.size()], mutated(seeds[random() % seeds.size()], random));
        const auto mesh = readMesh(path);
        // Of TetGen's two files the one that is wrong is named.
        const std::string stem = (path.parent_path() / path.stem()).string();
        EXPECT_TRUE(mesh.ok() || mesh.error().message.starts_with(stem)) << mesh.error().message;
    }
}

} // namespace
} // namespace serosa::sim
