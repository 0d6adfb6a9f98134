#include "report/report_study.h"

#include <algorithm>
#include <sstream>

#include <nlohmann/json.hpp>

#include "core/text/text_number.h"
#include "core/text/xml_text.h"
#include "core/version.h"
#include "report/report_checks.h"
#include "report/study_files.h"
#include "study/study_advice.h"

namespace meshwind {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const MeshSizeLine& line) {
    Json json{{"mandrel", line.mandrel},
              {"method", line.method},
              {"lambda", line.slip_ratio},
              {"quantity", name_of(line.quantity)},
              {"unit", unit_of(line.quantity)}};
    if (line.rule) {
        json["tangent_rule"] = name_of(*line.rule);
    }
    const auto order = fitted_order(line);
    json["order"] = order ? Json(*order) : Json();
    json["points"] = Json::array();
    for (const MeshSizePoint& point : line.points) {
        json["points"].push_back({{"edge_mm", point.edge_mm},
                                  {"mean_edge_mm", point.mean_edge_mm},
                                  {"triangles", point.triangles},
                                  {"rms", shown_error(line.quantity, point.rms)},
                                  {"worst", shown_error(line.quantity, point.worst)},
                                  {"order", point.order ? Json(*point.order) : Json()}});
    }
    return json;
}

std::string padded(const std::string& text, std::size_t width, bool right = false) {
    const std::string blanks(width > text.size() ? width - text.size() : 1, ' ');
    return right ? blanks + text : text + blanks;
}

constexpr std::size_t kNameWidth = 40;
constexpr std::size_t kNumberWidth = 11;

std::string words_of(const MeshSizeLine& line) {
    std::string text = padded(line.mandrel, 16) + line.method;
    if (line.rule) {
        return text + ", " + name_of(*line.rule);
    }
    text += ", lambda ";
    append_shortest(text, line.slip_ratio);
    return text;
}

// One quantity: a row for each line, a column for each edge length.
void print_quantity(std::ostream& out, const StudyOutcome& outcome, Quantity quantity) {
    const MeshSizeOptions& options = outcome.options;
    const bool machine = quantity == Quantity::SpindleAngle || quantity == Quantity::EyePoint;
    out << padded(std::string(name_of(quantity)) + ", " + unit_of(quantity) + " rms", kNameWidth);
    for (const double edge_mm : outcome.study.edges_mm) {
        std::string head;
        append_shortest(head, edge_mm);
        out << padded(head + " mm", kNumberWidth, true);
    }
    out << padded("order", kNumberWidth, true) << '\n';
    for (const MeshSizeLine& line : outcome.study.lines) {
        if (line.quantity != quantity ||
            (machine && line.slip_ratio != options.slip_ratios.front())) {
            continue;
        }
        out << "  " << padded(words_of(line), kNameWidth - 2);
        for (const double edge_mm : outcome.study.edges_mm) {
            const auto point =
                std::find_if(line.points.begin(), line.points.end(),
                             [&](const MeshSizePoint& p) { return p.edge_mm == edge_mm; });
            out << padded(
                point == line.points.end() ? "-" : fixed(shown_error(quantity, point->rms), 5),
                kNumberWidth, true);
        }
        const auto order = fitted_order(line);
        out << padded(order ? fixed(*order, 2) : "-", kNumberWidth, true) << '\n';
    }
}

// All that is the same from run to run.
void print_findings(std::ostream& out, const StudyOutcome& outcome) {
    for (const Quantity quantity : {Quantity::PathEnd, Quantity::WindingAngle, Quantity::Slip,
                                    Quantity::SpindleAngle, Quantity::EyePoint}) {
        print_quantity(out, outcome, quantity);
    }
    for (const std::string& remark : outcome.study.remarks) {
        out << remark << '\n';
    }
    out << "advice of Fu and others (2009):\n";
    for (const Advice& advice : judged_advice(outcome)) {
        out << "  " << (advice.holds ? "holds:        " : "does not hold: ") << advice.claim
            << "\n    " << advice.because << '\n';
    }
}

constexpr const char* kPageHead = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Study of mesh size</title>
<style>
body { margin: 2em auto; padding: 0 1em; max-width: 1200px; font: 14px/1.45 system-ui, sans-serif; }
svg { width: 100%; height: auto; background: #fff; }
pre { overflow-x: auto; font-size: 12px; }
</style>
</head>
<body>
<h1>Study of mesh size</h1>
)";

}  // namespace

std::string study_json(const StudyOutcome& outcome) {
    const MeshSizeOptions& options = outcome.options;
    Json json{{"meshwind", kVersion},
              {"study", "mesh-size"},
              {"options",
               {{"edges_mm", options.edges_mm},
                {"lambda", options.slip_ratios},
                {"paths", options.paths},
                {"length_mm", options.length_mm},
                {"free_length_mm", options.free_length_mm},
                {"irregular", options.irregular},
                {"seed", options.context.seed}}}};
    json["references"] = Json::object();
    for (const auto& [mandrel, words] : outcome.references) {
        json["references"][mandrel] = words;
    }
    json["lines"] = Json::array();
    for (const MeshSizeLine& line : outcome.study.lines) {
        json["lines"].push_back(json_of(line));
    }
    json["remarks"] = outcome.study.remarks;
    json["advice"] = Json::array();
    for (const Advice& advice : judged_advice(outcome)) {
        json["advice"].push_back(
            {{"claim", advice.claim}, {"holds", advice.holds}, {"because", advice.because}});
    }
    return json_text(json);
}

std::string study_page(const StudyOutcome& outcome) {
    std::ostringstream findings;
    print_findings(findings, outcome);
    return kPageHead + study_svg(outcome) + "\n<pre>\n" + xml_text(findings.str()) +
           "</pre>\n</body>\n</html>\n";
}

void print_study(std::ostream& out, const StudyOutcome& outcome,
                 const std::filesystem::path& folder) {
    print_findings(out, outcome);
    for (const MeshSizeTiming& t : outcome.study.timing) {
        out << t.mandrel << ", " << t.method << ", lambda " << fixed(t.slip_ratio, 2)
            << ", edges of " << fixed(t.edge_mm, 2) << " mm: " << fixed(t.ns_per_crossing, 0)
            << " ns per crossing, " << fixed(t.ms_per_metre, 3) << " ms per metre\n";
    }
    out << "written to " << folder.string() << ": study.html, study.csv, study.json, study.svg"
        << (outcome.options.timing ? ", timing.csv" : "") << '\n';
}

void write_study(const StudyOutcome& outcome, OutputFolder& folder) {
    folder.add("study.csv", study_csv(outcome.study));
    folder.add("study.json", study_json(outcome));
    folder.add("study.svg", study_svg(outcome));
    folder.add("study.html", study_page(outcome));
    if (outcome.options.timing) {
        folder.add("timing.csv", timing_csv(outcome.study));
    } else {
        folder.withdraw("timing.csv");
    }
    folder.publish();
}

}  // namespace meshwind
