/// Lines of RS274 text as words and comments.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace meshwind {

/// What opens a comment.
enum class NcComments {
    Brackets,             ///< ( ) alone
    BracketsOrSemicolon,  ///< both; what stands behind ; means nothing
    Semicolon,            ///< ; to the end of the line alone
};

/// A letter, in upper case, and the text of its number.
struct NcWord {
    char letter = '?';
    std::string_view number{};
};

/// One line: what stands outside the comments, and inside each.
struct NcLine {
    const std::string* file = nullptr;  ///< name used in messages
    std::int32_t number = 0;            ///< from 1
    std::vector<NcWord> words{};
    NcComments style = NcComments::BracketsOrSemicolon;
    std::vector<std::string_view> comments{};  ///< in order; behind ; where there is no ( )
    bool drops_digits = false;                 ///< of numbers, what is finer than 1e-9

    /// Replaces words and comments by those of `text`, which must outlive them.
    /// \throws InputError nc.comment, nc.not_understood, nc.number, nc.word_twice
    void split(std::string_view text);

    /// Replaces the comments alone; what stands between them is returned in lower case without
    /// blanks. \throws InputError nc.comment
    [[nodiscard]] std::string split_comments(std::string_view text);

    [[noreturn]] void fail(const std::string& code, const std::string& words_of_message) const;
    [[noreturn]] void not_understood(const NcWord& word) const;
    [[noreturn]] void bad_number(const NcWord& word) const;

    /// The word's number in 1e-9 units, exactly but for what drops_digits. \throws InputError
    /// nc.number
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
