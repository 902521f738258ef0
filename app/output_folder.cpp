// See app/output_folder.h.

#include "app/output_folder.h"

#include <unistd.h>

namespace serosa::app {

namespace fs = std::filesystem;

namespace {

bool isResult(const std::string& name) {
    const auto framed = [&name](const char* prefix, const char* suffix) {
        return name.starts_with(prefix) && name.ends_with(suffix);
    };
    return framed("frame_", ".png") || framed("surface_", ".ply") || framed("snapshot_", ".serosa") ||
           framed("displacement_", ".ply") || framed("displacement_", ".nrrd") ||
           framed("displacement_", ".mha") || name == "contact_sheet.png" || name == "turntable.png" ||
           name == "summary.json" || name == "report.html";
}

fs::path parentOf(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

} // namespace

Result<OutputFolder> OutputFolder::check(const fs::path& folder, bool force) {
    OutputFolder out;
    out.folder_ = folder.has_filename() ? folder : folder.parent_path(); // "out/" is "out"
    if (out.folder_.empty())
        return Error{"the output folder has no name: give one with --out"};
    std::error_code code;
    const fs::file_status status = fs::status(out.folder_, code);
    const std::string name = out.folder_.string();
    if (fs::exists(status)) {
        if (!fs::is_directory(status))
            return Error{name + " is a file, not a folder: choose another with --out"};
        const bool empty = fs::is_empty(out.folder_, code);
        if (code)
            return Error{name + ": " + code.message()};
        if (!empty && !force)
            return Error{name + " holds something: choose another folder with --out, or replace the results "
                                "in it with --force"};
    } else if (status.type() == fs::file_type::none && code) {
        return Error{name + ": " + code.message() + ": choose another folder with --out"};
    }
    fs::path ancestor = out.folder_;
    while (!fs::exists(ancestor, code)) {
        out.madeFolders_.push_back(ancestor); // innermost first
        ancestor = parentOf(ancestor);
    }
    if (!fs::is_directory(ancestor, code))
        return Error{name + " lies below a file (" + ancestor.string() +
                     "): choose another folder with --out"};
    if (access(ancestor.c_str(), W_OK | X_OK) != 0)
        return Error{name + ": no permission to write in " + ancestor.string()};
    return out;
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : folder_(std::move(other.folder_)), madeFolders_(std::move(other.madeFolders_)),
      files_(std::move(other.files_)), kept_(std::exchange(other.kept_, true)) {}

OutputFolder::~OutputFolder() {
    if (kept_)
        return;
    std::error_code ignored;
    for (const fs::path& file : files_)
        fs::remove(file, ignored);
    for (const fs::path& folder : madeFolders_)
        fs::remove(folder, ignored); // only if empty
}

Status OutputFolder::create() {
    std::error_code code;
    fs::create_directories(folder_, code);
    if (code)
        return Error{folder_.string() + ": cannot be made: " + code.message()};
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_, code))
        if (entry.is_regular_file(code) && isResult(entry.path().filename().string()))
            fs::remove(entry.path(), code);
    if (code)
        return Error{folder_.string() + ": " + code.message()};
    return {};
}

fs::path OutputFolder::file(const std::string& name) {
    files_.push_back(folder_ / name);
    return files_.back();
}

Status checkTarget(const std::filesystem::path& file, const std::string& example, bool force) {
    std::error_code code;
    if (std::filesystem::is_directory(file, code))
        return Error{file.string() + " is a folder: name a file, such as " + example};
    if (!force && std::filesystem::exists(file, code))
        return Error{file.string() + " exists: choose another name with -o, or replace it with --force"};
    return {};
}

} // namespace serosa::app
