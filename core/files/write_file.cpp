#include "core/files/write_file.h"

#include <system_error>

#include "core/files/disk_file.h"
#include "core/files/temporaries.h"

namespace meshwind {

namespace fs = std::filesystem;

void write_file(const fs::path& file, std::string_view bytes) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (fs::is_directory(status)) {
        throw_unwritable(file, "it is a folder");
    }
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        write_to_disk(file, bytes, file);
        return;
    }
    const fs::path target = fs::exists(status) ? fs::canonical(file, error) : file;
    if (error && fs::exists(status)) {
        throw_unwritable(file, error.message());
    }
    remove_leftovers_of(target);
    const fs::path temporary = temporary_beside(target, TemporaryKind::File);
    const RemovedInTheEnd guard(temporary);
    write_to_disk(temporary, bytes, file);
    fs::rename(temporary, target, error);
    if (error) {
        throw_unwritable(file, error.message());
    }
    flush_folder(target.parent_path());
}

}  // namespace meshwind
