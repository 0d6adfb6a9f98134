#include "report/folder/replacement.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "core/error.h"
#include "core/files/disk_file.h"
#include "report/folder/run_files.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

constexpr std::array kOrderOfTaking = {FileRole::Program, FileRole::Report, FileRole::Table};
constexpr std::array kOrderOfPutting = {FileRole::Table, FileRole::Report, FileRole::Program};

std::vector<std::string> in_order(const std::vector<std::string>& names,
                                  const std::array<FileRole, 3>& order) {
    std::vector<std::string> sorted;
    for (const FileRole role : order) {
        std::copy_if(names.begin(), names.end(), std::back_inserter(sorted),
                     [&](const std::string& name) { return role_of(name) == role; });
    }
    return sorted;
}

class Replacement {
public:
    explicit Replacement(fs::path folder) : folder_(std::move(folder)) {}

    // Another name for what is there, so that it can come back.
    void keep(const std::string& name) {
        const fs::path file = folder_ / name;
        const fs::path other = temporary_beside(file, TemporaryKind::Kept);
        // File systems without hard links have it moved.
        if (::link(file.c_str(), other.c_str()) != 0 &&
            ::rename(file.c_str(), other.c_str()) != 0) {
            if (errno == ENOENT) {
                return;
            }
            throw_unwritable(file, std::strerror(errno));
        }
        kept_.push_back({name, other});
    }

    void take_kept() {
        for (const Kept& kept : kept_) {
            const fs::path file = folder_ / kept.name;
            if (::unlink(file.c_str()) != 0 && errno != ENOENT) {
                throw_unwritable(file, std::strerror(errno));
            }
        }
    }

    void put(const std::string& name) {
        const fs::path file = folder_ / name;
        std::error_code error;
        fs::rename(temporary_beside(file, TemporaryKind::Staged), file, error);
        if (error) {
            throw_unwritable(file, error.message());
        }
        put_.push_back(name);
    }

    void undo() const noexcept {
        for (auto name = put_.rbegin(); name != put_.rend(); ++name) {
            if (::unlink((folder_ / *name).c_str()) != 0) {
                return;
            }
        }
        for (const FileRole role : kOrderOfPutting) {
            for (const Kept& kept : kept_) {
                if (role_of(kept.name) == role && !put_back(kept)) {
                    return;
                }
            }
        }
    }

    void finish() const noexcept {
        for (const Kept& kept : kept_) {
            ::unlink(kept.file.c_str());
        }
    }

private:
    struct Kept {
        std::string name;
        fs::path file;  // under its other name
    };

    [[nodiscard]] bool put_back(const Kept& kept) const noexcept {
        const fs::path file = folder_ / kept.name;
        const bool back = ::rename(kept.file.c_str(), file.c_str()) == 0 ||
                          ::link(kept.file.c_str(), file.c_str()) == 0 || errno == EEXIST;
        if (back) {
            ::unlink(kept.file.c_str());  // a rename onto the same file leaves both names
        }
        return back;
    }

    fs::path folder_;
    std::vector<Kept> kept_;
    std::vector<std::string> put_;
};

void refuse_folders_in_the_way(const fs::path& folder, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
        std::error_code ignored;
        if (fs::is_directory(fs::symlink_status(folder / name, ignored))) {
            throw_unwritable(folder / name, "a folder of that name is in the way");
        }
    }
}

}  // namespace

void replace_files(const fs::path& folder, const std::vector<std::string>& taken,
                   const std::vector<std::string>& put) {
    std::vector<std::string> old = taken;
    for (const std::string& name : put) {
        if (std::find(old.begin(), old.end(), name) == old.end()) {
            old.push_back(name);
        }
    }
    refuse_folders_in_the_way(folder, old);
    Replacement replacement(folder);
    try {
        for (const std::string& name : in_order(old, kOrderOfTaking)) {
            replacement.keep(name);
        }
        replacement.take_kept();
        flush_folder(folder);
        for (const std::string& name : in_order(put, kOrderOfPutting)) {
            replacement.put(name);
        }
    } catch (const Error&) {
        replacement.undo();
        flush_folder(folder);
        throw;
    }
    flush_folder(folder);
    replacement.finish();
}

}  // namespace meshwind
