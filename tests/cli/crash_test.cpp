// Errors of the program itself end it with one line and exit code 3, and leave nothing
// half-written.

#include "cli/crash.h"

#include <cassert>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "cli/exit_codes.h"
#include "cli/interrupt.h"
#include "core/files/temporaries.h"
#include "core/parallel.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // the signals of broken memory are the sanitizers' then
#else
constexpr bool kSanitized = false;
#endif

// The whole of what is said: one line.
const std::string kEnd =
    "; nothing unfinished is left; please report it with the command and its "
    "input\n$";

class Crash : public testing::Test {
protected:
    ~Crash() override { EXPECT_FALSE(fs::exists(begun_)); }

    // Something begun that has to go.
    void begin() const {
        end_on_crashes();
        static const Temporary registered(begun_);
        std::ofstream(begun_) << "half";
    }

    const fs::path begun_ = fs::path(testing::TempDir()) /
                            ("crash." + std::to_string(::getpid()) + "." +
                             testing::UnitTest::GetInstance()->current_test_info()->name());
};

// Calls itself until the stack is full; that it never ends has to be hidden from the compiler.
int deeper(const volatile bool* again) {
    volatile int here[1000] = {};
    return *again ? deeper(again) + here[0] : 0;
}

int overflow() {
    volatile bool again = true;
    return deeper(&again);
}

TEST_F(Crash, FailedAssertionNamesItsPlaceAndExpression) {
    EXPECT_EXIT(
        {
            begin();
            [[maybe_unused]] const int one = 1;
            assert(one == 2);
        },
        testing::ExitedWithCode(kInternalError),
        "^meshwind: internal error: cli/crash_test.cpp:[0-9]+: 'one == 2' does not hold" + kEnd);
}

TEST_F(Crash, AbortSaysSo) {
    EXPECT_EXIT(
        {
            begin();
            std::abort();
        },
        testing::ExitedWithCode(kInternalError),
        "^meshwind: internal error: the program gave up \\(SIGABRT\\)" + kEnd);
}

TEST_F(Crash, ExceptionThatNobodyTakesIsTold) {
    EXPECT_EXIT(
        {
            begin();
            std::thread([] { throw std::runtime_error("out of\nluck"); }).join();
        },
        testing::ExitedWithCode(kInternalError), "^meshwind: internal error: out of luck" + kEnd);
}

TEST_F(Crash, MemoryThatIsNotThere) {
    if (kSanitized) {
        GTEST_SKIP();
    }
    EXPECT_EXIT(
        {
            begin();
            int* volatile nowhere = nullptr;
            *nowhere = 1;
        },
        testing::ExitedWithCode(kInternalError), "^meshwind: internal error: .*SIGSEGV.*" + kEnd);
}

TEST_F(Crash, DivisionByZero) {
    if (kSanitized) {
        GTEST_SKIP();
    }
    EXPECT_EXIT(
        {
            begin();
            (void)std::raise(SIGFPE);
        },
        testing::ExitedWithCode(kInternalError), "^meshwind: internal error: .*SIGFPE.*" + kEnd);
}

TEST_F(Crash, StackThatOverflows) {
    if (kSanitized) {
        GTEST_SKIP();
    }
    EXPECT_EXIT(
        {
            begin();
            std::exit(overflow());
        },
        testing::ExitedWithCode(kInternalError), "^meshwind: internal error: .*SIGSEGV.*" + kEnd);
}

TEST_F(Crash, StackOfAWorkerThatOverflows) {
    if (kSanitized) {
        GTEST_SKIP();
    }
    EXPECT_EXIT(
        {
            begin();
            set_thread_count(4);
            const auto here = std::this_thread::get_id();
            parallel_for(10000, 1, [&](std::size_t, std::size_t) {
                if (std::this_thread::get_id() != here) {
                    std::exit(overflow());
                }
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            });
        },
        testing::ExitedWithCode(kInternalError), "^meshwind: internal error: .*SIGSEGV.*" + kEnd);
}

TEST_F(Crash, WhatIsDoneWholeIsNotTouched) {
    const fs::path kept = begun_.string() + ".kept";
    EXPECT_EXIT(
        {
            end_on_crashes();
            const Temporary registered(kept);
            std::ofstream(kept) << "whole";
            const Unbroken whole;
            std::abort();
        },
        testing::ExitedWithCode(kInternalError), "run again");
    EXPECT_TRUE(fs::remove(kept));
}

}  // namespace
}  // namespace meshwind
