// Legacy VTK files, versions 1 to 5, of DATASET POLYDATA: points, polygons and triangle strips; text, or
// binary with big-endian numbers. Reading ends at POINT_DATA or CELL_DATA, whose values are passed over.
// Lines and single points are refused: a surface is wanted.
#include "sim/mesh_reader_detail.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>

namespace serosa::sim::detail {
namespace {

constexpr std::string_view kMagic = "# vtk DataFile Version ";

bool blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

std::string lowered(std::string_view word) {
    std::string text(word);
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// Bytes of an integer or floating type by its VTK name; 0: unknown. vtkIdType is 32 bits wide in files.
std::size_t sizeOfType(const std::string& type) {
    if (type == "float" || type == "int" || type == "unsigned_int" || type == "vtkidtype")
        return 4;
    return type == "double" || type == "vtktypeint64" ? 8 : 0;
}

/// Words of the text parts, and numbers in the file's encoding.
class VtkCursor {
public:
    explicit VtkCursor(const MeshSource& source) : source_(&source) {}

    Error error(const std::string& text) const {
        return binary_ ? source_->atByte(wordOffset_, text) : source_->atLine(wordLine_, text);
    }
    void setBinary() { binary_ = true; }
    bool binary() const { return binary_; }
    std::size_t bytesLeft() const { return source_->bytes.size() - offset_; }

    /// The rest of the line, without its end; false at the end of the file.
    bool line(std::string_view& text) {
        mark();
        if (offset_ >= source_->bytes.size())
            return false;
        const std::size_t end = std::min(source_->bytes.find('\n', offset_), source_->bytes.size());
        text = source_->bytes.substr(offset_, end - offset_);
        if (text.ends_with('\r'))
            text.remove_suffix(1);
        offset_ = std::min(end + 1, source_->bytes.size());
        ++line_;
        return true;
    }

    /// The next word; empty at the end of the file.
    std::string_view word() {
        while (offset_ < source_->bytes.size() && blank(source_->bytes[offset_])) {
            line_ += source_->bytes[offset_] == '\n';
            ++offset_;
        }
        mark();
        const std::size_t begin = offset_;
        while (offset_ < source_->bytes.size() && !blank(source_->bytes[offset_]))
            ++offset_;
        return source_->bytes.substr(begin, offset_ - begin);
    }

    Result<std::size_t> count(const char* what) {
        std::string why;
        const std::string_view text = word();
        if (text.empty())
            return error(std::string("the file ends before the number of ") + what +
                         "; it is cut off, export it again");
        const auto value = parseInteger(text, 0, kMaxCount, why);
        if (!value)
            return error(why);
        return static_cast<std::size_t>(*value);
    }

    /// Before the first of `values` numbers of a type: a line end in binary files, and room for them.
    Status begin(std::size_t values, const std::string& type, const std::string& what) {
        type_ = type;
        size_ = sizeOfType(type);
        if (binary_ && size_ == 0)
            return error(what + " of type " + quotedWord(type) +
                         " are not read from binary files; export them as float and int, or as text");
        if (binary_) {
            std::string_view rest;
            if (line(rest); std::any_of(rest.begin(), rest.end(), [](char c) { return !blank(c); }))
                return error("text before the binary " + what + "; export the mesh again");
        }
        // The shortest number in text is a digit and a blank; the last may lack the blank.
        const std::size_t needed = binary_ ? values * size_ : values * 2;
        if (needed > bytesLeft() + (binary_ ? 0 : 1))
            return error("the header announces " + std::to_string(values) + " numbers of " + what +
                         ", more than the " + std::to_string(bytesLeft()) +
                         " bytes that follow can hold; the file is cut off or its header wrong, export it "
                         "again");
        return {};
    }

    Result<double> number(const char* what) {
        if (!binary_) {
            std::string why;
            const std::string_view text = word();
            if (text.empty())
                return ended(what);
            const auto value = parseNumber(text, why);
            if (!value)
                return error(why);
            return *value;
        }
        const std::uint64_t bits = big();
        const double value = type_ == "float" ? double(std::bit_cast<float>(static_cast<std::uint32_t>(bits)))
                             : type_ == "double" ? std::bit_cast<double>(bits)
                                                 : double(whole(bits));
        if (!std::isfinite(value))
            return error("a coordinate is not a finite number; repair the mesh where it was made");
        return value;
    }

    Result<std::int64_t> integer(const char* what) {
        if (!binary_) {
            std::string why;
            const std::string_view text = word();
            if (text.empty())
                return ended(what);
            const auto value = parseInteger(text, -kMaxCount, kMaxCount, why);
            if (!value)
                return error(why);
            return *value;
        }
        return whole(big());
    }

private:
    void mark() {
        wordOffset_ = offset_;
        wordLine_ = line_;
    }
    Error ended(const char* what) const {
        return error(std::string("the file ends within ") + what + "; it is cut off, export it again");
    }
    /// `begin` has seen that they are there.
    std::uint64_t big() {
        mark();
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < size_; ++i)
            bits = bits << 8 | static_cast<unsigned char>(source_->bytes[offset_++]);
        return bits;
    }
    std::int64_t whole(std::uint64_t bits) const {
        if (size_ == 8)
            return static_cast<std::int64_t>(bits);
        return type_ == "unsigned_int" ? std::int64_t(bits) : std::int64_t(static_cast<std::int32_t>(bits));
    }

    const MeshSource* source_; // not null; a cursor is copied to look ahead
    bool binary_ = false;
    std::size_t offset_ = 0, line_ = 1, wordOffset_ = 0, wordLine_ = 1;
    std::string type_;
    std::size_t size_ = 0;
};

class VtkReader {
public:
    explicit VtkReader(const MeshSource& source) : in_(source) {}

    Result<TriangleMesh> read() {
        SEROSA_TRY(readHeader());
        for (bool more = true; more;) {
            const std::string_view word = in_.word();
            const std::string section = lowered(word);
            if (section.empty() || section == "point_data" || section == "cell_data")
                more = false;
            else if (section == "points")
                SEROSA_TRY(readPoints());
            else if (section == "polygons" || section == "triangle_strips")
                SEROSA_TRY(readCells(section == "polygons"));
            else if (section == "metadata")
                skipMetadata();
            else if (section == "lines" || section == "vertices")
                SEROSA_TRY(refuseCells(section));
            else
                return in_.error("unknown section " + quotedWord(word) +
                                 " (POINTS, POLYGONS, TRIANGLE_STRIPS, POINT_DATA, CELL_DATA); export the "
                                 "surface alone as POLYDATA");
        }
        if (mesh_.positions.empty())
            return in_.error("no POINTS; export the mesh again");
        if (mesh_.faces.empty())
            return in_.error("no POLYGONS; export a surface, not points");
        return std::move(mesh_);
    }

private:
    Status readHeader() {
        std::string_view text;
        std::string why;
        if (!in_.line(text) || !text.starts_with(kMagic))
            return in_.error("wrong magic: a legacy VTK file starts with " + quotedWord(kMagic) +
                             ", this one with " + quotedWord(text) + "; export it as legacy VTK");
        const auto version = parseNumber(text.substr(kMagic.size()), why);
        if (!version || !(*version >= 1 && *version < 6))
            return in_.error("version " + quotedWord(text.substr(kMagic.size())) +
                             " of legacy VTK is not known (1 to 5 are); export an older one");
        if (!in_.line(text))
            return in_.error("the file ends before its title; it is cut off, export it again");
        const std::string_view encoding = in_.word();
        if (lowered(encoding) == "binary")
            in_.setBinary();
        else if (lowered(encoding) != "ascii")
            return in_.error(quotedWord(encoding) +
                             " where ASCII or BINARY should stand; export the mesh again");
        const std::string_view dataset = in_.word();
        if (lowered(dataset) != "dataset")
            return in_.error(quotedWord(dataset) + " where DATASET should stand; export the mesh again");
        const std::string_view kind = in_.word();
        if (lowered(kind) != "polydata")
            return in_.error("the dataset is " + quotedWord(kind) +
                             ", not POLYDATA; extract its surface and save that");
        return {};
    }

    Status readPoints() {
        if (!mesh_.positions.empty())
            return in_.error("a second POINTS; keep one surface a file");
        SEROSA_ASSIGN(const std::size_t count, in_.count("points"));
        const std::string type = lowered(in_.word());
        if (type.empty())
            return in_.error("the type of the points is missing; export the mesh again");
        if (count == 0)
            return in_.error("the file announces no points; export the mesh again");
        SEROSA_TRY(in_.begin(3 * count, type, "points"));
        mesh_.positions.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            glm::dvec3 position;
            for (int axis = 0; axis < 3; ++axis) {
                SEROSA_ASSIGN(position[axis], in_.number("the points"));
            }
            mesh_.positions.push_back(position);
        }
        return {};
    }

    /// An INFORMATION block, text in both encodings, that ends at an empty line.
    void skipMetadata() {
        std::string_view text;
        in_.line(text);
        while (in_.line(text) && !text.empty())
            ;
    }

    Status refuseCells(const std::string& section) {
        SEROSA_ASSIGN(const std::size_t count, in_.count(section.c_str()));
        if (count > 0)
            return in_.error("the file holds " + section +
                             "; export the surface alone, a face has three corners or more");
        SEROSA_TRY(in_.count(section.c_str()));
        return {};
    }

    Status readCells(bool polygons) {
        SEROSA_ASSIGN(const std::size_t first, in_.count("cells"));
        SEROSA_ASSIGN(const std::size_t second, in_.count("numbers of the cells"));
        const VtkCursor before = in_;
        if (first > 0 && lowered(in_.word()) == "offsets")
            return readOffsetCells(first, second, polygons);
        in_ = before;
        SEROSA_TRY(in_.begin(second, "int", "polygons"));
        std::size_t used = 0;
        for (std::size_t i = 0; i < first; ++i) {
            if (used >= second)
                return in_.error("face " + std::to_string(i) + " lies beyond the " + std::to_string(second) +
                                 " numbers that were announced; export the mesh again");
            SEROSA_ASSIGN(const std::int64_t corners, in_.integer("the polygons"));
            if (corners < 0 || std::size_t(corners) > second - used - 1)
                return in_.error("face " + std::to_string(i) + " announces " + std::to_string(corners) +
                                 " corners, " + std::to_string(second - used - 1) +
                                 " numbers at most are left; export the mesh again");
            used += std::size_t(corners) + 1;
            SEROSA_TRY(readCell(i, std::size_t(corners), polygons));
        }
        if (used != second)
            return in_.error("the faces take " + std::to_string(used) + " numbers, " +
                             std::to_string(second) + " were announced; export the mesh again");
        return {};
    }

    /// Version 5: where each cell begins among the corners of all, and where the last one ends.
    Status readOffsetCells(std::size_t offsetCount, std::size_t cornerCount, bool polygons) {
        const std::string offsetType = lowered(in_.word());
        SEROSA_TRY(in_.begin(offsetCount, offsetType, "offsets"));
        std::vector<std::int64_t> offsets;
        for (std::size_t i = 0; i < offsetCount; ++i) {
            SEROSA_ASSIGN(const std::int64_t offset, in_.integer("the offsets"));
            if (i == 0 ? offset != 0 : offset < offsets.back())
                return in_.error("offset " + std::to_string(i) + " is " + std::to_string(offset) +
                                 ": they start at 0 and never fall; export the mesh again");
            offsets.push_back(offset);
        }
        if (offsets.back() != std::int64_t(cornerCount))
            return in_.error("the last offset is " + std::to_string(offsets.back()) + ", but " +
                             std::to_string(cornerCount) + " corners were announced; export the mesh again");
        const std::string_view word = in_.word();
        if (lowered(word) != "connectivity")
            return in_.error(quotedWord(word) + " where CONNECTIVITY should stand; export the mesh again");
        const std::string cornerType = lowered(in_.word());
        SEROSA_TRY(in_.begin(cornerCount, cornerType, "corners"));
        for (std::size_t i = 0; i + 1 < offsets.size(); ++i)
            SEROSA_TRY(readCell(i, std::size_t(offsets[i + 1] - offsets[i]), polygons));
        return {};
    }

    Status readCell(std::size_t index, std::size_t corners, bool polygon) {
        if (corners < 3)
            return in_.error("face " + std::to_string(index) + " has " + std::to_string(corners) +
                             " corners; remove points and lines, a face has three or more");
        corners_.clear();
        for (std::size_t i = 0; i < corners; ++i) {
            SEROSA_ASSIGN(const std::int64_t corner, in_.integer("the polygons"));
            if (corner < 0 || std::size_t(corner) >= mesh_.positions.size())
                return in_.error(
                    "face " + std::to_string(index) + " names point " + std::to_string(corner) + ", but " +
                    (mesh_.positions.empty()
                         ? "no POINTS stand before it"
                         : "they are counted from 0 to " + std::to_string(mesh_.positions.size() - 1)) +
                    "; export the mesh again");
            corners_.push_back(static_cast<std::uint32_t>(corner));
        }
        if (polygon)
            appendFan(corners_, mesh_.faces);
        else
            for (std::size_t i = 2; i < corners_.size(); ++i) // every other triangle of a strip winds back
                mesh_.faces.push_back(
                    {corners_[i - 2], corners_[i % 2 == 0 ? i - 1 : i], corners_[i % 2 == 0 ? i : i - 1]});
        return {};
    }

    VtkCursor in_;
    TriangleMesh mesh_;
    std::vector<std::uint32_t> corners_;
};

} // namespace

Result<TriangleMesh> readVtk(const MeshSource& source) {
    return VtkReader(source).read();
}

} // namespace serosa::sim::detail
