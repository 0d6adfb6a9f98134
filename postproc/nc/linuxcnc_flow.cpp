#include "postproc/nc/linuxcnc_flow.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <utility>
#include <vector>

#include "postproc/motion/block.h"
#include "postproc/nc/foreign_notes.h"
#include "postproc/nc/linuxcnc_words.h"

namespace meshwind {
namespace {

// Names of both kinds of subprogram in one table: M98 cannot call `o100 sub`, nor a call `O100`.
std::string numbered(const std::string& label) {
    return "O" + label;
}
std::string worded(const std::string& label) {
    return "o" + label;
}

std::string without_leading_zeros(std::string_view digits) {
    return std::string(digits.substr(std::min(digits.find_first_not_of('0'), digits.size() - 1)));
}

bool all_digits(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// True when the line begins with an O, an N word before it or not.
bool is_o_line(std::string_view text) {
    std::size_t i = text.find_first_not_of(" \t");
    if (i != std::string_view::npos && (text[i] == 'n' || text[i] == 'N')) {
        const std::size_t digits = text.find_first_not_of(" \t", i + 1);
        i = text.find_first_not_of(" \t.0123456789", i + 1);
        i = i == digits ? std::string_view::npos : i;
    }
    return i != std::string_view::npos && (text[i] == 'o' || text[i] == 'O');
}

enum class Words { LinuxCnc, Fanuc };

// Of subprograms that Fanuc controls call, and the main program.
constexpr std::size_t kFanucLevels = 5;

class FlowParser {
public:
    FlowParser(std::span<const std::string_view> lines, const std::string& file, Words words)
        : lines_(lines), words_(words) {
        line_.file = &file;
        line_.style =
            words == Words::Fanuc ? NcComments::Brackets : NcComments::BracketsOrSemicolon;
        open_.push_back({});
    }

    ProgramFlow flow() && {
        bool any = false;
        for (const std::string_view text : lines_) {
            ++line_.number;
            if (text == "%" && any) {
                closing_percent();
                closed_ = true;
                break;
            }
            percent_ = percent_ || text == "%";
            any = any || text.find_first_not_of(" \t") != std::string_view::npos;
            if (is_o_line(text)) {
                o_line(text);
            } else if (!skipping()) {
                code_line(text);
            }
        }
        if (open_.size() > 1) {
            line_.number = open_.back().first;
            not_closed("nothing closes it");
        }
        if (words_ == Words::Fanuc) {
            check_percent();
            flow_.levels = kFanucLevels;
        }
        flow_.main = std::move(open_.front().body);
        return std::move(flow_);
    }

private:
    enum class Kind { Main, Numbered, Worded, Repeat };
    struct Open {
        Kind kind = Kind::Main;
        std::string label{};
        std::int32_t first = 0;
        std::int64_t times = 1;
        std::vector<FlowStep> body{};
        std::set<std::string> labels{};  // of repeats; the interpreter wants each once a subprogram
    };

    [[noreturn]] void not_closed(const std::string& words) const {
        static constexpr const char* kClose[] = {"M2", "M99", "endsub", "endrepeat"};
        const Open& open = open_.back();
        line_.fail("nc.not_closed", "O" + open.label + " of line " + std::to_string(open.first) +
                                        " is open until " + kClose[static_cast<int>(open.kind)] +
                                        "; " + words);
    }

    // Behind the end and outside subprograms nothing counts.
    [[nodiscard]] bool skipping() const { return main_ended_ && open_.size() == 1; }

    void plain() {
        std::vector<FlowStep>& steps = open_.back().body;
        if (!steps.empty() && steps.back().kind == FlowStep::Kind::Lines &&
            steps.back().last == line_.number - 1) {
            steps.back().last = line_.number;
        } else {
            steps.push_back(
                {.kind = FlowStep::Kind::Lines, .first = line_.number, .last = line_.number});
        }
    }

    void check_percent() const {
        if ((!percent_ || !closed_) && is_by_meshwind(lines_)) {
            line_.fail("nc.no_end", std::string("no % ") + (percent_ ? "closes" : "opens") +
                                        " the program; the file may be cut off");
        }
    }

    void closing_percent() {
        if (!percent_) {
            line_.fail("nc.not_understood", "% closes what no % in the first line opens");
        }
        if (!main_ended_) {
            plain();
        }
    }

    void call(const std::string& name, std::int64_t times) {
        open_.back().body.push_back({.kind = FlowStep::Kind::Call,
                                     .first = line_.number,
                                     .last = line_.number,
                                     .name = name,
                                     .times = times});
    }

    void open(Kind kind, const std::string& label, std::int64_t times = 1) {
        open_.push_back({.kind = kind, .label = label, .first = line_.number, .times = times});
    }

    void close_subprogram() {
        Open sub = std::move(open_.back());
        open_.pop_back();
        const bool by_word = sub.kind == Kind::Worded;
        const std::string name = by_word ? worded(sub.label) : numbered(sub.label);
        if (flow_.subprograms.count(worded(sub.label)) > 0 ||
            flow_.subprograms.count(numbered(sub.label)) > 0) {
            line_.number = sub.first;
            line_.fail("nc.label_twice", "subprogram O" + sub.label + " is defined twice");
        }
        if (!main_ended_) {
            open_.back().body.push_back({.kind = FlowStep::Kind::Definition,
                                         .first = sub.first,
                                         .last = line_.number,
                                         .name = name});
        }
        flow_.subprograms[name] = {sub.first, line_.number, std::move(sub.body)};
    }

    void code_line(std::string_view text) {
        if (text.find_first_of("mM") == std::string_view::npos) {
            plain();
            return;
        }
        line_.split(text);
        bool ends = false;
        for (const NcWord& word : line_.words) {
            const int code = word.letter == 'M' ? line_.code(word) : -1;
            if (code == 980) {
                call_by_number();
                return;
            }
            if (code == 990) {
                return_by_number();
                return;
            }
            ends = ends || code == 20 || code == 300;
        }
        plain();
        main_ended_ = main_ended_ || (ends && open_.size() == 1);
    }

    void call_by_number() {
        std::string name;
        std::int64_t times = 1;
        for (const NcWord& word : line_.words) {
            if (word.letter == 'P') {
                name = numbered(std::to_string(whole(word)));
            } else if (word.letter == 'L') {
                times = whole(word);
            } else {
                allow_only("M98", word);
            }
        }
        if (name.empty()) {
            line_.fail("nc.o_word", "M98 without P; write the number of the subprogram");
        }
        if (times == 0) {
            // The interpreter then loses the repeat around the call.
            line_.fail("nc.o_word", "L0 calls nothing; remove the line");
        }
        call(name, times);
    }

    void return_by_number() {
        for (const NcWord& word : line_.words) {
            allow_only("M99", word);
        }
        if (open_.back().kind == Kind::Numbered) {
            close_subprogram();
        } else if (open_.size() > 1) {
            not_closed("M99 does not close it");
        } else {
            line_.fail("nc.not_closed", "M99 outside a subprogram; subprograms stand behind M2");
        }
    }

    // The interpreter wants these in a line of their own.
    void allow_only(const std::string& code, const NcWord& word) {
        const bool first = word.letter == 'M' && &word == first_m();
        if (!first && word.letter != 'N') {
            line_.fail("nc.o_word", std::string("word ") + word.letter + " beside " + code +
                                        "; give the call a line of its own");
        }
    }

    [[nodiscard]] const NcWord* first_m() const {
        const auto found = std::find_if(line_.words.begin(), line_.words.end(),
                                        [](const NcWord& word) { return word.letter == 'M'; });
        return found == line_.words.end() ? nullptr : &*found;
    }

    [[nodiscard]] std::int64_t whole(const NcWord& word) const {
        const std::int64_t nano = line_.nano(word);
        if (nano < 0 || nano % kNanoPerUnit != 0) {
            line_.bad_number(word);
        }
        return nano / kNanoPerUnit;
    }

    [[noreturn]] void unknown_o_word(std::string_view code) const {
        line_.fail("nc.o_word",
                   "\"" + std::string(code) +
                       "\" is not read back: only sub, endsub, call, repeat [5] and endrepeat, "
                       "without arguments and expressions");
    }

    void o_line(std::string_view text) {
        const std::string stripped = line_.split_comments(text);
        std::string_view code = stripped;
        code.remove_prefix(code.find('o'));
        std::string_view rest = code.substr(1);
        std::string label;
        const bool named = !rest.empty() && rest.front() == '<';
        const std::size_t end = named ? rest.find('>') : rest.find_first_not_of("0123456789");
        if (named && end != std::string_view::npos) {
            label = rest.substr(0, end + 1);
            rest.remove_prefix(end + 1);
        } else if (!named && end != 0 && !rest.empty()) {
            label = without_leading_zeros(rest.substr(0, end));
            rest.remove_prefix(std::min(end, rest.size()));
        } else {
            if (!skipping()) {
                unknown_o_word(code);
            }
            return;
        }
        if (rest.empty() && !named) {
            number_line(label);
        } else if (words_ == Words::Fanuc) {
            unknown_o_word(code);
        } else if (rest == "sub") {
            if (open_.size() > 1) {
                not_closed("a subprogram cannot be defined within");
            }
            open(Kind::Worded, label);
        } else if (!skipping()) {
            inner_o_word(code, label, rest);
        }
    }

    void number_line(const std::string& label) {
        if (open_.size() > 1) {
            not_closed("O" + label + " stands within");
        }
        if (main_ended_) {
            open(Kind::Numbered, label);
        } else {
            open_.back().body.push_back(
                {.kind = FlowStep::Kind::Label, .first = line_.number, .last = line_.number});
        }
    }

    void inner_o_word(std::string_view code, const std::string& label, std::string_view rest) {
        if (rest == "call") {
            call(worded(label), 1);
        } else if (rest == "endsub") {
            close(Kind::Worded, label);
            close_subprogram();
        } else if (rest == "endrepeat") {
            close(Kind::Repeat, label);
            close_repeat();
        } else if (rest.substr(0, 7) == "repeat[" && rest.back() == ']' &&
                   all_digits(rest.substr(7, rest.size() - 8))) {
            open_repeat(label, rest.substr(7, rest.size() - 8));
        } else {
            unknown_o_word(code);
        }
    }

    void close(Kind kind, const std::string& label) {
        if (open_.size() == 1) {
            line_.fail("nc.not_closed", "O" + label + " closes what is not open");
        }
        if (open_.back().kind != kind || open_.back().label != label) {
            not_closed("this line closes O" + label);
        }
    }

    void open_repeat(const std::string& label, std::string_view digits) {
        // A subprogram stands right within the main program, so its frame is the second.
        const bool in_sub = open_.size() > 1 && open_[1].kind != Kind::Repeat;
        if (!open_[in_sub ? 1 : 0].labels.insert(label).second) {
            line_.fail("nc.label_twice", "O" + label + " marks two repeats; number each its own");
        }
        if (open_.size() > kMostOpenRepeats) {
            line_.fail("nc.nesting", "more than " + std::to_string(kMostOpenRepeats) +
                                         " repeats within one another");
        }
        std::int64_t times = 0;
        const auto [end, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), times);
        // What does not fit is too often all the same.
        open(Kind::Repeat, label, error == std::errc{} ? times : kMostLinesRun);
    }

    void close_repeat() {
        Open repeat = std::move(open_.back());
        open_.pop_back();
        open_.back().body.push_back({.kind = FlowStep::Kind::Repeat,
                                     .first = repeat.first,
                                     .last = line_.number,
                                     .times = repeat.times,
                                     .body = std::move(repeat.body)});
    }

    std::span<const std::string_view> lines_;
    Words words_;
    NcLine line_;
    ProgramFlow flow_;
    std::vector<Open> open_;
    bool percent_ = false;  // the first line is one
    bool closed_ = false;   // so is the last
    bool main_ended_ = false;
};

}  // namespace

ProgramFlow linuxcnc_flow(std::span<const std::string_view> lines, const std::string& file) {
    return FlowParser(lines, file, Words::LinuxCnc).flow();
}

ProgramFlow fanuc_flow(std::span<const std::string_view> lines, const std::string& file) {
    return FlowParser(lines, file, Words::Fanuc).flow();
}

}  // namespace meshwind
