#pragma once
// A folder of its own for each test, and one tetrahedron (tests/sim/mesh_shapes.h) in the bytes of each
// format.

#include "tests/sim/mesh_shapes.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace serosa::sim {

class MeshFiles : public testing::Test {
protected:
    void SetUp() override {
        std::string pattern = (std::filesystem::temp_directory_path() / "serosa-mesh-XXXXXX").string();
        ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    /// Writes the bytes and returns the path.
    std::filesystem::path file(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return folder_ / name;
    }
    static std::string content(const std::filesystem::path& path) {
        std::ifstream stream(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    std::size_t entries() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
    }

    std::filesystem::path folder_;
};

inline const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
inline const std::string kOff =
    "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
inline const std::string kPlyText =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
inline const std::string kStlText =
    "solid a\n"
    "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
    "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet\n"
    "facet normal 1 1 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "endsolid a\n";

inline void append(std::string& bytes, std::uint32_t bits, int size, bool little) {
    for (int i = 0; i < size; ++i)
        bytes += static_cast<char>(bits >> (8 * (little ? i : size - 1 - i)) & 0xff);
}

/// 4 vertices of 3 floats behind the header, then 4 faces of 13 bytes.
inline std::string plyBinary(bool little) {
    std::string bytes =
        std::string("ply\nformat binary_") + (little ? "little" : "big") +
        "_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
    for (const auto& p : tetrahedron().positions)
        for (int axis = 0; axis < 3; ++axis)
            append(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(p[axis])), 4, little);
    for (const auto& face : tetrahedron().faces) {
        append(bytes, 3, 1, little);
        for (int corner = 0; corner < 3; ++corner)
            append(bytes, face[corner], 4, little);
    }
    return bytes;
}

/// The same, with 16-bit coordinates, normals, a list and an element between, all to be passed over.
inline std::string plyBinaryWithExtras(bool little) {
    std::string bytes =
        std::string("ply\nformat binary_") + (little ? "little" : "big") +
        "_endian 1.0\nelement vertex 4\nproperty ushort x\nproperty short y\nproperty double nx\n"
        "property char z\nelement ring 2\nproperty list ushort short members\nproperty float width\n"
        "element face 4\nproperty list uchar uint vertex_index\nproperty list int float uv\nend_header\n";
    for (const auto& p : tetrahedron().positions) {
        append(bytes, static_cast<std::uint32_t>(p.x), 2, little);
        append(bytes, static_cast<std::uint32_t>(p.y), 2, little);
        bytes.append(8, '\x7f');
        append(bytes, static_cast<std::uint32_t>(p.z), 1, little);
    }
    for (std::uint32_t members = 0; members < 2; ++members) {
        append(bytes, members, 2, little);
        bytes.append(2 * members + 4, '\x55');
    }
    for (const auto& face : tetrahedron().faces) {
        append(bytes, 3, 1, little);
        for (int corner = 0; corner < 3; ++corner)
            append(bytes, face[corner], 4, little);
        append(bytes, 1, 4, little);
        bytes.append(4, '\x11');
    }
    return bytes;
}

inline std::string stlBinary() {
    std::string bytes(80, ' ');
    append(bytes, 4, 4, true);
    for (const auto& face : tetrahedron().faces) {
        bytes.append(12, '\0'); // the normal
        for (int corner = 0; corner < 3; ++corner)
            for (int axis = 0; axis < 3; ++axis)
                append(bytes,
                       std::bit_cast<std::uint32_t>(
                           static_cast<float>(tetrahedron().positions[face[corner]][axis])),
                       4, true);
        bytes.append(2, '\0');
    }
    return bytes;
}

inline const std::string kVtkText =
    "# vtk DataFile Version 3.0\na title\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0\n0 1 0\n0 0 "
    "1\nPOLYGONS 4 16\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

/// Big-endian, with a METADATA block and attributes to be passed over.
inline std::string vtkBinary() {
    std::string bytes = "# vtk DataFile Version 4.2\n\nBINARY\nDATASET POLYDATA\nPOINTS 4 float\n";
    for (const auto& p : tetrahedron().positions)
        for (int axis = 0; axis < 3; ++axis)
            append(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(p[axis])), 4, false);
    bytes += "\nMETADATA\nINFORMATION 0\n\nPOLYGONS 4 16\n";
    for (const auto& face : tetrahedron().faces) {
        append(bytes, 3, 4, false);
        for (int corner = 0; corner < 3; ++corner)
            append(bytes, face[corner], 4, false);
    }
    return bytes + "\nCELL_DATA 4\nSCALARS a float 1\nLOOKUP_TABLE default\n\1\2\3";
}

/// Version 5.1: offsets and connectivity, 64 bits, double coordinates.
inline std::string vtkOffsets(bool binary) {
    std::string bytes = "# vtk DataFile Version 5.1\nvtk output\n";
    bytes += binary ? "BINARY\n" : "ASCII\n";
    bytes += "DATASET POLYDATA\nPOINTS 4 double\n";
    const auto integer = [&](std::uint32_t value) {
        if (binary) {
            append(bytes, 0, 4, false);
            append(bytes, value, 4, false);
        } else {
            bytes += std::to_string(value) + " ";
        }
    };
    for (const auto& p : tetrahedron().positions)
        for (int axis = 0; axis < 3; ++axis)
            if (binary) {
                const auto bits = std::bit_cast<std::uint64_t>(p[axis]);
                append(bytes, static_cast<std::uint32_t>(bits >> 32), 4, false);
                append(bytes, static_cast<std::uint32_t>(bits), 4, false);
            } else {
                integer(static_cast<std::uint32_t>(p[axis]));
            }
    bytes += "\nPOLYGONS 5 12\nOFFSETS vtktypeint64\n";
    for (std::uint32_t i = 0; i <= 4; ++i)
        integer(3 * i);
    bytes += "\nCONNECTIVITY vtktypeint64\n";
    for (const auto& face : tetrahedron().faces)
        for (int corner = 0; corner < 3; ++corner)
            integer(face[corner]);
    return bytes + "\n";
}

/// TetGen, counted from 1, with an attribute, markers and a node that no face uses.
inline const std::string kNode = "# nodes\n5 3 1 1\n1 0 0 0 0.5 1\n2 1 0 0 -1 1\n3 0 1 0 0 1\n"
                                 "4 0 0 1 2e3 1 # the top\n5 0.1 0.1 0.1 0 0\n";
inline const std::string kFace = "4 1\n1 1 3 2 -1\n2 1 2 4 -1\n3 1 4 3 -1\n4 2 3 4 7\n# end\n";

} // namespace serosa::sim
