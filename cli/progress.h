/// Progress display of a run: a bar on a terminal, plain lines elsewhere.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace meshwind {

/// State of the running phase.
struct ProgressState {
    std::string phase;
    double share = 0.0;      ///< 0..1 done; 0 also where unknown
    double gained = 0.0;     ///< of it since the phase began
    double elapsed_s = 0.0;  ///< since then
};

/// Seconds until the phase ends if it goes on at its rate; none before there is a rate.
[[nodiscard]] std::optional<double> time_left_s(const ProgressState& state);

/// One line, "library [####......]  42 %  2.1 %/s  0:27 left", never longer than columns - 1, so
/// that no terminal breaks it: narrow ones omit first the rate, then the time, the bar, the share,
/// then the end of the name.
[[nodiscard]] std::string progress_bar(const ProgressState& state, int columns);

/// For a log: "library ..." where a phase begins, later "library 42 %, 0:27 left ...", or where its
/// end is unknown "library, for 0:12 ...".
[[nodiscard]] std::string progress_line(const ProgressState& state);

/// Follows phases by the reports of a run; times are the caller's.
class ProgressPhases {
public:
    /// \return whether a phase begins: another name, or a share that goes back
    bool report(const std::string& phase, double share, double now_s);

    [[nodiscard]] ProgressState state(double now_s) const;

private:
    ProgressState latest_;
    double first_share_ = 0.0;
    double begun_s_ = 0.0;
};

/// Shows progress on stderr, never on stdout. On a terminal one line is redrawn, at most ten times
/// a second, and wiped at the end. Elsewhere a line is written where another phase begins, and
/// every two seconds, in long runs every fifth of the elapsed time. Thread-safe.
class Progress {
public:
    explicit Progress(bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// A cancellation point (core/interrupt.h). \throws Interrupted
    void show(const std::string& phase, double share);

    /// Prints a line of its own, not over the bar; none when quiet.
    void say(const std::string& line);

    /// Wipes the bar, for good.
    void clear();

private:
    [[nodiscard]] static double now_s();
    void draw();                 // \pre mutex_ is held
    void draw_line(double now);  // \pre mutex_ is held
    void keep_drawing();

    bool quiet_;
    bool terminal_;
    std::mutex mutex_;
    std::condition_variable ended_;
    bool over_ = false;
    bool shown_ = false;
    double begun_s_ = now_s();
    double last_s_ = -1e9;  // of the last drawing or line
    std::string named_;     // phase of the last line
    ProgressPhases phases_;
    std::thread clock_;  // so that the time goes on where a phase says nothing
};

}  // namespace meshwind
