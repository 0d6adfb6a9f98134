#include "cli/report.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/report_mandrel.h"
#include "core/text_number.h"
#include "core/units.h"
#include "version.h"

namespace meshwind {
namespace {

using nlohmann::json;

// Numbers of the report: finer than any tolerance, free of rounding noise in the last digits.
double rounded(double value) {
    constexpr double kDigits = 1e9;
    const double result = std::round(value * kDigits) / kDigits;
    return result == 0.0 ? 0.0 : result;
}

json plan_report(const Plan& plan) {
    json uncovered = json::array();
    for (const Uncovered& u : plan.uncovered) {
        uncovered.push_back(
            {{"region", u.region}, {"area_mm2", rounded(u.area_mm2)}, {"reason", u.reason}});
    }
    json refusals = json::object();
    for (std::size_t r = 0; r < kRefusals; ++r) {
        refusals[name_of(static_cast<Refusal>(r))] = plan.effort.refusals[r];
    }
    json rejections = json::object();
    for (std::size_t r = 1; r < kRejections; ++r) {
        rejections[name_of(static_cast<Rejection>(r))] = plan.effort.rejections[r];
    }
    json report = {
        {"planner", plan.planner},
        {"courses", plan.courses},
        {"transitions", std::max(0, static_cast<int>(plan.pieces.size()) - plan.courses)},
        {"fibres", plan.fibres},
        {"fibre_length_mm", rounded(plan.fibre_length_mm)},
        {"coverage",
         {{"fraction", rounded(plan.coverage.fraction)},
          {"reachable", rounded(plan.coverage.reachable)},
          {"mean_layers", rounded(plan.coverage.mean_layers)},
          {"max_layers", plan.coverage.max_layers},
          {"cv", rounded(plan.coverage.cv)}}},
        {"uncovered", uncovered},
        {"library",
         {{"candidates", plan.effort.candidates},
          {"outcomes", refusals},
          {"rejected_courses", plan.effort.rejected_courses},
          {"rejections", rejections}}}};
    if (!plan.failure.empty()) {
        report["failure"] = plan.failure;
    }
    return report;
}

json checks_report(const std::vector<Check>& checks) {
    json report = json::object();
    for (const Check& check : checks) {
        json entry = {{"ok", check.ok}};
        for (const auto& [name, value] : check.numbers) {
            const bool whole = value == std::floor(value) && name.find("_mm") == std::string::npos;
            entry[name] = whole ? json(static_cast<std::int64_t>(value)) : json(rounded(value));
        }
        if (!check.ok) {
            entry["words"] = check.words;
        }
        report[check.name] = entry;
    }
    return report;
}

// Furthest of an axis from its planned position for circuits that are repeated, mm or deg.
double drift_of(const WindResult& result, std::size_t axis) {
    const std::vector<std::int64_t>& nano = result.layout.drift_nano;
    return nano.empty() ? 0.0 : static_cast<double>(nano[axis]) / static_cast<double>(kNanoPerUnit);
}

json repeats_report(const WindResult& result) {
    json drift = json::object();
    for (std::size_t a = 0; a < result.blocks.axes.size(); ++a) {
        drift[std::string(1, result.blocks.axes[a].letter)] = rounded(drift_of(result, a));
    }
    return {{"subprograms", result.layout.subprograms.size()},
            {"calls", result.layout.calls()},
            {"drift", drift}};
}

json axes_report(const WindResult& result) {
    json axes = json::object();
    const BlockList& list = result.blocks;
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        double low = list.value(0, a);
        double high = low;
        for (std::size_t b = 1; b < list.blocks.size(); ++b) {
            low = std::min(low, list.value(b, a));
            high = std::max(high, list.value(b, a));
        }
        const double step =
            static_cast<double>(list.axes[a].resolution_nano) / static_cast<double>(kNanoPerUnit);
        axes[std::string(1, list.axes[a].letter)] = {
            {"unit", list.axes[a].type == AxisType::Rotary ? "deg" : "mm"},
            {"min", rounded(low)},
            {"max", rounded(high)},
            {"resolution", step},
            {"max_rounding_error", 0.5 * step + drift_of(result, a)}};
    }
    return axes;
}

json choice_report(const BlockChoice& choice) {
    return {{"worst_sideways_mm", rounded(choice.worst_sideways_mm)},
            {"worst_angle_deg", rounded(deg_from_rad(choice.worst_angle_rad))},
            {"worst_pull_mm", rounded(choice.worst_pull_mm)},
            {"worst_eye_mm", rounded(choice.worst_eye_mm)},
            {"worst_twist_deg", rounded(deg_from_rad(choice.worst_twist_rad))},
            {"steps_beyond", choice.beyond}};
}

json program_report(const WindResult& result) {
    json binding = json::array();
    for (const BindingLimit& limit : result.binding) {
        binding.push_back({{"limit", limit.name}, {"time_s", rounded(limit.time_s)}});
    }
    return {{"file", result.program_written ? json(result.program_file) : json(nullptr)},
            {"dialect", result.setup.machine.controller.dialect},
            {"path_points", result.path_points},
            {"blocks", result.blocks.blocks.size()},
            {"choice", choice_report(result.choice)},
            {"duration_s", rounded(result.duration_s)},
            {"free_length_mm",
             {{"min", rounded(result.eyes.shortest_mm)}, {"max", rounded(result.eyes.longest_mm)}}},
            {"binding_limits", binding},
            {"repeats", repeats_report(result)},
            {"axes", axes_report(result)}};
}

std::string percent(double share) {
    return fixed(100.0 * share, 2) + " %";
}

void print_checks(std::ostream& out, const WindResult& result) {
    for (const Check& check : result.checks) {
        out << "  " << (check.ok ? "ok    " : "FAILED") << "  " << check.name;
        for (const auto& [name, value] : check.numbers) {
            std::string text;
            append_shortest(text, std::round(value * 1e4) / 1e4);
            out << "  " << name << ' ' << text;
        }
        out << '\n';
        if (!check.ok) {
            out << "          " << check.words << '\n';
        }
    }
}

}  // namespace

std::string report_json(const WindResult& result) {
    json timing = json::object();
    for (const auto& [stage, seconds] : result.timing_s) {
        timing[stage] = seconds;
    }
    const json report = {{"meshwind", kVersion},
                         {"machine", result.setup.machine.name},
                         {"mandrel", mandrel_report(result.setup.mandrel)},
                         {"plan", plan_report(result.plan)},
                         {"checks", checks_report(result.checks)},
                         {"program", program_report(result)},
                         {"ok", result.passed()},
                         {"timing_s", timing}};
    return report.dump(1) + "\n";
}

void print_summary(std::ostream& out, const WindResult& result,
                   const std::filesystem::path& folder) {
    const Plan& plan = result.plan;
    if (plan.failure.empty()) {
        out << result.setup.mandrel.file << " on " << result.setup.machine.name << ": "
            << plan.courses << " courses, " << fixed(plan.fibre_length_mm / 1000.0, 1)
            << " m of fibre, " << result.blocks.blocks.size() << " blocks, "
            << fixed(result.duration_s / 60.0, 1) << " min\n"
            << "covered " << percent(plan.coverage.fraction) << " of the wall (reachable "
            << percent(plan.coverage.reachable) << "), " << fixed(plan.coverage.mean_layers, 2)
            << " layers on average, at most " << plan.coverage.max_layers << '\n';
    }
    for (const Uncovered& bare : plan.uncovered) {
        out << "  bare: " << fixed(bare.area_mm2 / 100.0, 2) << " cm2 of region " << bare.region
            << ": " << bare.reason << '\n';
    }
    print_checks(out, result);
    out << (result.program_written ? "program: " + (folder / result.program_file).string()
                                   : std::string("no program written"))
        << "\nreport:  " << (folder / "report.json").string() << '\n';
}

}  // namespace meshwind
