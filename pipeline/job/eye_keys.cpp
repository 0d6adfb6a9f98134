#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/job/job_keys.h"
#include "pipeline/job/job_ranges.h"

namespace meshwind {
namespace {

std::vector<std::string_view> eye_words() {
    std::vector<std::string_view> words;
    words.reserve(kEyeRules.size());
    for (const EyeRuleTraits& rule : kEyeRules) {
        words.push_back(rule.word);
    }
    return words;
}

const KeyTable<LengthPiece>& length_keys() {
    static const KeyTable<LengthPiece> kTable = {
        {
            {"course", "number in the column course of path.csv", count_schema(0, kMaxId),
             [](const JsonValue& value, LengthPiece& piece) {
                 piece.piece = static_cast<std::int32_t>(value.integer(0, kMaxId));
             },
             [](const LengthPiece& piece) {
                 return piece.piece ? std::to_string(*piece.piece) : std::string();
             }},
            [] {
                Key<LengthPiece> key = number("from_mm", &LengthPiece::from_mm, kAlongRange,
                                              "mm of fibre laid since the start of the program");
                key.schema.erase("default");
                key.needed = [](const LengthPiece& piece) { return !piece.piece; };
                return only_if<LengthPiece>(
                    [](const LengthPiece& piece) { return !piece.piece; }, "job.eye_unused",
                    "\"course\" names the whole course; remove one of the two", std::move(key));
            }(),
            [] {
                Key<LengthPiece> key = number(
                    "to_mm", &LengthPiece::to_mm,
                    {.min = 0.0, .max = kAlongRange.max, .above_min = true}, "mm, above from_mm");
                key.schema.erase("default");
                key.needed = [](const LengthPiece& piece) { return !piece.piece; };
                key.read = [](const JsonValue& value, LengthPiece& piece) {
                    piece.to_mm = value.number(
                        {.min = piece.from_mm, .max = kAlongRange.max, .above_min = true});
                };
                return only_if<LengthPiece>(
                    [](const LengthPiece& piece) { return !piece.piece; }, "job.eye_unused",
                    "\"course\" names the whole course; remove one of the two", std::move(key));
            }(),
            required(number("free_length", &LengthPiece::free_length_mm, kLengthRange, "mm")),
        },
        {},
        schema_rules(R"({"oneOf": [
          {"required": ["course"],
           "not": {"anyOf": [{"required": ["from_mm"]}, {"required": ["to_mm"]}]}},
          {"required": ["from_mm", "to_mm"], "not": {"required": ["course"]}}
        ]})")};
    return kTable;
}

Key<EyeLaw> lengths_key() {
    const SchemaJson schema = {{"type", "array"}, {"items", keys_schema(length_keys())}};
    return {"lengths",
            "stretches of fibre, or whole courses, with a free length of their own; the last that "
            "names a place holds there; equal-free-length only",
            schema,
            [](const JsonValue& value, EyeLaw& eye) {
                for (const JsonValue& piece : value.array()) {
                    read_keys(length_keys(), piece, eye.lengths.emplace_back());
                }
            },
            [](const EyeLaw& eye) {
                std::string text;
                for (const LengthPiece& piece : eye.lengths) {
                    text += (text.empty() ? "[{" : ", {") + keys_text(length_keys(), piece) + "}";
                }
                return text.empty() ? text : text + "]";
            }};
}

// Which rule reads a key, and whether it needs it.
struct KeyOfRule {
    std::string_view key;
    EyeRule rule;
    bool needed;
};
constexpr std::array kKeysOfRules = {
    KeyOfRule{"lengths", EyeRule::EqualFreeLength, false},
    KeyOfRule{"radius", EyeRule::Cylinder, true},
    KeyOfRule{"plane_x", EyeRule::VerticalPlane, true},
    KeyOfRule{"plane_y", EyeRule::HorizontalPlane, true},
};

SchemaJson eye_key_rules() {
    SchemaJson all = SchemaJson::array();
    for (const auto& [key, rule, needed] : kKeysOfRules) {
        SchemaJson with = SchemaJson::object();
        with["required"] = SchemaJson::array({key});
        SchemaJson& row = all.emplace_back(schema_rules(R"({"if": {"required": ["rule"],
            "properties": {"rule": {}}}})"));
        row["if"]["properties"]["rule"]["const"] = name_of(rule);
        if (needed) {
            row["then"] = with;
        }
        row["else"]["not"] = with;
    }
    return SchemaJson::object({{"allOf", all}});
}

// A key belongs to one rule; with others it would say something that nothing does.
Key<EyeLaw> of_rule(Key<EyeLaw> key) {
    const auto& [name, rule, needed] =
        *std::find_if(kKeysOfRules.begin(), kKeysOfRules.end(),
                      [&](const KeyOfRule& row) { return row.key == key.name; });
    const auto reads = [rule = rule](const EyeLaw& eye) { return eye.rule == rule; };
    if (needed) {
        key.needed = reads;
        key.schema.erase("default");
    }
    const std::string word(name_of(rule));
    return only_if<EyeLaw>(reads, "job.eye_unused",
                           "only the rule \"" + word + "\" reads it; remove it or choose that rule",
                           std::move(key));
}

Key<EyeLaw> plane_y_key() {
    Key<EyeLaw> key =
        number("plane_y", &EyeLaw::plane_y_mm, kPlaneRange,
               "machine y of the eye in mm, negative below the spindle; horizontal-plane only");
    key.schema["not"] = {{"const", 0}};
    key.read = [read = key.read](const JsonValue& value, EyeLaw& eye) {
        read(value, eye);
        if (eye.plane_y_mm == 0.0) {
            value.fail("json.out_of_range",
                       "0 is the height of the spindle, where \"equal-free-length\" and "
                       "\"cylinder\" have the eye; give another height, negative below");
        }
    };
    return of_rule(std::move(key));
}

}  // namespace

const KeyTable<EyeLaw>& eye_keys() {
    static const KeyTable<EyeLaw> kTable = {
        {
            word("rule", &EyeLaw::rule, eye_words(),
                 "where on the free fibre the eye is; adaptive gives way to what is in the way, "
                 "the others are kept strictly"),
            number("free_length", &EyeLaw::free_length_mm, kLengthRange,
                   "mm from landing point to eye: what adaptive prefers, what equal-free-length "
                   "keeps"),
            of_rule(lengths_key()),
            of_rule(number("radius", &EyeLaw::radius_mm, kLengthRange,
                           "mm from the spindle axis to the eye; cylinder only")),
            of_rule(number("plane_x", &EyeLaw::plane_x_mm, kLengthRange,
                           "machine x of the eye in mm; vertical-plane only")),
            plane_y_key(),
        },
        {},
        eye_key_rules()};
    return kTable;
}

}  // namespace meshwind
