// Checksums: see sim/byte_stream.h.
#include "sim/byte_stream.h"

#include <xxhash.h>

#include <cstdio>

namespace serosa::sim {

Checksum checksumOf(std::string_view bytes) {
    const XXH128_hash_t digest = XXH3_128bits(bytes.data(), bytes.size());
    return {digest.low64, digest.high64};
}

std::string checksumText(const Checksum& checksum) {
    char text[40];
    std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(checksum.high),
                  static_cast<unsigned long long>(checksum.low));
    return text;
}

} // namespace serosa::sim
