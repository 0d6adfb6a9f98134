#include "report/cases/case_results.h"

#include <array>
#include <cmath>
#include <optional>
#include <system_error>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/write_file.h"
#include "core/text/text_file.h"
#include "core/version.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// A column of the merged table, and where report.json has it.
struct Figure {
    const char* column;
    const char* pointer;
};
constexpr std::array<Figure, 11> kFigures = {{{"courses", "/plan/courses"},
                                              {"fibre_mm", "/plan/fibre_length_mm"},
                                              {"fibre_factor", "/plan/fibre_factor"},
                                              {"turn_share", "/plan/turn_share"},
                                              {"covered", "/plan/coverage/fraction"},
                                              {"reachable", "/plan/coverage/reachable"},
                                              {"mean_layers", "/plan/coverage/mean_layers"},
                                              {"cv", "/plan/coverage/cv"},
                                              {"blocks", "/program/blocks"},
                                              {"duration_s", "/program/duration_s"},
                                              {"laydown_mm", "/checks/laydown/worst_mm"}}};

fs::path end_file(const fs::path& folder, const Case& of) {
    return folder / (of.id + ".json");
}

json inputs_of(const Case& of) {
    return {{"mandrel", of.mandrel},
            {"machine", of.machine},
            {"job", of.job},
            {"settings", of.settings}};
}

// None where the file is not there, or holds no JSON.
std::optional<json> read_json_file(const fs::path& file) {
    std::error_code ignored;
    if (!fs::exists(file, ignored)) {
        return {};
    }
    json read = json::parse(read_text_file(file), nullptr, false);
    return read.is_discarded() ? std::nullopt : std::optional(std::move(read));
}

// As a cell of a table: in quotes where a comma or a quote is in it.
std::string cell(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) {
        return text;
    }
    std::string quoted = "\"";
    for (const char c : text) {
        quoted += c == '"' ? "\"\"" : std::string(1, c);
    }
    return quoted + "\"";
}

std::string cell(const json& value) {
    return value.is_string() ? cell(value.get<std::string>())
           : value.is_null() ? std::string()
                             : value.dump();
}

std::string failed_checks(const json& report) {
    std::string names;
    const json checks = report.value("checks", json::object());
    for (const auto& [name, check] : checks.items()) {
        if (!check.value("ok", true)) {
            names += (names.empty() ? "" : " ") + name;
        }
    }
    return names;
}

}  // namespace

void write_case_end(const fs::path& folder, const Case& of, const CaseEnd& end) {
    json record{{"meshwind", kVersion},
                {"case", of.id},
                {"inputs", inputs_of(of)},
                {"exit_code", end.exit_code}};
    if (!end.code.empty()) {
        record["error"] = {{"code", end.code}, {"message", end.words}};
    }
    constexpr int kIndent = 2;
    write_file(end_file(folder, of),
               record.dump(kIndent, ' ', false, json::error_handler_t::replace) + "\n");
}

void forget_case_end(const fs::path& folder, const Case& of) {
    std::error_code error;
    fs::remove(end_file(folder, of), error);
    if (error) {
        throw IoError("output.unwritable", end_file(folder, of).string(), error.message());
    }
}

MergedCases merge_cases(const fs::path& folder, const std::vector<Case>& cases) {
    MergedCases merged;
    merged.csv = "id,outcome,words,mandrel,machine,job,settings";
    for (const Figure& figure : kFigures) {
        merged.csv += std::string(",") + figure.column;
    }
    merged.csv += '\n';
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Case& of = cases[i];
        const std::optional<json> end = read_json_file(end_file(folder, of));
        const bool done = end && end->value("inputs", json()) == inputs_of(of);
        const int exit_code = done ? end->value("exit_code", 2) : 0;
        std::string outcome = "missing";
        std::string words;
        std::optional<json> report;
        if (!done) {
            merged.missing.push_back(i + 1);
            words = end ? "was run with other inputs" : "";
        } else {
            if (exit_code < 2) {
                report = read_json_file(folder / of.id / "report.json");
            }
            outcome = exit_code == 0 ? "ok" : exit_code == 1 ? "check failed" : "error";
            words = exit_code == 1 && report ? failed_checks(*report)
                    : end->contains("error") ? (*end)["error"].value("message", "")
                                             : "";
            merged.passed += exit_code == 0 ? 1 : 0;
            if (exit_code != 0) {
                merged.failed.push_back(i + 1);
            }
        }
        std::string settings;
        for (const std::string& setting : of.settings) {
            settings += (settings.empty() ? "" : " ") + setting;
        }
        for (const std::string& text : {of.id, outcome, words, of.mandrel, of.machine, of.job}) {
            merged.csv += cell(text) + ",";
        }
        merged.csv += cell(settings);
        for (const Figure& figure : kFigures) {
            const json::json_pointer at(figure.pointer);
            merged.csv += "," + (report && report->contains(at) ? cell((*report)[at]) : "");
        }
        merged.csv += '\n';
    }
    return merged;
}

std::string merged_json(const MergedCases& merged, const fs::path& file) {
    const std::size_t cases =
        static_cast<std::size_t>(merged.passed) + merged.failed.size() + merged.missing.size();
    return json{{"cases", cases},
                {"ok", merged.passed},
                {"failed", merged.failed},
                {"missing", merged.missing},
                {"file", file.string()}}
               .dump() +
           "\n";
}

std::string numbers_text(const std::vector<std::size_t>& rows) {
    std::string text;
    for (const std::size_t row : rows) {
        text += (text.empty() ? "" : ",") + std::to_string(row);
    }
    return text;
}

}  // namespace meshwind
