/// Strict, typed reader of JSON files: every mistake is one line with file, JSON pointer and
/// remedy.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace meshwind {

class JsonObject;

/// Which numbers a key takes; the ends belong to the range unless said otherwise.
struct JsonRange {
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    bool above_min = false;  ///< true: `min` itself is refused
};

/// One value inside a JsonDocument, which must outlive it.
/// All readers throw InputError `json.wrong_type` or `json.out_of_range` with the value's place.
class JsonValue {
public:
    /// The value as an object; a key outside `known` is InputError `json.unknown_key`, and the
    /// words suggest the nearest known one.
    /// \param elsewhere of a key's name: where below this object it would be known, as
    /// mandrel.turn; empty: nowhere
    [[nodiscard]] JsonObject object(
        const std::vector<std::string_view>& known,
        const std::function<std::string(std::string_view)>& elsewhere = {}) const;
    [[nodiscard]] std::vector<JsonValue> array() const;
    [[nodiscard]] std::string string() const;
    [[nodiscard]] bool boolean() const;
    [[nodiscard]] double number(const JsonRange& range = {}) const;
    /// A number without a fraction ("3" and "3.0" alike) between `min` and `max`.
    [[nodiscard]] long long integer(long long min, long long max) const;
    /// Three numbers.
    [[nodiscard]] Eigen::Vector3d vector3() const;
    /// Index of the string among `words`; any other string is `json.out_of_range`.
    [[nodiscard]] std::size_t one_of(const std::vector<std::string_view>& words) const;

    [[nodiscard]] bool is_null() const;
    [[nodiscard]] bool is_string() const;
    [[nodiscard]] bool is_number() const;
    [[nodiscard]] bool is_array() const;
    [[nodiscard]] bool is_object() const;

    /// "file: /json/pointer" of this value; the file alone for the root.
    [[nodiscard]] std::string place() const;

    /// \throws InputError always, with this value's place
    [[noreturn]] void fail(const std::string& code, const std::string& message) const;

private:
    friend class JsonDocument;
    friend class JsonObject;
    JsonValue(const void* node, const std::string* file, std::string pointer);

    const void* node_;
    const std::string* file_;
    std::string pointer_;
};

/// The keys of an object whose names have been checked.
class JsonObject {
public:
    /// \throws InputError json.missing_key
    [[nodiscard]] JsonValue required(std::string_view key) const;
    /// Nothing when the key is absent or null.
    [[nodiscard]] std::optional<JsonValue> optional(std::string_view key) const;
    [[nodiscard]] const JsonValue& value() const { return value_; }

private:
    friend class JsonValue;
    explicit JsonObject(JsonValue value) : value_(std::move(value)) {}

    JsonValue value_;
};

/// A parsed file.
class JsonDocument {
public:
    /// \param file name used in messages
    /// \throws InputError json.syntax (place "file:line"), json.duplicate_key
    static JsonDocument parse(std::string_view text, const std::string& file);
    /// \throws IoError io.cannot_read; InputError as parse
    static JsonDocument load(const std::string& file);

    JsonDocument(JsonDocument&&) noexcept;
    JsonDocument& operator=(JsonDocument&&) noexcept;
    ~JsonDocument();

    /// Sets the value at a path; missing objects are made, and an index that is one past the end
    /// adds to its list. \param path keys and indices, joined by dots
    /// \param value JSON; other text is a number where it reads as one (.5), else a string
    /// \throws InputError json.no_such_place where the path leads through something that is
    /// neither object nor list, or beyond the end of one
    void set(std::string_view path, std::string_view value);

    /// \pre the document is neither moved from nor moved while the value lives
    [[nodiscard]] JsonValue root() const;

private:
    struct Impl;
    explicit JsonDocument(std::unique_ptr<Impl> impl);

    std::unique_ptr<Impl> impl_;
};

/// The word nearest to `word` by edit distance (exchanged neighbours count once), or nothing when
/// none is near enough to be a slip of the pen (more than a third of its letters differ, and more
/// than one).
[[nodiscard]] std::optional<std::string_view> nearest_word(
    std::string_view word, const std::vector<std::string_view>& known);

}  // namespace meshwind
