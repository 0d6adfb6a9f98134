#include "report/report_checks.h"

#include <cmath>
#include <map>
#include <string>

#include "core/text/text_number.h"

namespace meshwind {

using nlohmann::json;

namespace {

// What a check is about, for somebody who winds. A number at its end tells the fibre.
std::string meaning_of(const std::string& check) {
    static const std::map<std::string, std::string> kMeanings = {
        {"continuity", "fibres that are tied on, and how well their pieces meet"},
        {"plan", "courses that can be wound"},
        {"coverage", "wall under at least one layer"},
        {"thickness", "even layers where the winding is regular"},
        {"closure", "the pattern's last circuit ends where its first began"},
        {"import", "how far the landing points were from the mandrel"},
        {"tie_on", "the fibre is tied on where it is laid from"},
        {"approach", "rapid moves to the start within the axes and clear of the mandrel"},
        {"path_mode", "the controller passes corners as the machine file asks"},
        {"roller", "the fibre leaves the roller at a right angle"},
        {"code", "the program as it was written"},
        {"eye", "a free length that the rule allows everywhere"},
        {"rounding", "the program read back is the motion that was planned"},
        {"laydown", "the fibre comes to lie where it was planned"},
        {"slip", "friction holds it there"},
        {"bridging", "gap under the fibre over hollows"},
        {"collision", "fibre and head clear of the mandrel"},
        {"free_length", "fibre between mandrel and eye"},
        {"limits", "axes within travel, speed and acceleration"},
        {"payout", "speed of the fibre through the eye, and length taken back"},
        {"program", "the program is the planned one"},
        {"ring", "the frame clear of the rings"},
        {"reach", "every pose within the robot's reach"},
        {"wrist", "no axis that jumps"},
        {"clearance", "the frame clear of what stands on the base"},
        {"interpolation", "the axis in the middle of the head between the points"}};
    const auto found = kMeanings.find(check.substr(0, check.find('-')));
    return found == kMeanings.end() ? "" : ": " + found->second;
}

}  // namespace

double report_number(double value) {
    constexpr double kDigits = 1e9;
    const double result = std::round(value * kDigits) / kDigits;
    return result == 0.0 ? 0.0 : result;
}

namespace {

json place_report(const CheckPlace& place) {
    json position = json::array();
    for (const double x : place.position_mm) {
        position.push_back(report_number(x));
    }
    json report = {
        {"position_mm", position}, {"fibre", place.fibre + 1}, {"layer", place.layer + 1}};
    if (place.block) {
        report["block"] = *place.block;
    }
    return report;
}

}  // namespace

json checks_report(const std::vector<Check>& checks) {
    json report = json::object();
    for (const Check& check : checks) {
        json entry = {{"ok", check.ok}};
        for (const auto& [name, value] : check.numbers) {
            const bool whole = std::isfinite(value) && value == std::floor(value) &&
                               name.find("_mm") == std::string::npos;
            entry[name] =
                whole ? json(static_cast<std::int64_t>(value)) : json(report_number(value));
        }
        if (!check.ok) {
            entry["words"] = check.words;
        }
        if (check.place) {
            entry["place"] = place_report(*check.place);
        }
        report[check.name] = entry;
    }
    return report;
}

json verification_report(const Verification& verification, const BlockList& program) {
    json report = {{"blocks", program.moves()},
                   {"fibre_length_mm", report_number(verification.fibre_length_mm)},
                   {"duration_s", report_number(verification.duration_s)},
                   {"free_length_mm",
                    {{"min", report_number(verification.shortest_free_mm)},
                     {"max", report_number(verification.longest_free_mm)}}},
                   {"peeled_mm", report_number(verification.laid.peeled_mm)},
                   {"first_wrong", nullptr}};
    if (verification.first_wrong_block) {
        const std::size_t block = *verification.first_wrong_block;
        report["first_wrong"] = {{"block", block}, {"line", program.blocks[block].line}};
    }
    return report;
}

void print_checks(std::ostream& out, const std::vector<Check>& checks) {
    for (const Check& check : checks) {
        out << "  " << (check.ok ? "ok    " : "FAILED") << "  " << check.name
            << meaning_of(check.name) << (check.numbers.empty() ? "" : ";");
        for (const auto& [name, value] : check.numbers) {
            std::string text;
            if (std::isfinite(value)) {
                append_shortest(text, std::round(value * 1e4) / 1e4);
            } else {
                text = "none";  // of nothing that was laid there is no least and no most
            }
            out << "  " << name << ' ' << text;
        }
        out << '\n';
        if (!check.ok) {
            out << "          " << check.words << '\n';
        }
    }
}

std::string json_text(const json& value) {
    return value.dump(1, ' ', false, json::error_handler_t::replace) + '\n';
}

}  // namespace meshwind
