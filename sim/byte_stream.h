#pragma once
// Bytes of a file in memory: little-endian values of stated sizes, one after another, and a reader that never
// goes beyond the end nor allocates more than what is left could fill.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace serosa::sim {

/// XXH3, 128 bits.
struct Checksum {
    std::uint64_t low = 0, high = 0;
    friend bool operator==(const Checksum&, const Checksum&) = default;
};
Checksum checksumOf(std::string_view bytes);
/// 32 hexadecimal digits, as xxhsum -H128 prints.
std::string checksumText(const Checksum& checksum);

class ByteWriter {
public:
    void u8(std::uint8_t value) { little(value, 1); }
    void u32(std::uint32_t value) { little(value, 4); }
    void u64(std::uint64_t value) { little(value, 8); }
    void i64(std::int64_t value) { little(std::uint64_t(value), 8); }
    void f32(float value) { u32(std::bit_cast<std::uint32_t>(value)); }
    void f64(double value) { u64(std::bit_cast<std::uint64_t>(value)); }
    /// Length (u32), then the bytes.
    void text(std::string_view value) {
        u32(std::uint32_t(value.size()));
        bytes_ += value;
    }
    void raw(std::string_view value) { bytes_ += value; }

    const std::string& bytes() const { return bytes_; }
    std::string take() { return std::move(bytes_); }

private:
    void little(std::uint64_t bits, int size) {
        for (int i = 0; i < size; ++i)
            bytes_ += static_cast<char>(bits >> (8 * i) & 0xff);
    }
    std::string bytes_;
};

/// Reads what a ByteWriter wrote. The first value that does not fit makes `failed()`: all values after it are
/// 0, and all counts 0.
class ByteReader {
public:
    ByteReader(std::string_view bytes, std::size_t at) : bytes_(bytes), at_(at) {}
    std::uint8_t u8() { return std::uint8_t(little(1)); }
    std::uint32_t u32() { return std::uint32_t(little(4)); }
    std::uint64_t u64() { return little(8); }
    std::int64_t i64() { return std::int64_t(little(8)); }
    float f32() { return std::bit_cast<float>(u32()); }
    double f64() { return std::bit_cast<double>(u64()); }
    std::string text() {
        const std::size_t length = count(u32(), 1);
        const std::string value(bytes_.substr(at_, length));
        at_ += length;
        return value;
    }
    /// `wanted` if so many values of `size` bytes are left, else 0 and failed().
    std::size_t count(std::uint64_t wanted, std::size_t size) {
        if (!failed_ && wanted <= (bytes_.size() - at_) / size)
            return std::size_t(wanted);
        failed_ = true;
        return 0;
    }

    bool failed() const { return failed_; }
    /// Offset of the next byte; of the first value that did not fit once failed().
    std::size_t at() const { return at_; }
    std::size_t left() const { return bytes_.size() - at_; }

private:
    std::uint64_t little(std::size_t size) {
        if (failed_ || size > left()) {
            failed_ = true;
            return 0;
        }
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < size; ++i)
            bits |= std::uint64_t(static_cast<unsigned char>(bytes_[at_ + i])) << (8 * i);
        at_ += size;
        return bits;
    }
    std::string_view bytes_;
    std::size_t at_;
    bool failed_ = false;
};

} // namespace serosa::sim
