// Reads the file as a whole, tells its format, and hands it to the reader of that format.
#include "sim/mesh_reader.h"

#include "sim/mesh_reader_detail.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <new>
#include <system_error>

namespace serosa::sim {
namespace {

constexpr std::uintmax_t kMaxBytes = std::uintmax_t(8)
                                     << 30; // so that 32 bits count its vertices and triangles

enum class Format { obj, off, ply, stl, vtk, tetgen, unknown };

const char* nameOf(Format format) {
    switch (format) {
    case Format::obj:
        return "OBJ";
    case Format::off:
        return "OFF";
    case Format::ply:
        return "PLY";
    case Format::stl:
        return "STL";
    case Format::vtk:
        return "VTK";
    case Format::tetgen:
        return "TetGen";
    case Format::unknown:
        break;
    }
    return "unknown";
}

Format formatOfName(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".obj")
        return Format::obj;
    if (extension == ".off")
        return Format::off;
    if (extension == ".ply")
        return Format::ply;
    if (extension == ".stl")
        return Format::stl;
    if (extension == ".vtk")
        return Format::vtk;
    return extension == ".node" || extension == ".face" ? Format::tetgen : Format::unknown;
}

bool startsWithWord(std::string_view bytes, std::string_view word) {
    return bytes.starts_with(word) && bytes.size() > word.size() &&
           std::isspace(static_cast<unsigned char>(bytes[word.size()]));
}

/// OBJ, binary STL and TetGen's files have no magic.
Format formatOfContent(std::string_view bytes) {
    if (startsWithWord(bytes, "ply"))
        return Format::ply;
    if (bytes.starts_with("# vtk DataFile"))
        return Format::vtk;
    for (const char* magic : {"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF"})
        if (startsWithWord(bytes, magic))
            return Format::off;
    return startsWithWord(bytes, "solid") ? Format::stl : Format::unknown;
}

std::string firstBytes(std::string_view bytes) {
    return detail::quotedWord(bytes.substr(0, bytes.find('\n')));
}

Result<std::string> readWhole(const std::filesystem::path& file) {
    const std::string name = file.string();
    std::error_code code;
    const auto status = std::filesystem::status(file, code);
    if (status.type() == std::filesystem::file_type::not_found)
        return Error{name + ": no such file; check the path"};
    if (code)
        return Error{name + ": cannot be opened: " + code.message() + "; check the path"};
    if (std::filesystem::is_directory(status))
        return Error{name + ": is a folder, not a mesh; name a file in it"};
    if (!std::filesystem::is_regular_file(status))
        return Error{name + ": is not a regular file; copy the mesh to one first"};
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        return Error{name + ": cannot be opened for reading; check its permissions"};
    const auto size = std::filesystem::file_size(file, code);
    if (code)
        return Error{name + ": cannot be measured: " + code.message() + "; copy it to a local disk"};
    if (size == 0)
        return Error{name + ": the file is empty (0 bytes); export the mesh again"};
    if (size > kMaxBytes)
        return Error{name + ": is larger than 8 GiB; decimate the mesh first"};
    std::string bytes(static_cast<std::size_t>(size), '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(stream.gcount()) != size)
        return Error{name + ": byte " + std::to_string(stream.gcount()) +
                     ": reading stopped here; check the disk and copy the file again"};
    return bytes;
}

/// `source` is the content of one of the two files; the other one is read here.
Result<TriangleMesh> parseTetgen(const std::filesystem::path& file, const detail::MeshSource& source) {
    std::string extension = file.extension().string();
    const bool isNode = std::tolower(static_cast<unsigned char>(extension[1])) == 'n';
    std::filesystem::path partner = file;
    partner.replace_extension(isNode ? ".face" : ".node");
    std::error_code code;
    if (!std::filesystem::exists(partner, code))
        return Error{source.name + ": " + partner.filename().string() +
                     " is not beside it; a TetGen surface is a .node and a .face file of one name (write the "
                     "latter with tetgen -f)"};
    SEROSA_ASSIGN(const std::string bytes, readWhole(partner));
    const detail::MeshSource other{partner.string(), bytes};
    return isNode ? detail::readTetgen(source, other) : detail::readTetgen(other, source);
}

Result<TriangleMesh> parse(const std::filesystem::path& file, const std::string& bytes) {
    const detail::MeshSource source{file.string(), bytes};
    if (bytes.starts_with("\xef\xbb\xbf"))
        return source.atByte(0, "starts with a byte order mark; save it as plain ASCII or UTF-8 without one");
    const Format named = formatOfName(file), found = formatOfContent(bytes);
    if (named != Format::unknown && found != Format::unknown && named != found)
        return source.atByte(0, std::string("the content is ") + nameOf(found) + ", the name says " +
                                    nameOf(named) + "; rename the file");
    switch (named != Format::unknown ? named : found) {
    case Format::obj:
        return detail::readObj(source);
    case Format::off:
        if (found != Format::off)
            return source.atByte(0, "wrong magic: an OFF file starts with OFF, this one with " +
                                        firstBytes(bytes) +
                                        "; export it as OFF or give it the extension of its format");
        return detail::readOff(source);
    case Format::ply:
        if (found != Format::ply)
            return source.atByte(0, "wrong magic: a PLY file starts with ply, this one with " +
                                        firstBytes(bytes) +
                                        "; export it as PLY or give it the extension of its format");
        return detail::readPly(source);
    case Format::stl:
        if (found != Format::stl && !detail::isBinaryStl(bytes))
            return source.atByte(0, "wrong magic: a text STL starts with solid, this one with " +
                                        firstBytes(bytes) +
                                        "; export it as STL or give it the extension of its format");
        return detail::readStl(source);
    case Format::vtk:
        return detail::readVtk(source);
    case Format::tetgen:
        return parseTetgen(file, source);
    case Format::unknown:
        break;
    }
    return source.atByte(0, "neither the extension nor the first bytes, " + firstBytes(bytes) +
                                ", tell the format; use .obj, .ply, .off, .stl, .vtk, or .node and .face");
}

} // namespace

Result<TriangleMesh> readMesh(const std::filesystem::path& file) {
    try {
        SEROSA_ASSIGN(const std::string bytes, readWhole(file));
        return parse(file, bytes);
    } catch (const std::bad_alloc&) {
        return Error{file.string() + ": does not fit into memory; decimate the mesh first"};
    } catch (const std::length_error&) {
        return Error{file.string() + ": does not fit into memory; decimate the mesh first"};
    }
}

} // namespace serosa::sim
