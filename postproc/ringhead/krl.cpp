#include "postproc/ringhead/krl.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>

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

class KrlReader {
public:
    KrlReader(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

    KrlProgram read() && {
        head();
        while (line_text_ != "END") {
            body_line();
            if (!next()) {
                fail("krl.no_end", "the program has no END; it may be cut off: write it again");
            }
        }
        if (program_.moves.size() < 2) {
            fail("krl.no_motion", "has fewer than two LIN moves; there is nothing to run");
        }
        return std::move(program_);
    }

private:
    // Goes to the next line that is neither empty nor a comment; false at the end.
    bool next() {
        while (!rest_.empty()) {
            const std::size_t end = std::min(rest_.find('\n'), rest_.size());
            line_text_ = rest_.substr(0, end);
            rest_.remove_prefix(std::min(end + 1, rest_.size()));
            ++line_;
            while (!line_text_.empty() && (line_text_.back() == '\r' || line_text_.back() == ' ')) {
                line_text_.remove_suffix(1);
            }
            if (!line_text_.empty() && line_text_.front() != ';') {
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

    bool take(std::string_view start) {
        if (line_text_.substr(0, start.size()) != start) {
            return false;
        }
        line_text_.remove_prefix(start.size());
        return true;
    }

    void head() {
        need();
        while (line_text_.front() == '&') {
            need();
        }
        const std::string_view whole = line_text_;
        if (!take("DEF ") || line_text_.size() < 3 ||
            line_text_.substr(line_text_.size() - 3) != "( )") {
            not_understood(whole, "DEF name( )");
        }
        program_.name = std::string(line_text_.substr(0, line_text_.size() - 3));
        if (!is_name(program_.name)) {
            not_understood(whole, "DEF name( )");
        }
        need();
    }

    void body_line() {
        const std::string_view whole = line_text_;
        if (whole == kInit || whole == kAdvance || whole == kOrientation ||
            whole == kApproximation || whole == "HALT") {
            return;
        }
        if (take("$BASE=")) {
            program_.base.nano = aggregate(kFrameNames, "");
        } else if (take("$TOOL=")) {
            program_.tool.nano = aggregate(kFrameNames, "");
        } else if (take("PTP ")) {
            program_.start_nano = aggregate(kAxisNames, "");
        } else if (take(kPathSpeed)) {
            path_nano_m_s_ = speed();
        } else if (take(kSwivelSpeed)) {
            turn_nano_deg_s_ = speed();
            need();
            if (!take(kSpinSpeed) || speed() != turn_nano_deg_s_) {
                not_understood(line_text_, "$VEL.ORI2 of the value of $VEL.ORI1 behind it");
            }
        } else if (take("LIN ")) {
            move();
        } else {
            not_understood(whole, "the lines in postproc/ringhead/krl.h");
        }
    }

    void move() {
        if (path_nano_m_s_ == 0 || turn_nano_deg_s_ == 0) {
            fail("krl.no_motion", "LIN before $VEL.CP and $VEL.ORI1 are set; set them");
        }
        KrlMove move{{}, path_nano_m_s_, turn_nano_deg_s_, line_};
        move.to.nano = aggregate(kFrameNames, " C_DIS");
        program_.moves.push_back(move);
    }

    // {NAME number,..} with the names in order, then perhaps `tail`.
    std::array<std::int64_t, 6> aggregate(const std::array<std::string_view, 6>& names,
                                          std::string_view tail) {
        const std::string_view whole = line_text_;
        std::array<std::int64_t, 6> nano{};
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (!take(i == 0 ? "{" : ",") || !take(names[i]) || !take(" ")) {
                not_understood(whole, "{X ..,Y ..,Z ..,A ..,B ..,C ..} or {A1 ..,..,A6 ..}");
            }
            const std::size_t end = std::min(line_text_.find_first_of(",}"), line_text_.size());
            nano[i] = number(line_text_.substr(0, end));
            line_text_.remove_prefix(end);
        }
        if (!take("}") || (!line_text_.empty() && line_text_ != tail)) {
            not_understood(whole, "one closing bracket, then at most C_DIS");
        }
        return nano;
    }

    std::int64_t speed() {
        const std::int64_t nano = number(line_text_);
        if (nano <= 0) {
            fail("krl.number", "a speed must be above 0");
        }
        return nano;
    }

    // Decimal text of at most nine digits before and after the point, exactly, in 1e-9.
    [[nodiscard]] std::int64_t number(std::string_view text) const {
        const std::string_view whole = text;
        const bool negative = !text.empty() && text.front() == '-';
        text.remove_prefix(negative ? 1 : 0);
        const std::size_t point = std::min(text.find('.'), text.size());
        const std::string_view before = text.substr(0, point);
        const std::string_view after = point < text.size() ? text.substr(point + 1) : "";
        const auto digits = [](std::string_view part) {
            return part.size() <= 9 && std::all_of(part.begin(), part.end(),
                                                   [](char c) { return c >= '0' && c <= '9'; });
        };
        if (before.empty() || !digits(before) || !digits(after)) {
            fail("krl.number", "'" + std::string(whole) +
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

    [[noreturn]] void not_understood(std::string_view found, const std::string& wanted) const {
        fail("krl.not_understood",
             "'" + std::string(found) + "' is not read back; there may be " + wanted);
    }

    [[noreturn]] void fail(const char* code, const std::string& words) const {
        throw InputError(code, file_ + ":" + std::to_string(line_), words);
    }

    std::string_view rest_;
    std::string_view line_text_;
    std::string file_;
    std::int32_t line_ = 0;
    std::int64_t path_nano_m_s_ = 0;
    std::int64_t turn_nano_deg_s_ = 0;
    KrlProgram program_;
};

}  // namespace

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
    return KrlReader(text, file).read();
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
