#include "core/text/strict_json.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/text/text_number.h"
#include "tests/support/tells.h"

namespace meshwind {
namespace {

// The InputError that `action` must throw.
template <class Action>
InputError refusal(Action&& action) {
    try {
        action();
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error;
    }
    ADD_FAILURE() << "nothing thrown";
    return InputError("", "", "");
}

// With its code and place, and words that have the figures or keys.
template <class Action>
void expect_refused(Action&& action, const std::string& code, const std::string& place,
                    const std::vector<std::string>& figures = {}) {
    const InputError error = refusal(action);
    EXPECT_EQ(error.code(), code);
    EXPECT_EQ(error.place(), place);
    for (const std::string& figure : figures) {
        EXPECT_TRUE(test::tells(error.what(), figure)) << error.what();
    }
}

TEST(StrictJson, SuggestsTheNearestKnownKey) {
    const auto document = JsonDocument::parse(R"({"tow": {"widht": 6}})", "job.json");
    const JsonValue tow = document.root().object({"tow"}).required("tow");
    expect_refused(
        [&] {
            (void)tow.object({"width", "thickness", "friction"});
        },
        "json.unknown_key", "job.json: /tow/widht", {"\"width\""});
    expect_refused([&] { (void)tow.object({"speed"}); }, "json.unknown_key", "job.json: /tow/widht",
                   {"\"speed\""});
}

TEST(StrictJson, NamesFileAndLineOfASyntaxError) {
    const std::string text = "{\n  \"a\": 1,\n  \"b\": ]\n}";
    expect_refused([&] { (void)JsonDocument::parse(text, "m.json"); }, "json.syntax", "m.json:3");
}

TEST(StrictJson, EscapesThePointerAsRfc6901) {
    const auto document = JsonDocument::parse(R"({"a/b~c": "x"})", "m.json");
    const JsonValue value = document.root().object({"a/b~c"}).required("a/b~c");
    expect_refused([&] { (void)value.number(); }, "json.wrong_type", "m.json: /a~1b~0c");
}

TEST(StrictJson, NamesValueAndLimit) {
    const auto document = JsonDocument::parse(R"({"v": -0.5})", "m.json");
    const JsonValue value = document.root().object({"v"}).required("v");
    expect_refused([&] { (void)value.number({.min = 0.0, .above_min = true}); },
                   "json.out_of_range", "m.json: /v", {"-0.5", "0"});
    expect_refused([&] { (void)value.number({.max = -1.0}); }, "json.out_of_range", "m.json: /v",
                   {"-0.5", "-1"});
    expect_refused([&] { (void)value.integer(0, 9); }, "json.wrong_type", "m.json: /v", {"-0.5"});
}

TEST(StrictJson, ReadsWholeNumbersWrittenWithAPoint) {
    const auto document = JsonDocument::parse("[3.0, 3]", "m.json");
    for (const JsonValue& value : document.root().array()) {
        EXPECT_EQ(value.integer(0, 9), 3);
    }
}

TEST(StrictJson, TakesValuesAsPeopleTypeThem) {
    const auto taken = [](const char* value) {
        JsonDocument document = JsonDocument::parse("{}", "job.json");
        document.set("a", value);
        const JsonValue a = document.root().object({"a"}).required("a");
        return a.is_string() ? a.string() : fixed(a.number({}), 3);
    };
    for (const char* same : {"0.5", ".5", "+.5", "5e-1", "0.50"}) {
        EXPECT_EQ(taken(same), "0.500") << same;
    }
    EXPECT_EQ(taken("3."), "3.000");
    EXPECT_EQ(taken("-.25"), "-0.250");
    for (const char* word : {"pins", ".", "+", "1.5mm", "--2", "+-2", "nan", "inf", "1e999"}) {
        EXPECT_EQ(taken(word), word);
    }
}

TEST(StrictJson, NullCountsAsAbsentForOptionalKeysOnly) {
    const auto document = JsonDocument::parse(R"({"a": null})", "m.json");
    const JsonObject object = document.root().object({"a", "b"});
    EXPECT_FALSE(object.optional("a"));
    EXPECT_FALSE(object.optional("b"));
    expect_refused([&] { (void)object.required("a").number(); }, "json.wrong_type", "m.json: /a",
                   {"null"});
}

TEST(StrictJson, MissingFileIsIoError) {
    EXPECT_THROW((void)JsonDocument::load("/nonexistent/m.json"), IoError);
}

TEST(NearestWord, AcceptsSlipsOfThePenOnly) {
    EXPECT_EQ(nearest_word("frition", {"friction", "width"}), "friction");
    EXPECT_EQ(nearest_word("z", {"x", "velocity"}), "x");
    EXPECT_FALSE(nearest_word("gravity", {"friction", "width"}));
}

TEST(StrictJson, DeepNestingIsRead) {
    // Readers that recurse per level overflow the stack here.
    const int depth = 200'000;
    const std::string text = std::string(depth, '[') + std::string(depth, ']');
    EXPECT_TRUE(JsonDocument::parse(text, "deep.json").root().is_array());
}

}  // namespace
}  // namespace meshwind
