/// Splits lines of RS274 text (G-code) into words and comments.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace meshwind {

/// Characters that open a comment.
enum class NcComments {
    Brackets,             ///< ( ) alone
    BracketsOrSemicolon,  ///< both; text behind ; means nothing
    Semicolon,            ///< ; to the end of the line alone
    Exclamation,          ///< ! to the end of the line alone
};

/// Whether comments stand in brackets.
[[nodiscard]] constexpr bool has_brackets(NcComments comments) {
    return comments == NcComments::Brackets || comments == NcComments::BracketsOrSemicolon;
}

/// What opens a comment to the end of the line. \pre not NcComments::Brackets
[[nodiscard]] constexpr char line_comment(NcComments comments) {
    return comments == NcComments::Exclamation ? '!' : ';';
}

[[nodiscard]] constexpr bool opens_line_comment(char c, NcComments comments) {
    return comments != NcComments::Brackets && c == line_comment(comments);
}

/// A letter, in upper case, and the text of its number.
struct NcWord {
    char letter = '?';
    std::string_view number{};
};

/// One line: the words outside the comments, and the text of each comment.
struct NcLine {
    const std::string* file = nullptr;  ///< name used in messages
    std::int32_t number = 0;            ///< from 1
    std::vector<NcWord> words{};
    NcComments style = NcComments::BracketsOrSemicolon;
    std::vector<std::string_view> comments{};  ///< in order; behind ; where there is no ( )
    bool drops_digits = false;                 ///< drops digits of numbers finer than 1e-9

    /// Replaces words and comments by those of `text`, which must outlive them.
    /// \throws InputError nc.comment, nc.not_understood, nc.number, nc.word_twice
    void split(std::string_view text);

    /// Replaces the comments alone; the text between them is returned in lower case without blanks.
    /// \throws InputError nc.comment
    [[nodiscard]] std::string split_comments(std::string_view text);

    [[noreturn]] void fail(const std::string& code, const std::string& words_of_message) const;
    [[noreturn]] void not_understood(const NcWord& word) const;
    [[noreturn]] void bad_number(const NcWord& word) const;

    /// The word's number in 1e-9 units, exactly unless drops_digits. \throws InputError nc.number
    [[nodiscard]] std::int64_t nano(const NcWord& word) const;

    /// The number of a G or M word in tenths: G61.1 gives 611. \throws InputError nc.number,
    /// nc.not_understood
    [[nodiscard]] int code(const NcWord& word) const;

    /// The number of an F word. \throws InputError nc.feed unless it is above 0
    [[nodiscard]] double feed(const NcWord& word) const;

private:
    [[noreturn]] void no_expressions() const;
    void rest_of_line(std::string_view text);
    std::size_t comment(std::string_view text, std::size_t open);
    std::size_t word(std::string_view text, std::size_t i);
};

}  // namespace meshwind
