#include "mesh/io/mesh_text.h"

#include <charconv>
#include <cstdlib>
#include <utility>

#include "core/error.h"
#include "core/interrupt.h"

namespace meshwind {
namespace {

constexpr std::int64_t kLinesPerCheck = 4096;  // about a millisecond of reading
constexpr std::size_t kShownBytes = 24;

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

bool is_line_end(char c) {
    return c == '\n' || c == '\r';
}

std::string_view without_plus(std::string_view word) {
    return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

bool parse_number(std::string_view word, double& value) {
    const std::string_view digits = without_plus(word);
    const char* last = digits.data() + digits.size();
    const auto [end, error] = std::from_chars(digits.data(), last, value);
    if (error == std::errc::result_out_of_range && end == last) {
        // 1e-400 is zero, 1e400 is infinite: strtod tells them apart.
        value = std::strtod(std::string(digits).c_str(), nullptr);
        return true;
    }
    return error == std::errc() && end == last;
}

}  // namespace

std::string shown(std::string_view word) {
    if (word.empty()) {
        return "the end of the line";
    }
    std::string text = "'";
    for (const char c : word.substr(0, kShownBytes)) {
        text += c > ' ' && c < '\x7f' ? c : '?';
    }
    return text + (word.size() > kShownBytes ? "...'" : "'");
}

bool parse_integer(std::string_view word, std::int64_t& value) {
    const std::string_view digits = without_plus(word);
    const char* last = digits.data() + digits.size();
    const auto [end, error] = std::from_chars(digits.data(), last, value);
    return error == std::errc() && end == last;
}

MeshText::MeshText(std::string_view bytes, std::string file, MeshTextRules rules)
    : bytes_(bytes),
      file_(std::move(file)),
      rules_(rules),
      at_(rules.skip),
      line_(1 + rules.lines_before) {}

bool MeshText::at_line_end() const {
    return at_ >= bytes_.size() || is_line_end(bytes_[at_]);
}

void MeshText::pass_line_end() {
    if (at_ < bytes_.size()) {
        at_ += bytes_[at_] == '\r' && at_ + 1 < bytes_.size() && bytes_[at_ + 1] == '\n' ? 2 : 1;
        if (++line_ % kLinesPerCheck == 0) {
            check_interrupt();
        }
    }
}

// To the next word of the line or to the line's end.
void MeshText::pass_blanks() {
    for (;;) {
        while (at_ < bytes_.size() && is_blank(bytes_[at_])) {
            ++at_;
        }
        if (rules_.comment != '\0' && at_ < bytes_.size() && bytes_[at_] == rules_.comment) {
            while (!at_line_end()) {
                ++at_;
            }
        }
        const bool joins = rules_.joined && at_ + 1 < bytes_.size() && bytes_[at_] == '\\' &&
                           is_line_end(bytes_[at_ + 1]);
        if (!joins) {
            return;
        }
        ++at_;
        pass_line_end();
    }
}

bool MeshText::next_line() {
    if (started_) {
        pass_line();
        pass_line_end();
    }
    started_ = true;
    for (pass_blanks(); at_ < bytes_.size() && at_line_end(); pass_blanks()) {
        pass_line_end();
    }
    return at_ < bytes_.size();
}

std::string_view MeshText::word() {
    pass_blanks();
    const std::size_t begin = at_;
    const auto ends = [&] {
        const char c = bytes_[at_];
        const bool joins =
            rules_.joined && c == '\\' && at_ + 1 < bytes_.size() && is_line_end(bytes_[at_ + 1]);
        return is_blank(c) || is_line_end(c) || joins ||
               (rules_.comment != '\0' && c == rules_.comment);
    };
    while (at_ < bytes_.size() && !ends()) {
        ++at_;
    }
    return bytes_.substr(begin, at_ - begin);
}

std::string_view MeshText::word_of_text() {
    std::string_view next = started_ ? word() : std::string_view();
    return next.empty() && next_line() ? word() : next;
}

void MeshText::pass_line() {
    while (!word().empty()) {
    }
}

double MeshText::number(std::string_view of) {
    const std::string_view next = word();
    double value = 0.0;
    if (!parse_number(next, value)) {
        refuse("mesh.bad_line", shown(next) + " stands for one of " + std::string(of) +
                                    ", a number such as 12.5 is wanted; export the part again");
    }
    return value;
}

std::int64_t MeshText::integer(std::string_view of) {
    const std::string_view next = word();
    std::int64_t value = 0;
    if (!parse_integer(next, value)) {
        refuse("mesh.bad_line", shown(next) + " stands for " + std::string(of) +
                                    ", a whole number is wanted; export the part again");
    }
    return value;
}

std::string MeshText::place(std::int64_t line) const {
    return file_ + ":" + std::to_string(line);
}

void MeshText::refuse(const std::string& code, const std::string& message) const {
    throw InputError(code, place(line_), message);
}

}  // namespace meshwind
