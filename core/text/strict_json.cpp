#include "core/text/strict_json.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/text/text_file.h"
#include "core/text/text_number.h"

namespace meshwind {
namespace {

using Json = nlohmann::json;

// Numbers up to this size have no fraction that a double could hide.
constexpr double kLargestInteger = 9007199254740992.0;  // 2^53

const Json& json(const void* node) {
    return *static_cast<const Json*>(node);
}

// Of a list; nothing where the text is no whole number.
std::optional<std::size_t> index_of(std::string_view text) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(index)
                                                                    : std::nullopt;
}

// A value as people type it: JSON, a number with less than JSON asks for (.5, 3., +2), or a word.
Json typed(std::string_view value) {
    Json parsed = Json::parse(value, nullptr, false);
    if (!parsed.is_discarded()) {
        return parsed;
    }
    const std::string_view digits =
        value.starts_with('+') && !value.starts_with("+-") ? value.substr(1) : value;
    double number = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    const bool whole = error == std::errc() && end == digits.data() + digits.size();
    return whole && std::isfinite(number) ? Json(number) : Json(std::string(value));
}

std::string escaped_token(std::string_view key) {
    std::string token;
    for (const char c : key) {
        if (c == '~') {
            token += "~0";
        } else if (c == '/') {
            token += "~1";
        } else {
            token += static_cast<unsigned char>(c) < ' ' ? '?' : c;
        }
    }
    return token;
}

std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    return text;
}

std::string kind_of(const Json& node) {
    switch (node.type()) {
        case Json::value_t::null:
            return "null";
        case Json::value_t::object:
            return "an object";
        case Json::value_t::array:
            return "an array";
        case Json::value_t::string:
            return "a string";
        case Json::value_t::boolean:
            return "true or false";
        default:
            return "a number";
    }
}

std::string text_of(double value) {
    std::string text;
    append_shortest(text, value);
    return text;
}

std::string list_of(const std::vector<std::string_view>& words) {
    std::string text;
    for (const std::string_view word : words) {
        text += (text.empty() ? "\"" : ", \"") + std::string(word) + "\"";
    }
    return text;
}

// Letters to insert, remove, replace or exchange with their neighbour (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before_last(b.size() + 1);
    std::vector<std::size_t> last(b.size() + 1);
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        before_last.swap(last);
        last.swap(row);
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            row[j + 1] = std::min({last[j] + (a[i] == b[j] ? 0 : 1), last[j + 1] + 1, row[j] + 1});
            if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j]) {
                row[j + 1] = std::min(row[j + 1], before_last[j - 1] + 1);
            }
        }
    }
    return row.back();
}

// nlohmann keeps the last of two equal keys without a word; this callback refuses them.
class DuplicateKeys {
public:
    explicit DuplicateKeys(const std::string& file) : file_(file) {}

    bool operator()(int /*depth*/, Json::parse_event_t event, Json& parsed) {
        if (event == Json::parse_event_t::object_start) {
            keys_.emplace_back();
        } else if (event == Json::parse_event_t::object_end) {
            keys_.pop_back();
        } else if (event == Json::parse_event_t::key) {
            const std::string key = parsed.get<std::string>();
            if (!keys_.back().insert(key).second) {
                throw InputError(
                    "json.duplicate_key", file_,
                    one_line("key \"" + key + "\" stands twice in one object; remove one"));
            }
        }
        return true;
    }

private:
    const std::string& file_;
    std::vector<std::set<std::string>> keys_;
};

std::size_t line_of_byte(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, std::min(byte, text.size()));
    return 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
}

// "[json.exception.parse_error.101] parse error at line 3, column 5: words" -> "words"
std::string words_of(const Json::exception& error) {
    const std::string text = error.what();
    const std::size_t colon = text.find(": ");
    return one_line(colon == std::string::npos ? text : text.substr(colon + 2));
}

}  // namespace

std::optional<std::string_view> nearest_word(std::string_view word,
                                             const std::vector<std::string_view>& known) {
    std::optional<std::string_view> nearest;
    std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string_view candidate : known) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < least) {
            least = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

JsonValue::JsonValue(const void* node, const std::string* file, std::string pointer)
    : node_(node), file_(file), pointer_(std::move(pointer)) {}

std::string JsonValue::place() const {
    return pointer_.empty() ? *file_ : *file_ + ": " + pointer_;
}

void JsonValue::fail(const std::string& code, const std::string& message) const {
    throw InputError(code, place(), one_line(message));
}

bool JsonValue::is_null() const {
    return json(node_).is_null();
}
bool JsonValue::is_string() const {
    return json(node_).is_string();
}
bool JsonValue::is_number() const {
    return json(node_).is_number();
}
bool JsonValue::is_array() const {
    return json(node_).is_array();
}
bool JsonValue::is_object() const {
    return json(node_).is_object();
}

JsonObject JsonValue::object(const std::vector<std::string_view>& names,
                             const std::function<std::string(std::string_view)>& elsewhere) const {
    const Json& node = json(node_);
    if (!node.is_object()) {
        fail("json.wrong_type", "is " + kind_of(node) + "; write an object {..}");
    }
    for (const auto& [key, child] : node.items()) {
        if (std::find(names.begin(), names.end(), key) != names.end()) {
            continue;
        }
        std::string meant = elsewhere ? elsewhere(key) : std::string();
        if (meant.empty()) {
            meant = nearest_word(key, names).value_or("");
        }
        JsonValue(&child, file_, pointer_ + "/" + escaped_token(key))
            .fail("json.unknown_key", meant.empty()
                                          ? "unknown key; the known ones are " + list_of(names)
                                          : "unknown key; did you mean \"" + meant + "\"?");
    }
    return JsonObject(*this);
}

std::vector<JsonValue> JsonValue::array() const {
    const Json& node = json(node_);
    if (!node.is_array()) {
        fail("json.wrong_type", "is " + kind_of(node) + "; write an array [..]");
    }
    std::vector<JsonValue> values;
    values.reserve(node.size());
    for (std::size_t i = 0; i < node.size(); ++i) {
        values.push_back(JsonValue(&node[i], file_, pointer_ + "/" + std::to_string(i)));
    }
    return values;
}

std::string JsonValue::string() const {
    const Json& node = json(node_);
    if (!node.is_string()) {
        fail("json.wrong_type", "is " + kind_of(node) + "; write a string in quotes");
    }
    return node.get<std::string>();
}

bool JsonValue::boolean() const {
    const Json& node = json(node_);
    if (!node.is_boolean()) {
        fail("json.wrong_type", "is " + kind_of(node) + "; write true or false");
    }
    return node.get<bool>();
}

double JsonValue::number(const JsonRange& range) const {
    const Json& node = json(node_);
    if (!node.is_number()) {
        fail("json.wrong_type", "is " + kind_of(node) + "; write a number");
    }
    const double value = node.get<double>();
    if (value < range.min || (range.above_min && value == range.min)) {
        fail("json.out_of_range", "is " + text_of(value) + "; must be " +
                                      (range.above_min ? "above " : "at least ") +
                                      text_of(range.min));
    }
    if (value > range.max) {
        fail("json.out_of_range",
             "is " + text_of(value) + "; must be at most " + text_of(range.max));
    }
    return value;
}

long long JsonValue::integer(long long min, long long max) const {
    const double value = number();
    if (value != std::floor(value) || std::abs(value) > kLargestInteger) {
        fail("json.wrong_type", "is " + text_of(value) + "; write a number without a fraction");
    }
    return static_cast<long long>(
        number({.min = static_cast<double>(min), .max = static_cast<double>(max)}));
}

Eigen::Vector3d JsonValue::vector3() const {
    const std::vector<JsonValue> values = array();
    if (values.size() != 3) {
        fail("json.wrong_type",
             "has " + std::to_string(values.size()) + " entries; write three numbers [x, y, z]");
    }
    return {values[0].number(), values[1].number(), values[2].number()};
}

std::size_t JsonValue::one_of(const std::vector<std::string_view>& words) const {
    const std::string text = string();
    const auto found = std::find(words.begin(), words.end(), text);
    if (found == words.end()) {
        const std::optional<std::string_view> near = nearest_word(text, words);
        fail("json.out_of_range", "is \"" + text + "\"; " +
                                      (near ? "did you mean \"" + std::string(*near) + "\"?"
                                            : "choose one of " + list_of(words)));
    }
    return static_cast<std::size_t>(found - words.begin());
}

JsonValue JsonObject::required(std::string_view key) const {
    const Json& node = json(value_.node_);
    const auto found = node.find(key);
    if (found == node.end()) {
        value_.fail("json.missing_key", "key \"" + std::string(key) + "\" is missing; add it");
    }
    return {&*found, value_.file_, value_.pointer_ + "/" + escaped_token(key)};
}

std::optional<JsonValue> JsonObject::optional(std::string_view key) const {
    const Json& node = json(value_.node_);
    const auto found = node.find(key);
    if (found == node.end() || found->is_null()) {
        return std::nullopt;
    }
    return JsonValue(&*found, value_.file_, value_.pointer_ + "/" + escaped_token(key));
}

struct JsonDocument::Impl {
    std::string file;
    Json root;
};

JsonDocument::JsonDocument(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
JsonDocument::JsonDocument(JsonDocument&&) noexcept = default;
JsonDocument& JsonDocument::operator=(JsonDocument&&) noexcept = default;
JsonDocument::~JsonDocument() = default;

JsonDocument JsonDocument::parse(std::string_view text, const std::string& file) {
    auto impl = std::make_unique<Impl>();
    impl->file = file;
    try {
        impl->root = Json::parse(text.begin(), text.end(), DuplicateKeys(impl->file));
    } catch (const Json::parse_error& error) {
        // `byte` counts from 1 and points at the last byte read; the one before it is surely read.
        const std::size_t line = line_of_byte(text, error.byte > 0 ? error.byte - 1 : 0);
        const bool comment =
            error.byte > 0 && error.byte <= text.size() &&
            std::string_view("/#").find(text[error.byte - 1]) != std::string_view::npos;
        throw InputError("json.syntax", file + ":" + std::to_string(line),
                         "not valid JSON: " + words_of(error) +
                             (comment ? "; JSON has no comments: leave it out, or in a machine "
                                        "file write \"description\" or \"note\""
                                      : ""));
    } catch (const Json::exception& error) {
        throw InputError("json.syntax", file, "not valid JSON: " + words_of(error));
    }
    return JsonDocument(std::move(impl));
}

JsonDocument JsonDocument::load(const std::string& file) {
    return parse(read_text_file(file), file);
}

void JsonDocument::set(std::string_view path, std::string_view value) {
    const auto fail = [&](const std::string& message) {
        throw InputError("json.no_such_place", impl_->file, std::string(path) + " " + message);
    };
    Json* node = &impl_->root;
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find('.', begin), path.size());
        const std::string_view step = path.substr(begin, end - begin);
        begin = end + 1;
        const std::optional<std::size_t> index = index_of(step);
        if (node->is_null()) {
            *node = index ? Json::array() : Json::object();
        }
        if (step.empty()) {
            fail("has an empty name; write keys joined by dots, \"tow.width\"");
        }
        if (node->is_object()) {
            node = &(*node)[std::string(step)];
        } else if (node->is_array() && index && *index <= node->size()) {
            if (*index == node->size()) {
                node->push_back(Json());
            }
            node = &(*node)[*index];
        } else if (node->is_array()) {
            fail("leads to no entry of a list of " + std::to_string(node->size()) +
                 "; the first one is 0");
        } else {
            fail("leads through a value that is neither object nor list");
        }
    }
    *node = typed(value);
}

JsonValue JsonDocument::root() const {
    return {&impl_->root, &impl_->file, ""};
}

}  // namespace meshwind
