/// Durable writing of files: on the disk when a call returns, under temporary names before.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace meshwind {

/// Purpose of a temporary file in an output folder.
enum class TemporaryKind {
    File,    ///< ".NAME.PID.part": a file of its own (write_file)
    Staged,  ///< ".NAME.PID.tmp": a file of an OutputFolder before it is published
    Kept,    ///< ".NAME.PID.old": the file that is replaced, until all is published
};

/// Temporary name beside `file`; the process id keeps runs apart.
[[nodiscard]] std::filesystem::path temporary_beside(const std::filesystem::path& file,
                                                     TemporaryKind kind);

/// Writes the bytes and flushes them to the disk. A regular file that could not be written whole is
/// removed. \param place the name that the user knows
/// \throws IoError output.unwritable; Interrupted, also where the file became larger than the
/// shell allows (SIGXFSZ)
void write_to_disk(const std::filesystem::path& file, std::string_view bytes,
                   const std::filesystem::path& place);

/// Gives a file's bytes piece by piece, so that they are never all in memory.
using ByteSource = std::function<void(const std::function<void(std::string_view)>& write)>;

/// The same for the pieces of a source. \throws what the source throws
void write_to_disk(const std::filesystem::path& file, const ByteSource& source,
                   const std::filesystem::path& place);

/// Flushes the names in a folder to the disk, where the file system offers that.
void flush_folder(const std::filesystem::path& folder) noexcept;

/// Removes the temporaries that killed runs have left in a folder: all Staged and Kept ones, and
/// those of kind File whose process has ended.
/// \pre the folder is locked (FolderLock), so no other run has a use for them
void remove_leftovers(const std::filesystem::path& folder);

/// Removes the temporaries of kind File of one file, where their process has ended.
void remove_leftovers_of(const std::filesystem::path& file);

/// \throws IoError output.unwritable
[[noreturn]] void throw_unwritable(const std::filesystem::path& place, std::string_view reason);

}  // namespace meshwind
