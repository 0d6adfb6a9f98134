/// Ending a run early: asked for by a signal handler, done at the next cancellation point.
#pragma once

#include <exception>

namespace meshwind {

/// Thrown at a cancellation point once an end is asked for. No Error: nothing is wrong.
class Interrupted : public std::exception {
public:
    /// \param reason as given to request_interrupt()
    explicit Interrupted(int reason) : reason_(reason) {}
    [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
    [[nodiscard]] int reason() const { return reason_; }

private:
    int reason_;
};

/// Asks for the end of the run; the first reason stays. A signal handler may call it, and any
/// thread. \param reason > 0, the signal's number
void request_interrupt(int reason) noexcept;

/// The reason, or 0: no end is asked for. May be called where request_interrupt() may.
[[nodiscard]] int interrupt_requested() noexcept;

/// Forgets the request.
void withdraw_interrupt() noexcept;

/// A cancellation point; each chunk of a parallel loop is one. \throws Interrupted
void check_interrupt();

}  // namespace meshwind
