/// Tokeniser for mesh files in text: lines and words, each with its place for error messages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace meshwind {

/// How a format breaks its text into lines.
struct MeshTextRules {
    char comment = '\0';   ///< starts a comment that runs to the end of the line; '\0': none
    bool joined = false;   ///< a line that ends in '\' goes on in the next one
    std::size_t skip = 0;  ///< bytes before the first line
    std::int64_t lines_before = 0;  ///< lines in those bytes
};

/// Reads forward once. Lines end with "\n", "\r\n" or "\r"; words are parted by blanks.
class MeshText {
public:
    /// \param bytes must live as long as this \param file name for the errors
    MeshText(std::string_view bytes, std::string file, MeshTextRules rules = {});

    /// Goes to the next line that has a word; some of them are cancellation points.
    /// \return false at the end of the text \throws Interrupted
    bool next_line();

    /// Takes the next word of the line; empty at its end.
    std::string_view word();

    /// Takes the next word across line ends; empty at the end of the text.
    std::string_view word_of_text();

    /// Skips the rest of the line.
    void pass_line();

    /// Takes a number; "nan" and "inf" are numbers here, and values too large for a double are
    /// infinite. \param of for the error: what the number is one of, e.g. "a point's three
    /// coordinates" \throws InputError mesh.bad_line
    double number(std::string_view of);

    /// Takes a whole number. \throws InputError mesh.bad_line
    std::int64_t integer(std::string_view of);

    /// Line of the last word, from 1.
    [[nodiscard]] std::int64_t line() const { return line_; }

    /// Bytes before the next word or the end of its line.
    [[nodiscard]] std::size_t offset() const { return at_; }

    /// "file:line". \param line of this file, from 1
    [[nodiscard]] std::string place(std::int64_t line) const;

    /// \throws InputError with this code at the line of the last word
    [[noreturn]] void refuse(const std::string& code, const std::string& message) const;

private:
    [[nodiscard]] bool at_line_end() const;
    void pass_line_end();
    void pass_blanks();

    std::string_view bytes_;
    std::string file_;
    MeshTextRules rules_;
    std::size_t at_ = 0;
    std::int64_t line_ = 1;
    bool started_ = false;
};

/// Text to quote in an error: the word itself if it is short and printable.
[[nodiscard]] std::string shown(std::string_view word);

/// The whole of `word` as a whole number. \return false if it is none or beyond 64 bits
bool parse_integer(std::string_view word, std::int64_t& value);

}  // namespace meshwind
