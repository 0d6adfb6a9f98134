#include "postproc/ringhead/carry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "core/version.h"
#include "postproc/verify/check_kinds.h"

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
constexpr double kLeastWay_mm = 0.01;
// Rounding to a program's digits moves no axis by more.
constexpr double kRounded_mm = 1e-3;
constexpr double kRounded_deg = 1e-4;
// Loads are compared with 1; speeds are rounded up by at most a millionth m/s in a slow move.
constexpr double kLoadSlack = 1e-3;

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

class Carrier {
public:
    Carrier(CarryAxis&& axis, const Machine& machine, const CarryRequest& request)
        : result_(std::move(axis)) {
        result_.machine = machine;
        result_.request = request;
    }

    CarryOutcome run(const std::string& machine_file) {
        prepare(machine_file);
        plan();
        make_program();
        wind();
        check();
        lay_fibres();
        put_texts();
        return std::move(result_);
    }

private:
    void prepare(const std::string& machine_file) {
        const CarryRequest& request = result_.request;
        check_numbers(request);
        result_.tube_radius_mm =
            request.tube_radius_mm.value_or(result_.axis.radius_mm.value_or(kTubeRadius_mm));
        result_.stations = axis_.stations().size();
        result_.length_mm = axis_.length_mm();
        check_machine(result_.machine, machine_file);
        const double most_mm_s = result_.machine.fibre.max_speed_mm_s;
        if (request.speed_mm_s > most_mm_s) {
            fail("carry.speed", "--speed",
                 "is above the " + fixed(most_mm_s, 1) +
                     " mm/s that the machine's fibre allows; pass more slowly");
        }
        const EyeHead& eye = result_.machine.eye;
        result_.head = {eye.position_mm, eye.exit, eye.roller, request.ring_distance_mm,
                        request.ring_radius_mm};
        const auto& t = request.tool;
        tool_.translation() = Eigen::Vector3d(t[0], t[1], t[2]);
        tool_.linear() =
            EulerZyx{rad_from_deg(t[3]), rad_from_deg(t[4]), rad_from_deg(t[5])}.matrix();
        tool_ = pose_of(krl_frame(tool_));  // what the controller will use
    }

    void plan() {
        const CarryRequest& request = result_.request;
        const CarryTolerance tolerance{request.tolerance_mm, rad_from_deg(request.tolerance_deg)};
        result_.fit = worst_ring_fit(result_.head, axis_, result_.tube_radius_mm);
        result_.points = choose_carry_points(result_.head, axis_, tolerance);
        std::vector<Isometry3d> poses;
        for (const double s : result_.points.s_mm) {
            frames_.push_back(krl_frame(carried_pose(result_.head, axis_.at(s))));
            poses.push_back(pose_of(frames_.back()));
        }
        result_.samples = sample_moves(result_.points.s_mm, poses);
        result_.joints = follow_samples(result_.machine, result_.samples, tool_);
        result_.planned =
            time_moves(result_.machine, result_.samples, result_.joints, request.speed_mm_s);
    }

    void make_program() {
        planned_.name = result_.request.name;
        planned_.base = krl_frame(Isometry3d::Identity());
        planned_.tool = krl_frame(tool_);
        planned_.start_nano = start_nano(result_.joints, 0);
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            // The start is taken at the passage's own speed.
            double path_mm_s = result_.request.speed_mm_s;
            double turn_deg_s = kFreeTurn_deg_s;
            if (i > 0) {
                const Isometry3d from = pose_of(frames_[i - 1]);
                const Isometry3d to = pose_of(frames_[i]);
                const double way_mm = (to.translation() - from.translation()).norm();
                const double time_s = result_.planned.step_s[i];
                if (way_mm < kLeastWay_mm) {
                    const SwivelSpin turns = swivel_and_spin(from, to);
                    turn_deg_s =
                        deg_from_rad(std::max(turns.swivel_rad, std::abs(turns.spin_rad))) / time_s;
                } else {
                    path_mm_s = way_mm / time_s;
                }
            }
            planned_.moves.push_back(
                {frames_[i], krl_path_speed(path_mm_s / kMmPerM), krl_turn_speed(turn_deg_s)});
        }
        result_.duration_s = durations_s(planned_);
        text_ = write_krl(planned_, {}, result_.machine.controller.header);
        result_.program = read_krl(text_, planned_.name + kKrlExtension);
        back_ = back_program(planned_, carried_back(planned_.name),
                             start_nano(result_.joints, result_.samples.size() - 1));
    }

    void lay_fibres() {
        const CarryRequest& request = result_.request;
        if (!(request.angle_deg > 0.0)) {
            return;
        }
        const CarryWindingTask task{result_.head,
                                    axis_,
                                    result_.points.s_mm,
                                    text_,
                                    result_.winds_back() ? write_krl(back_, {}) : "",
                                    result_.tube_radius_mm,
                                    rad_from_deg(request.angle_deg),
                                    request.tows,
                                    request.tow_width_mm.value_or(0.0)};
        result_.winding = wind_carried(task, request.winding);
        result_.checks.insert(result_.checks.end(), result_.winding->checks.begin(),
                              result_.winding->checks.end());
    }

    // Speed of the frame's axis in a move, and of the frame's own turn in the head.
    [[nodiscard]] double passage_mm_s(std::size_t move) const {
        const std::vector<double>& s = result_.points.s_mm;
        return (s[move] - s[move - 1]) / result_.duration_s[move];
    }

    [[nodiscard]] double frame_rad_s(std::size_t move) const {
        return frame_turn_rad(result_.head, pose_of(frames_[move - 1]), pose_of(frames_[move])) /
               result_.duration_s[move];
    }

    // Speed of a ring (0: right-handed, 1: left-handed) that lays the wanted angle in a move.
    [[nodiscard]] double ring_rad_s(std::size_t ring, std::size_t move) const {
        const double sign = ring == 0 ? 1.0 : -1.0;
        return sign * 2.0 * kPi * result_.turns_per_mm * passage_mm_s(move) + frame_rad_s(move);
    }

    // Angle that a ring lays in a move where it turns evenly, as for the wanted passage.
    [[nodiscard]] double laid_deg(std::size_t ring, std::size_t move) const {
        const CarryRequest& request = result_.request;
        const double even =
            (ring == 0 ? 2.0 : -2.0) * kPi * result_.turns_per_mm * request.speed_mm_s;
        return deg_from_rad(
            laid_angle_rad(result_.tube_radius_mm, even, frame_rad_s(move), passage_mm_s(move)));
    }

    void wind() {
        const CarryRequest& request = result_.request;
        result_.turns_per_mm =
            ring_turns_per_mm(rad_from_deg(request.angle_deg), result_.tube_radius_mm);
        for (std::size_t ring = 0; ring < result_.ring.size(); ++ring) {
            RingResult& found = result_.ring[ring];
            found.lowest_deg = found.slowest_rev_min = std::numeric_limits<double>::infinity();
            found.highest_deg = found.fastest_rev_min = -found.lowest_deg;
            for (std::size_t i = 1; i < frames_.size(); ++i) {
                const double rev_min = ring_rad_s(ring, i) / (2.0 * kPi) * kSecondsPerMinute;
                found.lowest_deg = std::min(found.lowest_deg, laid_deg(ring, i));
                found.highest_deg = std::max(found.highest_deg, laid_deg(ring, i));
                found.slowest_rev_min = std::min(found.slowest_rev_min, rev_min);
                found.fastest_rev_min = std::max(found.fastest_rev_min, rev_min);
            }
        }
        for (std::size_t i = 1; i < frames_.size(); ++i) {
            const double lean =
                laid_angle_rad(result_.tube_radius_mm, 0.0, frame_rad_s(i), passage_mm_s(i));
            result_.longitudinal_deg =
                std::max(result_.longitudinal_deg, deg_from_rad(std::abs(lean)));
        }
    }

    void check() {
        check_ring();
        check_reach();
        check_limits();
        check_wrist();
        check_clearance();
        check_interpolation();
        check_rounding();
    }

    [[nodiscard]] std::string at(double s_mm) const { return " at " + fixed(s_mm, 1) + " mm"; }
    [[nodiscard]] std::string at_sample(std::size_t i) const { return at(result_.samples[i].s_mm); }

    void add(const CheckKind& kind, bool ok, const std::string& words,
             std::map<std::string, double> numbers) {
        result_.checks.emplace_back(kind, ok, ok ? "" : words, std::move(numbers));
    }

    void check_ring() {
        const RingFit& fit = result_.fit;
        const double limit_mm = result_.request.ring_radius_mm;
        const std::string words =
            fit.through ? "the frame reaches " + fixed(fit.reach_mm, 2) +
                              " mm from the centre of a ring of " + fixed(limit_mm, 2) +
                              " mm while its axis" + at(fit.s_mm) + " is in the head"
                        : "the frame turns back inside the head while its axis" + at(fit.s_mm) +
                              " is in the middle; the bend is too tight for this head";
        add(check_kind::kRing, fit.through && fit.reach_mm < limit_mm, words,
            {{"reach_mm", fit.reach_mm},
             {"limit_mm", limit_mm},
             {"offset_mm", fit.offset_mm},
             {"tilt_deg", deg_from_rad(fit.tilt_rad)}});
    }

    void check_reach() {
        const CarriedJoints& joints = result_.joints;
        add(check_kind::kReach, joints.reached(),
            "the robot stays " + fixed(joints.residual_mm, 3) + " mm and " +
                fixed(deg_from_rad(joints.residual_rad), 3) + " deg short" +
                at_sample(joints.residual_at) + " of the axis; mount the frame in another way",
            {{"short_mm", joints.residual_mm}, {"short_deg", deg_from_rad(joints.residual_rad)}});
    }

    // The axis that is furthest beyond its travel, in words.
    [[nodiscard]] std::string travel_words() const {
        double most = 0.0;
        std::string words;
        for (const LimitViolation& run : result_.joints.path.violations) {
            const double beyond = std::abs(run.value - run.limit);
            if (beyond > most) {
                most = beyond;
                words = "A" + std::to_string(result_.machine.joint_of(run.axis).value() + 1) +
                        " goes to " + fixed(deg_from_rad(run.value), 2) + " deg" +
                        at_sample(run.point) + " of the axis, " + fixed(deg_from_rad(beyond), 2) +
                        " deg beyond its end; mount the frame in another way";
            }
        }
        return words;
    }

    void check_limits() {
        result_.loads =
            move_loads(result_.machine, result_.samples, result_.joints, result_.duration_s);
        const AxisLoads& loads = result_.loads;
        std::string words = travel_words();
        for (const auto& [name, load] : {std::pair("velocity", loads.velocity),
                                         std::pair("acceleration", loads.acceleration)}) {
            if (words.empty() && load.ratio > 1.0 + kLoadSlack) {
                words = "A" + std::to_string(load.joint + 1) + " needs " + fixed(load.ratio, 3) +
                        " times its " + name + at(result_.points.s_mm[load.step]) +
                        " of the axis; pass more slowly";
            }
        }
        add(check_kind::kLimits, words.empty(), words,
            {{"travel_violations", static_cast<double>(result_.joints.path.violations.size())},
             {"velocity_ratio", loads.velocity.ratio},
             {"acceleration_ratio", loads.acceleration.ratio}});
    }

    void check_wrist() {
        const CarriedJoints& joints = result_.joints;
        add(check_kind::kWrist, joints.flips == 0,
            "an axis jumps by more than a quarter turn" + at_sample(joints.first_flip) +
                " of the axis; mount the frame in another way",
            {{"flips", static_cast<double>(joints.flips)}, {"least_singular", joints.singular}});
    }

    void check_clearance() {
        const CarryRequest& request = result_.request;
        const auto found =
            frame_clearance(result_.machine, axis_, result_.samples, result_.tube_radius_mm);
        if (!found) {
            return;
        }
        add(check_kind::kClearance, found->least_mm >= request.clearance_mm,
            "the frame comes within " + fixed(found->least_mm, 2) + " mm of body " +
                std::to_string(found->body + 1) + " of the machine file" +
                at_sample(found->sample) + " of the axis; mount the frame in another way",
            {{"least_mm", found->least_mm}, {"limit_mm", request.clearance_mm}});
    }

    // Of the frames that were read back, not of those that were planned.
    void check_interpolation() {
        const CarryRequest& request = result_.request;
        const std::vector<double>& s = result_.points.s_mm;
        CarryError& worst = result_.program_error;
        double worst_share = 0.0;
        double worst_s_mm = 0.0;
        for (std::size_t i = 1; i < s.size(); ++i) {
            const CarryError error = lin_error(result_.head, axis_, s[i - 1], s[i],
                                               pose_of(result_.program.moves[i - 1].to),
                                               pose_of(result_.program.moves[i].to));
            const double share = std::max(error.distance_mm / request.tolerance_mm,
                                          deg_from_rad(error.turn_rad) / request.tolerance_deg);
            if (share > worst_share) {
                worst_share = share;
                worst_s_mm = s[i - 1];
            }
            worst.distance_mm = std::max(worst.distance_mm, error.distance_mm);
            worst.tilt_rad = std::max(worst.tilt_rad, error.tilt_rad);
            worst.turn_rad = std::max(worst.turn_rad, error.turn_rad);
        }
        add(check_kind::kInterpolation, worst_share <= 1.0,
            "between two points the axis leaves the centre by up to " +
                fixed(worst.distance_mm, 4) + " mm and turns by up to " +
                fixed(deg_from_rad(worst.turn_rad), 4) + " deg, worst" + at(worst_s_mm) +
                ", and shorter moves do not help; smooth the axis there",
            {{"distance_mm", worst.distance_mm},
             {"limit_mm", request.tolerance_mm},
             {"tilt_deg", deg_from_rad(worst.tilt_rad)},
             {"turn_deg", deg_from_rad(worst.turn_rad)},
             {"limit_deg", request.tolerance_deg}});
    }

    void check_rounding() {
        CarryError worst;
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            const CarryError error = carry_error(result_.head, pose_of(result_.program.moves[i].to),
                                                 axis_.at(result_.points.s_mm[i]));
            worst.distance_mm = std::max(worst.distance_mm, error.distance_mm);
            worst.turn_rad = std::max(worst.turn_rad, error.turn_rad);
        }
        const bool ok = result_.program == planned_ && worst.distance_mm <= kRounded_mm &&
                        deg_from_rad(worst.turn_rad) <= kRounded_deg;
        add(check_kind::kRounding, ok,
            "the program that is read back is up to " + fixed(worst.distance_mm, 6) + " mm and " +
                fixed(deg_from_rad(worst.turn_rad), 6) + " deg off at its points",
            {{"worst_mm", worst.distance_mm}, {"worst_deg", deg_from_rad(worst.turn_rad)}});
    }

    [[nodiscard]] std::vector<std::string> comments() const {
        const CarryRequest& request = result_.request;
        std::vector<std::string> lines = {
            std::string("meshwind ") + kVersion,
            "axis: " + result_.axis.file,
            "axis sha256 " + result_.axis.digest,
            "machine: " + result_.machine.name,
            "length: " + fixed(result_.length_mm, 3) + " mm",
            "time: " + fixed(result_.total_s(), 1) + " s",
            "moves: " + std::to_string(frames_.size()),
            "passage: " + fixed(request.speed_mm_s, 3) + " mm/s",
            "rings: " + fixed(result_.turns_per_mm * request.speed_mm_s * kSecondsPerMinute, 4) +
                " rev/min each way for " + fixed(request.angle_deg, 2) + " deg on radius " +
                fixed(result_.tube_radius_mm, 3) + " mm"};
        for (const Check& failed : result_.checks) {
            if (!failed.ok) {
                lines.push_back("FAILED check " + failed.name + ": " + failed.words);
            }
        }
        return lines;
    }

    [[nodiscard]] std::string motion_csv() const {
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
        for (std::size_t i = 0; i < result_.samples.size(); ++i) {
            const CarriedSample& sample = result_.samples[i];
            before_s += sample.move == move ? 0.0 : result_.duration_s[move];
            move = sample.move;
            text += std::to_string(i) + ',' + std::to_string(move);
            append(before_s + sample.share * result_.duration_s[move], 6);
            append(sample.s_mm, 4);
            for (const double joint : result_.joints.path.row(i)) {
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
            append(passage_mm_s(into), 4);
            for (const std::size_t ring : {0U, 1U}) {
                append(ring_rad_s(ring, into) / (2.0 * kPi) * kSecondsPerMinute, 5);
            }
            text += '\n';
        }
        return text;
    }

    // With what failed in their heads.
    void put_texts() {
        result_.usable = result_.passed() || result_.request.force;
        const std::vector<std::string>& header = result_.machine.controller.header;
        result_.text = write_krl(planned_, comments(), header);
        if (result_.winds_back()) {
            result_.back_text = write_krl(back_, comments(), header);
        }
        result_.motion = motion_csv();
    }

    CarryOutcome result_;
    const FrameAxis& axis_ = result_.axis.axis;
    Isometry3d tool_ = Isometry3d::Identity();
    std::vector<KrlFrame> frames_;  ///< of the points
    KrlProgram planned_;
    KrlProgram back_;  ///< the same moves the other way
    std::string text_;
};

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
    return Carrier(std::move(axis), machine, request).run(machine_file);
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
