#include "pipeline/pattern_checks.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "core/text/text_number.h"
#include "core/units.h"
#include "postproc/verify/check_kinds.h"
#include "postproc/verify/closure.h"

namespace meshwind {
namespace {

// Share of a band that is no gap: rounding.
constexpr double kNoGap = 1e-6;

Check check_of(const LaidClosure& closure, std::size_t circuits) {
    Check check(check_kind::kClosure, closure.holds());
    check.numbers = {{"limit_closure_deg", deg_from_rad(closure.limit_rad())},
                     {"closure_deg", deg_from_rad(closure.closure_rad)},
                     {"resolution_deg", deg_from_rad(closure.resolution_rad)},
                     {"drift_deg", deg_from_rad(closure.drift_rad)}};
    if (!closure.failure.empty()) {
        check.words = closure.failure;
    } else if (!check.ok) {
        check.words = "the pattern does not close: after " + std::to_string(circuits) +
                      " circuits the laid fibre is " + fixed(deg_from_rad(closure.closure_rad), 4) +
                      " deg from where it began, and circuit " +
                      std::to_string(closure.drift_circuit) + " is " +
                      fixed(deg_from_rad(closure.drift_rad), 4) + " deg off its place";
    }
    return check;
}

// Evenly over stretches of a tube, a tow width from their ends.
std::vector<double> sections_on(std::span<const std::array<double, 2>> stretches,
                                double margin_mm) {
    constexpr int kSections = 21;  // as many as parallels of a body of revolution
    std::vector<double> sections_mm;
    for (const auto& [from, to] : stretches) {
        for (int k = 0; k < kSections && to - from > 2.0 * margin_mm; ++k) {
            const double share = static_cast<double>(k) / (kSections - 1);
            sections_mm.push_back(from + margin_mm + share * (to - from - 2.0 * margin_mm));
        }
    }
    return sections_mm;
}

}  // namespace

bool is_open(const Plan& plan) {
    if (plan.pattern() == nullptr) {
        return false;
    }
    const LaidPattern& laid = *plan.pattern();
    return laid.lattice ? !laid.lattice->filled : laid.pattern.overlap < -kNoGap;
}

Check open_coverage_check(const Plan& plan) {
    const LaidPattern& laid = *plan.pattern();
    Check check(check_kind::kCoverage);
    check.numbers = {{"fraction", plan.coverage.fraction},
                     {"ribs", 2.0 * static_cast<double>(laid.pattern.circuits)},
                     {"crossings", static_cast<double>(laid.interlacing.crossings)}};
    return check;
}

Check closure_check(const Plan& plan, std::span<const PathPoint> laid) {
    double low_mm = std::numeric_limits<double>::infinity();
    double high_mm = -low_mm;
    for (const Piece& piece : plan.pieces) {
        if (piece.kind == PieceKind::Course) {
            for (const PathPoint& at : {piece.path.front(), piece.path.back()}) {
                low_mm = std::min(low_mm, at.position_mm.z());
                high_mm = std::max(high_mm, at.position_mm.z());
            }
        }
    }
    const std::vector<double>& starts_rad = plan.pattern()->starts_rad;
    return check_of(laid_closure(laid, starts_rad, low_mm, high_mm), starts_rad.size());
}

Check elbow_closure_check(const Plan& plan, double tow_width_mm, std::span<const PathPoint> laid,
                          std::span<const PathPoint> meant) {
    const LaidElbow& elbow = *plan.elbow();
    const CentreLine& line = *elbow.line;
    const std::array<std::array<double, 2>, 2> even{
        {{0.0, elbow.leg[0].length_mm - elbow.leg[0].run_mm},
         {line.length_mm() - elbow.leg[1].length_mm + elbow.leg[1].run_mm, line.length_mm()}}};
    std::vector<double> sections_mm = sections_on(even, tow_width_mm);
    if (sections_mm.empty()) {
        const std::array<std::array<double, 2>, 1> all{{{0.0, line.length_mm()}}};
        sections_mm = sections_on(all, tow_width_mm);
    }
    const auto circuits = static_cast<std::size_t>(elbow.lines);
    return check_of(laid_tube_closure(laid, meant, circuits, line, sections_mm), circuits);
}

}  // namespace meshwind
