#include "machines/strict_json.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace meshwind {
namespace {

// Runs `action`, returns "code | what" of the InputError it must throw.
template <class Action>
std::string refusal(Action&& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.code() + " | " + error.what();
    }
    return "nothing thrown";
}

TEST(StrictJson, SuggestsTheNearestKnownKey) {
    const auto document = JsonDocument::parse(R"({"tow": {"widht": 6}})", "job.json");
    const JsonValue tow = document.root().object({"tow"}).required("tow");
    EXPECT_EQ(refusal([&] {
                  (void)tow.object({"width", "thickness", "friction"});
              }),
              "json.unknown_key | job.json: /tow/widht: unknown key; did you mean \"width\"?");
    EXPECT_EQ(refusal([&] { (void)tow.object({"speed"}); }),
              "json.unknown_key | job.json: /tow/widht: unknown key; the known ones are \"speed\"");
}

TEST(StrictJson, NamesFileAndLineOfASyntaxError) {
    const std::string text = "{\n  \"a\": 1,\n  \"b\": ]\n}";
    const std::string words = refusal([&] { (void)JsonDocument::parse(text, "m.json"); });
    EXPECT_EQ(words.find("json.syntax | m.json:3: not valid JSON: "), 0u) << words;
    EXPECT_EQ(words.find('\n'), std::string::npos);
}

TEST(StrictJson, EscapesThePointerAsRfc6901) {
    const auto document = JsonDocument::parse(R"({"a/b~c": "x"})", "m.json");
    const JsonValue value = document.root().object({"a/b~c"}).required("a/b~c");
    EXPECT_EQ(refusal([&] { (void)value.number(); }),
              "json.wrong_type | m.json: /a~1b~0c: is a string; write a number");
}

TEST(StrictJson, NamesValueAndLimit) {
    const auto document = JsonDocument::parse(R"({"v": -0.5})", "m.json");
    const JsonValue value = document.root().object({"v"}).required("v");
    EXPECT_EQ(refusal([&] { (void)value.number({.min = 0.0, .above_min = true}); }),
              "json.out_of_range | m.json: /v: is -0.5; must be above 0");
    EXPECT_EQ(refusal([&] { (void)value.number({.max = -1.0}); }),
              "json.out_of_range | m.json: /v: is -0.5; must be at most -1");
    EXPECT_EQ(refusal([&] { (void)value.integer(0, 9); }),
              "json.wrong_type | m.json: /v: is -0.5; write a number without a fraction");
}

TEST(StrictJson, ReadsWholeNumbersWrittenWithAPoint) {
    const auto document = JsonDocument::parse("[3.0, 3]", "m.json");
    for (const JsonValue& value : document.root().array()) {
        EXPECT_EQ(value.integer(0, 9), 3);
    }
}

TEST(StrictJson, NullCountsAsAbsentForOptionalKeysOnly) {
    const auto document = JsonDocument::parse(R"({"a": null})", "m.json");
    const JsonObject object = document.root().object({"a", "b"});
    EXPECT_FALSE(object.optional("a"));
    EXPECT_FALSE(object.optional("b"));
    EXPECT_EQ(refusal([&] { (void)object.required("a").number(); }),
              "json.wrong_type | m.json: /a: is null; write a number");
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
