#include "core/files/disk_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "core/error.h"
#include "core/interrupt.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

// Written between two looks at whether the run is to end.
constexpr std::size_t kPiece_bytes = std::size_t{16} << 20;

std::string_view ending_of(TemporaryKind kind) {
    switch (kind) {
        case TemporaryKind::File:
            return ".part";
        case TemporaryKind::Staged:
            return ".tmp";
        default:
            return ".old";
    }
}

// An open file that is closed in the end.
class Descriptor {
public:
    Descriptor(const fs::path& file, int flags) : number_(::open(file.c_str(), flags, 0666)) {}
    ~Descriptor() {
        if (number_ >= 0) {
            ::close(number_);
        }
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    [[nodiscard]] int number() const { return number_; }
    [[nodiscard]] bool close() { return ::close(std::exchange(number_, -1)) == 0; }

private:
    int number_;
};

bool written(int number, std::string_view bytes) {
    while (!bytes.empty()) {
        if (interrupt_requested() != 0) {
            return false;
        }
        const ssize_t count = ::write(number, bytes.data(), std::min(bytes.size(), kPiece_bytes));
        if (count < 0 && errno != EINTR) {
            return false;
        }
        bytes.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    }
    return true;
}

// Pipes and devices have no disk to reach.
bool flushed(int number) {
    return ::fsync(number) == 0 || errno == EINVAL || errno == EROFS || errno == ENOTSUP;
}

struct TemporaryName {
    std::string name;  ///< of the file it stands for
    pid_t process = 0;
    TemporaryKind kind = TemporaryKind::File;
};

std::optional<TemporaryName> parsed(const std::string& text) {
    for (const TemporaryKind kind :
         {TemporaryKind::File, TemporaryKind::Staged, TemporaryKind::Kept}) {
        const std::string_view ending = ending_of(kind);
        if (text.size() <= ending.size() || text.front() != '.' || !text.ends_with(ending)) {
            continue;
        }
        const std::string stem = text.substr(1, text.size() - 1 - ending.size());
        const std::size_t point = stem.rfind('.');
        TemporaryName found{.name = stem.substr(0, point), .process = 0, .kind = kind};
        if (point == std::string::npos || found.name.empty()) {
            continue;
        }
        const char* const end = stem.data() + stem.size();
        const auto read = std::from_chars(stem.data() + point + 1, end, found.process);
        if (read.ec == std::errc() && read.ptr == end && found.process > 0) {
            return found;
        }
    }
    return std::nullopt;
}

bool has_ended(pid_t process) {
    return process == ::getpid() || (::kill(process, 0) != 0 && errno == ESRCH);
}

template <typename Wanted>
void remove_temporaries_in(const fs::path& folder, const Wanted& wanted) {
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
        const auto name = parsed(entry.path().filename().string());
        if (name && wanted(*name) && !entry.is_directory(ignored)) {
            fs::remove(entry.path(), ignored);
        }
    }
}

}  // namespace

void throw_unwritable(const fs::path& place, std::string_view reason) {
    throw IoError("output.unwritable", place.string(),
                  "cannot write (" + std::string(reason) +
                      "); choose another place with -o, or make room there");
}

fs::path temporary_beside(const fs::path& file, TemporaryKind kind) {
    std::string name = "." + file.filename().string() + "." + std::to_string(::getpid());
    name += ending_of(kind);
    return file.parent_path() / name;
}

void write_to_disk(const fs::path& file, const ByteSource& source, const fs::path& place) {
    Descriptor target(file, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC);
    const auto give_up = [&] {
        const std::string reason = std::strerror(errno);
        std::error_code ignored;
        if (fs::is_regular_file(file, ignored)) {
            fs::remove(file, ignored);
        }
        check_interrupt();  // the signal is the cause, where there was one
        throw_unwritable(place, reason);
    };
    if (target.number() < 0) {
        give_up();
    }
    source([&](std::string_view bytes) {
        if (!written(target.number(), bytes)) {
            give_up();
        }
    });
    if (!flushed(target.number()) || !target.close()) {
        give_up();
    }
}

void write_to_disk(const fs::path& file, std::string_view bytes, const fs::path& place) {
    write_to_disk(file, ByteSource([bytes](const auto& write) { write(bytes); }), place);
}

void flush_folder(const fs::path& folder) noexcept {
    const Descriptor open(folder.empty() ? fs::path(".") : folder,
                          O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (open.number() >= 0) {
        (void)::fsync(open.number());
    }
}

void remove_leftovers(const fs::path& folder) {
    remove_temporaries_in(folder, [](const TemporaryName& name) {
        return name.kind != TemporaryKind::File || has_ended(name.process);
    });
}

void remove_leftovers_of(const fs::path& file) {
    remove_temporaries_in(file.parent_path().empty() ? fs::path(".") : file.parent_path(),
                          [&](const TemporaryName& name) {
                              return name.kind == TemporaryKind::File &&
                                     name.name == file.filename() && has_ended(name.process);
                          });
}

}  // namespace meshwind
