// The bytes of a file are made in memory and written at once. Text numbers are the shortest that read back
// the same (std::to_chars), in no locale.
#include "sim/mesh_writer.h"

#include "base/atomic_file.h"
#include "base/check.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

namespace serosa::sim {
namespace {

class Bytes {
public:
    template <class Value>
    void text(const Value& value) {
        if constexpr (std::is_arithmetic_v<Value>) {
            char digits[32];
            bytes_.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
        } else {
            bytes_ += value;
        }
    }
    /// Words with blanks between, and a line end.
    template <class First, class... Rest>
    void line(const First& first, const Rest&... rest) {
        text(first);
        ((bytes_ += ' ', text(rest)), ...);
        bytes_ += '\n';
    }

    void little(std::uint64_t bits, int size) {
        for (int i = 0; i < size; ++i)
            bytes_ += static_cast<char>(bits >> (8 * i) & 0xff);
    }
    void float32(double value) { little(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4); }
    void float64(double value) { little(std::bit_cast<std::uint64_t>(value), 8); }

    std::string& content() { return bytes_; }

private:
    std::string bytes_;
};

std::string plyOf(const TriangleMesh& mesh) {
    Bytes out;
    out.line("ply");
    out.line("format binary_little_endian 1.0");
    out.line("element vertex", mesh.positions.size());
    for (const char* axis : {"x", "y", "z"})
        out.line("property double", axis);
    if (!mesh.colours.empty())
        for (const char* channel : {"red", "green", "blue"})
            out.line("property uchar", channel);
    out.line("element face", mesh.faces.size());
    out.line("property list uchar int vertex_indices");
    out.line("end_header");
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis)
            out.float64(mesh.positions[i][axis]);
        if (!mesh.colours.empty())
            for (int channel = 0; channel < 3; ++channel)
                out.little(mesh.colours[i][channel], 1);
    }
    for (const auto& face : mesh.faces) {
        out.little(3, 1);
        for (int corner = 0; corner < 3; ++corner)
            out.little(face[corner], 4);
    }
    return std::move(out.content());
}

std::string objOf(const TriangleMesh& mesh) {
    Bytes out;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3& p = mesh.positions[i];
        if (mesh.colours.empty()) {
            out.line("v", p.x, p.y, p.z);
        } else {
            const glm::dvec3 colour = glm::dvec3(mesh.colours[i]) / 255.0;
            out.line("v", p.x, p.y, p.z, static_cast<float>(colour.x), static_cast<float>(colour.y),
                     static_cast<float>(colour.z));
        }
    }
    for (const auto& face : mesh.faces)
        out.line("f", std::uint64_t(face.x) + 1, std::uint64_t(face.y) + 1, std::uint64_t(face.z) + 1);
    return std::move(out.content());
}

std::string offOf(const TriangleMesh& mesh) {
    Bytes out;
    out.line(mesh.colours.empty() ? "OFF" : "COFF");
    out.line(mesh.positions.size(), mesh.faces.size(), 0);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3& p = mesh.positions[i];
        if (mesh.colours.empty()) {
            out.line(p.x, p.y, p.z);
        } else {
            const glm::uvec3 colour(mesh.colours[i]);
            out.line(p.x, p.y, p.z, colour.x, colour.y, colour.z, 255);
        }
    }
    for (const auto& face : mesh.faces)
        out.line(3, face.x, face.y, face.z);
    return std::move(out.content());
}

/// The header does not begin with "solid", which would pass for a text STL.
std::string stlOf(const TriangleMesh& mesh) {
    Bytes out;
    out.content() = "serosa, binary STL";
    out.content().resize(80, ' ');
    out.little(mesh.faces.size(), 4);
    for (const auto& face : mesh.faces) {
        const glm::dvec3 &a = mesh.positions[face.x], &b = mesh.positions[face.y],
                         &c = mesh.positions[face.z];
        const glm::dvec3 twiceArea = glm::cross(b - a, c - a);
        const double length = glm::length(twiceArea);
        const glm::dvec3 normal = length > 0 && std::isfinite(length) ? twiceArea / length : glm::dvec3(0);
        for (const glm::dvec3& vector : {normal, a, b, c})
            for (int axis = 0; axis < 3; ++axis)
                out.float32(vector[axis]);
        out.little(0, 2);
    }
    return std::move(out.content());
}

} // namespace

Status writeMesh(const TriangleMesh& mesh, const std::filesystem::path& file) {
    const std::string name = file.string();
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto format = extension == ".ply"   ? plyOf
                        : extension == ".obj" ? objOf
                        : extension == ".off" ? offOf
                        : extension == ".stl" ? stlOf
                                              : nullptr;
    if (!format)
        return Error{name + ": unknown extension '" + extension +
                     "' for a surface; use .ply, .obj, .off or .stl"};
    if (mesh.faces.empty())
        return Error{name + ": not written: the surface has no triangles"};
    SEROSA_CHECK(mesh.colours.empty() || mesh.colours.size() == mesh.positions.size(),
                 "one colour a vertex, or none");
    for (const auto& face : mesh.faces)
        SEROSA_CHECK(std::max({face.x, face.y, face.z}) < mesh.positions.size(),
                     "a triangle names a vertex that is not there");
    const double largest =
        format == stlOf ? double(std::numeric_limits<float>::max()) : std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(mesh.positions[i][axis]) <= largest))
                return Error{name + ": not written: vertex " + std::to_string(i) +
                             " (from 0) has a coordinate that is " +
                             (std::isfinite(mesh.positions[i][axis])
                                  ? "too large for STL; write .ply"
                                  : "not finite; the deformation went wrong")};
    return writeFileAtomically(file, format(mesh));
}

} // namespace serosa::sim
