#include "postproc/robot/rapid_tokens.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "core/text/lower_case.h"

namespace meshwind {
namespace {

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool is_letter(char c) {
    return lower_case(c) >= 'a' && lower_case(c) <= 'z';
}

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f';
}

}  // namespace

bool RapidToken::is_word(std::string_view word) const {
    return kind == Kind::Word &&
           std::equal(text.begin(), text.end(), word.begin(), word.end(),
                      [](char written, char wanted) { return lower_case(written) == wanted; });
}

std::optional<double> RapidToken::value() const {
    double number = 0.0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, number);
    return error == std::errc{} && end == last ? std::optional(number) : std::nullopt;
}

// Blanks and comments.
void RapidTokens::skip() {
    while (at_ < text_.size() && (is_blank(text_[at_]) || text_[at_] == '!')) {
        if (text_[at_] == '!') {
            const std::size_t end = std::min(text_.find('\n', at_), text_.size());
            std::string_view words = text_.substr(at_ + 1, end - at_ - 1);
            words.remove_prefix(!words.empty() && words.front() == ' ' ? 1 : 0);
            while (!words.empty() && is_blank(words.back())) {
                words.remove_suffix(1);
            }
            on_comment_(words, line_);
            at_ = end;
            continue;
        }
        line_ += text_[at_] == '\n' ? 1 : 0;
        ++at_;
    }
}

RapidToken RapidTokens::next() {
    skip();
    RapidToken token{.line = line_};
    if (at_ == text_.size()) {
        return token;
    }
    const char c = text_[at_];
    const bool number =
        is_digit(c) || (c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]));
    token.kind = is_letter(c) ? RapidToken::Kind::Word
                 : number     ? RapidToken::Kind::Number
                 : c == '"'   ? RapidToken::Kind::Text
                              : RapidToken::Kind::Mark;
    const std::size_t end = end_of_token(token.kind);
    token.text = text_.substr(at_, end - at_);
    if (token.text == "\"") {
        token.kind = RapidToken::Kind::Mark;
    }
    at_ = end;
    return token;
}

std::size_t RapidTokens::end_of_token(RapidToken::Kind kind) const {
    std::size_t end = at_ + 1;
    const auto goes_on = [&](auto&& fits) {
        while (end < text_.size() && fits(text_[end])) {
            ++end;
        }
    };
    if (kind == RapidToken::Kind::Word) {
        goes_on([](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
    } else if (kind == RapidToken::Kind::Number) {
        // The sign of an exponent stands behind its E.
        goes_on([&](char c) {
            const bool exponent = lower_case(text_[end - 1]) == 'e';
            return is_digit(c) || c == '.' || lower_case(c) == 'e' ||
                   (exponent && (c == '+' || c == '-'));
        });
    } else if (kind == RapidToken::Kind::Text) {
        const std::size_t close = text_.find_first_of("\"\n", end);
        const bool closed = close != std::string_view::npos && text_[close] == '"';
        end = closed ? close + 1 : end;
    } else if (text_.substr(at_, 2) == ":=") {
        ++end;
    }
    return end;
}

}  // namespace meshwind
