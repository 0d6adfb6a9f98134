#include "postproc/nc/nc_form.h"

#include <algorithm>

#include "postproc/nc/float32_steps.h"

namespace meshwind {
namespace {

bool is_harmless(const NcFlavour& flavour, std::string_view word) {
    return std::any_of(
        flavour.harmless_words.begin(), flavour.harmless_words.end(), [&](std::string_view known) {
            const bool number = known.back() == '=';
            const std::string_view rest = word.substr(std::min(known.size(), word.size()));
            return word.substr(0, known.size()) == known &&
                   (number ? !rest.empty() && rest.find_first_not_of("0123456789.") == rest.npos
                           : rest.empty());
        });
}

void check_command(const NcLine& line, bool foreign, std::string_view code) {
    if (std::any_of(code.begin(), code.end(), [](char c) { return c >= 'a' && c <= 'z'; })) {
        line.fail("nc.not_understood", "the controller knows no small letters");
    }
    const auto is_command = [](const NcWord& w) { return w.letter == 'G' || w.letter == 'M'; };
    const auto& words = line.words;
    const auto commands = std::count_if(words.begin(), words.end(), is_command);
    if (!words.empty() && (commands != 1 || !is_command(words.front()))) {
        line.fail("nc.not_understood",
                  "the controller runs one command a line, which stands in front; give each its "
                  "own");
    }
    const bool takes_words =
        foreign || (!words.empty() &&
                    (words.front().letter == 'M' ||
                     words.front().number.find_first_not_of("01") == std::string_view::npos));
    if (words.size() > 1 && !takes_words) {
        line.not_understood(words[1]);
    }
}

}  // namespace

void check_length(const NcFlavour& flavour, bool foreign, std::string_view text, NcLine& line) {
    std::size_t length = text.size();
    if (length > flavour.line_length && (flavour.counted == NcCounted::Code || foreign)) {
        length = line.split_comments(text).size();
    } else if (length > flavour.line_length && flavour.counted == NcCounted::UpToComment) {
        length = std::min(text.find(';'), length);
    }
    if (length > flavour.line_length) {
        line.fail("nc.long_line", "has " + std::to_string(length) +
                                      " characters; the controller reads at most " +
                                      std::to_string(flavour.line_length));
    }
}

std::string without_harmless_words(const NcFlavour& flavour, std::string_view text) {
    const std::size_t code = std::min(text.find(';'), text.size());
    std::string kept;
    for (std::size_t i = 0; i < code;) {
        const std::size_t end = std::min(text.find_first_of(" \t", i), code);
        const std::string_view word = text.substr(i, end - i);
        kept += is_harmless(flavour, word) ? std::string() : std::string(word) + ' ';
        i = end + (end < code ? 1 : 0);
    }
    kept += text.substr(code);
    return kept;
}

void check_form(const NcFlavour& flavour, bool foreign, std::string_view text, const NcLine& line,
                std::string_view axes) {
    if (flavour.one_command) {
        check_command(line, foreign, text.substr(0, text.find(';')));
    }
    for (const NcWord& word : line.words) {
        const auto digits = std::count_if(word.number.begin(), word.number.end(),
                                          [](char c) { return c >= '0' && c <= '9'; });
        const auto shown = [&word] {
            return std::string("\"") + word.letter + std::string(word.number) + '"';
        };
        if (flavour.most_digits > 0 && digits > static_cast<long>(flavour.most_digits)) {
            line.fail("nc.digits", shown() + " has more than the " +
                                       std::to_string(flavour.most_digits) +
                                       " digits that the controller reads");
        }
        const bool value = word.letter == 'F' || axes.find(word.letter) != std::string_view::npos;
        if (flavour.needs_point && value && word.number.find('.') == std::string_view::npos) {
            line.fail("nc.number",
                      shown() + " has no point and may mean thousandths; write it with one");
        }
    }
}

void check_step(const NcFlavour& flavour, bool foreign, const NcLine& line, const NcWord& word,
                const BlockAxis& axis, std::int64_t value) {
    const bool binary = flavour.float32 != Float32Text::None && value % kFinestBinary_nano == 0;
    if (value % axis.resolution_nano != 0 && !binary && !foreign) {
        line.fail("nc.resolution", std::string("\"") + word.letter + std::string(word.number) +
                                       "\" is not a multiple of the axis' resolution");
    }
}

}  // namespace meshwind
