#include "report/folder/output_files.h"
#include "core/files/write_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/error.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) {
        names.insert(entry.path().filename().string());
    }
    return names;
}

/// Place of the IoError output.unwritable that `action` throws; nothing when it throws none.
template <typename Action>
std::optional<std::string> unwritable_place(const Action& action) {
    try {
        action();
    } catch (const IoError& error) {
        EXPECT_EQ(error.code(), "output.unwritable");
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.place();
    }
    return std::nullopt;
}

class OutputFiles : public testing::Test {
protected:
    OutputFiles() { fs::create_directories(folder_); }
    ~OutputFiles() override { fs::remove_all(folder_); }

    const fs::path folder_ = fs::path(testing::TempDir()) /
                             ("output_files." + std::to_string(::getpid()) + "." +
                              testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(OutputFiles, FilesAppearTogetherWithPublish) {
    OutputFolder out(folder_ / "a" / "b");
    out.add("one.txt", "1");
    out.add("two.txt", "2");
    EXPECT_FALSE(fs::exists(folder_ / "a" / "b" / "one.txt"));
    out.publish();
    EXPECT_EQ(names_in(folder_ / "a" / "b"), (std::set<std::string>{"one.txt", "two.txt"}));
    EXPECT_EQ(text_of(folder_ / "a" / "b" / "two.txt"), "2");
}

TEST_F(OutputFiles, WithoutPublishNothingRemains) {
    {
        OutputFolder out(folder_ / "a" / "b");
        out.add("one.txt", "1");
    }
    EXPECT_TRUE(names_in(folder_).empty());
}

TEST_F(OutputFiles, WithoutPublishAnEarlierRunIsUntouched) {
    write_file(folder_ / "one.txt", "old");
    {
        OutputFolder out(folder_);
        out.add("one.txt", "new");
        out.withdraw("one.txt");
    }
    EXPECT_EQ(names_in(folder_), std::set<std::string>{"one.txt"});
    EXPECT_EQ(text_of(folder_ / "one.txt"), "old");
}

TEST_F(OutputFiles, PublishReplacesAndWithdraws) {
    write_file(folder_ / "report.json", "old");
    write_file(folder_ / "program.ngc", "old");
    OutputFolder out(folder_);
    out.add("report.json", "new");
    out.withdraw("program.ngc");
    out.withdraw("never-there.ngc");
    out.publish();
    EXPECT_EQ(names_in(folder_), std::set<std::string>{"report.json"});
    EXPECT_EQ(text_of(folder_ / "report.json"), "new");
}

TEST_F(OutputFiles, TrailingSlashNamesTheSameFolder) {
    {
        OutputFolder out((folder_ / "a").string() + "/");
        out.add("one.txt", "1");
    }
    EXPECT_TRUE(names_in(folder_).empty());
}

TEST_F(OutputFiles, FileInTheWayOfTheFolderIsAnError) {
    write_file(folder_ / "a", "");
    EXPECT_EQ(unwritable_place([&] { OutputFolder out(folder_ / "a"); }), folder_ / "a");
    EXPECT_EQ(unwritable_place([&] { OutputFolder out(folder_ / "a" / "b"); }),
              folder_ / "a" / "b");
}

TEST_F(OutputFiles, FolderThatTakesNoFilesIsAnErrorAtOnce) {
    EXPECT_EQ(unwritable_place([&] { OutputFolder out("/proc"); }), "/proc");
    EXPECT_EQ(unwritable_place([&] { OutputFolder out("/proc/meshwind"); }), "/proc/meshwind");
}

TEST_F(OutputFiles, FolderInTheWayOfAFileStopsBeforeTheFirstRename) {
    fs::create_directory(folder_ / "two.txt");
    {
        OutputFolder out(folder_);
        out.add("one.txt", "1");
        out.add("two.txt", "2");
        EXPECT_EQ(unwritable_place([&] { out.publish(); }), folder_ / "two.txt");
    }
    EXPECT_EQ(names_in(folder_), std::set<std::string>{"two.txt"});
}

TEST_F(OutputFiles, WriteFileReplacesTheTextThroughALink) {
    write_file(folder_ / "file", "old and longer");
    fs::create_symlink("file", folder_ / "link");
    write_file(folder_ / "link", "new");
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(text_of(folder_ / "file"), "new");
    EXPECT_EQ(names_in(folder_), (std::set<std::string>{"file", "link"}));
}

TEST_F(OutputFiles, WriteFileKeepsADeviceADevice) {
    write_file("/dev/null", "text");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(OutputFiles, FullDiskIsAnError) {
    EXPECT_EQ(unwritable_place([] { write_file("/dev/full", "text"); }), "/dev/full");
}

TEST_F(OutputFiles, WriteFileRefusesAFolderAndAMissingFolder) {
    EXPECT_EQ(unwritable_place([&] { write_file(folder_, "text"); }), folder_);
    EXPECT_EQ(unwritable_place([&] { write_file(folder_ / "a" / "b", "text"); }),
              folder_ / "a" / "b");
}

}  // namespace
}  // namespace meshwind
