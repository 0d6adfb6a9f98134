/// Keys of a JSON object tied to the fields of a struct. Each key is one row; reader, writer (where
/// there is one) and schema come from it.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/text/strict_json.h"
#include "core/text/text_number.h"

namespace meshwind {

using SchemaJson = nlohmann::ordered_json;

/// Where a number or a count is the planner's choice, the file has this word.
inline constexpr std::string_view kAutoWord = "auto";

template <typename Owner>
struct Key {
    std::string_view name;
    std::string_view meaning;  ///< for schema and reference; units first; may be empty
    SchemaJson schema;         ///< without the meaning
    /// Not called where the file says null, unless it must have the key.
    std::function<void(const JsonValue&, Owner&)> read;
    /// The value as JSON; empty: left out. No function: of a table that is only read.
    std::function<std::string(const Owner&)> text{};
    /// The value in a file of only the keys that it needs; empty: left out. No function: the text,
    /// where it differs from that of the defaults.
    std::function<std::string(const Owner&, const Owner& defaults)> told{};
    /// Whether the file must have it, given the keys before it. No function: it need not.
    std::function<bool(const Owner&)> needed{};
    bool required = false;  ///< the file must have it, whatever else it says
};

template <typename Owner>
struct KeyTable {
    std::vector<Key<Owner>> keys;  ///< in the order of reading and writing
    /// Checks between keys beyond that; may be empty.
    std::function<void(const JsonObject&, Owner&)> check{};
    SchemaJson rules = SchemaJson::object();  ///< the same for the schema: "allOf", "required", ..
};

template <typename Owner>
std::vector<std::string_view> names_of(const KeyTable<Owner>& table) {
    std::vector<std::string_view> names;
    for (const Key<Owner>& key : table.keys) {
        names.push_back(key.name);
    }
    return names;
}

/// Path of the first key of this name inside keys that are objects, or lists of them: as
/// mandrel.turn or layers.0.angle; empty where there is none.
template <typename Owner>
std::string key_below(const KeyTable<Owner>& table, std::string_view name) {
    const auto has = [name](const SchemaJson& schema) {
        const auto keys = schema.find("properties");
        return keys != schema.end() && keys->contains(name);
    };
    for (const Key<Owner>& key : table.keys) {
        const auto items = key.schema.find("items");
        if (has(key.schema)) {
            return std::string(key.name) + "." + std::string(name);
        }
        if (items != key.schema.end() && has(*items)) {
            return std::string(key.name) + ".0." + std::string(name);
        }
    }
    return {};
}

/// Reads an object into `owner`; fields whose keys it leaves out stay as they are.
/// \throws InputError json.*, and what keys throw
template <typename Owner>
void read_keys(const KeyTable<Owner>& table, const JsonValue& value, Owner& owner) {
    const JsonObject object = value.object(
        names_of(table), [&table](std::string_view name) { return key_below(table, name); });
    for (const Key<Owner>& key : table.keys) {
        if (key.required || (key.needed && key.needed(owner))) {
            key.read(object.required(key.name), owner);
        } else if (const auto found = object.optional(key.name)) {
            key.read(*found, owner);
        }
    }
    if (table.check) {
        table.check(object, owner);
    }
}

inline std::string number_text(double value) {
    std::string digits;
    append_shortest(digits, value);
    return digits;
}

/// As JsonValue::vector3() reads it.
inline std::string vector_text(const Eigen::Vector3d& vector) {
    return "[" + number_text(vector[0]) + "," + number_text(vector[1]) + "," +
           number_text(vector[2]) + "]";
}

/// In quotes, with what JSON escapes and all that is not ASCII.
inline std::string string_text(std::string_view raw) {
    return nlohmann::json(raw).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

/// Members of an object as JSON text. \param between separator of two members
template <typename Owner>
std::string keys_text(const KeyTable<Owner>& table, const Owner& owner,
                      std::string_view between = ", ") {
    std::string text;
    for (const Key<Owner>& key : table.keys) {
        const std::string value = key.text(owner);
        if (!value.empty()) {
            text += text.empty() ? "" : between;
            text += '"';
            text += key.name;
            text += "\":" + value;
        }
    }
    return text;
}

/// Key::told, or its default.
template <typename Owner>
std::string told_text(const Key<Owner>& key, const Owner& owner, const Owner& defaults) {
    if (key.told) {
        return key.told(owner, defaults);
    }
    std::string text = key.text(owner);
    return text == key.text(defaults) ? std::string() : text;
}

/// The members that differ from the defaults (Key::told), without blanks between.
template <typename Owner>
std::string told_keys_text(const KeyTable<Owner>& table, const Owner& owner,
                           const Owner& defaults) {
    std::string text;
    for (const Key<Owner>& key : table.keys) {
        const std::string value = told_text(key, owner, defaults);
        if (!value.empty()) {
            text += text.empty() ? "\"" : ",\"";
            text += key.name;
            text += "\":" + value;
        }
    }
    return text;
}

template <typename Owner>
SchemaJson keys_schema(const KeyTable<Owner>& table) {
    SchemaJson schema = {{"type", "object"}, {"additionalProperties", false}};
    SchemaJson required = SchemaJson::array();
    for (const Key<Owner>& key : table.keys) {
        SchemaJson& property = schema["properties"][std::string(key.name)];
        if (!key.meaning.empty()) {
            property["description"] = key.meaning;
        }
        property.update(key.schema);
        if (key.required) {
            required.push_back(key.name);
        }
    }
    if (!required.empty()) {
        schema["required"] = required;
    }
    schema.update(table.rules);
    return schema;
}

inline SchemaJson number_schema(const JsonRange& range) {
    SchemaJson schema = {{"type", "number"}};
    const auto bound = [&](const char* name, double value) {
        if (std::isinf(value)) {
            return;
        }
        // Whole numbers without a fraction, as a person writes them.
        const auto whole = static_cast<std::int64_t>(value);
        static_cast<double>(whole) == value ? schema[name] = whole : schema[name] = value;
    };
    bound(range.above_min ? "exclusiveMinimum" : "minimum", range.min);
    bound("maximum", range.max);
    return schema;
}

inline SchemaJson vector_schema(const JsonRange& range = {}) {
    return {{"type", "array"}, {"items", number_schema(range)}, {"minItems", 3}, {"maxItems", 3}};
}

inline SchemaJson count_schema(std::int64_t least, std::int64_t most) {
    return {{"type", "integer"}, {"minimum", least}, {"maximum", most}};
}

/// Rules between keys (KeyTable::rules), from their text.
inline SchemaJson schema_rules(const char* text) {
    return SchemaJson::parse(text);
}

inline SchemaJson or_word(std::string_view word, const SchemaJson& schema) {
    return {{"default", word},
            {"oneOf", SchemaJson::array({SchemaJson::object({{"const", word}}), schema})}};
}

/// The same with a default.
inline SchemaJson with_default(SchemaJson schema, const SchemaJson& value) {
    schema["default"] = value;
    return schema;
}

// Rows of the common kinds.

template <typename Owner>
Key<Owner> number(std::string_view name, double Owner::*field, const JsonRange& range,
                  std::string_view meaning) {
    const Owner defaults;
    return {name, meaning, with_default(number_schema(range), defaults.*field),
            [=](const JsonValue& value, Owner& owner) { owner.*field = value.number(range); },
            [=](const Owner& owner) { return number_text(owner.*field); }};
}

/// Left out where it is not set.
template <typename Owner>
Key<Owner> number(std::string_view name, std::optional<double> Owner::*field,
                  const JsonRange& range, std::string_view meaning) {
    return {name, meaning, number_schema(range),
            [=](const JsonValue& value, Owner& owner) { owner.*field = value.number(range); },
            [=](const Owner& owner) {
                return owner.*field ? number_text(*(owner.*field)) : std::string();
            }};
}

inline bool is_auto(const JsonValue& value) {
    return value.is_string() && value.one_of({kAutoWord}) == 0;
}

/// "auto" where it is 0, or not set.
template <typename Owner, typename Number>
Key<Owner> number_or_auto(std::string_view name, Number Owner::*field, const JsonRange& range,
                          std::string_view meaning) {
    return {name, meaning, or_word(kAutoWord, number_schema(range)),
            [=](const JsonValue& value, Owner& owner) {
                if (!is_auto(value)) {
                    owner.*field = value.number(range);
                }
            },
            [=](const Owner& owner) {
                double set = 0.0;
                if constexpr (std::is_same_v<Number, double>) {
                    set = owner.*field;
                } else {
                    set = (owner.*field).value_or(0.0);
                }
                return set > 0.0 ? number_text(set) : string_text(kAutoWord);
            }};
}

template <typename Owner, typename Integer>
Key<Owner> count(std::string_view name, Integer Owner::*field, std::int64_t most,
                 std::string_view meaning) {
    const Owner defaults;
    return {name, meaning, with_default(count_schema(1, most), defaults.*field),
            [=](const JsonValue& value, Owner& owner) {
                owner.*field = static_cast<Integer>(value.integer(1, most));
            },
            [=](const Owner& owner) { return std::to_string(owner.*field); }};
}

/// Left out where it is not set.
template <typename Owner, typename Integer>
Key<Owner> count(std::string_view name, std::optional<Integer> Owner::*field, std::int64_t most,
                 std::string_view meaning) {
    return {name, meaning, count_schema(1, most),
            [=](const JsonValue& value, Owner& owner) {
                owner.*field = static_cast<Integer>(value.integer(1, most));
            },
            [=](const Owner& owner) {
                return owner.*field ? std::to_string(*(owner.*field)) : std::string();
            }};
}

/// Left out where it is 0.
template <typename Owner, typename Integer>
Key<Owner> count_if_any(std::string_view name, Integer Owner::*field, std::int64_t most,
                        std::string_view meaning) {
    Key<Owner> key = count(name, field, most, meaning);
    key.schema = count_schema(1, most);
    key.text = [=](const Owner& owner) {
        return owner.*field > 0 ? std::to_string(owner.*field) : std::string();
    };
    return key;
}

/// "auto" where it is 0.
template <typename Owner, typename Integer>
Key<Owner> count_or_auto(std::string_view name, Integer Owner::*field, std::int64_t most,
                         std::string_view meaning) {
    return {name, meaning, or_word(kAutoWord, count_schema(1, most)),
            [=](const JsonValue& value, Owner& owner) {
                if (!is_auto(value)) {
                    owner.*field = static_cast<Integer>(value.integer(1, most));
                }
            },
            [=](const Owner& owner) {
                return owner.*field > 0 ? std::to_string(owner.*field) : string_text(kAutoWord);
            }};
}

/// Any text. Left out where it is empty.
template <typename Owner>
Key<Owner> any_text(std::string_view name, std::string Owner::*field, std::string_view meaning) {
    return {name,
            meaning,
            {{"type", "string"}},
            [=](const JsonValue& value, Owner& owner) { owner.*field = value.string(); },
            [=](const Owner& owner) {
                return (owner.*field).empty() ? std::string() : string_text(owner.*field);
            }};
}

/// \param words in the order of the enumerators
template <typename Owner, typename Enum>
Key<Owner> word(std::string_view name, Enum Owner::*field, std::vector<std::string_view> words,
                std::string_view meaning) {
    const auto word_of = [words](Enum value) { return words[static_cast<std::size_t>(value)]; };
    const Owner defaults;
    return {name,
            meaning,
            {{"enum", words}, {"default", word_of(defaults.*field)}},
            [field, words](const JsonValue& value, Owner& owner) {
                owner.*field = static_cast<Enum>(value.one_of(words));
            },
            [=](const Owner& owner) { return string_text(word_of(owner.*field)); }};
}

/// \param table lives as long as this one
template <typename Owner, typename Inner>
Key<Owner> object(std::string_view name, Inner Owner::*field, const KeyTable<Inner>& table,
                  std::string_view meaning) {
    return {
        name,
        meaning,
        keys_schema(table),
        [field, &table](const JsonValue& value, Owner& owner) {
            read_keys(table, value, owner.*field);
        },
        [field, &table](const Owner& owner) { return "{" + keys_text(table, owner.*field) + "}"; },
        [field, &table](const Owner& owner, const Owner& defaults) {
            const std::string keys = told_keys_text(table, owner.*field, defaults.*field);
            return keys.empty() ? std::string() : "{" + keys + "}";
        }};
}

/// A key that the file must have.
template <typename Owner>
Key<Owner> required(Key<Owner> key) {
    key.schema.erase("default");
    key.required = true;
    return key;
}

/// A key that may be left out and may be null, which says the same; its meaning tells what holds
/// then.
template <typename Owner>
Key<Owner> or_null(Key<Owner> key) {
    key.schema.erase("default");
    if (key.schema.contains("enum")) {
        key.schema["enum"].push_back(nullptr);
    } else {
        key.schema["type"] = SchemaJson::array({key.schema["type"], "null"});
    }
    return key;
}

/// A key that only some objects read: others refuse it and do not write it.
template <typename Owner>
Key<Owner> only_if(std::function<bool(const Owner&)> reads, const std::string& code,
                   const std::string& refusal, Key<Owner> key) {
    key.read = [reads, code, refusal, read = std::move(key.read)](const JsonValue& value,
                                                                  Owner& owner) {
        if (!reads(owner)) {
            value.fail(code, refusal);
        }
        read(value, owner);
    };
    key.told = [reads, inner = key](const Owner& owner, const Owner& defaults) {
        return !reads(owner)     ? std::string()
               : reads(defaults) ? told_text(inner, owner, defaults)
                                 : inner.text(owner);
    };
    key.text = [reads, text = std::move(key.text)](const Owner& owner) {
        return reads(owner) ? text(owner) : std::string();
    };
    return key;
}

}  // namespace meshwind
