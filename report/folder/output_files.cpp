#include "report/folder/output_files.h"

#include <algorithm>
#include <cassert>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/files/disk_file.h"
#include "core/interrupt.h"
#include "report/folder/replacement.h"
#include "report/folder/run_files.h"

namespace meshwind {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(fs::path folder) : folder_(std::move(folder)) {
    if (!folder_.has_filename() && folder_.has_parent_path() && folder_ != folder_.root_path()) {
        folder_ = folder_.parent_path();  // "out/" and "out" are one folder
    }
    try {
        open();
    } catch (...) {
        remove_created();
        throw;
    }
}

OutputFolder::~OutputFolder() {
    std::error_code ignored;
    for (const std::string& name : added_) {
        fs::remove(staged(name), ignored);
    }
    remove_created();
}

void OutputFolder::open() {
    do {
        lock_.reset();
        create_folders();
        try {
            lock_.emplace(folder_);
        } catch (const IoError&) {
            created_.clear();  // a run that was quicker is in there
            throw;
        }
    } while (!lock_->holds(folder_));
    remove_leftovers(folder_);
    // Found out now, not after minutes of planning.
    const RemovedInTheEnd probe(staged("probe"));
    write_to_disk(staged("probe"), std::string_view(), folder_);
}

void OutputFolder::create_folders() {
    std::vector<fs::path> missing;
    std::error_code error;
    for (fs::path outer = folder_; !outer.empty() && !fs::exists(outer, error);
         outer = outer.parent_path()) {
        missing.push_back(outer);
    }
    for (auto outer = missing.rbegin(); outer != missing.rend(); ++outer) {
        Temporary registered(*outer);
        if (fs::create_directory(*outer, error)) {
            created_.push_back(*outer);
            temporaries_.push_back(std::move(registered));
        }
    }
    if (error || !fs::is_directory(folder_, error)) {
        throw_unwritable(folder_, error ? error.message() : "a file of that name is in the way");
    }
}

void OutputFolder::remove_created() {
    std::error_code ignored;
    for (auto folder = created_.rbegin(); folder != created_.rend(); ++folder) {
        fs::remove(*folder, ignored);  // only where it is empty
    }
}

fs::path OutputFolder::staged(const std::string& name) const {
    return temporary_beside(folder_ / name, TemporaryKind::Staged);
}

void OutputFolder::add(const std::string& name, std::string_view bytes) {
    add(name, ByteSource([bytes](const auto& write) { write(bytes); }));
}

void OutputFolder::add(const std::string& name, const ByteSource& source) {
    assert(fs::path(name).filename() == name);
    assert(std::find(added_.begin(), added_.end(), name) == added_.end());
    temporaries_.emplace_back(staged(name));
    added_.push_back(name);
    write_to_disk(staged(name), source, folder_ / name);
}

void OutputFolder::withdraw(const std::string& name) {
    assert(fs::path(name).filename() == name);
    withdrawn_.push_back(name);
}

void OutputFolder::withdraw_earlier_run() {
    for (const std::string& name : files_of_earlier_run(folder_)) {
        withdraw(name);
    }
}

void OutputFolder::publish() {
    check_interrupt();
    const Unbroken whole;
    replace_files(folder_, withdrawn_, added_);
    added_.clear();
    withdrawn_.clear();
    created_.clear();
    temporaries_.clear();
}

}  // namespace meshwind
