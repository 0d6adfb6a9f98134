/// The commands as the command line gives them: words in, summary or JSON and exit code out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cli/carry_command.h"
#include "cli/design_command.h"
#include "cli/exit_codes.h"
#include "cli/post_command.h"
#include "cli/preview.h"
#include "cli/study_command.h"
#include "cli/trace_command.h"
#include "cli/wind.h"

namespace meshwind {

/// What every command takes.
struct Common {
    int threads = 0;         ///< 0: one per core
    std::uint64_t seed = 1;  ///< of every random draw
    bool quiet = false;
    bool json = false;
    bool force = false;
    std::string units;  ///< auto, um, mm, cm, m, in; empty: auto
};

struct WindOptions {
    std::string mandrel;
    std::string machine = "six_axis.json";
    std::string job;
    std::string out = "meshwind-out";
    int effort = 1;
    PreviewOptions png;
};

struct VerifyOptions {
    std::string program, mandrel, machine, job, plan, out, tie_on;
};

struct InspectOptions {
    std::string mandrel;
    std::optional<double> refine_mm;
    std::string out;
};

struct TraceOptionsText {
    std::string mandrel, start, direction, to, frame = "mandrel", method = "patches";
    double angle_deg = 0.0;
    TraceRequest request;
};

struct CarryOptionsText {
    std::string axis, machine = "robot_kr16.json", out = "meshwind-out", tool = "0,0,0,0,0,0";
    CarryRequest request;
};

/// Each runs one command: files are looked up as find_input() does, summary or JSON go to stdout,
/// progress and a line for each failed check to stderr. Return the exit code.
/// \throws Error for input that cannot be used
[[nodiscard]] int run_wind(const WindOptions& options, const Common& common);
[[nodiscard]] int run_post(const PostOptions& options, const Common& common);
[[nodiscard]] int run_verify_command(const VerifyOptions& options, const Common& common);
[[nodiscard]] int run_inspect(const InspectOptions& options, const Common& common);
/// \param has_angle the angle was given
[[nodiscard]] int run_trace_command(TraceOptionsText& text, bool has_angle, const Common& common);
[[nodiscard]] int run_mesh_size(StudyRequest& request, const Common& common);
[[nodiscard]] int run_carry_command(CarryOptionsText& text, const Common& common);
[[nodiscard]] int run_design_command(const DesignRequest& request, const Common& common);
[[nodiscard]] int run_validate(const std::string& name, const Common& common);

}  // namespace meshwind
