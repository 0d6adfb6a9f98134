/// `meshwind carry`: a frame on a robot through a fixed ring head.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "cli/carry_winding.h"
#include "machines/machine.h"
#include "postproc/carried_path.h"
#include "postproc/frame_axis.h"
#include "postproc/krl.h"
#include "postproc/ring_head.h"
#include "postproc/verify.h"

namespace meshwind {

/// The dialect of machines that carry; its programs are no lists of axis blocks (dialect.h).
inline constexpr const char* kCarryDialect = "krl";

/// The paper's frame.
inline constexpr double kTubeRadius_mm = 20.0;

struct CarryRequest {
    /// Table of postproc/frame_axis.h, or a mesh (.stl, .obj, .ply, .off) that is a tube.
    std::filesystem::path axis;
    double unit_mm = 0.0;           ///< of a mesh's lengths; 0: found (mesh/mandrel.h)
    bool from_the_end = false;      ///< of a mesh: TubeAxisOptions
    double bend_turn_deg = 180.0;   ///< of a mesh: keeps longitudinal fibre from bridging in bends
    std::filesystem::path machine;  ///< its eye stands still: the centre of the head
    std::filesystem::path out;
    std::string name = "program";  ///< of the program and its file
    double speed_mm_s = 20.0;      ///< passage of the frame's axis through the head
    double tolerance_mm = 0.2;     ///< of the axis from the centre of the head
    double tolerance_deg = 0.2;    ///< of the frame's turn from what is wanted
    /// None: that of the mesh; of a table kTubeRadius_mm.
    std::optional<double> tube_radius_mm;
    double ring_radius_mm = 40.0;
    double ring_distance_mm = 70.0;
    double clearance_mm = 5.0;           ///< of the frame from bodies on the machine's base
    double angle_deg = 45.0;             ///< wanted of the rings' fibres, one ring to each side
    int tows = 12;                       ///< on each ring
    std::optional<double> tow_width_mm;  ///< none: the narrowest that covers
    CarryWindingOptions winding;
    /// Frame of the axis' table on the robot's flange: x, y, z in mm, a, b, c in deg.
    std::array<double, 6> tool{};
    bool force = false;
};

/// What one ring lays.
struct RingResult {
    double lowest_deg = 0.0;  ///< angle laid where the ring turns at one speed all the way
    double highest_deg = 0.0;
    double slowest_rev_min = 0.0;  ///< speeds that keep the wanted angle
    double fastest_rev_min = 0.0;
};

struct CarryOutcome {
    std::string axis_file;
    std::string axis_digest;
    CarryRequest request;
    double tube_radius_mm = 0.0;
    /// Of a mesh: the frame in which all is told, in the file's; no value for a table.
    std::optional<Eigen::Isometry3d> frame_in_file;
    double tube_residual_mm = 0.0;  ///< of the mesh's vertices from the tube
    Machine machine;
    RingHead head;
    std::size_t stations = 0;
    double length_mm = 0.0;
    CarryPoints points;
    RingFit fit;
    std::vector<CarriedSample> samples;
    CarriedJoints joints;
    TimedPath planned;               ///< why the moves take the time that they take
    KrlProgram program;              ///< as it was read back
    std::vector<double> duration_s;  ///< of its moves
    CarryError program_error;        ///< on its moves
    AxisLoads loads;                 ///< of its moves
    double turns_per_mm = 0.0;       ///< of a ring, for the wanted angle
    std::array<RingResult, 2> ring;  ///< right-handed, left-handed
    double longitudinal_deg = 0.0;   ///< largest lean of fibres along the axis, of the frame's turn
    std::optional<CarryWinding> winding;  ///< none at an angle of 0: the rings stand still
    /// ring, reach, limits, wrist, clearance (with bodies), interpolation, rounding, and those of
    /// `winding`
    std::vector<Check> checks;
    bool written = false;  ///< the programs

    [[nodiscard]] bool passed() const;
    /// Whether a program for the way back belongs to it.
    [[nodiscard]] bool winds_back() const;
    [[nodiscard]] double total_s() const;
};

/// Works everything out, reads the program back from its text, checks it and writes the folder:
/// NAME.src and NAME_back.src (unless all is wound at once) where all checks passed or `force` is
/// set, motion.csv and report.json, with an angle also rings.csv and fibre.csv.
/// \throws InputError carry.*, axis.*, krl.*; IoError; nothing is written then
[[nodiscard]] CarryOutcome run_carry(const CarryRequest& request);

/// Frame on the flange from X,Y,Z,A,B,C. \throws InputError carry.tool
[[nodiscard]] std::array<double, 6> tool_of(const std::string& text);

}  // namespace meshwind
