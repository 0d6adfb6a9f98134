#include "cli/usage.h"

#include <algorithm>
#include <optional>

#include "core/text/strict_json.h"
#include "pipeline/job/key_named.h"

namespace meshwind {
namespace {

const CommandWords* find_command(const CommandWords& in, std::string_view name) {
    const auto at = std::find_if(in.commands.begin(), in.commands.end(),
                                 [&](const CommandWords& each) { return each.name == name; });
    return at == in.commands.end() ? nullptr : &*at;
}

const OptionWords* find_option(const CommandWords& in, std::string_view name) {
    const auto at = std::find_if(in.options.begin(), in.options.end(),
                                 [&](const OptionWords& each) { return each.name == name; });
    return at == in.options.end() ? nullptr : &*at;
}

template <class Words>
std::vector<std::string_view> names_of(const std::vector<Words>& words) {
    std::vector<std::string_view> names;
    names.reserve(words.size());
    for (const Words& each : words) {
        names.push_back(each.name);
    }
    return names;
}

std::string list_of(std::span<const std::string_view> words) {
    std::string text;
    for (const std::string_view word : words) {
        text.append(text.empty() ? "" : ", ").append(word);
    }
    return text;
}

// Words that begin alike are meant, too: "inch" for "in".
std::optional<std::string_view> near_word(std::string_view word,
                                          std::span<const std::string_view> known) {
    const std::vector<std::string_view> words(known.begin(), known.end());
    if (const auto nearest = nearest_word(word, words)) {
        return nearest;
    }
    std::optional<std::string_view> longest;
    for (const std::string_view candidate : words) {
        const bool alike = word.starts_with(candidate) || candidate.starts_with(word);
        if (alike && (!longest || candidate.size() > longest->size())) {
            longest = candidate;
        }
    }
    return longest;
}

std::string in_quotes(std::string_view word) {
    return '"' + std::string(word) + '"';
}

// The words of a line, sorted into commands, unknown options and the rest.
struct Line {
    std::vector<const CommandWords*> path;  // program first, then the commands that are named
    std::vector<std::string> words;         // neither option nor command
    std::optional<std::string> unknown_option;
    std::optional<std::string> late_command;  // behind a word that is none
};

bool is_option(const std::string& word) {
    return word.size() > 1 && word.front() == '-' && word.find_first_of("0123456789.") != 1;
}

const OptionWords* option_of(const Line& line, std::string_view name) {
    for (const CommandWords* command : line.path) {
        if (const OptionWords* option = find_option(*command, name)) {
            return option;
        }
    }
    return nullptr;
}

Line sorted(const CommandWords& program, std::span<const std::string> arguments) {
    Line line;
    line.path.push_back(&program);
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string& word = arguments[i];
        if (is_option(word)) {
            const std::string name = word.substr(0, word.find('='));
            const OptionWords* option = option_of(line, name);
            if (option == nullptr && !line.unknown_option) {
                line.unknown_option = name;
            }
            const bool value_follows = (option == nullptr || option->takes_value) && name == word &&
                                       i + 1 < arguments.size() && !is_option(arguments[i + 1]);
            i += value_follows ? 1 : 0;
        } else if (const CommandWords* command = find_command(*line.path.back(), word)) {
            if (line.words.empty()) {
                line.path.push_back(command);
            } else {
                line.late_command = word;
            }
        } else {
            line.words.push_back(word);
        }
    }
    return line;
}

std::string called(const Line& line) {
    std::string text = "meshwind";
    for (std::size_t i = 1; i < line.path.size(); ++i) {
        text += " " + line.path[i]->name;
    }
    return text;
}

std::string see_help(const Line& line, const std::string& behind) {
    return (behind.ends_with('?') ? " See " : "; see ") + called(line) + " --help";
}

InputError error_of(const Line& line, const char* code, const std::string& place,
                    const std::string& words) {
    return InputError(code, place, words + see_help(line, words));
}

// Where the command takes settings, the job's key that the unknown option may mean; else empty.
std::string key_meant(const Line& line) {
    return find_option(*line.path.back(), "--set") != nullptr ? job_key_named(*line.unknown_option)
                                                              : std::string();
}

InputError unknown_option(const Line& line) {
    if (const std::string key = key_meant(line); !key.empty()) {
        return error_of(
            line, "cli.unknown_option", *line.unknown_option,
            "is no option of " + called(line) + " but a key of the job: --set " + key + "=VALUE");
    }
    std::vector<std::string_view> known;
    for (const CommandWords* command : line.path) {
        const std::vector<std::string_view> more = names_of(command->options);
        known.insert(known.end(), more.begin(), more.end());
    }
    const auto near = near_word(*line.unknown_option, known);
    const bool parameter = line.path.size() == 3 && line.path[1]->name == "make";
    const std::string what =
        parameter ? "is no parameter of " + line.path[2]->name : "is no option of " + called(line);
    const std::string has = parameter ? "; it has " + list_of(names_of(line.path[2]->options)) : "";
    return error_of(line, parameter ? "make.unknown_parameter" : "cli.unknown_option",
                    *line.unknown_option,
                    what + (near ? "; did you mean " + std::string(*near) + "?" : has));
}

InputError unknown_kind(const Line& line) {
    const std::vector<std::string_view> known = names_of(line.path.back()->commands);
    const bool make = line.path.back()->name == "make";
    const std::string choice = "one of " + list_of(known);
    if (line.words.empty()) {
        return error_of(line, "cli.usage", called(line),
                        std::string("name ") + (make ? "a kind" : "what") + ", " + choice);
    }
    const std::string& word = line.words.front();
    const auto near = near_word(word, known);
    const std::string what = make ? "is no kind" : "is not known to " + called(line);
    return error_of(
        line, make ? "make.unknown_kind" : "cli.unknown_command", word,
        what + "; take " + choice + (near ? "; did you mean " + in_quotes(*near) + "?" : ""));
}

}  // namespace

std::string command_meant(const CommandWords& program, std::string_view word) {
    if (word.find_first_of("./\\") != std::string_view::npos) {
        return {};
    }
    const std::vector<std::string_view> known = names_of(program.commands);
    const auto near = nearest_word(word, known);
    return near ? std::string(*near) : "";
}

std::string why_no_choice(std::string_view word, std::span<const std::string_view> words) {
    if (std::find(words.begin(), words.end(), word) != words.end()) {
        return {};
    }
    const auto near = near_word(word, words);
    return in_quotes(word) + " is none of " + list_of(words) +
           (near ? "; did you mean " + in_quotes(*near) + "?" : "");
}

InputError usage_error(const CommandWords& program, std::span<const std::string> arguments,
                       const std::string& parser_words) {
    const Line line = sorted(program, arguments);
    const bool no_command = line.path.size() == 1;
    if (no_command && !line.words.empty()) {
        const std::string& word = line.words.front();
        const std::string meant = command_meant(program, word);
        if (!meant.empty()) {
            return error_of(line, "cli.unknown_command", word,
                            "is no command; did you mean " + in_quotes(meant) + "?");
        }
        if (line.late_command) {
            return InputError(
                "cli.extra", word,
                "the command comes first: meshwind " + *line.late_command + " " + word);
        }
    }
    if (line.unknown_option) {
        return unknown_option(line);
    }
    if (!no_command && !line.path.back()->commands.empty()) {
        return unknown_kind(line);
    }
    return error_of(line, "cli.usage", "", parser_words);
}

std::vector<std::string> with_help_as_option(std::vector<std::string> arguments) {
    if (!arguments.empty() && arguments.front() == "help") {
        arguments.erase(arguments.begin());
        arguments.emplace_back("--help");
    }
    return arguments;
}

}  // namespace meshwind
