#include "postproc/nc/made_from.h"

#include <array>
#include <charconv>

#include "core/text/text_number.h"
#include "postproc/motion/program_head.h"
#include "postproc/nc/dialect.h"
#include "postproc/nc/foreign_notes.h"
#include "postproc/nc/nc_reader.h"

namespace meshwind {
namespace {

constexpr std::string_view kMaker = "meshwind ";
constexpr std::string_view kMandrel = "mandrel: ";
constexpr std::string_view kMandrelDigest = "mandrel digest: ";
constexpr std::string_view kMachineFile = "machine file: ";
constexpr std::string_view kJob = "job: ";
constexpr std::array<std::string_view, 3> kRun = {"run: seed ", ", effort ", ", mandrel "};

// Characters that some controller does not take in a comment. In JSON they stand in strings alone,
// where each can be written by its number.
constexpr std::string_view kNotInComments = "();%!?~";

// On one line, such that it comes back from a comment of every controller as it is.
std::string plain_json(std::string_view json) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string plain;
    bool in_string = false;
    bool escaped = false;
    for (const char c : json) {
        const auto code = static_cast<unsigned char>(c);
        if (in_string && !escaped && (code <= ' ' || kNotInComments.find(c) != std::string::npos)) {
            plain += "\\u00";
            plain += kDigits[code / kDigits.size()];
            plain += kDigits[code % kDigits.size()];
        } else if (in_string || code > ' ') {
            plain += c;
        }
        in_string ^= c == '"' && !escaped;
        escaped = in_string && !escaped && c == '\\';
    }
    return plain;
}

std::optional<std::string_view> behind(std::string_view begin, std::string_view comment) {
    return comment.substr(0, begin.size()) == begin ? std::optional(comment.substr(begin.size()))
                                                    : std::nullopt;
}

// What stands in the brackets, or behind what opens it, of a line that is a comment alone.
std::optional<std::string_view> comment_of(std::string_view line) {
    if (line.size() >= 2 && line.front() == '(' && line.back() == ')') {
        return line.substr(1, line.size() - 2);
    }
    const bool opens = line.substr(0, 2) == "; " || line.substr(0, 2) == "! ";
    return opens ? std::optional(line.substr(2)) : std::nullopt;
}

template <typename Number>
bool take_number(std::string_view& words, std::string_view before, Number& number) {
    const auto rest = behind(before, words);
    if (!rest) {
        return false;
    }
    const auto [end, error] = std::from_chars(rest->data(), rest->data() + rest->size(), number);
    words = rest->substr(static_cast<std::size_t>(end - rest->data()));
    return error == std::errc{};
}

std::optional<MainJobRun> run_of(std::string_view words) {
    MainJobRun run;
    if (!take_number(words, kRun[0], run.seed) || !take_number(words, kRun[1], run.effort)) {
        return std::nullopt;
    }
    const auto mandrel = behind(kRun[2], words);
    if (!mandrel || mandrel->empty() || !(run.effort > 0.0)) {
        return std::nullopt;
    }
    run.mandrel = *mandrel;
    return run;
}

}  // namespace

void append_made_from(std::vector<std::string>& comments, const ProgramHeader& header,
                      std::size_t width) {
    if (!header.machine_file.empty()) {
        comments.push_back(std::string(kMachineFile) + header.machine_file);
    }
    if (header.run) {
        std::string& words = comments.emplace_back(kRun[0]);
        words += std::to_string(header.run->seed);
        words += kRun[1];
        append_shortest(words, header.run->effort);
        words += kRun[2];
        words += header.run->mandrel;
    }
    const std::string job = plain_json(header.job);
    const std::size_t share = width - kJob.size();
    for (std::size_t i = 0; i < job.size(); i += share) {
        comments.push_back(std::string(kJob) + job.substr(i, share));
    }
}

std::optional<MadeFrom> made_from(std::string_view program) {
    const std::string remarks = tp_text(tp_lines(program));
    const std::vector<std::string_view> lines = lines_of_text(remarks.empty() ? program : remarks);
    if (!is_by_meshwind(lines)) {
        return std::nullopt;
    }
    MadeFrom found;
    const std::array<std::pair<std::string_view, std::string*>, 5> texts = {
        {{kMaker, &found.version},
         {kMandrel, &found.mandrel},
         {kMandrelDigest, &found.mandrel_digest},
         {kMachineFile, &found.machine_file},
         {kCodeDigest, &found.code_digest}}};
    for (const std::string_view line : lines) {
        const auto comment = comment_of(line);
        if (!comment && found.version.empty()) {
            continue;  // "%", or the program's number
        }
        if (!comment) {
            break;  // comments further on are of blocks
        }
        for (const auto& [begin, text] : texts) {
            const auto words = behind(begin, *comment);
            if (words && text->empty()) {
                *text = *words;
            }
        }
        if (const auto more = behind(kJob, *comment)) {
            found.job += *more;
        }
        if (!found.run) {
            found.run = run_of(*comment);
        }
    }
    return found;
}

}  // namespace meshwind
