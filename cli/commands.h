/// The commands of the command line: arguments in, summary or JSON and exit code out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/exit_codes.h"
#include "pipeline/trace_table.h"
#include "postproc/ringhead/carry.h"
#include "report/picture/preview.h"
#include "study/mesh_size.h"
#include "winding/vessel/vessel_table.h"

namespace meshwind {

/// Options of every command.
struct Common {
    int threads = 0;         ///< 0: one per core
    std::uint64_t seed = 1;  ///< of every random draw
    bool quiet = false;
    bool verbose = false;
    bool json = false;
    bool force = false;
    std::string units;  ///< auto, um, mm, cm, m, in; empty: auto
};

/// A job file, and the values that override it.
struct JobArguments {
    std::string file;                   ///< empty: the defaults
    std::vector<std::string> profiles;  ///< files of materials and processes, below the job
    std::vector<std::string> settings;  ///< "tow.width=8"
    std::string program, text;          ///< job of a program's head, JSON, where no file is given
};

struct WindArguments {
    std::string mandrel;
    std::string machine = "six_axis.json";
    JobArguments job;
    std::string out = "meshwind-out";
    double effort = 1.0;
    PreviewOptions png;
};

/// Imported landing points.
struct PostArguments {
    std::string points, mandrel, machine;
    JobArguments job;
    std::string frame = "file";  ///< "file" or "mandrel"
    std::string out = "meshwind-out";
    double within_mm = 1.0;  ///< > 0; a coarse mesh of the same part is nearer than that
    int circuits = 1;
    double turn_deg = 0.0;
    double smooth_mm = 0.0;
    PreviewOptions png;
};

struct DesignArguments {
    DesignRequest request;
    std::string out;  ///< empty: no mesh and no job
};

// The schemas that `validate --schema` prints.
inline constexpr const char* kJobSchema = "job";
inline constexpr const char* kMachineSchema = "machine";
inline constexpr const char* kReportSchema = "report";
inline constexpr const char* kLayupSchema = "layup";

struct ValidateArguments {
    std::string file;
    std::string schema;  ///< schema to print instead; empty: none
};

struct InspectArguments {
    std::string mandrel;
    JobArguments job;  ///< only its mandrel is read
    std::optional<double> refine_mm;
    std::string out, page;
};

struct TraceArguments {
    std::string mandrel, start, direction, to, frame = "mandrel", method = "patches";
    std::string out;
    std::optional<double> angle_deg;
    TraceRequest request;
};

struct StudyArguments {
    /// cylinder, torus, ellipsoid, tee or a file; empty: the four
    std::vector<std::string> mandrels;
    std::vector<double> radii_mm{kStudyRadii_mm.begin(),
                                 kStudyRadii_mm.end()};  ///< of the cylinders
    MeshSizeOptions options;
    std::string out;
};

struct CarryArguments {
    std::string axis, machine = "robot_kr16.json", out = "meshwind-out", tool = "0,0,0,0,0,0";
    bool from_the_end = false;     ///< of a mesh: TubeAxisOptions
    double bend_turn_deg = 180.0;  ///< of a mesh: keeps longitudinal fibre from bridging in bends
    CarryRequest request;
};

/// Each runs one command: files are looked up as find_input() does, summary or JSON go to stdout,
/// progress and a line for each failed check to stderr. Return the exit code.
/// \throws Error for input that cannot be used
[[nodiscard]] int run_wind(const WindArguments& arguments, const Common& common);
[[nodiscard]] int run_post(const PostArguments& arguments, const Common& common);
[[nodiscard]] int run_inspect(const InspectArguments& arguments, const Common& common);
[[nodiscard]] int run_trace_command(TraceArguments& arguments, const Common& common);
[[nodiscard]] int run_mesh_size(StudyArguments& arguments, const Common& common);
[[nodiscard]] int run_carry_command(CarryArguments& arguments, const Common& common);
[[nodiscard]] int run_design_command(const DesignArguments& arguments, const Common& common);
/// Lists the machines that come with the program.
[[nodiscard]] int run_machines(const Common& common);

/// Lists the materials and processes that come with the program, with their contents.
[[nodiscard]] int run_profiles(const Common& common);
[[nodiscard]] int run_validate(const ValidateArguments& arguments, const Common& common);

}  // namespace meshwind
