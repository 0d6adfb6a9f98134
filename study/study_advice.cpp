#include "study/study_advice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/text/text_number.h"
#include "core/units.h"
#include "study/helix_law.h"
#include "study/study_run.h"

namespace meshwind {
namespace {

constexpr double kHelixAngleDeg = 45.0;
// The radii of the paper's figure 8 and its mesh size for the largest, mm.
constexpr std::array kPaperRadiiMm{20.0, 70.0, 450.0};
constexpr double kPaperEdgeMm = 2.0;
// Spacings of the same sum, mm: even, and one twice the other.
constexpr Spacing kEven{2.0, 2.0};
constexpr Spacing kUneven{8.0 / 3.0, 4.0 / 3.0};
constexpr double kLongestSpacingMm = 60.0;  // of the search on the smallest radius: half its turn

// Three significant digits.
std::string digits(double value) {
    const double size = std::abs(value);
    const int decimals =
        size > 0.0 ? std::clamp(2 - static_cast<int>(std::floor(std::log10(size))), 0, 9) : 0;
    return fixed(value, decimals);
}

Helix helix_of(double radius_mm) {
    return {radius_mm, rad_from_deg(kHelixAngleDeg)};
}

class Judge {
public:
    explicit Judge(const StudyOutcome& outcome)
        : outcome_(outcome), free_length_mm_(outcome.options.free_length_mm) {}

    [[nodiscard]] std::vector<Advice> all() const {
        std::vector<Advice> found = growth();
        for (const auto& more : {small_radius(), large_radius(), even_spacing(), dense_chord()}) {
            found.insert(found.end(), more.begin(), more.end());
        }
        return found;
    }

private:
    // Lines of C errors by one rule, of geodesics (or the first slip ratio) by each method.
    [[nodiscard]] std::vector<const MeshSizeLine*> c_lines(TangentRule rule) const {
        std::vector<const MeshSizeLine*> lines;
        for (const MeshSizeLine& line : outcome_.study.lines) {
            if (line.quantity == Quantity::SpindleAngle && line.rule == rule &&
                line.slip_ratio == outcome_.options.slip_ratios.front() && !line.points.empty()) {
                lines.push_back(&line);
            }
        }
        return lines;
    }

    [[nodiscard]] std::vector<Advice> growth() const {
        double least = 1e300;
        double most = -1e300;
        for (const MeshSizeLine* line : c_lines(TangentRule::Chord)) {
            if (const auto order = fitted_order(*line)) {
                least = std::min(least, *order);
                most = std::max(most, *order);
            }
        }
        if (least > most) {
            return {};
        }
        return {{"the error grows with the mesh size", least > 0.0,
                 "error of C with the chord P1-P2: order " + fixed(least, 2) + " to " +
                     fixed(most, 2) + " in edge length"}};
    }

    // On the cylinders of the study, at the finest edge length that all have.
    [[nodiscard]] std::vector<Advice> small_radius() const {
        std::map<double, const MeshSizeLine*> cylinders;  // by radius
        for (const MeshSizeLine* line : c_lines(TangentRule::Chord)) {
            constexpr std::string_view kName = "cylinder-";
            if (line->mandrel.starts_with(kName) && line->method == path_methods().front().name) {
                const std::string radius = line->mandrel.substr(kName.size());
                if (radius.find_first_not_of("0123456789.e+-") == std::string::npos) {
                    cylinders[std::stod(radius)] = line;
                }
            }
        }
        if (cylinders.size() < 2) {
            return {};
        }
        double edge_mm = 0.0;
        for (const auto& [radius, line] : cylinders) {
            edge_mm = std::max(edge_mm, line->points.back().edge_mm);
        }
        std::vector<double> errors;
        std::string words;
        for (const auto& [radius, line] : cylinders) {
            const auto point = std::find_if(line->points.begin(), line->points.end(),
                                            [&](const auto& p) { return p.edge_mm == edge_mm; });
            if (point == line->points.end()) {
                continue;
            }
            errors.push_back(point->rms);
            words += (words.empty() ? "" : ", ") + digits(deg_from_rad(point->rms)) +
                     " deg at R = " + digits(radius);
        }
        return {{"a small radius needs a small mesh",
                 errors.size() > 1 && std::is_sorted(errors.rbegin(), errors.rend()),
                 "error of C with the chord, edges of " + digits(edge_mm) + " mm: " + words}};
    }

    [[nodiscard]] std::vector<Advice> large_radius() const {
        const double error =
            std::abs(helix_error(TangentRule::Chord, helix_of(kPaperRadiiMm.back()),
                                 {kPaperEdgeMm, kPaperEdgeMm}, free_length_mm_)
                         .c_rad);
        std::vector<double> spacings;
        std::string words;
        for (const double radius : kPaperRadiiMm) {
            spacings.push_back(spacing_for_c_error_mm(TangentRule::Chord, helix_of(radius),
                                                      free_length_mm_, error, kLongestSpacingMm));
            words += (words.empty() ? "" : ", ") + digits(spacings.back()) +
                     " mm at R = " + digits(radius);
        }
        // As a bound that begins at R = 450 it would have to be the tightest there.
        const bool tightest =
            *std::min_element(spacings.begin(), spacings.end()) == spacings.back();
        return {{"above R = 450 mm the mesh must be at most 2 mm, below it need not", tightest,
                 "the same error of C, " + digits(deg_from_rad(error)) +
                     " deg by the chord on a helix of 45 deg, takes landing points every " +
                     words}};
    }

    [[nodiscard]] std::vector<Advice> even_spacing() const {
        const Helix helix = helix_of(kPaperRadiiMm[1]);
        const auto direction_deg = [&](TangentRule rule, const Spacing& spacing) {
            return deg_from_rad(helix_error(rule, helix, spacing, free_length_mm_).direction_rad);
        };
        const double even = direction_deg(TangentRule::Central, kEven);
        const double uneven = direction_deg(TangentRule::Central, kUneven);
        return {{"the more uniform the mesh, the more precise", even < uneven,
                 "direction by P1-P3 on a helix of R = 70, 45 deg, points 4 mm apart: off by " +
                     digits(even) + " deg with P2 in the middle, " + digits(uneven) +
                     " deg with P2 at two thirds; the parabola is off by " +
                     digits(direction_deg(TangentRule::Parabola, kUneven)) + " deg there"}};
    }

    [[nodiscard]] std::vector<Advice> dense_chord() const {
        double least = 1e300;
        double most = 0.0;
        std::size_t mandrels = 0;
        const auto chords = c_lines(TangentRule::Chord);
        for (std::size_t i = 0; i < chords.size(); ++i) {
            double best = 1e300;
            for (const TangentRule rule :
                 {TangentRule::Central, TangentRule::Parabola, TangentRule::Traced}) {
                best = std::min(best, c_lines(rule).at(i)->points.back().rms);
            }
            if (best > 0.0) {
                const double ratio = chords[i]->points.back().rms / best;
                least = std::min(least, ratio);
                most = std::max(most, ratio);
                ++mandrels;
            }
        }
        if (mandrels == 0) {
            return {};
        }
        return {{"on a dense mesh the chord P1-P2 will do", least <= 1.0,
                 "at the finest edges its error of C is " + digits(least) + " to " + digits(most) +
                     " times that of the best other rule"}};
    }

    const StudyOutcome& outcome_;
    double free_length_mm_;
};

}  // namespace

std::vector<Advice> judged_advice(const StudyOutcome& outcome) {
    return Judge(outcome).all();
}

}  // namespace meshwind
