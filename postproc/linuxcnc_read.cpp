#include "postproc/linuxcnc.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "core/error.h"
#include "postproc/linuxcnc_flow.h"
#include "postproc/linuxcnc_words.h"

namespace meshwind {
namespace {

constexpr double kSecondsPerMinute = 60.0;
// G codes are compared in tenths: G61.1 is 611.
constexpr std::array<int, 8> kHarmlessG = {170, 210, 400, 490, 540, 610, 611, 640};

class Reader {
public:
    Reader(std::string file, const Machine& machine) : file_(std::move(file)) {
        line_.file = &file_;
        axis_of_.fill(-1);
        for (std::size_t a = 0; a < machine.axis_count(); ++a) {
            const Axis& axis = machine.axis(a);
            list_.axes.push_back({axis.letter, axis.type, axis.resolution_nano});
            axis_of_[static_cast<std::size_t>(axis.letter - 'A')] = static_cast<int>(a);
        }
        position_.assign(list_.axes.size(), 0);
        placed_.assign(list_.axes.size(), false);
    }

    BlockList program(std::string_view text) && {
        const std::vector<std::string_view> lines = lines_of(text);
        const ProgramFlow flow = linuxcnc_flow(lines, file_);
        run_flow(flow, file_, [&](std::int32_t number, FlowLine kind) {
            line_.number = number;
            const std::string_view words = lines[static_cast<std::size_t>(number) - 1];
            if (kind == FlowLine::Code) {
                line(words);
            } else {
                check_length(words);
                (void)line_.split_comments(words);
                comments();
            }
            return !ended_;
        });
        if (!ended_) {
            fail("nc.no_end", "the program has no M2; the file may be cut off");
        }
        if (list_.blocks.empty()) {
            fail("nc.no_motion", "the program has no feed move; there is nothing to wind");
        }
        return std::move(list_);
    }

    void line(std::string_view text) {
        check_length(text);
        if (text == "%") {
            ended_ = list_.blocks.empty() ? ended_ : true;
            return;
        }
        line_.split(text);
        comments();
        execute();
    }

    [[nodiscard]] bool moved() const {
        return !list_.blocks.empty() || any_placed_ || ended_ || list_.tie_on_mm.has_value();
    }

private:
    [[noreturn]] void fail(const std::string& code, const std::string& words) const {
        line_.fail(code, words);
    }

    static std::vector<std::string_view> lines_of(std::string_view text) {
        std::vector<std::string_view> lines;
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            std::string_view line = text.substr(0, end);
            if (!line.empty() && line.back() == '\r') {
                line.remove_suffix(1);
            }
            lines.push_back(line);
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        return lines;
    }

    void check_length(std::string_view text) const {
        if (text.size() > kLinuxCncLineLength) {
            fail("nc.long_line", "has " + std::to_string(text.size()) +
                                     " characters; the interpreter reads at most 252");
        }
    }

    void comments() {
        for (const std::string_view comment : line_.comments) {
            mark(comment);
            tie_on(comment);
        }
    }

    void mark(std::string_view comment) {
        constexpr std::string_view kCourse = "course ";
        if (comment.substr(0, kCourse.size()) == kCourse) {
            comment.remove_prefix(kCourse.size());
            std::int32_t piece = 0;
            const auto [end, error] =
                std::from_chars(comment.data(), comment.data() + comment.size(), piece);
            if (error == std::errc{} && end == comment.data() + comment.size()) {
                piece_ = piece;
            }
        }
    }

    void tie_on(std::string_view comment) {
        static constexpr std::array<std::string_view, 3> kBefore = {"tie on at X", " Y", " Z"};
        if (comment.substr(0, 6) != "tie on") {
            return;
        }
        if (list_.tie_on_mm) {
            fail("nc.tie_on", "a second place to tie the fibre on; keep one");
        }
        Eigen::Vector3d place = Eigen::Vector3d::Zero();
        for (std::size_t i = 0; i < kBefore.size(); ++i) {
            const bool key = comment.substr(0, kBefore[i].size()) == kBefore[i];
            comment.remove_prefix(key ? kBefore[i].size() : comment.size());
            double& value = place[static_cast<Eigen::Index>(i)];
            const auto [end, error] = std::from_chars(
                comment.data(), comment.data() + comment.size(), value, std::chars_format::fixed);
            if (error != std::errc{} || !std::isfinite(value)) {
                bad_tie_on();
            }
            comment.remove_prefix(static_cast<std::size_t>(end - comment.data()));
        }
        if (comment != " on the mandrel") {
            bad_tie_on();
        }
        list_.tie_on_mm = place;
    }

    [[noreturn]] void bad_tie_on() const {
        fail("nc.tie_on",
             "a comment \"tie on\" must read (tie on at X1.000 Y2.000 Z3.000 on the mandrel)");
    }

    [[nodiscard]] double feed(const NcWord& word) const {
        double value = 0.0;
        const char* last = word.number.data() + word.number.size();
        const auto [end, error] =
            std::from_chars(word.number.data(), last, value, std::chars_format::fixed);
        if (error != std::errc{} || end != last || !(value > 0.0) || !std::isfinite(value)) {
            fail("nc.feed", "F" + std::string(word.number) + " is not above 0");
        }
        return value;
    }

    void execute() {
        feed_word_.reset();
        bool axes = false;
        bool blending = false;
        int motions = 0;
        for (const NcWord& word : line_.words) {
            if (word.letter == 'G') {
                const int number = line_.code(word);
                motions += number == 0 || number == 10 ? 1 : 0;
                blending = blending || number == 640;
                g_code(number, word);
            } else if (word.letter == 'M') {
                m_code(word);
            } else if (word.letter == 'F') {
                feed_word_ = feed(word);
            } else if (word.letter == 'N' ||
                       ((word.letter == 'P' || word.letter == 'Q') && blending)) {
                (void)line_.nano(word);
            } else if (axis_of_[static_cast<std::size_t>(word.letter - 'A')] >= 0) {
                axes = true;
            } else {
                line_.not_understood(word);
            }
        }
        if (motions > 1) {
            fail("nc.not_understood", "G0 and G1 in one line; keep one");
        }
        if (feed_word_ && !inverse_time_) {
            feed_per_minute_ = *feed_word_;
        }
        if (axes) {
            move();
        }
    }

    void g_code(int number, const NcWord& word) {
        switch (number) {
            case 0:
            case 10:
                motion_ = number == 0 ? Motion::Rapid : Motion::Feed;
                break;
            case 800:
                motion_ = Motion::None;
                break;
            case 900:
            case 910:
                incremental_ = number == 910;
                break;
            case 930:
            case 940:
                inverse_time_ = number == 930;
                feed_per_minute_ = 0.0;  // a change of mode asks for a fresh F
                break;
            default:
                if (std::find(kHarmlessG.begin(), kHarmlessG.end(), number) == kHarmlessG.end()) {
                    line_.not_understood(word);
                }
        }
    }

    void m_code(const NcWord& word) {
        const int number = line_.code(word);
        if (number == 20 || number == 300) {
            ended_ = true;
        } else if (number != 0 && number != 10) {
            line_.not_understood(word);
        }
    }

    void move() {
        if (motion_ == Motion::None) {
            fail("nc.no_motion_mode", "axis words before any G0 or G1");
        }
        if (motion_ == Motion::Feed && list_.blocks.empty()) {
            start();
        }
        const std::vector<std::int64_t> before = position_;
        for (const NcWord& word : line_.words) {
            const int axis = axis_of_[static_cast<std::size_t>(word.letter - 'A')];
            if (axis >= 0) {
                place(static_cast<std::size_t>(axis), word);
            }
        }
        if (motion_ == Motion::Rapid) {
            if (!list_.blocks.empty()) {
                fail("nc.rapid", "a rapid move after the first feed move would tear the fibre");
            }
            any_placed_ = true;
            return;
        }
        list_.blocks.push_back(
            {.duration_s = duration_s(before), .piece = piece_, .line = line_.number});
        list_.nano.insert(list_.nano.end(), position_.begin(), position_.end());
    }

    // The place where the first feed move begins is block 0.
    void start() {
        for (std::size_t a = 0; a < placed_.size(); ++a) {
            if (!placed_[a]) {
                fail("nc.unknown_start", std::string("axis ") + list_.axes[a].letter +
                                             " has no absolute position before the first feed "
                                             "move; place it with G90 G0");
            }
        }
        list_.blocks.push_back({.piece = piece_, .line = line_.number});
        list_.nano.insert(list_.nano.end(), position_.begin(), position_.end());
    }

    void place(std::size_t axis, const NcWord& word) {
        const std::int64_t value = line_.nano(word);
        if (value % list_.axes[axis].resolution_nano != 0) {
            fail("nc.resolution", std::string("\"") + word.letter + std::string(word.number) +
                                      "\" is not a multiple of the axis' resolution");
        }
        std::int64_t sum = value;
        if (incremental_ && __builtin_add_overflow(position_[axis], value, &sum)) {
            line_.bad_number(word);
        }
        position_[axis] = sum;
        placed_[axis] = placed_[axis] || !incremental_;
    }

    // Feed rule of the interpreter: X Y Z alone, or U V W when those rest, or the rotary axes.
    [[nodiscard]] double path_length(const std::vector<std::int64_t>& before) const {
        double main = 0.0;
        double second = 0.0;
        double rotary = 0.0;
        for (std::size_t a = 0; a < before.size(); ++a) {
            const double move =
                static_cast<double>(position_[a] - before[a]) / static_cast<double>(kNanoPerUnit);
            (list_.axes[a].type == AxisType::Rotary ? rotary
             : list_.axes[a].letter >= 'X'          ? main
                                                    : second) += move * move;
        }
        return std::sqrt(main > 0.0 ? main : second > 0.0 ? second : rotary);
    }

    [[nodiscard]] double duration_s(const std::vector<std::int64_t>& before) const {
        if (inverse_time_) {
            if (!feed_word_) {
                fail("nc.feed", "a G93 feed move without F; write F in every line");
            }
            return kSecondsPerMinute / *feed_word_;
        }
        if (!(feed_per_minute_ > 0.0)) {
            fail("nc.feed", "a feed move before any F; write F");
        }
        return kSecondsPerMinute * path_length(before) / feed_per_minute_;
    }

    enum class Motion { None, Rapid, Feed };

    const std::string file_;
    BlockList list_;
    std::array<int, 26> axis_of_{};
    std::vector<std::int64_t> position_;
    std::vector<bool> placed_;
    NcLine line_;
    Motion motion_ = Motion::None;
    bool incremental_ = false;
    bool inverse_time_ = false;
    bool ended_ = false;
    bool any_placed_ = false;
    double feed_per_minute_ = 0.0;
    std::optional<double> feed_word_;
    std::int32_t piece_ = -1;
};

}  // namespace

void check_linuxcnc_lines(const Machine& machine) {
    for (const auto* lines : {&machine.controller.header, &machine.controller.footer}) {
        for (const std::string& line : *lines) {
            Reader reader(machine.name, machine);
            std::string trouble;
            try {
                reader.line(line);
                trouble = reader.moved() ? "it moves, ends the program or ties the fibre on" : "";
            } catch (const InputError& error) {
                trouble = error.what();
            }
            if (!trouble.empty()) {
                throw InputError("dialect.header_line", machine.name,
                                 std::string("controller line \"")
                                     .append(line)
                                     .append("\" cannot be used: ")
                                     .append(trouble));
            }
        }
    }
}

double LinuxCnc::corner_tolerance_mm(const Machine& machine) const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    double tolerance_mm = kNone;
    for (const std::string& text : machine.controller.header) {
        NcLine line;
        line.file = &machine.name;
        line.split(text);
        bool blends = false;
        std::int64_t nano = 0;
        for (const NcWord& word : line.words) {
            blends = blends || (word.letter == 'G' && line.code(word) == 640);
            nano = word.letter == 'P' ? line.nano(word) : nano;
        }
        if (blends) {
            tolerance_mm =
                nano > 0 ? static_cast<double>(nano) / static_cast<double>(kNanoPerUnit) : kNone;
        }
    }
    return tolerance_mm;
}

BlockList LinuxCnc::read(std::string_view text, const std::string& file,
                         const Machine& machine) const {
    return Reader(file, machine).program(text);
}

}  // namespace meshwind
