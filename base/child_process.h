#pragma once
// A program of its own, run as a child with a time limit: what must not be linked, or may crash, or may never
// end. The child gets nothing on stdin; what it says goes to a file.

#include "base/result.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace serosa {

/// A new folder below the system's folder for temporary files that nobody else can read; removed, with all it
/// holds, when this dies.
class TemporaryFolder {
public:
    /// Errors: the system's temporary folder cannot be written to.
    static Result<TemporaryFolder> create();
    TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
    TemporaryFolder& operator=(TemporaryFolder&&) = delete;
    ~TemporaryFolder();
    const std::filesystem::path& path() const { return path_; }

private:
    explicit TemporaryFolder(std::filesystem::path path) : path_(std::move(path)) {}
    std::filesystem::path path_;
};

struct ChildCommand {
    std::string program; // a path, or a name that is looked for in PATH
    std::vector<std::string> arguments;
    std::filesystem::path folder; // where it runs; its stdout and stderr go to `folder`/output.txt
    double seconds = 60;          // it may take; then it is killed
};

/// Is there such a program in PATH?
bool programExists(const std::string& name);

/// Runs the child to its end. Errors, each in one line with the last line that the child said: it is not
/// there (exit code 2); it crashed, was killed because time ran out, or returned something but 0 (exit code
/// 3).
Status runChild(const ChildCommand& command);

} // namespace serosa
