#include "cli/pattern_checks.h"

#include <algorithm>
#include <limits>
#include <string>

#include "core/text_number.h"
#include "core/units.h"
#include "postproc/closure.h"

namespace meshwind {
namespace {

// Share of a band that is no gap: rounding.
constexpr double kNoGap = 1e-6;

}  // namespace

bool is_open(const Plan& plan) {
    if (!plan.pattern) {
        return false;
    }
    const LaidPattern& laid = *plan.pattern;
    return laid.lattice ? !laid.lattice->filled : laid.pattern.overlap < -kNoGap;
}

Check open_coverage_check(const Plan& plan) {
    const LaidPattern& laid = *plan.pattern;
    Check check{"coverage", true, {}, {}};
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
    const std::vector<double>& starts_rad = plan.pattern->starts_rad;
    const LaidClosure closure = laid_closure(laid, starts_rad, low_mm, high_mm);
    Check check{"closure", closure.holds(), {}, {}};
    check.numbers = {{"limit_deg", deg_from_rad(kClosureLimit_rad)},
                     {"closure_deg", deg_from_rad(closure.closure_rad)},
                     {"resolution_deg", deg_from_rad(closure.resolution_rad)},
                     {"drift_deg", deg_from_rad(closure.drift_rad)}};
    if (!closure.failure.empty()) {
        check.words = closure.failure;
    } else if (!check.ok) {
        check.words = "the pattern does not close: after " + std::to_string(starts_rad.size()) +
                      " circuits the laid fibre is " + fixed(deg_from_rad(closure.closure_rad), 4) +
                      " deg from where it began, and circuit " +
                      std::to_string(closure.drift_circuit) + " is " +
                      fixed(deg_from_rad(closure.drift_rad), 4) + " deg off its place";
    }
    return check;
}

}  // namespace meshwind
