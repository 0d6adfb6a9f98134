#include "cli/progress.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iostream>

#include <sys/ioctl.h>
#include <unistd.h>

#include "core/interrupt.h"
#include "core/text/text_number.h"

namespace meshwind {
namespace {

constexpr double kRedraw_s = 0.1;
constexpr double kClock_s = 0.5;
constexpr double kLines_s = 2.0;
constexpr double kLinesShare = 0.2;  // of the time that has gone by

// A rate is told from so much of a phase on; before, it is mostly noise.
constexpr double kSettled_s = 1.0;
constexpr double kSettledShare = 0.01;

constexpr int kUsualColumns = 80;
constexpr int kLongestBar = 40;
constexpr int kShortestBar = 8;

constexpr const char* kWipe = "\r\033[K";

std::string clock_text(double seconds) {
    const auto all = static_cast<long long>(std::llround(std::clamp(seconds, 0.0, 3.6e6)));
    const auto two = [](long long n) { return (n < 10 ? "0" : "") + std::to_string(n); };
    return all < 3600 ? std::to_string(all / 60) + ":" + two(all % 60)
                      : std::to_string(all / 3600) + ":" + two(all / 60 % 60) + ":" + two(all % 60);
}

// Rounded down: 100 % is all.
std::string whole_percent(double share) {
    return std::to_string(static_cast<int>(100.0 * share)) + " %";
}

std::string bar_text(double share, std::size_t width) {
    const auto done = static_cast<std::size_t>(static_cast<double>(width) * share);
    return " [" + std::string(done, '#') + std::string(width - done, '.') + "]";
}

int columns_of_terminal() {
    winsize size{};
    const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : kUsualColumns;
}

}  // namespace

std::optional<double> time_left_s(const ProgressState& state) {
    if (state.elapsed_s < kSettled_s || state.gained < kSettledShare) {
        return std::nullopt;
    }
    return (1.0 - state.share) * state.elapsed_s / state.gained;
}

std::string progress_bar(const ProgressState& state, int columns) {
    const auto room = static_cast<std::size_t>(std::max(0, columns - 1));
    const double share = std::clamp(state.share, 0.0, 1.0);
    const std::optional<double> left_s = time_left_s(state);
    std::string done;
    if (share > 0.0) {
        const std::string number = whole_percent(share);
        done = "  " + std::string(5 - std::min<std::size_t>(5, number.size()), ' ') + number;
    }
    const std::string rate =
        left_s ? "  " + fixed(100.0 * state.gained / state.elapsed_s, 1) + " %/s" : "";
    std::string time;
    if (left_s) {
        time = "  " + clock_text(*left_s) + " left";
    } else if (state.elapsed_s >= kSettled_s) {
        time = "  " + clock_text(state.elapsed_s);
    }
    std::string all = done;
    all += rate;
    all += time;
    constexpr std::size_t kBrackets = 3;
    for (const std::string& more : {all, done + time, done}) {
        const std::size_t words = state.phase.size() + more.size() + kBrackets;
        if (room >= words + kShortestBar) {
            const auto width = std::min<std::size_t>(room - words, kLongestBar);
            return state.phase + bar_text(share, width) + more;
        }
    }
    if (state.phase.size() + done.size() <= room) {
        return state.phase + done;
    }
    return state.phase.substr(0, room);
}

std::string progress_line(const ProgressState& state) {
    std::string line = state.phase;
    if (state.gained > 0.0) {
        line += " " + whole_percent(std::clamp(state.share, 0.0, 1.0));
    }
    if (const std::optional<double> left_s = time_left_s(state)) {
        line += ", " + clock_text(*left_s) + " left";
    } else if (state.elapsed_s >= kSettled_s) {
        line += ", for " + clock_text(state.elapsed_s);
    }
    return line + " ...";
}

bool ProgressPhases::report(const std::string& phase, double share, double now) {
    const bool begins = phase != latest_.phase || share < latest_.share;
    if (begins) {
        first_share_ = share;
        begun_s_ = now;
    }
    latest_.phase = phase;
    latest_.share = share;
    return begins;
}

ProgressState ProgressPhases::state(double now) const {
    ProgressState state = latest_;
    state.gained = state.share - first_share_;
    state.elapsed_s = now - begun_s_;
    return state;
}

Progress::Progress(bool quiet) : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
    clear();
}

double Progress::now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

void Progress::show(const std::string& phase, double share) {
    check_interrupt();
    const std::lock_guard lock(mutex_);
    if (quiet_ || over_) {
        return;
    }
    phases_.report(phase, share, now_s());
    draw();
    if (!clock_.joinable()) {
        clock_ = std::thread([this] { keep_drawing(); });
    }
}

void Progress::say(const std::string& line) {
    const std::lock_guard lock(mutex_);
    if (!quiet_) {
        std::cerr << (shown_ ? kWipe : "") << line << '\n';
        shown_ = false;
    }
}

void Progress::draw_line(double now) {
    const ProgressState state = phases_.state(now);
    if (state.phase != named_ ||
        now - last_s_ >= std::max(kLines_s, kLinesShare * (now - begun_s_))) {
        std::cerr << progress_line(state) << '\n';
        named_ = state.phase;
        last_s_ = now;
    }
}

void Progress::draw() {
    const double now = now_s();
    if (!terminal_) {
        draw_line(now);
        return;
    }
    if (now - last_s_ < kRedraw_s) {
        return;
    }
    std::cerr << kWipe + progress_bar(phases_.state(now), columns_of_terminal()) << std::flush;
    shown_ = true;
    last_s_ = now;
}

void Progress::keep_drawing() {
    std::unique_lock lock(mutex_);
    while (
        !ended_.wait_for(lock, std::chrono::duration<double>(kClock_s), [this] { return over_; })) {
        draw();
    }
}

void Progress::clear() {
    {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    ended_.notify_all();
    if (clock_.joinable()) {
        clock_.join();
    }
    if (shown_) {
        std::cerr << kWipe << std::flush;
        shown_ = false;
    }
}

}  // namespace meshwind
