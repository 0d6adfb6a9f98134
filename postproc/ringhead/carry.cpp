#include "postproc/ringhead/carry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "core/version.h"
#include "postproc/ringhead/carry_checks.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;

constexpr std::size_t kRobotAxes = 6;
constexpr double kMmPerM = 1000.0;
constexpr double kSecondsPerMinute = 60.0;
// The controller's own highest orientation speed: then the path's speed decides.
constexpr double kFreeTurn_deg_s = 400.0;
// A move with less way than this takes its time from its turn: with half of it 1e-6 m/s, the last
// digit of $VEL.CP, would already be a tenth of the speed of a slow passage.
constexpr double kMinWay_mm = 0.01;

[[noreturn]] void fail(const char* code, const std::string& place, const std::string& words) {
    throw InputError(code, place, words);
}

void check_numbers(const CarryRequest& request) {
    const auto positive = [](const char* option, double value) {
        if (!(value > 0.0) || !std::isfinite(value)) {
            fail("carry.not_positive", option, "must be a number above 0");
        }
    };
    positive("--speed", request.speed_mm_s);
    positive("--tolerance", request.tolerance_mm);
    positive("--tolerance-angle", request.tolerance_deg);
    positive("--tube-radius", request.tube_radius_mm.value_or(1.0));
    positive("--ring-radius", request.ring_radius_mm);
    positive("--ring-distance", request.ring_distance_mm);
    positive("--clearance", request.clearance_mm);
    positive("--tow-width", request.tow_width_mm.value_or(1.0));
    positive("--tows", request.tows);
    if (!(request.angle_deg >= 0.0 && request.angle_deg < 90.0)) {
        fail("carry.angle", "--angle",
             "is measured from the frame's axis; give 0 to below 90 degrees");
    }
}

void check_machine(const Machine& machine, const std::string& file) {
    const auto rotary = [](const Axis& axis) { return axis.type == AxisType::Rotary; };
    if (!machine.eye_chain.empty() || machine.mandrel_chain.size() != kRobotAxes ||
        !std::all_of(machine.mandrel_chain.begin(), machine.mandrel_chain.end(), rotary)) {
        fail("carry.machine", file,
             "carrying takes six rotary axes in the mandrel chain and none in the eye chain, as "
             "robot_kr16.json has");
    }
    if (machine.controller.dialect != kCarryDialect) {
        fail("carry.dialect", file + ": /controller/dialect",
             "programs for carrying are written for \"krl\" alone");
    }
}

// Axis values at a sample, for the first move of a program.
std::array<std::int64_t, 6> start_nano(const CarriedJoints& joints, std::size_t sample) {
    std::array<std::int64_t, 6> start{};
    for (std::size_t a = 0; a < start.size(); ++a) {
        constexpr double kSteps = 1e5;  // kKrlAngleDecimals
        constexpr std::int64_t kStep_nano = 10'000;
        start[a] = std::llround(deg_from_rad(joints.path.row(sample)[a]) * kSteps) * kStep_nano;
    }
    return start;
}

void check_speed(const CarryRequest& request, const Machine& machine) {
    const double most_mm_s = machine.fibre.max_speed_mm_s;
    if (request.speed_mm_s > most_mm_s) {
        fail("carry.speed", "--speed",
             "is above the " + fixed(most_mm_s, 1) +
                 " mm/s that the machine's fibre allows; pass more slowly");
    }
}

RingHead ring_head(const EyeHead& eye, const CarryRequest& request) {
    return {eye.position_mm, eye.exit, eye.roller, request.ring_distance_mm,
            request.ring_radius_mm};
}

// Pose of the axis' table on the flange, as the controller will have it: rounded to its digits.
Isometry3d tool_pose(const std::array<double, 6>& tool) {
    Isometry3d pose = Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(tool[0], tool[1], tool[2]);
    pose.linear() =
        EulerZyx{rad_from_deg(tool[3]), rad_from_deg(tool[4]), rad_from_deg(tool[5])}.matrix();
    return pose_of(krl_frame(pose));
}

std::vector<KrlFrame> frames_at(const RingHead& head, const FrameAxis& axis,
                                const std::vector<double>& s_mm) {
    std::vector<KrlFrame> frames;
    frames.reserve(s_mm.size());
    for (const double s : s_mm) {
        frames.push_back(krl_frame(carried_pose(head, axis.at(s))));
    }
    return frames;
}

std::vector<Isometry3d> poses_of(const std::vector<KrlFrame>& frames) {
    std::vector<Isometry3d> poses;
    poses.reserve(frames.size());
    for (const KrlFrame& frame : frames) {
        poses.push_back(pose_of(frame));
    }
    return poses;
}

// A move that takes its time. Way sets it, or where there is next to none the turn.
KrlMove timed_move(const KrlFrame& from, const KrlFrame& to, double time_s, double speed_mm_s) {
    const Isometry3d begin = pose_of(from);
    const Isometry3d end = pose_of(to);
    double path_mm_s = speed_mm_s;
    double turn_deg_s = kFreeTurn_deg_s;
    const double way_mm = (end.translation() - begin.translation()).norm();
    if (way_mm < kMinWay_mm) {
        const SwivelSpin turns = swivel_and_spin(begin, end);
        turn_deg_s = deg_from_rad(std::max(turns.swivel_rad, std::abs(turns.spin_rad))) / time_s;
    } else {
        path_mm_s = way_mm / time_s;
    }
    return {to, krl_path_speed(path_mm_s / kMmPerM), krl_turn_speed(turn_deg_s)};
}

// The moves through all frames. The start is taken at the passage's own speed.
std::vector<KrlMove> timed_moves(const std::vector<KrlFrame>& frames,
                                 const std::vector<double>& step_s, double speed_mm_s) {
    std::vector<KrlMove> moves;
    moves.push_back(
        {frames[0], krl_path_speed(speed_mm_s / kMmPerM), krl_turn_speed(kFreeTurn_deg_s)});
    for (std::size_t i = 1; i < frames.size(); ++i) {
        moves.push_back(timed_move(frames[i - 1], frames[i], step_s[i], speed_mm_s));
    }
    return moves;
}

// The frame while it passes: its moves, from point to point, and their durations.
struct FramePassage {
    const RingHead& head;
    const std::vector<double>& s_mm;  // of the points
    const std::vector<KrlFrame>& frames;
    const std::vector<double>& duration_s;
};

// Speed of the frame's axis in a move, and of the frame's own turn in the head.
double passage_mm_s(const FramePassage& passage, std::size_t move) {
    return (passage.s_mm[move] - passage.s_mm[move - 1]) / passage.duration_s[move];
}

double frame_rad_s(const FramePassage& passage, std::size_t move) {
    return frame_turn_rad(passage.head, pose_of(passage.frames[move - 1]),
                          pose_of(passage.frames[move])) /
           passage.duration_s[move];
}

// Speed of a ring (0: right-handed, 1: left-handed) that lays the wanted angle in a move.
double ring_rad_s(const FramePassage& passage, double turns_per_mm, std::size_t ring,
                  std::size_t move) {
    const double sign = ring == 0 ? 1.0 : -1.0;
    return sign * 2.0 * kPi * turns_per_mm * passage_mm_s(passage, move) +
           frame_rad_s(passage, move);
}

// What both rings do at one wanted angle.
struct RingTurn {
    double tube_radius_mm = 0.0;
    double turns_per_mm = 0.0;  // for the wanted angle
    double speed_mm_s = 0.0;    // wanted passage
};

// Angle that a ring lays in a move where it turns evenly, as for the wanted passage.
double laid_deg(const FramePassage& passage, const RingTurn& turn, std::size_t ring,
                std::size_t move) {
    const double even = (ring == 0 ? 2.0 : -2.0) * kPi * turn.turns_per_mm * turn.speed_mm_s;
    return deg_from_rad(laid_angle_rad(turn.tube_radius_mm, even, frame_rad_s(passage, move),
                                       passage_mm_s(passage, move)));
}

RingResult ring_result(const FramePassage& passage, const RingTurn& turn, std::size_t ring) {
    RingResult found;
    found.lowest_deg = found.slowest_rev_min = std::numeric_limits<double>::infinity();
    found.highest_deg = found.fastest_rev_min = -found.lowest_deg;
    for (std::size_t i = 1; i < passage.frames.size(); ++i) {
        const double rev_min =
            ring_rad_s(passage, turn.turns_per_mm, ring, i) / (2.0 * kPi) * kSecondsPerMinute;
        const double angle_deg = laid_deg(passage, turn, ring, i);
        found.lowest_deg = std::min(found.lowest_deg, angle_deg);
        found.highest_deg = std::max(found.highest_deg, angle_deg);
        found.slowest_rev_min = std::min(found.slowest_rev_min, rev_min);
        found.fastest_rev_min = std::max(found.fastest_rev_min, rev_min);
    }
    return found;
}

// Largest lean of fibres along the axis, of the frame's own turn.
double longitudinal_deg(const FramePassage& passage, double tube_radius_mm) {
    double most_deg = 0.0;
    for (std::size_t i = 1; i < passage.frames.size(); ++i) {
        const double lean =
            laid_angle_rad(tube_radius_mm, 0.0, frame_rad_s(passage, i), passage_mm_s(passage, i));
        most_deg = std::max(most_deg, deg_from_rad(std::abs(lean)));
    }
    return most_deg;
}

// \param planned the program before it was written
std::vector<Check> motion_checks(const CarryOutcome& result, const KrlProgram& planned,
                                 const CarriedMovesError& error) {
    const CarryRequest& request = result.request;
    const FrameAxis& axis = result.axis.axis;
    const std::vector<double>& s_mm = result.points.s_mm;
    std::vector<Check> checks;
    checks.push_back(ring_fit_check(result.fit, request.ring_radius_mm));
    checks.push_back(pose_reach_check(result.joints, result.samples));
    checks.push_back(
        carried_limits_check(result.machine, result.joints, result.samples, result.loads, s_mm));
    checks.push_back(wrist_flip_check(result.joints, result.samples));
    const auto clearance =
        frame_clearance(result.machine, axis, result.samples, result.tube_radius_mm);
    if (clearance) {
        checks.push_back(frame_clearance_check(*clearance, result.samples, request.clearance_mm));
    }
    checks.push_back(interpolation_error_check(error, request));
    checks.push_back(krl_rounding_check(
        result.program == planned, carried_points_error(result.head, axis, s_mm, result.program)));
    return checks;
}

// The fibres that the written programs lay; none at an angle of 0.
std::optional<CarryWinding> laid_fibres(const CarryOutcome& result, const std::string& text,
                                        const KrlProgram& back) {
    const CarryRequest& request = result.request;
    if (!(request.angle_deg > 0.0)) {
        return {};
    }
    const CarryWindingTask task{result.head,
                                result.axis.axis,
                                result.points.s_mm,
                                text,
                                result.winds_back() ? write_krl(back, {}) : "",
                                result.tube_radius_mm,
                                rad_from_deg(request.angle_deg),
                                request.tows,
                                request.tow_width_mm.value_or(0.0)};
    return wind_carried(task, request.winding);
}

// Comments at the head of a program, with the checks that failed.
std::vector<std::string> head_lines(const CarryOutcome& result) {
    const CarryRequest& request = result.request;
    std::vector<std::string> lines = {
        std::string("meshwind ") + kVersion,
        "axis: " + result.axis.file,
        "axis sha256 " + result.axis.digest,
        "machine: " + result.machine.name,
        "length: " + fixed(result.length_mm, 3) + " mm",
        "time: " + fixed(result.total_s(), 1) + " s",
        "moves: " + std::to_string(result.points.s_mm.size()),
        "passage: " + fixed(request.speed_mm_s, 3) + " mm/s",
        "rings: " + fixed(result.turns_per_mm * request.speed_mm_s * kSecondsPerMinute, 4) +
            " rev/min each way for " + fixed(request.angle_deg, 2) + " deg on radius " +
            fixed(result.tube_radius_mm, 3) + " mm"};
    for (const Check& failed : result.checks) {
        if (!failed.ok) {
            lines.push_back("FAILED check " + failed.name + ": " + failed.words);
        }
    }
    return lines;
}

std::string motion_table(const CarryOutcome& result, const FramePassage& passage) {
    std::string text =
        "sample,move,time_s,s_mm,A1,A2,A3,A4,A5,A6,x_mm,y_mm,z_mm,a_deg,b_deg,c_deg,"
        "passage_mm_s,ring1_rev_min,ring2_rev_min\n";
    const auto append = [&](double value, int decimals) {
        text += ',';
        append_fixed(text, value, decimals);
    };
    std::optional<EulerZyx> angles;
    double before_s = 0.0;
    std::size_t move = 0;
    for (std::size_t i = 0; i < result.samples.size(); ++i) {
        const CarriedSample& sample = result.samples[i];
        before_s += sample.move == move ? 0.0 : passage.duration_s[move];
        move = sample.move;
        text += std::to_string(i) + ',' + std::to_string(move);
        append(before_s + sample.share * passage.duration_s[move], 6);
        append(sample.s_mm, 4);
        for (const double joint : result.joints.path.row(i)) {
            append(deg_from_rad(joint), 5);
        }
        for (const double length : sample.pose.translation()) {
            append(length, 4);
        }
        angles = euler_zyx(sample.pose.linear(), angles);
        for (const double angle : {angles->a_rad, angles->b_rad, angles->c_rad}) {
            append(deg_from_rad(angle), 5);
        }
        const std::size_t into = std::max<std::size_t>(move, 1);
        append(passage_mm_s(passage, into), 4);
        for (const std::size_t ring : {0U, 1U}) {
            append(ring_rad_s(passage, result.turns_per_mm, ring, into) / (2.0 * kPi) *
                       kSecondsPerMinute,
                   5);
        }
        text += '\n';
    }
    return text;
}

// What was asked for, and the sizes that follow from it alone.
CarryOutcome begun(CarryAxis&& axis, const Machine& machine, const CarryRequest& request) {
    CarryOutcome result(std::move(axis));
    result.machine = machine;
    result.request = request;
    result.tube_radius_mm =
        request.tube_radius_mm.value_or(result.axis.radius_mm.value_or(kTubeRadius_mm));
    result.stations = result.axis.axis.stations().size();
    result.length_mm = result.axis.axis.length_mm();
    result.head = ring_head(machine.eye, request);
    result.turns_per_mm = ring_turns_per_mm(rad_from_deg(request.angle_deg), result.tube_radius_mm);
    return result;
}

}  // namespace

bool CarryOutcome::passed() const {
    return std::all_of(checks.begin(), checks.end(), [](const Check& check) { return check.ok; });
}

bool CarryOutcome::winds_back() const {
    return request.angle_deg > 0.0 && !request.winding.at_once;
}

double CarryOutcome::total_s() const {
    double total = 0.0;
    for (const double step : duration_s) {
        total += step;
    }
    return total;
}

CarryOutcome carry(CarryAxis axis, const Machine& machine, const CarryRequest& request,
                   const std::string& machine_file) {
    check_numbers(request);
    check_machine(machine, machine_file);
    check_speed(request, machine);
    CarryOutcome result = begun(std::move(axis), machine, request);
    const FrameAxis& along = result.axis.axis;

    const Isometry3d tool = tool_pose(request.tool);
    result.fit = worst_ring_fit(result.head, along, result.tube_radius_mm);
    result.points = choose_carry_points(
        result.head, along, {request.tolerance_mm, rad_from_deg(request.tolerance_deg)});
    const std::vector<double>& s_mm = result.points.s_mm;
    const std::vector<KrlFrame> frames = frames_at(result.head, along, s_mm);
    result.samples = sample_moves(s_mm, poses_of(frames));
    result.joints = follow_samples(machine, result.samples, tool);
    result.planned = time_moves(machine, result.samples, result.joints, request.speed_mm_s);

    const KrlProgram forth{request.name, krl_frame(Isometry3d::Identity()), krl_frame(tool),
                           start_nano(result.joints, 0),
                           timed_moves(frames, result.planned.step_s, request.speed_mm_s)};
    result.duration_s = durations_s(forth);
    const std::vector<std::string>& header = machine.controller.header;
    const std::string plain_text = write_krl(forth, {}, header);
    result.program = read_krl(plain_text, forth.name + kKrlExtension);
    const KrlProgram back = back_program(forth, carried_back(forth.name),
                                         start_nano(result.joints, result.samples.size() - 1));

    const FramePassage passage{result.head, s_mm, frames, result.duration_s};
    const RingTurn turn{result.tube_radius_mm, result.turns_per_mm, request.speed_mm_s};
    for (std::size_t ring = 0; ring < result.ring.size(); ++ring) {
        result.ring[ring] = ring_result(passage, turn, ring);
    }
    result.longitudinal_deg = longitudinal_deg(passage, result.tube_radius_mm);

    result.loads = move_loads(machine, result.samples, result.joints, result.duration_s);
    const CarriedMovesError error =
        carried_moves_error(result.head, along, s_mm, result.program, request);
    result.program_error = error.largest;
    result.checks = motion_checks(result, forth, error);
    result.winding = laid_fibres(result, plain_text, back);
    if (result.winding) {
        result.checks.insert(result.checks.end(), result.winding->checks.begin(),
                             result.winding->checks.end());
    }

    result.usable = result.passed() || request.force;
    result.text = write_krl(forth, head_lines(result), header);
    result.back_text = result.winds_back() ? write_krl(back, head_lines(result), header) : "";
    result.motion = motion_table(result, passage);
    return result;
}

std::array<double, 6> tool_of(const std::string& text) {
    std::array<double, 6> tool{};
    std::istringstream in(text);
    bool ok = true;
    for (std::size_t i = 0; i < tool.size(); ++i) {
        char comma = ',';
        if (i > 0) {
            in >> comma;
        }
        ok = ok && comma == ',' && static_cast<bool>(in >> tool[i]) && std::isfinite(tool[i]);
    }
    std::string rest;
    if (!ok || in >> rest) {
        fail("carry.tool", "--tool",
             "'" + text +
                 "' is not six numbers; write X,Y,Z in mm and A,B,C in degrees without "
                 "blanks");
    }
    return tool;
}

}  // namespace meshwind
