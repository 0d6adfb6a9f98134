#include "report/study_files.h"

#include <algorithm>
#include <array>

#include "core/text/text_number.h"
#include "core/units.h"
#include "report/picture/log_plot.h"

namespace meshwind {
namespace {

constexpr int kErrorDecimals = 9;
constexpr int kOrderDecimals = 4;
constexpr int kEdgeDecimals = 6;
constexpr int kTimeDecimals = 3;

struct Column {
    Quantity quantity;
    const char* head;
};
constexpr std::array kColumns{
    Column{Quantity::PathEnd, "path end, mm"},
    Column{Quantity::WindingAngle, "winding angle, deg"},
    Column{Quantity::Slip, "slip ratio"},
    Column{Quantity::SpindleAngle, "spindle angle C, deg"},
    Column{Quantity::EyePoint, "eye point, mm"},
};

bool of_machine(Quantity quantity) {
    return quantity == Quantity::SpindleAngle || quantity == Quantity::EyePoint;
}

// Paths: a colour for each method, dashes where it is steered. Machine: another colour for each
// tangent rule of geodesics, dashes for methods after the first; of these the rules whose order
// the method changes.
constexpr int kMethodColour = static_cast<int>(kTangentRules.size());

struct Styles {
    const MeshSizeOptions& options;

    [[nodiscard]] int method(const std::string& name) const {
        const auto methods = path_methods();
        return static_cast<int>(std::find_if(methods.begin(), methods.end(),
                                             [&](const PathMethod& m) { return m.name == name; }) -
                                methods.begin());
    }
    [[nodiscard]] bool shown(const MeshSizeLine& line) const {
        return !of_machine(line.quantity) ||
               (line.slip_ratio == options.slip_ratios.front() &&
                (method(line.method) == 0 || line.rule == TangentRule::Parabola ||
                 line.rule == TangentRule::Traced));
    }
    [[nodiscard]] PlotStyle of(const MeshSizeLine& line) const {
        if (of_machine(line.quantity)) {
            return {static_cast<int>(*line.rule), method(line.method) > 0};
        }
        return {kMethodColour + method(line.method),
                line.slip_ratio != options.slip_ratios.front()};
    }
};

// A file's name may hold commas.
std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) {
        return text;
    }
    std::string quoted = "\"";
    for (const char c : text) {
        quoted += c == '"' ? "\"\"" : std::string(1, c);
    }
    return quoted + '"';
}

std::string lambda_words(double slip_ratio) {
    std::string text = slip_ratio == 0.0 ? "geodesic, lambda " : "steered, lambda ";
    append_shortest(text, slip_ratio);
    return text;
}

std::vector<std::vector<PlotKey>> keys_of(const MeshSizeOptions& options) {
    std::vector<std::vector<PlotKey>> keys(2);
    int m = kMethodColour;
    for (const PathMethod& method : path_methods()) {
        for (std::size_t s = 0; s < options.slip_ratios.size(); ++s) {
            keys[0].push_back({{m, s > 0},
                               "path by " + std::string(method.name) + ", " +
                                   lambda_words(options.slip_ratios[s])});
        }
        ++m;
    }
    constexpr std::array kWords{"tangent by chord P1-P2", "central P1-P3", "parabola P1-P2-P3",
                                "traced"};
    for (std::size_t r = 0; r < kTangentRules.size(); ++r) {
        keys[1].push_back({{static_cast<int>(r), false}, kWords[r]});
    }
    for (const TangentRule rule : {TangentRule::Parabola, TangentRule::Traced}) {
        const auto r = static_cast<std::size_t>(rule);
        keys[1].push_back({{static_cast<int>(rule), true},
                           std::string(rule == TangentRule::Traced ? kWords[r] : "parabola") +
                               " by " + path_methods().back().name});
    }
    return keys;
}

}  // namespace

std::string study_csv(const MeshSizeStudy& study) {
    std::string text =
        "mandrel,method,lambda,quantity,unit,tangent_rule,edge_mm,mean_edge_mm,triangles,rms,worst,"
        "order\n";
    for (const MeshSizeLine& line : study.lines) {
        for (const MeshSizePoint& point : line.points) {
            text += csv_field(line.mandrel) + ',' + line.method + ',';
            append_shortest(text, line.slip_ratio);
            text += std::string(",") + name_of(line.quantity) + ',' + unit_of(line.quantity) + ',' +
                    (line.rule ? name_of(*line.rule) : "") + ',';
            append_shortest(text, point.edge_mm);
            text += ',' + fixed(point.mean_edge_mm, kEdgeDecimals) + ',' +
                    std::to_string(point.triangles) + ',' +
                    fixed(shown_error(line.quantity, point.rms), kErrorDecimals) + ',' +
                    fixed(shown_error(line.quantity, point.worst), kErrorDecimals) + ',' +
                    (point.order ? fixed(*point.order, kOrderDecimals) : "") + '\n';
        }
    }
    return text;
}

std::string timing_csv(const MeshSizeStudy& study) {
    std::string text = "mandrel,method,lambda,edge_mm,triangles,ns_per_crossing,ms_per_metre\n";
    for (const MeshSizeTiming& t : study.timing) {
        text += csv_field(t.mandrel) + ',' + t.method + ',';
        append_shortest(text, t.slip_ratio);
        text += ',';
        append_shortest(text, t.edge_mm);
        text += ',' + std::to_string(t.triangles) + ',' + fixed(t.ns_per_crossing, kTimeDecimals) +
                ',' + fixed(t.ms_per_metre, kTimeDecimals) + '\n';
    }
    return text;
}

std::string study_svg(const StudyOutcome& outcome) {
    const Styles styles{outcome.options};
    LogPlot plot;
    plot.title = "Error (rms) against edge length" +
                 std::string(outcome.options.irregular ? ", irregular meshes" : "");
    plot.x_label = "mean edge length, mm; dotted: orders 1 to 4";
    for (const Column& column : kColumns) {
        plot.columns.emplace_back(column.head);
    }
    for (const auto& [mandrel, words] : outcome.references) {
        plot.rows.push_back(mandrel);
        for (const Column& column : kColumns) {
            std::vector<PlotLine>& panel = plot.panels.emplace_back();
            for (const MeshSizeLine& line : outcome.study.lines) {
                if (line.mandrel != mandrel || line.quantity != column.quantity ||
                    !styles.shown(line)) {
                    continue;
                }
                PlotLine& drawn = panel.emplace_back();
                drawn.style = styles.of(line);
                for (const MeshSizePoint& point : line.points) {
                    drawn.points.emplace_back(point.mean_edge_mm,
                                              shown_error(line.quantity, point.rms));
                }
            }
        }
    }
    plot.keys = keys_of(outcome.options);
    return log_plot_svg(plot);
}

}  // namespace meshwind
