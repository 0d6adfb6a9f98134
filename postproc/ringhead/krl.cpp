#include "postproc/ringhead/krl.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/text/decimal_text.h"
#include "core/units.h"
#include "postproc/motion/block.h"
#include "postproc/ringhead/ring_head.h"

namespace meshwind {
namespace {

constexpr std::int64_t kLengthStep_nano = 100'000;     // 1e-4 mm
constexpr std::int64_t kAngleStep_nano = 10'000;       // 1e-5 deg
constexpr std::int64_t kPathSpeedStep_nano = 1'000;    // 1e-6 m/s
constexpr std::int64_t kTurnSpeedStep_nano = 100'000;  // 1e-4 deg/s
constexpr int kPathSpeedDecimals = 6;
constexpr int kTurnSpeedDecimals = 4;
constexpr double kFarthest_mm = 1e6;
constexpr std::size_t kLongestName = 24;
constexpr double kMmPerM = 1000.0;

constexpr std::array<std::string_view, 6> kFrameNames = {"X", "Y", "Z", "A", "B", "C"};
constexpr std::array<std::string_view, 6> kAxisNames = {"A1", "A2", "A3", "A4", "A5", "A6"};

// The lines that write_krl puts before the first move and that the reader asks for as they are.
constexpr std::string_view kInit = "BAS(#INITMOV,0)";
constexpr std::string_view kAdvance = "$ADVANCE=3";
constexpr std::string_view kOrientation = "$ORI_TYPE=#VAR";
constexpr std::string_view kApproximation = "$APO.CDIS=0.5000";
constexpr std::string_view kPathSpeed = "$VEL.CP=";
constexpr std::string_view kSwivelSpeed = "$VEL.ORI1=";
constexpr std::string_view kSpinSpeed = "$VEL.ORI2=";

std::int64_t rounded_nano(double value, std::int64_t step_nano) {
    const double steps = value * static_cast<double>(kNanoPerUnit) / static_cast<double>(step_nano);
    return std::llround(steps) * step_nano;
}

std::int64_t up_nano(double value, std::int64_t step_nano) {
    const double steps = value * static_cast<double>(kNanoPerUnit) / static_cast<double>(step_nano);
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(steps))) * step_nano;
}

double value_of(std::int64_t nano) {
    return static_cast<double>(nano) / static_cast<double>(kNanoPerUnit);
}

int frame_decimals(std::size_t component) {
    return component < 3 ? kKrlLengthDecimals : kKrlAngleDecimals;
}

int axis_decimals(std::size_t /*axis*/) {
    return kKrlAngleDecimals;
}

using DecimalsOf = int (*)(std::size_t);

void append_aggregate(std::string& text, const std::array<std::string_view, 6>& names,
                      const std::array<std::int64_t, 6>& nano, DecimalsOf decimals) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        text += i == 0 ? '{' : ',';
        text += names[i];
        text += ' ';
        append_nano(text, nano[i], decimals(i));
    }
    text += '}';
}

void append_frame(std::string& text, std::string_view before, const KrlFrame& frame) {
    text += before;
    append_aggregate(text, kFrameNames, frame.nano, frame_decimals);
}

// The moves, each with the speeds that change before it.
void append_moves(std::string& text, const KrlProgram& program) {
    std::int64_t path = 0;
    std::int64_t turn = 0;
    for (std::size_t i = 0; i < program.moves.size(); ++i) {
        const KrlMove& move = program.moves[i];
        if (move.path_nano_m_s != path) {
            path = move.path_nano_m_s;
            text += kPathSpeed;
            append_nano(text, path, kPathSpeedDecimals);
            text += '\n';
        }
        if (move.turn_nano_deg_s != turn) {
            turn = move.turn_nano_deg_s;
            for (const std::string_view name : {kSwivelSpeed, kSpinSpeed}) {
                text += name;
                append_nano(text, turn, kTurnSpeedDecimals);
                text += '\n';
            }
        }
        append_frame(text, "LIN ", move.to);
        text += i == 0 || i + 1 == program.moves.size() ? "\n" : " C_DIS\n";
        if (i == 0) {
            text += "; tie the fibre on, then start again; the rings turn from here on\nHALT\n";
        }
    }
}

bool is_name(const std::string& name) {
    const auto letter = [](unsigned char c) { return std::isalpha(c) != 0 && c < 128; };
    return !name.empty() && name.size() <= kLongestName &&
           letter(static_cast<unsigned char>(name.front())) &&
           std::all_of(name.begin(), name.end(), [&](unsigned char c) {
               return letter(c) || (c >= '0' && c <= '9') || c == '_';
           });
}

void append_comment(std::string& text, const std::string& comment) {
    text += "; ";
    for (const char c : comment) {
        text += c >= ' ' && c <= '~' ? c : '?';
    }
    text += '\n';
}

// The lines of a program that are neither empty nor comments, each taken word by word.
class KrlLines {
public:
    KrlLines(std::string_view text, std::string file) : rest_(text), file_(std::move(file)) {}

    // Goes to the next line; false at the end.
    bool next() {
        while (!rest_.empty()) {
            const std::size_t end = std::min(rest_.find('\n'), rest_.size());
            words_ = rest_.substr(0, end);
            rest_.remove_prefix(std::min(end + 1, rest_.size()));
            ++line_;
            while (!words_.empty() && (words_.back() == '\r' || words_.back() == ' ')) {
                words_.remove_suffix(1);
            }
            if (!words_.empty() && words_.front() != ';') {
                return true;
            }
        }
        return false;
    }

    void need() {
        if (!next()) {
            fail("krl.no_end", "the program ends here; it may be cut off: write it again");
        }
    }

    // What the line begins with; false where it does not.
    bool take(std::string_view start) {
        if (words_.substr(0, start.size()) != start) {
            return false;
        }
        words_.remove_prefix(start.size());
        return true;
    }

    // Up to one of the characters, or to the end.
    std::string_view take_until(const char* characters) {
        const std::size_t end = std::min(words_.find_first_of(characters), words_.size());
        const std::string_view taken = words_.substr(0, end);
        words_.remove_prefix(end);
        return taken;
    }

    // What is left of the line.
    [[nodiscard]] std::string_view words() const { return words_; }
    [[nodiscard]] std::int32_t line() const { return line_; }

    [[noreturn]] void not_understood(std::string_view found, const std::string& wanted) const {
        fail("krl.not_understood",
             "'" + std::string(found) + "' is not read back; there may be " + wanted);
    }

    [[noreturn]] void fail(const char* code, const std::string& words) const {
        throw InputError(code, file_ + ":" + std::to_string(line_), words);
    }

private:
    std::string_view rest_;
    std::string_view words_;
    std::string file_;
    std::int32_t line_ = 0;
};

// Decimal text of at most nine digits before and after the point, exactly, in 1e-9.
// \param lines whose last one it stands in
std::int64_t read_nano(std::string_view text, const KrlLines& lines) {
    const std::string_view whole = text;
    const bool negative = !text.empty() && text.front() == '-';
    text.remove_prefix(negative ? 1 : 0);
    const std::size_t point = std::min(text.find('.'), text.size());
    const std::string_view before = text.substr(0, point);
    const std::string_view after = point < text.size() ? text.substr(point + 1) : "";
    const auto digits = [](std::string_view part) {
        return part.size() <= 9 &&
               std::all_of(part.begin(), part.end(), [](char c) { return c >= '0' && c <= '9'; });
    };
    if (before.empty() || !digits(before) || !digits(after)) {
        lines.fail("krl.number", "'" + std::string(whole) +
                                     "' is not a number of at most nine "
                                     "digits before and after the point");
    }
    std::int64_t nano = 0;
    for (const char c : before) {
        nano = 10 * nano + (c - '0');
    }
    for (std::size_t i = 0; i < 9; ++i) {
        nano = 10 * nano + (i < after.size() ? after[i] - '0' : 0);
    }
    return negative ? -nano : nano;
}

// {NAME number,..} with the names in order, then perhaps `tail`.
std::array<std::int64_t, 6> read_aggregate(const std::array<std::string_view, 6>& names,
                                           std::string_view tail, KrlLines& lines) {
    const std::string_view whole = lines.words();
    std::array<std::int64_t, 6> nano{};
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (!lines.take(i == 0 ? "{" : ",") || !lines.take(names[i]) || !lines.take(" ")) {
            lines.not_understood(whole, "{X ..,Y ..,Z ..,A ..,B ..,C ..} or {A1 ..,..,A6 ..}");
        }
        nano[i] = read_nano(lines.take_until(",}"), lines);
    }
    if (!lines.take("}") || (!lines.words().empty() && lines.words() != tail)) {
        lines.not_understood(whole, "one closing bracket, then at most C_DIS");
    }
    return nano;
}

std::int64_t read_speed(const KrlLines& lines) {
    const std::int64_t nano = read_nano(lines.words(), lines);
    if (nano <= 0) {
        lines.fail("krl.number", "a speed must be above 0");
    }
    return nano;
}

// The name in the head; goes to the line behind it.
std::string read_name(KrlLines& lines) {
    lines.need();
    while (lines.words().front() == '&') {
        lines.need();
    }
    const std::string_view whole = lines.words();
    if (!lines.take("DEF ") || lines.words().size() < 3 ||
        lines.words().substr(lines.words().size() - 3) != "( )") {
        lines.not_understood(whole, "DEF name( )");
    }
    std::string name(lines.words().substr(0, lines.words().size() - 3));
    if (!is_name(name)) {
        lines.not_understood(whole, "DEF name( )");
    }
    lines.need();
    return name;
}

// As $VEL was set last; 0: not yet.
struct KrlSpeeds {
    std::int64_t path_nano_m_s = 0;
    std::int64_t turn_nano_deg_s = 0;
};

// Behind "LIN ".
KrlMove read_move(const KrlSpeeds& speeds, KrlLines& lines) {
    if (speeds.path_nano_m_s == 0 || speeds.turn_nano_deg_s == 0) {
        lines.fail("krl.no_motion", "LIN before $VEL.CP and $VEL.ORI1 are set; set them");
    }
    KrlMove move{{}, speeds.path_nano_m_s, speeds.turn_nano_deg_s, lines.line()};
    move.to.nano = read_aggregate(kFrameNames, " C_DIS", lines);
    return move;
}

// Behind "$VEL.ORI1=", whose line that of "$VEL.ORI2=" follows.
std::int64_t read_turn_speed(KrlLines& lines) {
    const std::int64_t swivel = read_speed(lines);
    lines.need();
    if (!lines.take(kSpinSpeed) || read_speed(lines) != swivel) {
        lines.not_understood(lines.words(), "$VEL.ORI2 of the value of $VEL.ORI1 behind it");
    }
    return swivel;
}

bool is_fixed_line(std::string_view line) {
    return line == kInit || line == kAdvance || line == kOrientation || line == kApproximation ||
           line == "HALT";
}

void read_body_line(KrlLines& lines, KrlSpeeds& speeds, KrlProgram& program) {
    const std::string_view whole = lines.words();
    if (is_fixed_line(whole)) {
        return;
    }
    if (lines.take("$BASE=")) {
        program.base.nano = read_aggregate(kFrameNames, "", lines);
    } else if (lines.take("$TOOL=")) {
        program.tool.nano = read_aggregate(kFrameNames, "", lines);
    } else if (lines.take("PTP ")) {
        program.start_nano = read_aggregate(kAxisNames, "", lines);
    } else if (lines.take(kPathSpeed)) {
        speeds.path_nano_m_s = read_speed(lines);
    } else if (lines.take(kSwivelSpeed)) {
        speeds.turn_nano_deg_s = read_turn_speed(lines);
    } else if (lines.take("LIN ")) {
        program.moves.push_back(read_move(speeds, lines));
    } else {
        lines.not_understood(whole, "the lines in postproc/ringhead/krl.h");
    }
}

}  // namespace

bool carries_frames(const Machine& machine) {
    return machine.controller.dialect == kCarryDialect && machine.eye_chain.empty();
}

KrlFrame krl_frame(const Eigen::Isometry3d& pose) {
    const EulerZyx angles = euler_zyx(pose.linear());
    KrlFrame frame;
    for (std::size_t i = 0; i < 3; ++i) {
        const double length_mm = pose.translation()[static_cast<Eigen::Index>(i)];
        if (!(std::abs(length_mm) <= kFarthest_mm)) {
            throw InputError("krl.too_far", "",
                             "a frame is more than 1 km from its base; check the axis and the "
                             "head, both are in mm");
        }
        frame.nano[i] = rounded_nano(length_mm, kLengthStep_nano);
    }
    frame.nano[3] = rounded_nano(deg_from_rad(angles.a_rad), kAngleStep_nano);
    frame.nano[4] = rounded_nano(deg_from_rad(angles.b_rad), kAngleStep_nano);
    frame.nano[5] = rounded_nano(deg_from_rad(angles.c_rad), kAngleStep_nano);
    return frame;
}

Eigen::Isometry3d pose_of(const KrlFrame& frame) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    const EulerZyx angles{rad_from_deg(value_of(frame.nano[3])),
                          rad_from_deg(value_of(frame.nano[4])),
                          rad_from_deg(value_of(frame.nano[5]))};
    pose.linear() = angles.matrix();
    pose.translation() =
        Eigen::Vector3d(value_of(frame.nano[0]), value_of(frame.nano[1]), value_of(frame.nano[2]));
    return pose;
}

std::int64_t krl_path_speed(double m_s) {
    return up_nano(m_s, kPathSpeedStep_nano);
}

std::int64_t krl_turn_speed(double deg_s) {
    return up_nano(deg_s, kTurnSpeedStep_nano);
}

std::string write_krl(const KrlProgram& program, const std::vector<std::string>& comments,
                      const std::vector<std::string>& header) {
    assert(program.moves.size() >= 2);
    if (!is_name(program.name)) {
        throw InputError("krl.name", program.name,
                         "is no name of a program; a letter, then letters, digits and _, 24 at "
                         "most");
    }
    std::string text = "&ACCESS RVP\nDEF " + program.name + "( )\n";
    for (const std::string& comment : comments) {
        append_comment(text, comment);
    }
    ((text += kInit) += '\n');
    append_frame(text, "$BASE=", program.base);
    append_frame(text, "\n$TOOL=", program.tool);
    for (const std::string_view line : {kAdvance, kOrientation, kApproximation}) {
        (text += '\n') += line;
    }
    text += '\n';
    for (const std::string& line : header) {
        if (line.empty() || line.front() != ';') {
            throw InputError("krl.header_line", line,
                             "a header line for a KUKA robot is a comment; begin it with ;");
        }
        append_comment(text, line.substr(1));
    }
    text += "; the way to the start is free, by hand if it is not\nPTP ";
    append_aggregate(text, kAxisNames, program.start_nano, axis_decimals);
    text += '\n';
    append_moves(text, program);
    return text + "END\n";
}

KrlProgram read_krl(std::string_view text, const std::string& file) {
    KrlLines lines(text, file);
    KrlSpeeds speeds;
    KrlProgram program;
    program.name = read_name(lines);
    while (lines.words() != "END") {
        read_body_line(lines, speeds, program);
        if (!lines.next()) {
            lines.fail("krl.no_end", "the program has no END; it may be cut off: write it again");
        }
    }
    if (program.moves.size() < 2) {
        lines.fail("krl.no_motion", "has fewer than two LIN moves; there is nothing to run");
    }
    return program;
}

std::vector<double> durations_s(const KrlProgram& program) {
    std::vector<double> durations(program.moves.size(), 0.0);
    for (std::size_t i = 1; i < program.moves.size(); ++i) {
        const KrlMove& move = program.moves[i];
        const Eigen::Isometry3d from = pose_of(program.moves[i - 1].to);
        const Eigen::Isometry3d to = pose_of(move.to);
        const double way_mm = (to.translation() - from.translation()).norm();
        const SwivelSpin turns = swivel_and_spin(from, to);
        const double turn_rad = std::max(turns.swivel_rad, std::abs(turns.spin_rad));
        durations[i] = std::max(way_mm / (kMmPerM * value_of(move.path_nano_m_s)),
                                deg_from_rad(turn_rad) / value_of(move.turn_nano_deg_s));
    }
    return durations;
}

std::string carried_back(const std::string& program) {
    return program + "_back";
}

}  // namespace meshwind
