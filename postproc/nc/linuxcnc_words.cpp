#include "postproc/nc/linuxcnc_words.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/text/lower_case.h"
#include "postproc/motion/block.h"

namespace meshwind {
namespace {

constexpr int kNanoDecimals = 9;

std::string printable(char c) {
    return c >= ' ' && c <= '~' ? std::string(1, c)
                                : "byte " + std::to_string(static_cast<unsigned char>(c));
}

bool is_expression(char c) {
    return c == '#' || c == '[';
}

}  // namespace

void NcLine::no_expressions() const {
    fail("nc.not_understood", "parameters and expressions are not read back; write numbers");
}

void NcLine::fail(const std::string& code, const std::string& words_of_message) const {
    throw InputError(code, *file + ":" + std::to_string(number), words_of_message);
}

void NcLine::not_understood(const NcWord& word) const {
    fail("nc.not_understood", std::string("\"") + word.letter + std::string(word.number) +
                                  "\" is not part of the subset that is read back");
}

void NcLine::bad_number(const NcWord& word) const {
    fail("nc.number", std::string("\"") + word.letter + std::string(word.number) +
                          "\" is not a number of at most nine decimals");
}

void NcLine::split(std::string_view text) {
    words.clear();
    comments.clear();
    std::size_t i = 0;
    while (i < text.size()) {
        const char c = text[i];
        if (c == ' ' || c == '\t') {
            ++i;
        } else if (opens_line_comment(c, style)) {
            rest_of_line(text.substr(i + 1));
            return;
        } else {
            const bool opens = c == '(' && has_brackets(style);
            i = opens ? comment(text, i) : word(text, i);
        }
    }
}

std::string NcLine::split_comments(std::string_view text) {
    comments.clear();
    std::string code;
    std::size_t i = 0;
    while (i < text.size()) {
        const char c = text[i];
        if (opens_line_comment(c, style)) {
            rest_of_line(text.substr(i + 1));
            break;
        }
        if (c == '(' && has_brackets(style)) {
            i = comment(text, i);
            continue;
        }
        if (c != ' ' && c != '\t') {
            code += lower_case(c);
        }
        ++i;
    }
    return code;
}

void NcLine::rest_of_line(std::string_view text) {
    if (!has_brackets(style)) {
        text.remove_prefix(!text.empty() && text.front() == ' ' ? 1 : 0);
        comments.push_back(text);
    }
}

// The place after the comment that opens at `open`.
std::size_t NcLine::comment(std::string_view text, std::size_t open) {
    const std::size_t close = text.find_first_of("()", open + 1);
    if (close == std::string_view::npos || text[close] == '(') {
        fail("nc.comment", "a comment is not closed; add )");
    }
    comments.push_back(text.substr(open + 1, close - open - 1));
    return close + 1;
}

// The place after the word that begins at i.
std::size_t NcLine::word(std::string_view text, std::size_t i) {
    const char c = text[i];
    const char letter = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    if (is_expression(c)) {
        no_expressions();
    }
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
    if (end == begin && begin < text.size() && is_expression(text[begin])) {
        no_expressions();
    }
    if (end == begin) {
        fail("nc.number", std::string("no number after ") + letter);
    }
    for (const NcWord& other : words) {
        if (other.letter == letter && letter != 'G' && letter != 'M') {
            fail("nc.word_twice", std::string("word ") + letter + " stands twice");
        }
    }
    words.push_back({letter, text.substr(begin, end - begin)});
    return end;
}

std::int64_t NcLine::nano(const NcWord& word) const {
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
            if (c != '0' && !drops_digits) {
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

int NcLine::code(const NcWord& word) const {
    constexpr std::int64_t kTenth = kNanoPerUnit / 10;
    const std::int64_t value = nano(word);
    if (value < 0 || value % kTenth != 0 || value > 1000 * kNanoPerUnit) {
        not_understood(word);
    }
    return static_cast<int>(value / kTenth);
}

double NcLine::feed(const NcWord& word) const {
    double value = 0.0;
    const char* last = word.number.data() + word.number.size();
    const auto [end, error] =
        std::from_chars(word.number.data(), last, value, std::chars_format::fixed);
    if (error != std::errc{} || end != last || !(value > 0.0) || !std::isfinite(value)) {
        fail("nc.feed", "F" + std::string(word.number) + " is not above 0");
    }
    return value;
}

}  // namespace meshwind
