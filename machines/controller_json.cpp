#include "machines/controller_json.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

namespace meshwind {
namespace {

constexpr std::int64_t kLargestProgramNumber = 99'999'999;  // eight digits, the longest O word
constexpr double kLargestDeviation_mm = 1e6;                // a slip of units
constexpr JsonRange kDeviation{.min = 0.0, .max = kLargestDeviation_mm, .above_min = true};
// A robot's arm has six axes, and its controller counts as many external ones.
constexpr std::size_t kMaxLetters = 6;

Key<Controller> lines_key(std::string_view name, std::vector<std::string> Controller::*field,
                          std::string_view meaning) {
    return or_null<Controller>(
        {name,
         meaning,
         {{"type", "array"}, {"items", {{"type", "string"}, {"pattern", "^[^\\r\\n]*$"}}}},
         [field](const JsonValue& value, Controller& controller) {
             for (const JsonValue& line : value.array()) {
                 const std::string& text = (controller.*field).emplace_back(line.string());
                 if (text.find_first_of("\r\n") != std::string::npos) {
                     line.fail("machine.comment", "holds a line break; write one entry per line");
                 }
             }
         }});
}

// Letters of axes, which check_robot_letters looks up in the chains.
struct Letters {
    const char* pattern;    // of the schema
    std::size_t least = 1;  // of at most six
    bool gaps = false;      // - stands for none
    std::string_view form;  // for messages
};

Key<Controller> letters_key(std::string_view name, std::string Controller::*field,
                            const Letters& letters, std::string_view meaning) {
    return or_null<Controller>(
        {name,
         meaning,
         {{"type", "string"}, {"pattern", letters.pattern}},
         [=](const JsonValue& value, Controller& controller) {
             const std::string text = value.string();
             const bool fits = text.size() >= letters.least && text.size() <= kMaxLetters &&
                               std::all_of(text.begin(), text.end(), [&](char c) {
                                   return (c >= 'A' && c <= 'Z') || (letters.gaps && c == '-');
                               });
             if (!fits) {
                 value.fail("machine.robot_axes",
                            "is \"" + text + "\"; write " + std::string(letters.form));
             }
             controller.*field = text;
         }});
}

constexpr Letters kRobotLetters{
    .pattern = "^[A-Z]{6}$", .least = kMaxLetters, .form = "the letters of six axes, \"ABCUVW\""};
constexpr Letters kExternalLetters{
    .pattern = "^[A-Z-]{1,6}$",
    .gaps = true,
    .form = "up to six letters, - for a number without an axis, \"Z-X\""};

}  // namespace

const KeyTable<Controller>& controller_keys() {
    static const KeyTable<Controller> kTable = {{
        required(
            any_text("dialect", &Controller::dialect,
                     "language of the program: linuxcnc, fanuc, siemens, grbl, marlin, "
                     "pulses, rapid, krl, which carried frames are written in as well, or tp")),
        or_null(word("feed", &Controller::feed, {"inverse-time", "per-minute"},
                     "what F means; inverse-time without")),
        lines_key("header", &Controller::header, "lines of one's own at the head of the program"),
        lines_key("footer", &Controller::footer, "lines of one's own at its end"),
        or_null(count("program_number", &Controller::program_number, kLargestProgramNumber,
                      "O number of fanuc programs; 1 without")),
        or_null(number("junction_deviation", &Controller::junction_deviation_mm, kDeviation,
                       "of grbl, $11: how near to the corners it stays, mm; 0.01 without")),
        letters_key("robot_axes", &Controller::robot_axes, kRobotLetters,
                    "of rapid, krl and tp: letters of the robot's axes 1 to 6; the last six of "
                    "eye_chain without"),
        letters_key("external_axes", &Controller::external_axes, kExternalLetters,
                    "of rapid, krl and tp: letters of the external axes, eax_a or E1 first, - for "
                    "one that is not there; without it all others, those of mandrel_chain first"),
    }};
    return kTable;
}

void check_robot_letters(const JsonValue& value, const Machine& machine) {
    const JsonObject controller = value.object(names_of(controller_keys()));
    std::set<char> numbered;
    for (const auto& [name, letters] :
         {std::pair("robot_axes", &machine.controller.robot_axes),
          std::pair("external_axes", &machine.controller.external_axes)}) {
        for (const char letter : *letters) {
            if (letter != '-' && (!machine.joint_of(letter) || !numbered.insert(letter).second)) {
                controller.required(name).fail(
                    "machine.robot_axes",
                    machine.joint_of(letter)
                        ? std::string("names axis ") + letter + " twice; give each one number"
                        : std::string("names axis ") + letter +
                              ", which the machine does not have; name those of its chains");
            }
        }
    }
}

}  // namespace meshwind
