// Whatever call of the system fails while an output folder is published, and wherever the process
// is killed: no program lies beside a report that does not describe it.

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"
#include "report/folder/output_files.h"
#include "report/folder/run_files.h"
#include "tests/support/system_faults.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;
using faults::Fault;

using Files = std::map<std::string, std::string>;

// Two fibres on the old machine, three on the new one of another language; a table less.
const Files kOld = {{"report.json", "old: program.mpf program-2.mpf"},
                    {"report.html", "old"},
                    {"path.csv", "old"},
                    {"path-layer-2.csv", "old"},
                    {"program.mpf", "old"},
                    {"program-2.mpf", "old"}};
const Files kNew = {{"report.json", "new: program.ngc program-2.ngc program-3.ngc"},
                    {"report.html", "new"},
                    {"path.csv", "new"},
                    {"motion.csv", "new"},
                    {"program.ngc", "new"},
                    {"program-2.ngc", "new"},
                    {"program-3.ngc", "new"}};

std::string text_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

Files files_in(const fs::path& folder) {
    Files files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        files[entry.path().filename().string()] = text_of(entry.path());
    }
    return files;
}

Files without_hidden(Files files) {
    std::erase_if(files, [](const auto& file) { return file.first.front() == '.'; });
    return files;
}

// Every program has a report of its own run beside it that names it.
void expect_described(const Files& files) {
    for (const auto& [name, text] : files) {
        if (role_of(name) == FileRole::Program) {
            const auto report = files.find("report.json");
            ASSERT_NE(report, files.end()) << name << " has no report";
            EXPECT_EQ(report->second.substr(0, 3), text) << name;
            EXPECT_NE(report->second.find(name), std::string::npos) << name;
        }
    }
}

class PublishFaults : public testing::Test {
protected:
    ~PublishFaults() override { fs::remove_all(folder_); }

    void write_old() const {
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        for (const auto& [name, text] : kOld) {
            std::ofstream(folder_ / name) << text;
        }
        std::ofstream(folder_ / "mine.txt") << "mine";
    }

    // A run in a process of its own, with a fault at the n-th call of its publishing.
    // \param calls gets how many calls the publishing makes, where it comes to its end
    int run(Fault fault, int n) const {
        const pid_t child = ::fork();
        if (child == 0) {
            int code = 0;
            try {
                OutputFolder out(folder_);
                for (const auto& [name, text] : kNew) {
                    out.add(name, text);
                }
                out.withdraw_earlier_run();
                faults::arm(fault, n);
                out.publish();
                code = 100 + faults::calls();
            } catch (const IoError& error) {
                code = error.code() == "output.unwritable" ? 2 : 3;
            }
            faults::arm(Fault::None, 0);
            ::_exit(code);
        }
        int status = 0;
        ::waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }

    // Every call of a publishing that comes to its end.
    [[nodiscard]] int count_calls() const {
        write_old();
        const int code = run(Fault::None, 0);
        EXPECT_GT(code, 100 + static_cast<int>(kNew.size()));
        return code - 100;
    }

    Files with_mine(Files files) const {
        files["mine.txt"] = "mine";
        return files;
    }

    const fs::path folder_ = fs::path(testing::TempDir()) /
                             ("publish_faults." + std::to_string(::getpid()) + "." +
                              testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(PublishFaults, NoneGivesTheNewFilesAlone) {
    write_old();
    EXPECT_GE(run(Fault::None, 0), 100);
    EXPECT_EQ(files_in(folder_), with_mine(kNew));
}

TEST_F(PublishFaults, KilledAtAnyCallNoProgramLacksItsReport) {
    const int calls = count_calls();
    for (int n = 1; n <= calls; ++n) {
        SCOPED_TRACE(n);
        write_old();
        EXPECT_EQ(run(Fault::Kill, n), -SIGKILL);
        const Files left = files_in(folder_);
        expect_described(left);
        EXPECT_EQ(left.at("mine.txt"), "mine");
        // The next run has the folder as if nothing had been.
        EXPECT_GE(run(Fault::None, 0), 100);
        EXPECT_EQ(files_in(folder_), with_mine(kNew));
    }
}

TEST_F(PublishFaults, AnyCallThatFailsLeavesTheOldFilesOrTheNewOnes) {
    const int calls = count_calls();
    int undone = 0;
    for (int n = 1; n <= calls; ++n) {
        SCOPED_TRACE(n);
        write_old();
        const int code = run(Fault::FailOnce, n);
        const Files left = without_hidden(files_in(folder_));
        if (code == 2) {
            EXPECT_EQ(left, with_mine(kOld));
            ++undone;
        } else {
            EXPECT_GE(code, 100);  // the call was one that may fail: there was another way
            EXPECT_EQ(left, with_mine(kNew));
        }
    }
    EXPECT_GE(undone, static_cast<int>(kNew.size()));  // every rename at the least
}

TEST_F(PublishFaults, WhereAllCallsFailFromOneOnNoProgramLacksItsReport) {
    const int calls = count_calls();
    for (int n = 1; n <= calls; ++n) {
        SCOPED_TRACE(n);
        write_old();
        (void)run(Fault::FailOn, n);
        expect_described(files_in(folder_));
        EXPECT_GE(run(Fault::None, 0), 100);
        EXPECT_EQ(files_in(folder_), with_mine(kNew));
    }
}

}  // namespace
}  // namespace meshwind
