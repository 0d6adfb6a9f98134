/// Splits RAPID text into tokens.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

namespace meshwind {

struct RapidToken {
    enum class Kind {
        Word,    ///< identifier or reserved word; small and capital letters are alike
        Number,  ///< without its sign
        Text,    ///< with its quotes
        Mark,    ///< one character, or :=
        End,     ///< of the text
    };
    Kind kind = Kind::End;
    std::string_view text{};  ///< as it stands
    std::int32_t line = 0;    ///< from 1

    /// \param word in small letters
    [[nodiscard]] bool is_word(std::string_view word) const;
    [[nodiscard]] bool is(std::string_view mark) const {
        return kind == Kind::Mark && text == mark;
    }
    /// Nothing where the text is not a number as a whole.
    [[nodiscard]] std::optional<double> value() const;
};

/// Token after token. RAPID is free of form: blanks and ends of lines stand between any two; a
/// comment goes from ! to the end of its line. Nothing is refused here: a character that no token
/// begins with is a mark of its own, and so is the quote of a text that its line does not close.
class RapidTokens {
public:
    /// The words of a comment, without a blank in front and those behind, and their line.
    using OnComment = std::function<void(std::string_view, std::int32_t)>;

    /// \pre text outlives this
    RapidTokens(std::string_view text, OnComment on_comment)
        : text_(text), on_comment_(std::move(on_comment)) {}

    /// The next one; comments before it are told of first.
    [[nodiscard]] RapidToken next();

private:
    void skip();
    [[nodiscard]] std::size_t end_of_token(RapidToken::Kind kind) const;

    std::string_view text_;
    OnComment on_comment_;
    std::size_t at_ = 0;
    std::int32_t line_ = 1;
};

}  // namespace meshwind
