// See atomic_file.h. POSIX calls rather than streams, because only they tell a full disk at fsync and close.
#include "base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

namespace serosa {
namespace {

Error failed(const std::filesystem::path& file, const std::string& what, int code) {
    std::string hint;
    switch (code) {
    case ENOENT:
        hint = "make the folder first";
        break;
    case ENOTDIR:
        hint = "a part of the path is a file, not a folder";
        break;
    case EACCES:
    case EPERM:
    case EROFS:
        hint = "choose a folder that may be written";
        break;
    case ENOSPC:
    case EDQUOT:
        hint = "free some space or choose another disk";
        break;
    case EFBIG:
        hint = "the limit on file sizes is below it";
        break;
    default:
        hint = "nothing was written under this name";
        break;
    }
    return {file.string() + ": " + what + ": " + std::generic_category().message(code) + "; " + hint};
}

bool writeAll(int descriptor, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return false;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
}

/// A rename survives a power cut once its folder is flushed. The file is complete already, so a refusal is no
/// error.
void flushFolder(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0)
        return;
    (void)::fsync(descriptor);
    ::close(descriptor);
}

} // namespace

Status writeFileAtomically(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    // A link's target is replaced, not the link; a folder, a device or a pipe is no place for a rename.
    std::error_code ignored;
    std::filesystem::path target = file;
    if (std::filesystem::is_symlink(file, ignored)) {
        target = std::filesystem::weakly_canonical(file, ignored);
        if (ignored)
            return failed(file, "cannot follow the link", ignored.value());
    }
    struct stat info {};
    if (!target.has_filename())
        return Error{file.string() + ": a file name is missing at the end of the path; add one"};
    if (::stat(target.c_str(), &info) == 0 && !S_ISREG(info.st_mode))
        return Error{file.string() + ": cannot be written: it is " +
                     (S_ISDIR(info.st_mode) ? "a folder" : "not a regular file") + "; give a file name"};

    const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
    static std::atomic<unsigned> counter{0};
    std::filesystem::path temporary;
    int descriptor = -1;
    do { // a name left by a killed process with our id is passed over
        temporary =
            folder / (".serosa-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp");
        descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor < 0 && (errno == EEXIST || errno == EINTR));
    if (descriptor < 0)
        return failed(file, "cannot be created", errno);

    int code = 0;
    if (!writeAll(descriptor, bytes) || ::fsync(descriptor) != 0)
        code = errno;
    if (::close(descriptor) != 0 && code == 0)
        code = errno;
    if (code == 0 && ::rename(temporary.c_str(), target.c_str()) != 0)
        code = errno;
    if (code != 0) {
        ::unlink(temporary.c_str());
        return failed(file, "cannot be written", code);
    }
    flushFolder(folder);
    return {};
}

Status writeFileAtomically(const std::filesystem::path& file, std::string_view text) {
    return writeFileAtomically(file, std::as_bytes(std::span(text.data(), text.size())));
}

} // namespace serosa
