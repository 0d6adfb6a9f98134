#include "core/interrupt.h"

#include <atomic>
#include <csignal>

#include <gtest/gtest.h>

#include "core/parallel.h"

namespace meshwind {
namespace {

class Interrupt : public testing::Test {
protected:
    ~Interrupt() override { withdraw_interrupt(); }
};

int reason_of_loop(std::size_t count) {
    try {
        parallel_for(count, 1, [](std::size_t, std::size_t) {});
    } catch (const Interrupted& end) {
        return end.reason();
    }
    return 0;
}

TEST_F(Interrupt, NothingEndsUnasked) {
    EXPECT_EQ(interrupt_requested(), 0);
    EXPECT_NO_THROW(check_interrupt());
    EXPECT_EQ(reason_of_loop(100), 0);
}

TEST_F(Interrupt, FirstReasonStays) {
    request_interrupt(SIGTERM);
    request_interrupt(SIGINT);
    EXPECT_EQ(interrupt_requested(), SIGTERM);
    EXPECT_EQ(reason_of_loop(1), SIGTERM);
    withdraw_interrupt();
    EXPECT_EQ(reason_of_loop(1), 0);
}

TEST_F(Interrupt, LoopsEndAtTheNextChunk) {
    set_thread_count(1);
    std::atomic<int> begun{0};
    EXPECT_THROW(parallel_for(1000, 1,
                              [&](std::size_t, std::size_t) {
                                  if (++begun == 10) {
                                      request_interrupt(SIGINT);
                                  }
                              }),
                 Interrupted);
    EXPECT_EQ(begun.load(), 10);
    set_thread_count(0);
}

TEST_F(Interrupt, NestedLoopsEndAsOne) {
    std::atomic<int> inner{0};
    EXPECT_THROW(parallel_for(50, 1,
                              [&](std::size_t, std::size_t) {
                                  parallel_for(50, 1, [&](std::size_t, std::size_t) {
                                      if (++inner == 100) {
                                          request_interrupt(SIGINT);
                                      }
                                  });
                              }),
                 Interrupted);
    EXPECT_LT(inner.load(), 2500);
}

TEST_F(Interrupt, SignalHandlersMayAsk) {
    const auto before = std::signal(SIGUSR1, [](int number) { request_interrupt(number); });
    std::raise(SIGUSR1);
    std::signal(SIGUSR1, before);
    EXPECT_EQ(interrupt_requested(), SIGUSR1);
}

}  // namespace
}  // namespace meshwind
