#include "report/report_checks.h"

#include <cmath>
#include <string>
#include <utility>

#include "core/text/text_number.h"

namespace meshwind {

using nlohmann::json;

double report_number(double value) {
    constexpr double kDigits = 1e9;
    const double result = std::round(value * kDigits) / kDigits;
    return result == 0.0 ? 0.0 : result;
}

json report_vector(const Eigen::Vector3d& vector) {
    return {report_number(vector.x()), report_number(vector.y()), report_number(vector.z())};
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

json check_kinds_report(const std::vector<Check>& checks) {
    json report = json::object();
    for (const Check& check : checks) {
        const CheckKind& kind = *check.kind;
        json measures = json::array();
        for (const CheckMeasure& measure : kind.measures) {
            if (measure.key.empty()) {
                break;
            }
            json entry = {{"key", measure.key}, {"label", measure.label}};
            if (!measure.limit_key.empty()) {
                entry["limit"] = measure.limit_key;
            } else if (measure.fixed_limit) {
                entry["limit"] = *measure.fixed_limit;
            }
            if (measure.least) {
                entry["least"] = true;
            }
            measures.push_back(std::move(entry));
        }
        report[std::string(kind.name)] = {{"title", kind.title}, {"measures", measures}};
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
        out << "  " << (check.ok ? "ok    " : "FAILED") << "  " << check.name << ": "
            << check.kind->meaning << (check.numbers.empty() ? "" : ";");
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

void print_failed_checks(std::ostream& out, const std::vector<Check>& checks) {
    std::size_t passed = 0;
    for (const Check& check : checks) {
        if (check.ok) {
            ++passed;
            continue;
        }
        out << "FAILED: " << check.name << ": " << check.words << '\n';
    }
    out << "checks: " << passed << " of " << checks.size() << " passed\n";
}

std::string json_text(const json& value) {
    return value.dump(1, ' ', false, json::error_handler_t::replace) + '\n';
}

}  // namespace meshwind
