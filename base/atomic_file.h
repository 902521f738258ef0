#pragma once
// Files appear complete or not at all: the bytes go to a temporary in the same folder, are flushed to the
// disk, and the temporary is renamed to the final name. On any error the temporary is removed and the final
// name is as it was before.

#include "base/result.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace serosa {

/// Writes `bytes` to `file`, replacing what was there only when all of them are on the disk.
/// Errors name the file and the cause: its folder is missing or is a file, it is a folder itself, no
/// permission, disk full.
Status writeFileAtomically(const std::filesystem::path& file, std::span<const std::byte> bytes);
Status writeFileAtomically(const std::filesystem::path& file, std::string_view text);

} // namespace serosa
