// STL, binary and text. Its corners are unshared: those of identical positions become one vertex, in order of
// first use. Identical means bit by bit (with -0 as +0): real organs have edges of 1e-4 mm beside 3 mm, which
// a tolerance would close. Normals and attribute bytes are passed over.
#include "sim/mesh_reader_detail.h"

#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <unordered_map>

namespace serosa::sim::detail {
namespace {

constexpr std::size_t kHeaderBytes = 84, kFacetBytes = 50;

std::uint32_t littleEndian32(std::string_view bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[offset + i])) << (8 * i);
    return value;
}

struct PositionHash {
    std::size_t operator()(const glm::dvec3& p) const {
        std::uint64_t hash = 0;
        for (int i = 0; i < 3; ++i) {
            hash = (hash ^ std::bit_cast<std::uint64_t>(p[i])) * 0x9e3779b97f4a7c15ull;
            hash ^= hash >> 29;
        }
        return static_cast<std::size_t>(hash);
    }
};

/// Turns corners into vertices and triangles.
class CornerMerger {
public:
    void reserve(std::size_t facets) {
        mesh_.faces.reserve(facets);
        indices_.reserve(facets / 2 + 2);
    }

    void add(const glm::dvec3& corner) {
        const glm::dvec3 position = corner + 0.0; // -0 becomes +0
        const auto [entry, fresh] =
            indices_.try_emplace(position, static_cast<std::uint32_t>(mesh_.positions.size()));
        if (fresh)
            mesh_.positions.push_back(position);
        face_[corners_++] = entry->second;
        if (corners_ == 3) {
            mesh_.faces.push_back(face_);
            corners_ = 0;
        }
    }

    TriangleMesh take() { return std::move(mesh_); }

private:
    TriangleMesh mesh_;
    std::unordered_map<glm::dvec3, std::uint32_t, PositionHash> indices_;
    glm::uvec3 face_{0};
    int corners_ = 0;
};

Result<TriangleMesh> readBinary(const MeshSource& source) {
    const std::string_view bytes = source.bytes;
    if (bytes.size() < kHeaderBytes)
        return source.atByte(bytes.size(),
                             "the file ends within the 84 bytes of a binary STL's header; export it again");
    const std::size_t facets = littleEndian32(bytes, 80);
    const std::size_t expected = kHeaderBytes + facets * kFacetBytes;
    const std::string claim = "the header announces " + std::to_string(facets) + " triangles (" +
                              std::to_string(expected) + " bytes), the file has " +
                              std::to_string(bytes.size()) + " bytes; ";
    if (bytes.size() < expected)
        return source.atByte(80, claim + "it is cut off or no STL, export it again");
    if (bytes.size() > expected)
        return source.atByte(80, claim + "remove what follows, or export it again");
    if (facets == 0)
        return source.atByte(80, "the header announces no triangles; export a surface");
    CornerMerger merger;
    merger.reserve(facets);
    for (std::size_t facet = 0; facet < facets; ++facet) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            glm::dvec3 position;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::size_t offset = kHeaderBytes + facet * kFacetBytes + 12 + corner * 12 + axis * 4;
                const float value = std::bit_cast<float>(littleEndian32(bytes, offset));
                if (!std::isfinite(value))
                    return source.atByte(offset, "triangle " + std::to_string(facet) +
                                                     " has a coordinate that is " +
                                                     (std::isnan(value) ? "not a number" : "infinite") +
                                                     "; repair the mesh where it was made");
                position[static_cast<int>(axis)] = static_cast<double>(value);
            }
            merger.add(position);
        }
    }
    return merger.take();
}

/// The grammar: solid NAME { facet normal X Y Z  outer loop  3 times: vertex X Y Z  endloop  endfacet }
/// endsolid NAME, one or more times; a line for each.
class TextReader {
public:
    explicit TextReader(const MeshSource& source) : source_(source), reader_(source) {}

    Result<TriangleMesh> read() {
        std::size_t facets = 0;
        while (reader_.nextWithWords()) {
            if (!is(0, "solid"))
                return error("expected solid, found " + quotedWord(reader_.words()[0]) +
                             "; remove what follows endsolid");
            const std::size_t solidLine = reader_.line();
            while (true) {
                SEROSA_TRY(
                    next("facet or endsolid (of the solid in line " + std::to_string(solidLine) + ")"));
                if (is(0, "endsolid") || (is(0, "end") && is(1, "solid")))
                    break;
                SEROSA_TRY(readFacet());
                ++facets;
            }
        }
        if (facets == 0)
            return error("no facets up to the end of the file; export a surface");
        return merger_.take();
    }

private:
    Error error(const std::string& text) const { return source_.atLine(reader_.line(), text); }

    Status next(const std::string& expected) {
        if (!reader_.nextWithWords())
            return error("the file ends where " + expected + " should come; it is cut off, export it again");
        return {};
    }

    bool is(std::size_t word, std::string_view keyword) const {
        if (word >= reader_.words().size() || reader_.words()[word].size() != keyword.size())
            return false;
        for (std::size_t i = 0; i < keyword.size(); ++i)
            if (std::tolower(static_cast<unsigned char>(reader_.words()[word][i])) != keyword[i])
                return false;
        return true;
    }

    Error unexpected(const std::string& expected) const {
        return error("expected " + expected + ", found " + quotedWord(reader_.words()[0]) + " and " +
                     std::to_string(reader_.words().size() - 1) + " more words; export the mesh again");
    }

    Status readFacet() {
        // The normal is not used, and some programs write nan for it: only its place is checked.
        if (!is(0, "facet") || !is(1, "normal") || reader_.words().size() != 5)
            return unexpected("facet normal X Y Z or endsolid");
        SEROSA_TRY(next("outer loop"));
        if (!is(0, "outer") || !is(1, "loop") || reader_.words().size() != 2)
            return unexpected("outer loop");
        for (int corner = 0; corner < 3; ++corner) {
            SEROSA_TRY(next("vertex X Y Z"));
            if (!is(0, "vertex") || reader_.words().size() != 4)
                return unexpected("vertex X Y Z");
            glm::dvec3 position;
            std::string why;
            for (int axis = 0; axis < 3; ++axis) {
                const auto value = parseNumber(reader_.words()[static_cast<std::size_t>(axis + 1)], why);
                if (!value)
                    return error(why);
                position[axis] = *value;
            }
            merger_.add(position);
        }
        SEROSA_TRY(next("endloop"));
        if (!is(0, "endloop") && !(is(0, "end") && is(1, "loop")))
            return unexpected("endloop (a facet is a triangle)");
        SEROSA_TRY(next("endfacet"));
        if (!is(0, "endfacet") && !(is(0, "end") && is(1, "facet")))
            return unexpected("endfacet");
        return {};
    }

    const MeshSource& source_;
    LineReader reader_;
    CornerMerger merger_;
};

} // namespace

bool isBinaryStl(std::string_view bytes) {
    if (bytes.size() >= kHeaderBytes &&
        kHeaderBytes + std::size_t(littleEndian32(bytes, 80)) * kFacetBytes == bytes.size())
        return true;
    const std::string_view head = bytes.substr(0, 512);
    return head.find('\0') != std::string_view::npos;
}

Result<TriangleMesh> readStl(const MeshSource& source) {
    return isBinaryStl(source.bytes) ? readBinary(source) : TextReader(source).read();
}

} // namespace serosa::sim::detail
