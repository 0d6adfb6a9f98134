#include "mesh/segment/axis_candidates.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "core/text/text_number.h"
#include "core/units.h"
#include "mesh/segment/spindle_axis.h"
#include "mesh/segment/spindle_lines.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Lines nearer than this, as a sine and as a share of the part's diagonal, are one.
constexpr double kSame = 1e-3;

std::string in_deg(double angle_rad) {
    return fixed(deg_from_rad(angle_rad), 0) + " deg";
}

class Candidates {
public:
    explicit Candidates(const Mandrel& mandrel)
        : mandrel_(mandrel),
          points_(weighed_points({mandrel.surface.position_mm, mandrel.surface.face})),
          centroid_(centroid_of(points_)),
          size_mm_(diagonal_mm(mandrel.whole)) {}

    std::vector<AxisCandidate> all() {
        const std::string& rule = mandrel_.axis.rule;
        add(rule, {Vector3d::Zero(), Vector3d::UnitZ(), mandrel_.axis.residual_mm}, why_chosen());
        add_coaxial(rule);
        add_revolution(rule);
        add_chord();
        add_principal(rule);
        return std::move(found_);
    }

private:
    [[nodiscard]] std::string why_chosen() const {
        const std::string& rule = mandrel_.axis.rule;
        if (rule == "given") {
            return "the job gives it";
        }
        if (rule == "coaxial-rims") {
            return "of all rims on one line the two on this lie farthest apart";
        }
        if (rule == "revolution") {
            return "no rims lie on one line, the wall goes all around this one";
        }
        return "no rims on one line, no axis of revolution: " +
               std::string(mandrel_.rims.empty()
                               ? "its moment of inertia differs most"
                               : "of the principal axes most rims point along it");
    }

    void add_coaxial(const std::string& rule) {
        for (const CoaxialRims& pair : coaxial_rims(mandrel_.rims)) {
            add("coaxial-rims", pair.line,
                rule == "given" ? "the job gives another"
                                : "its rims are " + fixed(pair.apart_mm, 1) +
                                      " mm apart, those of the chosen one farther");
        }
    }

    void add_revolution(const std::string& rule) {
        const SpindleLine line = line_of_normals(points_, centroid_);
        const double radius_mm = mean_distance_from(line, points_);
        const double gap_rad = gap_about_rad(line, points_, radius_mm);
        std::string why = rule == "given" ? "the job gives another" : "rims on one line come first";
        if (!(line.residual_mm <= kRevolutionShare * radius_mm)) {
            why = "the wall's normals miss it by " + fixed(line.residual_mm, 2) +
                  " mm, more than " + percent(kRevolutionShare, 0) + " of its mean radius";
        } else if (!(gap_rad <= kWidestGap_rad)) {
            why = "the wall does not go around it, " + in_deg(gap_rad) + " are open";
        }
        add("revolution", line, std::move(why));
    }

    // Two rims that are not on one line: an elbow's.
    void add_chord() {
        if (mandrel_.rims.size() != 2) {
            return;
        }
        const Vector3d chord = mandrel_.rims[1].centre_mm - mandrel_.rims[0].centre_mm;
        if (chord.norm() > kSame * size_mm_) {
            add("chord", {mandrel_.rims[0].centre_mm, chord.normalized(), 0.0},
                "taken only where the job gives it");
        }
    }

    void add_principal(const std::string& rule) {
        const PrincipalAxes<3> axes = inertia_of(points_, centroid_);
        for (int i = 2; i >= 0; --i) {
            SpindleLine line{centroid_, axes.vectors.col(i), 0.0};
            line.residual_mm = scatter_about(line, points_);
            add("principal", line,
                rule == "given"       ? "the job gives another"
                : rule == "principal" ? "fewer rims point along it, or its moment differs less"
                                      : "rims on one line and axes of revolution come first");
        }
    }

    void add(std::string rule, SpindleLine line, std::string why) {
        const bool known =
            std::any_of(found_.begin(), found_.end(), [&](const AxisCandidate& other) {
                const SpindleLine there{other.through_mm, other.direction, 0.0};
                return line.direction.cross(other.direction).norm() < kSame &&
                       distance_from(there, line.origin) < kSame * size_mm_;
            });
        if (known) {
            return;
        }
        if (line.direction.z() < 0.0) {
            line.direction = -line.direction;
        }
        AxisCandidate candidate;
        candidate.rule = std::move(rule);
        candidate.direction = line.direction;
        // The foot of the chosen one's origin.
        candidate.through_mm = line.origin - line.direction * line.direction.dot(line.origin);
        candidate.residual_mm = line.residual_mm;
        for (const Vector3d& p : mandrel_.whole.points_mm) {
            candidate.swing_mm = std::max(candidate.swing_mm, distance_from(line, p));
        }
        for (const Rim& rim : mandrel_.rims) {
            const bool on = rim.axis.cross(line.direction).norm() <= kCoaxialSine &&
                            distance_from(line, rim.centre_mm) <= kCoaxialSine * size_mm_;
            candidate.rims += on ? 1 : 0;
        }
        candidate.gap_rad = gap_about_rad(line, points_, mean_distance_from(line, points_));
        candidate.angle_rad = std::atan2(line.direction.cross(Vector3d::UnitZ()).norm(),
                                         std::abs(line.direction.z()));
        candidate.off_mm = distance_from(line, Vector3d::Zero());
        candidate.why = std::move(why);
        found_.push_back(std::move(candidate));
    }

    const Mandrel& mandrel_;
    std::vector<WeighedPoint> points_;
    Vector3d centroid_;
    double size_mm_;
    std::vector<AxisCandidate> found_;
};

}  // namespace

std::vector<AxisCandidate> axis_candidates(const Mandrel& mandrel) {
    return Candidates(mandrel).all();
}

}  // namespace meshwind
