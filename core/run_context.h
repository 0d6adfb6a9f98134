/// Settings of a run besides its inputs, passed down from the caller to every stage.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace meshwind {

/// A run is ended from outside by core/interrupt.h; core/parallel.h has the number of threads.
struct RunContext {
    std::uint64_t seed = 1;  ///< of every random draw
    double effort = 1.0;     ///< how long plans are improved, as a multiple
    /// Called when a step begins or goes on, with the share of it that is done, 0 .. 1.
    std::function<void(const std::string& step, double share)> progress{};
    /// Called at once with remarks for the user who waits, a line each.
    std::function<void(const std::string& line)> remark{};

    void report_progress(const std::string& step, double share) const {
        if (progress) {
            progress(step, share);
        }
    }
    void report_remark(const std::string& line) const {
        if (remark) {
            remark(line);
        }
    }
};

}  // namespace meshwind
