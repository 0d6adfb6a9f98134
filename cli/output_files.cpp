#include "cli/output_files.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "core/error.h"
#include "core/interrupt.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void throw_unwritable(const fs::path& place, const std::string& reason) {
    throw IoError(
        "output.unwritable", place.string(),
        "cannot write (" + reason + "); choose another place with -o, or make room there");
}

/// Temporary name beside `file`; the process id keeps concurrent runs apart.
fs::path temporary_beside(const fs::path& file) {
    return file.parent_path() /
           ("." + file.filename().string() + "." + std::to_string(::getpid()) + ".tmp");
}

/// Writes and closes; `place` is the name the user knows.
void write_plain(const fs::path& file, std::string_view bytes, const fs::path& place) {
    errno = 0;
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) {
        const std::string reason = errno != 0 ? std::strerror(errno) : "unknown reason";
        std::error_code ignored;
        if (fs::is_regular_file(file, ignored)) {
            fs::remove(file, ignored);
        }
        throw_unwritable(place, reason);
    }
}

/// Missing folders on the way to `folder`, outermost first.
std::vector<fs::path> missing_folders(fs::path folder) {
    std::vector<fs::path> missing;
    std::error_code ignored;
    while (!folder.empty() && !fs::exists(folder, ignored)) {
        missing.push_back(folder);
        folder = folder.parent_path();
    }
    std::reverse(missing.begin(), missing.end());
    return missing;
}

}  // namespace

void write_file(const fs::path& file, std::string_view bytes) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (fs::is_directory(status)) {
        throw_unwritable(file, "it is a folder");
    }
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        write_plain(file, bytes, file);
        return;
    }
    const fs::path target = fs::exists(status) ? fs::canonical(file, error) : file;
    if (error && fs::exists(status)) {
        throw_unwritable(file, error.message());
    }
    const fs::path temporary = temporary_beside(target);
    const Temporary registered(temporary);
    write_plain(temporary, bytes, file);
    fs::rename(temporary, target, error);
    if (error) {
        const std::string reason = error.message();
        fs::remove(temporary, error);
        throw_unwritable(file, reason);
    }
}

OutputFolder::OutputFolder(fs::path folder) : folder_(std::move(folder)) {
    if (!folder_.has_filename() && folder_.has_parent_path() && folder_ != folder_.root_path()) {
        folder_ = folder_.parent_path();  // "out/" and "out" are one folder
    }
    created_ = missing_folders(folder_);
    for (const fs::path& created : created_) {
        temporaries_.emplace_back(created);
    }
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error || !fs::is_directory(folder_, error)) {
        throw_unwritable(folder_, error ? error.message() : "a file of that name is in the way");
    }
    // Found out now, not after minutes of planning.
    const fs::path probe = temporary("probe");
    const Temporary registered(probe);
    write_plain(probe, {}, folder_);
    fs::remove(probe, error);
}

OutputFolder::~OutputFolder() {
    std::error_code ignored;
    for (const std::string& name : added_) {
        fs::remove(temporary(name), ignored);
    }
    for (auto folder = created_.rbegin(); folder != created_.rend(); ++folder) {
        fs::remove(*folder, ignored);  // only where it is empty
    }
}

fs::path OutputFolder::temporary(const std::string& name) const {
    return temporary_beside(folder_ / name);
}

void OutputFolder::add(const std::string& name, std::string_view bytes) {
    assert(fs::path(name).filename() == name);
    assert(std::find(added_.begin(), added_.end(), name) == added_.end());
    temporaries_.emplace_back(temporary(name));
    write_plain(temporary(name), bytes, folder_ / name);
    added_.push_back(name);
}

void OutputFolder::withdraw(const std::string& name) {
    assert(fs::path(name).filename() == name);
    withdrawn_.push_back(name);
}

void OutputFolder::publish() {
    check_interrupt();
    const Unbroken whole;
    std::error_code error;
    for (const std::string& name : added_) {
        if (fs::is_directory(folder_ / name, error)) {
            throw_unwritable(folder_ / name, "a folder of that name is in the way");
        }
    }
    for (const std::string& name : withdrawn_) {
        fs::remove(folder_ / name, error);
        if (error) {
            throw_unwritable(folder_ / name, error.message());
        }
    }
    for (const std::string& name : added_) {
        fs::rename(temporary(name), folder_ / name, error);
        if (error) {
            throw_unwritable(folder_ / name, error.message());
        }
    }
    added_.clear();
    withdrawn_.clear();
    created_.clear();
    temporaries_.clear();
}

}  // namespace meshwind
