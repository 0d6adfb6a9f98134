#include "postproc/nc/linuxcnc_flow.h"

#include <algorithm>
#include <charconv>
#include <optional>
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

std::int64_t whole(const NcLine& line, const NcWord& word) {
    const std::int64_t nano = line.nano(word);
    if (nano < 0 || nano % kNanoPerUnit != 0) {
        line.bad_number(word);
    }
    return nano / kNanoPerUnit;
}

const NcWord* first_m(const NcLine& line) {
    const auto found = std::find_if(line.words.begin(), line.words.end(),
                                    [](const NcWord& word) { return word.letter == 'M'; });
    return found == line.words.end() ? nullptr : &*found;
}

// The interpreter wants these in a line of their own.
void allow_only(const NcLine& line, const std::string& code, const NcWord& word) {
    const bool first = word.letter == 'M' && &word == first_m(line);
    if (!first && word.letter != 'N') {
        line.fail("nc.o_word", std::string("word ") + word.letter + " beside " + code +
                                   "; give the call a line of its own");
    }
}

[[noreturn]] void unknown_o_word(const NcLine& line, std::string_view code) {
    line.fail("nc.o_word", "\"" + std::string(code) +
                               "\" is not read back: only sub, endsub, call, repeat [5] and "
                               "endrepeat, without arguments and expressions");
}

struct SubprogramCall {
    std::string name{};
    std::int64_t times = 1;
};

// M98 with its words.
SubprogramCall call_by_number(const NcLine& line) {
    SubprogramCall call;
    for (const NcWord& word : line.words) {
        if (word.letter == 'P') {
            call.name = numbered(std::to_string(whole(line, word)));
        } else if (word.letter == 'L') {
            call.times = whole(line, word);
        } else {
            allow_only(line, "M98", word);
        }
    }
    if (call.name.empty()) {
        line.fail("nc.o_word", "M98 without P; write the number of the subprogram");
    }
    if (call.times == 0) {
        // The interpreter then loses the repeat around the call.
        line.fail("nc.o_word", "L0 calls nothing; remove the line");
    }
    return call;
}

// A line that begins with an O.
struct OWord {
    std::string label{};
    bool named = false;          // by a name in < >
    std::string_view keyword{};  // what stands behind the label
};

// None where it has no label. \param code without comments and blanks, from the O on
std::optional<OWord> split_o_word(std::string_view code) {
    OWord word;
    word.keyword = code.substr(1);
    std::string_view& rest = word.keyword;
    word.named = !rest.empty() && rest.front() == '<';
    const std::size_t end = word.named ? rest.find('>') : rest.find_first_not_of("0123456789");
    if (word.named && end != std::string_view::npos) {
        word.label = rest.substr(0, end + 1);
        rest.remove_prefix(end + 1);
    } else if (!word.named && end != 0 && !rest.empty()) {
        word.label = without_leading_zeros(rest.substr(0, end));
        rest.remove_prefix(std::min(end, rest.size()));
    } else {
        return {};
    }
    return word;
}

// The digits of `repeat[5]`; empty where a keyword is none.
std::string_view repeat_digits(std::string_view keyword) {
    const bool repeats = keyword.substr(0, 7) == "repeat[" && keyword.back() == ']';
    const std::string_view digits =
        repeats ? keyword.substr(7, keyword.size() - 8) : std::string_view();
    return all_digits(digits) ? digits : std::string_view();
}

// What is open until a later line closes it, and the main program.
struct OpenFlow {
    enum class Kind { Main, Numbered, Worded, Repeat };
    Kind kind = Kind::Main;
    std::string label{};
    std::int32_t first = 0;
    std::int64_t times = 1;
    std::vector<FlowStep> body{};
    std::set<std::string> labels{};  // of repeats; the interpreter wants each once a subprogram
};

// Reads a program line by line into its flow.
class FlowParser {
public:
    FlowParser(std::span<const std::string_view> lines, const std::string& file, Words words);

    [[nodiscard]] ProgramFlow flow() &&;

private:
    using Kind = OpenFlow::Kind;

    // Behind the end and outside subprograms nothing counts.
    [[nodiscard]] bool skipping() const { return main_ended_ && open_.size() == 1; }

    void plain();
    void code_line(std::string_view text);
    void o_line(std::string_view text);
    void number_line(const std::string& label);
    void inner_o_word(std::string_view code, const OWord& word);
    void call(SubprogramCall call);
    void open(Kind kind, const std::string& label, std::int64_t times = 1);
    void open_repeat(const std::string& label, std::string_view digits);
    void check_closes(Kind kind, const std::string& label) const;
    void close_subprogram();
    void close_repeat();
    void return_by_number();
    void closing_percent();
    void check_percent() const;
    [[noreturn]] void not_closed(const std::string& words) const;

    std::span<const std::string_view> lines_;
    Words words_;
    NcLine line_;
    ProgramFlow flow_;
    std::vector<OpenFlow> open_;
    bool percent_ = false;  // the first line is one
    bool closed_ = false;   // so is the last
    bool main_ended_ = false;
};

FlowParser::FlowParser(std::span<const std::string_view> lines, const std::string& file,
                       Words words)
    : lines_(lines), words_(words) {
    line_.file = &file;
    line_.style = words == Words::Fanuc ? NcComments::Brackets : NcComments::BracketsOrSemicolon;
    open_.push_back({});
}

ProgramFlow FlowParser::flow() && {
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

// The line is run.
void FlowParser::plain() {
    std::vector<FlowStep>& steps = open_.back().body;
    if (!steps.empty() && steps.back().kind == FlowStep::Kind::Lines &&
        steps.back().last == line_.number - 1) {
        steps.back().last = line_.number;
    } else {
        steps.push_back(
            {.kind = FlowStep::Kind::Lines, .first = line_.number, .last = line_.number});
    }
}

void FlowParser::code_line(std::string_view text) {
    if (text.find_first_of("mM") == std::string_view::npos) {
        plain();
        return;
    }
    line_.split(text);
    bool ends = false;
    for (const NcWord& word : line_.words) {
        const int code = word.letter == 'M' ? line_.code(word) : -1;
        if (code == 980) {
            call(call_by_number(line_));
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

void FlowParser::o_line(std::string_view text) {
    const std::string stripped = line_.split_comments(text);
    std::string_view code = stripped;
    code.remove_prefix(code.find('o'));
    const std::optional<OWord> word = split_o_word(code);
    if (!word) {
        if (!skipping()) {
            unknown_o_word(line_, code);
        }
        return;
    }
    if (word->keyword.empty() && !word->named) {
        number_line(word->label);
    } else if (words_ == Words::Fanuc) {
        unknown_o_word(line_, code);
    } else if (word->keyword == "sub") {
        if (open_.size() > 1) {
            not_closed("a subprogram cannot be defined within");
        }
        open(Kind::Worded, word->label);
    } else if (!skipping()) {
        inner_o_word(code, *word);
    }
}

void FlowParser::number_line(const std::string& label) {
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

void FlowParser::inner_o_word(std::string_view code, const OWord& word) {
    const std::string_view digits = repeat_digits(word.keyword);
    if (word.keyword == "call") {
        call({worded(word.label)});
    } else if (word.keyword == "endsub") {
        check_closes(Kind::Worded, word.label);
        close_subprogram();
    } else if (word.keyword == "endrepeat") {
        check_closes(Kind::Repeat, word.label);
        close_repeat();
    } else if (!digits.empty()) {
        open_repeat(word.label, digits);
    } else {
        unknown_o_word(line_, code);
    }
}

void FlowParser::call(SubprogramCall call) {
    open_.back().body.push_back({.kind = FlowStep::Kind::Call,
                                 .first = line_.number,
                                 .last = line_.number,
                                 .name = std::move(call.name),
                                 .times = call.times});
}

void FlowParser::open(Kind kind, const std::string& label, std::int64_t times) {
    open_.push_back({.kind = kind, .label = label, .first = line_.number, .times = times});
}

void FlowParser::open_repeat(const std::string& label, std::string_view digits) {
    // A subprogram stands right within the main program, so its frame is the second.
    const bool in_sub = open_.size() > 1 && open_[1].kind != Kind::Repeat;
    if (!open_[in_sub ? 1 : 0].labels.insert(label).second) {
        line_.fail("nc.label_twice", "O" + label + " marks two repeats; number each its own");
    }
    if (open_.size() > kMaxOpenRepeats) {
        line_.fail("nc.nesting",
                   "more than " + std::to_string(kMaxOpenRepeats) + " repeats within one another");
    }
    std::int64_t times = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), times);
    // What does not fit is too often all the same.
    open(Kind::Repeat, label, error == std::errc{} ? times : kMaxLinesRun);
}

void FlowParser::check_closes(Kind kind, const std::string& label) const {
    if (open_.size() == 1) {
        line_.fail("nc.not_closed", "O" + label + " closes what is not open");
    }
    if (open_.back().kind != kind || open_.back().label != label) {
        not_closed("this line closes O" + label);
    }
}

void FlowParser::close_subprogram() {
    OpenFlow sub = std::move(open_.back());
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

void FlowParser::close_repeat() {
    OpenFlow repeat = std::move(open_.back());
    open_.pop_back();
    open_.back().body.push_back({.kind = FlowStep::Kind::Repeat,
                                 .first = repeat.first,
                                 .last = line_.number,
                                 .times = repeat.times,
                                 .body = std::move(repeat.body)});
}

// M99.
void FlowParser::return_by_number() {
    for (const NcWord& word : line_.words) {
        allow_only(line_, "M99", word);
    }
    if (open_.back().kind == Kind::Numbered) {
        close_subprogram();
    } else if (open_.size() > 1) {
        not_closed("M99 does not close it");
    } else {
        line_.fail("nc.not_closed", "M99 outside a subprogram; subprograms stand behind M2");
    }
}

void FlowParser::closing_percent() {
    if (!percent_) {
        line_.fail("nc.not_understood", "% closes what no % in the first line opens");
    }
    if (!main_ended_) {
        plain();
    }
}

void FlowParser::check_percent() const {
    if ((!percent_ || !closed_) && is_by_meshwind(lines_)) {
        line_.fail("nc.no_end", std::string("no % ") + (percent_ ? "closes" : "opens") +
                                    " the program; the file may be cut off");
    }
}

void FlowParser::not_closed(const std::string& words) const {
    static constexpr const char* kClose[] = {"M2", "M99", "endsub", "endrepeat"};
    const OpenFlow& open = open_.back();
    line_.fail("nc.not_closed", "O" + open.label + " of line " + std::to_string(open.first) +
                                    " is open until " + kClose[static_cast<int>(open.kind)] + "; " +
                                    words);
}

}  // namespace

ProgramFlow linuxcnc_flow(std::span<const std::string_view> lines, const std::string& file) {
    return FlowParser(lines, file, Words::LinuxCnc).flow();
}

ProgramFlow fanuc_flow(std::span<const std::string_view> lines, const std::string& file) {
    return FlowParser(lines, file, Words::Fanuc).flow();
}

}  // namespace meshwind
