#include "postproc/linuxcnc.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "core/error.h"

namespace meshwind {
namespace {

constexpr double kSecondsPerMinute = 60.0;
constexpr int kNanoDecimals = 9;
// G codes are compared in tenths: G61.1 is 611.
constexpr std::array<int, 8> kHarmlessG = {170, 210, 400, 490, 540, 610, 611, 640};

struct Word {
    char letter = '?';
    std::string_view number;
};

// One line split into words, the comments already taken out.
struct Line {
    std::int32_t number = 0;
    std::vector<Word> words;
};

class Reader {
public:
    Reader(const std::string& file, const Machine& machine) : file_(file) {
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
        std::size_t begin = 0;
        while (begin < text.size() && !ended_) {
            std::size_t end = text.find('\n', begin);
            end = end == std::string_view::npos ? text.size() : end;
            ++line_.number;
            line(text.substr(begin, end - begin));
            begin = end + 1;
        }
        if (!ended_) {
            fail("nc.no_end", "the program has no M2; the file may be cut off");
        }
        if (list_.blocks.empty()) {
            fail("nc.no_motion", "the program has no feed move; there is nothing to wind");
        }
        return std::move(list_);
    }

    void line(std::string_view text) {
        if (!text.empty() && text.back() == '\r') {
            text.remove_suffix(1);
        }
        if (text.size() > kLinuxCncLineLength) {
            fail("nc.long_line", "has " + std::to_string(text.size()) +
                                     " characters; the interpreter reads at most 252");
        }
        if (text == "%") {
            ended_ = list_.blocks.empty() ? ended_ : true;
            return;
        }
        split(text);
        execute();
    }

    [[nodiscard]] bool moved() const {
        return !list_.blocks.empty() || any_placed_ || ended_ || list_.tie_on_mm.has_value();
    }

private:
    [[noreturn]] void fail(const std::string& code, const std::string& words) const {
        throw InputError(code, file_ + ":" + std::to_string(line_.number), words);
    }

    void split(std::string_view text) {
        line_.words.clear();
        std::size_t i = 0;
        while (i < text.size()) {
            const char c = text[i];
            if (c == ' ' || c == '\t') {
                ++i;
            } else if (c == ';') {
                return;
            } else if (c == '(') {
                const std::size_t close = text.find_first_of("()", i + 1);
                if (close == std::string_view::npos || text[close] == '(') {
                    fail("nc.comment", "a comment is not closed; add )");
                }
                mark(text.substr(i + 1, close - i - 1));
                tie_on(text.substr(i + 1, close - i - 1));
                i = close + 1;
            } else {
                i = word(text, i);
            }
        }
    }

    std::size_t word(std::string_view text, std::size_t i) {
        const char c = text[i];
        const char letter = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
        if (letter < 'A' || letter > 'Z') {
            fail("nc.not_understood", "unexpected \"" + printable(c) + "\"");
        }
        std::size_t begin = text.find_first_not_of(" \t", i + 1);
        begin = begin == std::string_view::npos ? text.size() : begin;
        std::size_t end = begin;
        while (end < text.size() && (text[end] == '.' || text[end] == '-' || text[end] == '+' ||
                                     (text[end] >= '0' && text[end] <= '9'))) {
            ++end;
        }
        if (end == begin) {
            fail("nc.number", std::string("no number after ") + letter);
        }
        for (const Word& other : line_.words) {
            if (other.letter == letter && letter != 'G' && letter != 'M') {
                fail("nc.word_twice", std::string("word ") + letter + " stands twice");
            }
        }
        line_.words.push_back({letter, text.substr(begin, end - begin)});
        return end;
    }

    static std::string printable(char c) {
        return c >= ' ' && c <= '~' ? std::string(1, c)
                                    : "byte " + std::to_string(static_cast<unsigned char>(c));
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

    // The word's number in 1e-9 units, exactly.
    [[nodiscard]] std::int64_t nano(const Word& word) const {
        std::string_view digits = word.number;
        const bool negative = digits.front() == '-';
        if (negative || digits.front() == '+') {
            digits.remove_prefix(1);
        }
        std::int64_t value = 0;
        int decimals = -1;  // before the point
        bool any = false;
        for (const char c : digits) {
            if (c == '.' && decimals < 0) {
                decimals = 0;
            } else if (c < '0' || c > '9') {
                bad_number(word);
            } else if (decimals == kNanoDecimals) {
                if (c != '0') {
                    bad_number(word);
                }
            } else {
                if (value > (std::numeric_limits<std::int64_t>::max() - 9) / 10) {
                    bad_number(word);
                }
                value = 10 * value + (c - '0');
                decimals += decimals < 0 ? 0 : 1;
                any = true;
            }
        }
        for (int i = std::max(decimals, 0); i < kNanoDecimals; ++i) {
            if (value > std::numeric_limits<std::int64_t>::max() / 10) {
                bad_number(word);
            }
            value *= 10;
        }
        if (!any) {
            bad_number(word);
        }
        return negative ? -value : value;
    }

    [[noreturn]] void bad_number(const Word& word) const {
        fail("nc.number", std::string("\"") + word.letter + std::string(word.number) +
                              "\" is not a number of at most nine decimals");
    }

    [[nodiscard]] double feed(const Word& word) const {
        double value = 0.0;
        const char* last = word.number.data() + word.number.size();
        const auto [end, error] =
            std::from_chars(word.number.data(), last, value, std::chars_format::fixed);
        if (error != std::errc{} || end != last || !(value > 0.0) || !std::isfinite(value)) {
            fail("nc.feed", "F" + std::string(word.number) + " is not above 0");
        }
        return value;
    }

    // Code in tenths: G61.1 gives 611.
    [[nodiscard]] int code(const Word& word) const {
        constexpr std::int64_t kTenth = kNanoPerUnit / 10;
        const std::int64_t value = nano(word);
        if (value < 0 || value % kTenth != 0 || value > 1000 * kNanoPerUnit) {
            not_understood(word);
        }
        return static_cast<int>(value / kTenth);
    }

    [[noreturn]] void not_understood(const Word& word) const {
        fail("nc.not_understood", std::string("\"") + word.letter + std::string(word.number) +
                                      "\" is not part of the subset that is read back");
    }

    void execute() {
        feed_word_.reset();
        bool axes = false;
        bool blending = false;
        int motions = 0;
        for (const Word& word : line_.words) {
            if (word.letter == 'G') {
                const int number = code(word);
                motions += number == 0 || number == 10 ? 1 : 0;
                blending = blending || number == 640;
                g_code(number, word);
            } else if (word.letter == 'M') {
                m_code(word);
            } else if (word.letter == 'F') {
                feed_word_ = feed(word);
            } else if (word.letter == 'N' ||
                       ((word.letter == 'P' || word.letter == 'Q') && blending)) {
                (void)nano(word);
            } else if (axis_of_[static_cast<std::size_t>(word.letter - 'A')] >= 0) {
                axes = true;
            } else {
                not_understood(word);
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

    void g_code(int number, const Word& word) {
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
                    not_understood(word);
                }
        }
    }

    void m_code(const Word& word) {
        const int number = code(word);
        if (number == 20 || number == 300) {
            ended_ = true;
        } else if (number != 0 && number != 10) {
            not_understood(word);
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
        for (const Word& word : line_.words) {
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

    void place(std::size_t axis, const Word& word) {
        const std::int64_t value = nano(word);
        if (value % list_.axes[axis].resolution_nano != 0) {
            fail("nc.resolution", std::string("\"") + word.letter + std::string(word.number) +
                                      "\" is not a multiple of the axis' resolution");
        }
        std::int64_t sum = value;
        if (incremental_ && __builtin_add_overflow(position_[axis], value, &sum)) {
            bad_number(word);
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

    std::string file_;
    BlockList list_;
    std::array<int, 26> axis_of_{};
    std::vector<std::int64_t> position_;
    std::vector<bool> placed_;
    Line line_;
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

BlockList LinuxCnc::read(std::string_view text, const std::string& file,
                         const Machine& machine) const {
    return Reader(file, machine).program(text);
}

}  // namespace meshwind
