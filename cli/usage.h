/// Error messages for command lines that the parser refuses, with the nearest known word.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace meshwind {

struct OptionWords {
    std::string name;  ///< "--machine", "-o"
    bool takes_value = true;
};

/// A command with its options and the commands below it; the program itself has no name.
struct CommandWords {
    std::string name;
    std::vector<OptionWords> options;
    std::vector<CommandWords> commands;
};

/// One line that names the word and proposes the nearest one that is known, or the command's help.
/// Codes: cli.unknown_option, cli.unknown_command, cli.extra, make.unknown_kind,
/// make.unknown_parameter, and cli.usage with the parser's own words for everything else.
[[nodiscard]] InputError usage_error(const CommandWords& program,
                                     std::span<const std::string> arguments,
                                     const std::string& parser_words);

/// The command that a word that is no file may mean; empty where none is near.
[[nodiscard]] std::string command_meant(const CommandWords& program, std::string_view word);

/// `"inch" is none of auto, mm, in; did you mean "in"?`; empty where `word` is one of them.
[[nodiscard]] std::string why_no_choice(std::string_view word,
                                        std::span<const std::string_view> words);

/// The arguments with `help [COMMAND..]` as `[COMMAND..] --help`.
[[nodiscard]] std::vector<std::string> with_help_as_option(std::vector<std::string> arguments);

}  // namespace meshwind
