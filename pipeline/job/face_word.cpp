#include "pipeline/job/face_word.h"

#include <algorithm>
#include <cctype>

#include "mesh/cad_face.h"
#include "pipeline/job/job_ranges.h"

namespace meshwind {
namespace {

constexpr std::size_t kColourLetters = 7;  // "#rrggbb"

bool is_colour(const std::string& word) {
    return word.size() == kColourLetters && word[0] == '#' &&
           std::all_of(word.begin() + 1, word.end(),
                       [](unsigned char letter) { return std::isxdigit(letter) != 0; });
}

std::string all_kinds(const std::string& between) {
    std::string words;
    for (const std::string_view kind : kCadFaceKinds) {
        words += words.empty() ? "" : between;
        words += kind;
    }
    return words;
}

}  // namespace

std::string read_face_word(const JsonValue& value) {
    if (!value.is_string()) {
        return std::to_string(value.integer(1, kMaxId));
    }
    std::string word = value.string();
    if (is_colour(word)) {
        std::transform(word.begin(), word.end(), word.begin(), [](unsigned char letter) {
            return static_cast<char>(std::tolower(letter));
        });
        return word;
    }
    if (std::find(kCadFaceKinds.begin(), kCadFaceKinds.end(), word) == kCadFaceKinds.end()) {
        value.fail("json.out_of_range", "\"" + word + "\" names no face; give a number, a colour " +
                                            "as \"#ff0000\", or a kind: " + all_kinds(", "));
    }
    return word;
}

SchemaJson face_word_schema() {
    return {{"oneOf",
             SchemaJson::array({count_schema(1, kMaxId),
                                {{"type", "string"},
                                 {"pattern", "^(" + all_kinds("|") + "|#[0-9A-Fa-f]{6})$"}}})}};
}

std::string face_word_text(const std::string& word) {
    return std::isdigit(static_cast<unsigned char>(word[0])) != 0 ? word : string_text(word);
}

}  // namespace meshwind
