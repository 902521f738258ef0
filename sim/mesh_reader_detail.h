#pragma once
// What the mesh readers share: errors that name line or byte, strict numbers, and lines cut into words.
// Not for use outside of sim/mesh_reader*.cpp.

#include "base/result.h"
#include "sim/triangle_mesh.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace serosa::sim::detail {

/// A file's name, for messages, and its whole content.
struct MeshSource {
    std::string name;
    std::string_view bytes;

    Error atLine(std::size_t line, const std::string& text) const;
    Error atByte(std::size_t offset, const std::string& text) const;
};

/// Cuts the bytes into lines (ended by \n or \r\n), counted from 1, and lines into words (parted by blanks
/// and tabs).
class LineReader {
public:
    /// `line` is the number of the first line of bytes from `offset` on.
    explicit LineReader(const MeshSource& source, std::size_t offset = 0, std::size_t line = 1)
        : bytes_(source.bytes), offset_(offset), line_(line - 1) {}

    /// Steps to the next line; false at the end. Text after '#' is dropped.
    bool next();
    /// The same, over lines without a word.
    bool nextWithWords();
    /// Appends the words of the next line to those of the current one (OBJ's trailing backslash).
    bool appendNext();

    const std::vector<std::string_view>& words() const { return words_; }
    std::size_t line() const { return line_; }     // of the last line, from 1
    std::size_t offset() const { return offset_; } // of the first byte not yet read
    std::size_t bytesLeft() const { return bytes_.size() - offset_; }

private:
    bool cut();

    std::string_view bytes_;
    std::size_t offset_, line_;
    std::vector<std::string_view> words_;
};

/// A word as it stands in a message: quoted, at most 24 characters, unprintable ones as dots.
std::string quotedWord(std::string_view word);

/// A finite number. Empty if it is none; then `why` says so, with a hint ("'1,5' has a decimal comma;
/// write 1.5").
std::optional<double> parseNumber(std::string_view word, std::string& why);
/// A whole number in [lowest, highest]; the same.
std::optional<std::int64_t> parseInteger(std::string_view word, std::int64_t lowest, std::int64_t highest,
                                         std::string& why);

/// Splits a polygon with corners[0..n) into n - 2 triangles around its first corner.
void appendFan(const std::vector<std::uint32_t>& corners, std::vector<glm::uvec3>& faces);

/// Largest vertex or triangle count: indices are 32 bits, one of which means "none".
constexpr std::int64_t kMaxCount = 0xfffffffe;

Result<TriangleMesh> readObj(const MeshSource& source);
Result<TriangleMesh> readOff(const MeshSource& source);
Result<TriangleMesh> readPly(const MeshSource& source);
Result<TriangleMesh> readStl(const MeshSource& source);
Result<TriangleMesh> readVtk(const MeshSource& source);
/// The two files of one surface.
Result<TriangleMesh> readTetgen(const MeshSource& nodes, const MeshSource& faces);

/// True if an STL file of these bytes is a binary one: its size fits its triangle count, or it does not read
/// as text.
bool isBinaryStl(std::string_view bytes);

} // namespace serosa::sim::detail
