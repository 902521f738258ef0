#pragma once
// The header of a PLY file: which elements follow, of which properties, in which byte order.
// Not for use outside of sim/mesh_reader*.cpp.

#include "base/result.h"
#include "sim/mesh_reader_detail.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace serosa::sim::detail {

enum class PlyEncoding { text, littleEndian, bigEndian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
/// What a property is to us; the order within x y z and red green blue matters.
enum class PlyRole { other, x, y, z, red, green, blue, u, v, corners };

struct PlyProperty {
    std::string name;
    PlyType type{};
    bool isList = false;
    PlyType lengthType{}; // of a list
    PlyRole role = PlyRole::other;
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyEncoding encoding{};
    std::vector<PlyElement> elements;
    std::size_t vertexElement = 0;
    bool coloured = false;      // uchar red, green and blue are all there
    bool textured = false;      // u and v are, under one of their names
    std::size_t bodyOffset = 0; // first byte after end_header's line
    std::size_t bodyLine = 1;   // its line number

    const PlyElement& vertices() const { return elements[vertexElement]; }
};

/// Bytes of a value in a binary body.
std::size_t plySize(PlyType type);
/// The whole numbers that a whole type holds.
std::pair<std::int64_t, std::int64_t> plyRange(PlyType type);
/// The value of the lowest plySize(type) bytes of `bits`; exact for all types.
double plyValue(PlyType type, std::uint64_t bits);

/// Errors: any line that is not PLY 1.0, no vertices with x y z, no faces with corners, counts larger than
/// the rest of the file can hold.
Result<PlyHeader> readPlyHeader(const MeshSource& source);

} // namespace serosa::sim::detail
