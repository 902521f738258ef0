#pragma once
// The folder that a run writes into: refused if it holds something (without --force), made only when there is
// something to write, and taken back when the run fails, so that bad input leaves nothing behind.

#include "base/result.h"

#include <filesystem>
#include <vector>

namespace serosa::app {

class OutputFolder {
public:
    /// Checks `folder` and touches nothing. Errors: it holds something and `force` is not set, it is a file
    /// or lies below one, its nearest existing ancestor cannot be written to.
    static Result<OutputFolder> check(const std::filesystem::path& folder, bool force);

    OutputFolder(OutputFolder&& other) noexcept;
    OutputFolder& operator=(OutputFolder&&) = delete;
    /// Without keep(), removes every file that was named by file(), and the folders that create() made.
    ~OutputFolder();

    /// Makes the folder; with force, removes results of an earlier run from it (frame_*.png, surface_*.ply,
    /// snapshot_*.serosa, displacement_*, contact_sheet.png, summary.json, report.html) and leaves all else.
    Status create();
    /// Path of a file that is about to be written.
    std::filesystem::path file(const std::string& name);
    const std::filesystem::path& path() const { return folder_; }
    /// The run has succeeded: what was written stays.
    void keep() { kept_ = true; }

private:
    OutputFolder() = default;
    std::filesystem::path folder_;
    std::vector<std::filesystem::path> madeFolders_, files_;
    bool kept_ = false;
};

/// A file that a command is to write: not a folder, and not there already. \param example of a name
Status checkTarget(const std::filesystem::path& file, const std::string& example, bool force);

} // namespace serosa::app
