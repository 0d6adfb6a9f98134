#include "cli/study_command.h"

#include <algorithm>
#include <array>

#include "cli/output_files.h"
#include "cli/project_files.h"
#include "cli/report_study.h"
#include "cli/study_advice.h"
#include "cli/study_files.h"
#include "core/error.h"
#include "core/text_number.h"

namespace meshwind {
namespace {

std::vector<StudyMandrel> mandrels_of(const StudyRequest& request) {
    std::vector<std::string> names = request.mandrels;
    if (names.empty()) {
        names = {"cylinder", "torus", "ellipsoid", "tee"};
    }
    std::vector<StudyMandrel> mandrels;
    const auto add = [&](StudyMandrel mandrel) {
        for (const StudyMandrel& there : mandrels) {
            if (there.name == mandrel.name) {
                throw InputError("study.twice", mandrel.name, "stands twice; name it once");
            }
        }
        mandrels.push_back(std::move(mandrel));
    };
    for (const std::string& name : names) {
        if (name == "cylinder") {
            for (const double radius_mm : request.radii_mm) {
                add(cylinder_study(radius_mm));
            }
        } else if (name == "torus") {
            add(torus_study());
        } else if (name == "ellipsoid") {
            add(ellipsoid_study());
        } else if (name == "tee") {
            add(tee_study());
        } else {
            add(file_study(load_mandrel(find_input(name), {.unit_mm = request.unit_mm})));
        }
    }
    return mandrels;
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

}  // namespace

StudyOutcome run_study(const StudyRequest& request) {
    StudyOutcome outcome;
    outcome.options = request.options;
    outcome.options.validate();
    OutputFolder folder(request.out);
    const std::vector<StudyMandrel> mandrels = mandrels_of(request);
    for (const StudyMandrel& mandrel : mandrels) {
        outcome.references.emplace_back(mandrel.name, mandrel.reference_words);
    }
    outcome.study = mesh_size_study(mandrels, outcome.options);
    folder.add("study.csv", study_csv(outcome.study));
    folder.add("study.json", study_json(outcome));
    folder.add("study.svg", study_svg(outcome));
    if (outcome.options.timing) {
        folder.add("timing.csv", timing_csv(outcome.study));
    } else {
        folder.withdraw("timing.csv");
    }
    folder.publish();
    return outcome;
}

void print_study(std::ostream& out, const StudyOutcome& outcome,
                 const std::filesystem::path& folder) {
    for (const Quantity quantity : {Quantity::PathEnd, Quantity::WindingAngle, Quantity::Slip,
                                    Quantity::SpindleAngle, Quantity::EyePoint}) {
        print_quantity(out, outcome, quantity);
    }
    for (const std::string& remark : outcome.study.remarks) {
        out << remark << '\n';
    }
    for (const MeshSizeTiming& t : outcome.study.timing) {
        out << t.mandrel << ", " << t.method << ", lambda " << fixed(t.slip_ratio, 2)
            << ", edges of " << fixed(t.edge_mm, 2) << " mm: " << fixed(t.ns_per_crossing, 0)
            << " ns per crossing, " << fixed(t.ms_per_metre, 3) << " ms per metre\n";
    }
    out << "advice of Fu and others (2009):\n";
    for (const Advice& advice : judged_advice(outcome)) {
        out << "  " << (advice.holds ? "holds:        " : "does not hold: ") << advice.claim
            << "\n    " << advice.because << '\n';
    }
    out << "written to " << folder.string() << ": study.csv, study.json, study.svg"
        << (outcome.options.timing ? ", timing.csv" : "") << '\n';
}

}  // namespace meshwind
