#include "core/interrupt.h"

#include <atomic>

namespace meshwind {
namespace {

// The process has one end, so there is one of it.
std::atomic<int>& reason() noexcept {
    static constinit std::atomic<int> asked{0};
    return asked;
}
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler writes it");

}  // namespace

void request_interrupt(int why) noexcept {
    int none = 0;
    reason().compare_exchange_strong(none, why);
}

int interrupt_requested() noexcept {
    return reason().load(std::memory_order_relaxed);
}

void withdraw_interrupt() noexcept {
    reason().store(0);
}

void check_interrupt() {
    if (const int why = interrupt_requested(); why != 0) {
        throw Interrupted(why);
    }
}

}  // namespace meshwind
