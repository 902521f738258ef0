// Stanford PLY, text and both binary byte orders. The vertex element needs x y z, the face element a list
// vertex_indices (or vertex_index); uchar red green blue are colours, u v, s t or texture_u texture_v texture
// coordinates; all other properties and elements are passed over, but must be complete. Counts are compared
// with the bytes that are left before anything is allocated.
#include "sim/mesh_reader_ply.h"

#include "sim/mesh_reader_detail.h"

#include <array>
#include <cmath>

namespace serosa::sim::detail {
namespace {

/// Takes the values of one body, one after another, and knows where it stands.
class PlyBody {
public:
    PlyBody(const MeshSource& source, const PlyHeader& header)
        : source_(source), encoding_(header.encoding), text_(source, header.bodyOffset, header.bodyLine),
          offset_(header.bodyOffset) {}

    Error error(const std::string& what) const {
        return encoding_ == PlyEncoding::text ? source_.atLine(text_.line(), what)
                                              : source_.atByte(at_, what);
    }

    std::size_t bytesLeft() const {
        return encoding_ == PlyEncoding::text ? text_.bytesLeft() : source_.bytes.size() - offset_;
    }

    /// Text: each row is a line.
    Status beginRow(const PlyElement& element, std::size_t row) {
        element_ = &element;
        row_ = row;
        word_ = 0;
        at_ = offset_;
        if (encoding_ == PlyEncoding::text && !text_.nextWithWords())
            return error("the file ends after " + std::to_string(row) + " of " +
                         std::to_string(element.count) + " " + element.name +
                         " rows; it is cut off, export it again");
        return {};
    }

    Status endRow() const {
        if (encoding_ == PlyEncoding::text && word_ != text_.words().size())
            return error(where() + " has " + std::to_string(text_.words().size()) + " values where " +
                         std::to_string(word_) + " are announced; export the mesh again");
        return {};
    }

    /// A coordinate, of any type.
    Result<double> coordinate(PlyType type) {
        if (encoding_ == PlyEncoding::text) {
            SEROSA_ASSIGN(const std::string_view word, nextWord());
            std::string why;
            const auto value = parseNumber(word, why);
            return value ? Result<double>(*value) : error(why);
        }
        SEROSA_ASSIGN(const std::uint64_t bits, nextBits(type));
        const double value = plyValue(type, bits);
        if (!std::isfinite(value))
            return error(where() + " has a coordinate that is " +
                         (std::isnan(value) ? "not a number" : "infinite") +
                         "; repair the mesh where it was made");
        return value;
    }

    /// A list's length, a corner or a colour.
    Result<std::int64_t> integer(PlyType type) {
        if (encoding_ == PlyEncoding::text) {
            SEROSA_ASSIGN(const std::string_view word, nextWord());
            std::string why;
            const auto [lowest, highest] = plyRange(type);
            const auto value = parseInteger(word, lowest, highest, why);
            return value ? Result<std::int64_t>(*value) : error(why);
        }
        SEROSA_ASSIGN(const std::uint64_t bits, nextBits(type));
        return static_cast<std::int64_t>(plyValue(type, bits));
    }

    /// A list's length, checked against what is left of the file.
    Result<std::size_t> length(const PlyProperty& property) {
        SEROSA_ASSIGN(const std::int64_t length, integer(property.lengthType));
        const std::size_t left = encoding_ == PlyEncoding::text ? text_.words().size() - word_
                                                                : bytesLeft() / plySize(property.type);
        if (length < 0 || static_cast<std::uint64_t>(length) > left)
            return error(where() + ": the list " + property.name + " announces " + std::to_string(length) +
                         " values, " + std::to_string(left) +
                         " at most are left; the file may be cut off here, export it again");
        return static_cast<std::size_t>(length);
    }

    /// Words or bytes that nobody needs.
    Status skip(const PlyProperty& property) {
        std::size_t values = 1;
        if (property.isList) {
            SEROSA_ASSIGN(values, length(property));
        }
        if (encoding_ != PlyEncoding::text) {
            at_ = offset_;
            const std::size_t bytes = values * plySize(property.type);
            if (bytes > bytesLeft())
                return endsWithin();
            offset_ += bytes;
            return {};
        }
        for (std::size_t i = 0; i < values; ++i)
            SEROSA_TRY(nextWord());
        return {};
    }

    std::string where() const { return element_->name + " " + std::to_string(row_); }

    Status expectEnd() {
        at_ = offset_;
        if (encoding_ == PlyEncoding::text ? text_.nextWithWords() : bytesLeft() > 0)
            return error(
                "data after the last row that the header announces; correct its counts or remove the rest");
        return {};
    }

private:
    Error endsWithin() const {
        return error("the file ends within " + where() + " of " + std::to_string(element_->count) +
                     "; it is cut off, export it again");
    }

    Result<std::string_view> nextWord() {
        if (word_ >= text_.words().size())
            return error(where() + " has only " + std::to_string(word_) +
                         " values; the file may be cut off here, export it again");
        return text_.words()[word_++];
    }

    Result<std::uint64_t> nextBits(PlyType type) {
        const std::size_t size = plySize(type);
        at_ = offset_;
        if (size > bytesLeft())
            return endsWithin();
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t place = encoding_ == PlyEncoding::littleEndian ? i : size - 1 - i;
            bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(source_.bytes[offset_ + i]))
                    << (8 * place);
        }
        offset_ += size;
        return bits;
    }

    const MeshSource& source_;
    PlyEncoding encoding_;
    LineReader text_;
    std::size_t offset_;       // first byte not yet taken
    std::size_t at_ = offset_; // first byte of the value that was last begun
    std::size_t word_ = 0, row_ = 0;
    const PlyElement* element_ = nullptr;
};

class PlyReader {
public:
    PlyReader(const MeshSource& source, const PlyHeader& header) : header_(header), body_(source, header) {}

    Result<TriangleMesh> read() {
        mesh_.positions.reserve(header_.vertices().count);
        if (header_.coloured)
            mesh_.colours.reserve(header_.vertices().count);
        for (const auto& element : header_.elements)
            for (std::size_t row = 0; row < element.count; ++row) {
                SEROSA_TRY(body_.beginRow(element, row));
                SEROSA_TRY(readRow(element));
                SEROSA_TRY(body_.endRow());
            }
        SEROSA_TRY(body_.expectEnd());
        if (mesh_.faces.empty())
            return body_.error("no faces; export a surface, not points");
        if (header_.textured)
            for (const glm::uvec3& face : mesh_.faces)
                for (int i = 0; i < 3; ++i)
                    mesh_.uvs.push_back(uvs_[face[i]]);
        return std::move(mesh_);
    }

private:
    Status readRow(const PlyElement& element) {
        glm::dvec3 position(0);
        glm::u8vec3 colour(0);
        glm::vec2 uv(0);
        for (const auto& property : element.properties) {
            switch (property.role) {
            case PlyRole::x:
            case PlyRole::y:
            case PlyRole::z: {
                SEROSA_ASSIGN(const double value, body_.coordinate(property.type));
                position[static_cast<int>(property.role) - static_cast<int>(PlyRole::x)] = value;
                break;
            }
            case PlyRole::red:
            case PlyRole::green:
            case PlyRole::blue: {
                SEROSA_ASSIGN(const std::int64_t value, body_.integer(property.type));
                colour[static_cast<int>(property.role) - static_cast<int>(PlyRole::red)] =
                    static_cast<std::uint8_t>(value);
                break;
            }
            case PlyRole::u:
            case PlyRole::v: {
                SEROSA_ASSIGN(const double value, body_.coordinate(property.type));
                uv[property.role == PlyRole::v ? 1 : 0] = float(value);
                break;
            }
            case PlyRole::corners:
                SEROSA_TRY(readCorners(property));
                break;
            case PlyRole::other:
                SEROSA_TRY(body_.skip(property));
                break;
            }
        }
        if (&element == &header_.vertices()) {
            mesh_.positions.push_back(position);
            if (header_.coloured)
                mesh_.colours.push_back(colour);
            if (header_.textured)
                uvs_.push_back(uv);
        }
        return {};
    }

    Status readCorners(const PlyProperty& property) {
        SEROSA_ASSIGN(const std::size_t count, body_.length(property));
        if (count < 3)
            return body_.error(body_.where() + " has " + std::to_string(count) +
                               " corners; remove points and lines, a face has three or more");
        corners_.clear();
        for (std::size_t i = 0; i < count; ++i) {
            SEROSA_ASSIGN(const std::int64_t corner, body_.integer(property.type));
            if (corner < 0 || static_cast<std::size_t>(corner) >= header_.vertices().count)
                return body_.error(body_.where() + " names vertex " + std::to_string(corner) +
                                   ", but they are counted from 0 to " +
                                   std::to_string(header_.vertices().count - 1) + "; export the mesh again");
            corners_.push_back(static_cast<std::uint32_t>(corner));
        }
        appendFan(corners_, mesh_.faces);
        return {};
    }

    const PlyHeader& header_;
    PlyBody body_;
    TriangleMesh mesh_;
    std::vector<glm::vec2> uvs_; // one a vertex
    std::vector<std::uint32_t> corners_;
};

} // namespace

Result<TriangleMesh> readPly(const MeshSource& source) {
    SEROSA_ASSIGN(const PlyHeader header, readPlyHeader(source));
    return PlyReader(source, header).read();
}

} // namespace serosa::sim::detail
