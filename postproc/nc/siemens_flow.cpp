#include "postproc/nc/siemens_flow.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <vector>

#include "postproc/nc/linuxcnc_words.h"

namespace meshwind {
namespace {

// Sections do not call one another: the main program and one level.
constexpr std::size_t kLevels = 2;

class SectionParser {
public:
    SectionParser(std::span<const std::string_view> lines, const std::string& file)
        : lines_(lines) {
        line_.file = &file;
        line_.style = NcComments::Semicolon;
    }

    ProgramFlow flow() && {
        find_labels();
        flow_.levels = kLevels;
        flow_.searches_forward = false;
        for (std::int32_t number = 1; number <= last_; ++number) {
            line_.number = number;
            const std::vector<std::string_view> words = words_of(number);
            if (!words.empty() && words.front() == "REPEAT") {
                repeat(words);
            } else {
                append(flow_.main, number);
            }
        }
        return std::move(flow_);
    }

private:
    // Words of a line without its comment.
    [[nodiscard]] std::vector<std::string_view> words_of(std::int32_t number) const {
        std::string_view text = lines_[static_cast<std::size_t>(number) - 1];
        text = text.substr(0, text.find(';'));
        std::vector<std::string_view> words;
        while (true) {
            const std::size_t begin = text.find_first_not_of(" \t");
            if (begin == std::string_view::npos) {
                return words;
            }
            const std::size_t end = std::min(text.find_first_of(" \t", begin), text.size());
            words.push_back(text.substr(begin, end - begin));
            text.remove_prefix(end);
        }
    }

    void find_labels() {
        last_ = static_cast<std::int32_t>(lines_.size());
        for (std::int32_t number = 1; number <= last_; ++number) {
            line_.number = number;
            const std::vector<std::string_view> words = words_of(number);
            if (words.size() == 1 && words[0].size() > 1 && words[0].back() == ':') {
                const std::string name(words[0].substr(0, words[0].size() - 1));
                if (!labels_.emplace(name, number).second) {
                    line_.fail("nc.label_twice", "label " + name + " stands twice");
                }
                label_lines_.insert(number);
            } else if (words.size() == 1 && (words[0] == "M30" || words[0] == "M2")) {
                last_ = number;
            } else if (!words.empty() && words.front() == "REPEAT") {
                repeats_.push_back(number);
            }
        }
    }

    void append(std::vector<FlowStep>& to, std::int32_t number) {
        const bool label = label_lines_.count(number) > 0;
        if (!label && !to.empty() && to.back().kind == FlowStep::Kind::Lines &&
            to.back().last == number - 1) {
            to.back().last = number;
        } else {
            to.push_back({.kind = label ? FlowStep::Kind::Label : FlowStep::Kind::Lines,
                          .first = number,
                          .last = number});
        }
    }

    [[nodiscard]] std::int32_t place(std::string_view label) const {
        const auto found = labels_.find(std::string(label));
        if (found == labels_.end()) {
            line_.fail("nc.no_subprogram",
                       "label " + std::string(label) + " is not in the file; add it");
        }
        return found->second;
    }

    [[nodiscard]] std::int64_t times(const std::vector<std::string_view>& words) const {
        if (words.size() == 3) {
            return 1;
        }
        std::int64_t value = 0;
        bool good = words.size() == 4 && words[3].substr(0, 2) == "P=";
        if (good) {
            const std::string_view digits = words[3].substr(2);
            const char* last = digits.data() + digits.size();
            const auto [end, error] = std::from_chars(digits.data(), last, value);
            good = error == std::errc{} && end == last && value > 0;
        }
        if (!good) {
            line_.fail("nc.not_understood",
                       "REPEAT is read back as REPEAT LABEL LABEL P=5, with two labels");
        }
        return value;
    }

    void repeat(const std::vector<std::string_view>& words) {
        const std::int32_t here = line_.number;
        const std::int64_t count = times(words);
        const std::int32_t first = place(words[1]);
        const std::int32_t last = place(words[2]);
        const bool holds_repeat =
            std::any_of(repeats_.begin(), repeats_.end(),
                        [&](std::int32_t r) { return r > first && r < last; });
        if (first >= last || holds_repeat || last > last_) {
            line_.fail("nc.not_closed", "lines " + std::to_string(first) + " to " +
                                            std::to_string(last) +
                                            " cannot be repeated: a section begins before it ends "
                                            "and holds no REPEAT");
        }
        const std::string name = std::string(words[1]) + ' ' + std::string(words[2]);
        Subprogram& section = flow_.subprograms[name];
        if (section.first == 0) {
            section.first = first;
            section.last = last;
            for (std::int32_t number = first + 1; number < last; ++number) {
                append(section.body, number);
            }
        }
        flow_.main.push_back({.kind = FlowStep::Kind::Call,
                              .first = here,
                              .last = here,
                              .name = name,
                              .times = count});
    }

    std::span<const std::string_view> lines_;
    NcLine line_;
    ProgramFlow flow_;
    std::map<std::string, std::int32_t> labels_;  // lines
    std::set<std::int32_t> label_lines_;
    std::vector<std::int32_t> repeats_;  // lines
    std::int32_t last_ = 0;              // line of the main program
};

}  // namespace

ProgramFlow siemens_flow(std::span<const std::string_view> lines, const std::string& file) {
    return SectionParser(lines, file).flow();
}

}  // namespace meshwind
