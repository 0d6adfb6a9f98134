#include "mesh/tube/centre_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// An arc that turns by less is straight to rounding.
constexpr double kStraight_rad = 1e-12;

// `from` carried on by so much along a stretch of constant curvature.
CentrePlace carried(const CentrePlace& from, double way_mm) {
    CentrePlace place = from;
    place.arc_mm += way_mm;
    const double curvature = from.curvature_per_mm.norm();
    const double turn = curvature * way_mm;
    if (std::abs(turn) < kStraight_rad) {
        place.position_mm += way_mm * from.tangent;
        return place;
    }
    const Vector3d inward = from.curvature_per_mm / curvature;
    const double half = std::sin(0.5 * turn);
    place.position_mm += (std::sin(turn) * from.tangent + 2.0 * half * half * inward) / curvature;
    const Eigen::AngleAxisd turned(turn, from.tangent.cross(inward));
    place.tangent = (turned * from.tangent).normalized();
    const Vector3d reference = turned * from.reference;
    place.reference = (reference - reference.dot(place.tangent) * place.tangent).normalized();
    place.curvature_per_mm = turned * from.curvature_per_mm;
    return place;
}

void curve(CentrePlace& place, const CentreArc& arc) {
    place.curvature_per_mm =
        arc.curvature_per_mm.x() * place.reference + arc.curvature_per_mm.y() * place.across();
}

// The arc that leaves a place along its tangent and leads to a point.
CentreArc arc_to(const CentrePlace& from, const Vector3d& point_mm) {
    const Vector3d chord = point_mm - from.position_mm;
    const Vector3d aside = chord - chord.dot(from.tangent) * from.tangent;
    const double half = std::atan2(aside.norm(), chord.dot(from.tangent));
    const Vector3d curvature = 2.0 * aside / chord.squaredNorm();
    CentreArc arc;
    arc.length_mm = half < kStraight_rad ? chord.norm() : chord.norm() * half / std::sin(half);
    arc.curvature_per_mm = {curvature.dot(from.reference), curvature.dot(from.across())};
    return arc;
}

// Tangent of the circle through a, b, c at b; with `shift` -1 at a, 1 at c.
Vector3d circle_tangent(const Vector3d& a, const Vector3d& b, const Vector3d& c, int shift) {
    const Vector3d in = b - a;
    const Vector3d out = c - b;
    const Vector3d slope_in = in / in.squaredNorm();
    const Vector3d slope_out = out / out.squaredNorm();
    const Vector3d middle = (slope_in + slope_out).normalized();
    if (shift == 0) {
        return middle;
    }
    // The chord halves the angle between the tangents at its ends.
    const Vector3d chord = (shift < 0 ? in : out).normalized();
    return 2.0 * chord.dot(middle) * chord - middle;
}

// Where the two arcs from a to b meet that have these tangents at its ends.
Vector3d biarc_middle(const Vector3d& a, const Vector3d& at_a, const Vector3d& b,
                      const Vector3d& at_b) {
    const Vector3d way = b - a;
    const double along = way.dot(at_a + at_b);
    const double apart = 2.0 * (1.0 - at_a.dot(at_b));
    const double reach =
        way.squaredNorm() / (along + std::sqrt(along * along + apart * way.squaredNorm()));
    return 0.5 * (a + b + reach * (at_a - at_b));
}

CentrePlace straight_on(CentrePlace place, double way_mm) {
    place.curvature_per_mm.setZero();
    return carried(place, way_mm);
}

}  // namespace

Vector3d CentrePlace::across() const {
    return tangent.cross(reference);
}

CentreLine::CentreLine(const CentrePlace& start, std::vector<CentreArc> arcs)
    : arcs_(std::move(arcs)) {
    CentrePlace place = start;
    place.arc_mm = 0.0;
    for (const CentreArc& arc : arcs_) {
        curve(place, arc);
        nodes_.push_back(place);
        place = carried(place, arc.length_mm);
    }
    nodes_.push_back(place);
}

CentrePlace CentreLine::along(std::size_t arc, double way_mm) const {
    return carried(nodes_[arc], way_mm);
}

CentrePlace CentreLine::at(double arc_mm) const {
    if (arc_mm < 0.0) {
        return straight_on(nodes_.front(), arc_mm);
    }
    if (arc_mm > length_mm()) {
        return straight_on(nodes_.back(), arc_mm - length_mm());
    }
    const auto after =
        std::upper_bound(nodes_.begin(), nodes_.end() - 1, arc_mm,
                         [](double s, const CentrePlace& node) { return s < node.arc_mm; });
    const std::size_t arc =
        std::min(static_cast<std::size_t>(after - nodes_.begin()), arcs_.size()) - 1;
    return along(arc, arc_mm - nodes_[arc].arc_mm);
}

// Way along an arc, 0 to its length, that is nearest to a point.
double CentreLine::way_under(std::size_t arc, const Vector3d& point_mm) const {
    const CentrePlace& node = nodes_[arc];
    const Vector3d to = point_mm - node.position_mm;
    const double length = arcs_[arc].length_mm;
    const double curvature = node.curvature_per_mm.norm();
    if (curvature * length < kStraight_rad) {
        return std::clamp(to.dot(node.tangent), 0.0, length);
    }
    const Vector3d inward = node.curvature_per_mm / curvature;
    // From the centre of curvature: the angle from the start, least where it is ahead of the middle
    // by half a turn.
    const double angle = std::atan2(to.dot(node.tangent), 1.0 / curvature - to.dot(inward));
    const double middle = 0.5 * curvature * length;
    const double near = middle + std::remainder(angle - middle, 2.0 * kPi);
    return std::clamp(near / curvature, 0.0, length);
}

CentrePlace CentreLine::foot(const Vector3d& point_mm) const {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const double distance = (point_mm - nodes_[i].position_mm).squaredNorm();
        if (distance < least) {
            least = distance;
            nearest = i;
        }
    }
    CentrePlace best = nodes_[nearest];
    least = std::sqrt(least);
    const auto try_place = [&](const CentrePlace& place) {
        const double distance = (point_mm - place.position_mm).norm();
        if (distance < least) {
            least = distance;
            best = place;
        }
    };
    const double before = (point_mm - nodes_.front().position_mm).dot(nodes_.front().tangent);
    if (before < 0.0 && nearest == 0) {
        try_place(straight_on(nodes_.front(), before));
    }
    const double beyond = (point_mm - nodes_.back().position_mm).dot(nodes_.back().tangent);
    if (beyond > 0.0 && nearest + 1 == nodes_.size()) {
        try_place(straight_on(nodes_.back(), beyond));
    }
    for (std::size_t arc = 0; arc < arcs_.size(); ++arc) {
        // No place of an arc is farther from its start than it is long.
        const double node = (point_mm - nodes_[arc].position_mm).norm();
        if (node - arcs_[arc].length_mm < least) {
            try_place(along(arc, way_under(arc, point_mm)));
        }
    }
    return best;
}

CentreLine line_through(std::span<const Vector3d> points_mm) {
    const std::size_t last = points_mm.size() - 1;
    const auto tangent = [&](std::size_t i) {
        const std::size_t middle = std::clamp<std::size_t>(i, 1, last - 1);
        return circle_tangent(points_mm[middle - 1], points_mm[middle], points_mm[middle + 1],
                              static_cast<int>(i) - static_cast<int>(middle));
    };
    CentrePlace start;
    start.position_mm = points_mm.front();
    start.tangent = tangent(0);
    start.reference = start.tangent.unitOrthogonal();
    std::vector<CentreArc> arcs;
    CentrePlace place = start;
    const auto lead_to = [&](const Vector3d& point) {
        arcs.push_back(arc_to(place, point));
        curve(place, arcs.back());
        place = carried(place, arcs.back().length_mm);
    };
    for (std::size_t i = 0; i < last; ++i) {
        lead_to(biarc_middle(place.position_mm, place.tangent, points_mm[i + 1], tangent(i + 1)));
        lead_to(points_mm[i + 1]);
    }
    return {start, std::move(arcs)};
}

}  // namespace meshwind
