#include "cli/interrupt.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <string_view>

#include <unistd.h>

#include "cli/exit_codes.h"
#include "core/files/temporaries.h"
#include "core/interrupt.h"

namespace meshwind {
namespace {

// A run has to end within a second of the signal. So much of it is left to the run, which removes
// what it has begun by itself; after it the handler does.
constexpr long kGrace_ns = 800'000'000;

// An end at once that has to wait looks again after this time; what is done whole takes less.
constexpr long kAgain_ns = 20'000'000;

// What a signal handler reads and writes: no locks, no memory of its own.
struct State {
    std::atomic<bool> told{false};
    timer_t timer{};
    bool terminal = false;
};

State& state() noexcept {
    static constinit State only;
    return only;
}

void wake_after(long ns) noexcept {
    itimerspec when{};
    when.it_value.tv_nsec = ns;
    ::timer_settime(state().timer, 0, &when, nullptr);
}

void tell(int signal) noexcept {
    constexpr std::string_view kInterrupted = "meshwind: interrupted; nothing unfinished is left\n";
    constexpr std::string_view kTooLarge =
        "meshwind: a file would be larger than the shell allows (ulimit -f); nothing unfinished "
        "is left\n";
    // Whoever closed a pipe has read enough, and may be the one who would read this.
    if (signal != SIGPIPE && !state().told.exchange(true)) {
        const std::string_view words = signal == SIGXFSZ ? kTooLarge : kInterrupted;
        (void)!::write(STDERR_FILENO, words.data(), words.size());
    }
}

void end_or_wait() noexcept {
    if (!remove_temporaries()) {
        wake_after(kAgain_ns);
        return;
    }
    const int signal = interrupt_requested();
    if (state().terminal) {
        (void)!::write(STDERR_FILENO, "\n", 1);  // the bar stands in the line
    }
    tell(signal);
    ::_exit(kInterrupted + signal);
}

void on_signal(int signal) {
    const int kept = errno;
    if (interrupt_requested() == 0) {
        request_interrupt(signal);
        wake_after(kGrace_ns);
    } else {
        end_or_wait();
    }
    errno = kept;
}

void on_timer(int) {
    const int kept = errno;
    if (interrupt_requested() != 0) {
        end_or_wait();
    }
    errno = kept;
}

void handle(int signal, void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART | SA_ONSTACK;
    ::sigfillset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
}

}  // namespace

void end_on_signals() {
    state().terminal = ::isatty(STDERR_FILENO) != 0;
    handle(SIGALRM, on_timer);
    sigevent event{};
    event.sigev_notify = SIGEV_SIGNAL;
    event.sigev_signo = SIGALRM;
    ::timer_create(CLOCK_MONOTONIC, &event, &state().timer);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGXFSZ, SIGPIPE}) {
        struct sigaction before {};
        ::sigaction(signal, nullptr, &before);
        if (before.sa_handler != SIG_IGN) {
            handle(signal, on_signal);
        }
    }
}

void end_interrupted() {
    const int signal = interrupt_requested();
    tell(signal);
    ::_exit(kInterrupted + signal);
}

}  // namespace meshwind
