#include "mesh/revolution/meridian_fit.h"

#include <algorithm>
#include <cmath>

#include "mesh/revolution/profile_curve.h"
#include "mesh/revolution/profile_lines.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;

// Places off a line by so many times their usual scatter are not on it.
constexpr double kScatters = 4.0;

// Of the body's size: what files in single precision cannot tell apart.
constexpr double kSinglePrecision = 2e-7;

// Between two creases or ends.
struct Section {
    std::vector<ProfilePoint> points;
    std::array<Vector2d, 2> bound_mm;
    std::array<bool, 2> pole{};
};

std::vector<Section> sections_of(const ProfilePoints& profile) {
    std::vector<Section> sections;
    double low = -1.0;
    Vector2d bound = profile.end_mm[0];
    for (std::size_t c = 0; c <= profile.creases.size(); ++c) {
        const bool last = c == profile.creases.size();
        const double high = last ? profile.points.back().arc_mm : profile.creases[c].high_mm;
        Section section;
        for (const ProfilePoint& p : profile.points) {
            if (p.arc_mm >= low && p.arc_mm <= high) {
                section.points.push_back(p);
            }
        }
        section.bound_mm = {bound, last ? profile.end_mm[1] : profile.creases[c].at_mm};
        section.pole = {c == 0 && profile.end[0].kind == MeridianEnd::Kind::Pole,
                        last && profile.end[1].kind == MeridianEnd::Kind::Pole};
        sections.push_back(std::move(section));
        if (!last) {
            low = profile.creases[c].low_mm;
            bound = profile.creases[c].at_mm;
        }
    }
    return sections;
}

// Where two lines meet; nothing when that is not near `beside`.
std::optional<Vector2d> meeting(const ProfileLine& a, const ProfileLine& b, const Vector2d& beside,
                                double within_mm) {
    const double sine = a.way.x() * b.way.y() - a.way.y() * b.way.x();
    if (sine == 0.0) {
        return std::nullopt;
    }
    const Vector2d arm = b.origin_mm - a.origin_mm;
    const Vector2d at = a.origin_mm + (arm.x() * b.way.y() - arm.y() * b.way.x()) / sine * a.way;
    return (at - beside).norm() <= within_mm ? std::optional(at) : std::nullopt;
}

class SectionFit {
public:
    SectionFit(const Section& section, std::vector<ProfilePlace> places, double tolerance_mm,
               double precision_mm)
        : section_(section),
          places_(std::move(places)),
          tolerance_mm_(tolerance_mm),
          stretches_(stretches_of(section.points, places_, tolerance_mm, precision_mm)) {}

    [[nodiscard]] std::vector<MeridianNode> nodes() const {
        std::vector<MeridianNode> nodes;
        for (std::size_t i = 0; i < stretches_.size(); ++i) {
            if (stretches_[i].straight) {
                add_line(i, nodes);
            } else {
                add_curve(i, nodes);
            }
        }
        return nodes;
    }

    [[nodiscard]] const ProfileStretch& first() const { return stretches_.front(); }
    [[nodiscard]] const ProfileStretch& last() const { return stretches_.back(); }

private:
    [[nodiscard]] bool has_line(std::size_t i) const {
        return i < stretches_.size() && stretches_[i].straight;
    }

    // Curves bring the nodes at which they meet a line.
    void add_line(std::size_t i, std::vector<MeridianNode>& nodes) const {
        const ProfileLine& line = stretches_[i].line;
        if (i == 0) {
            nodes.push_back(bound_on(line, 0));
        } else if (has_line(i - 1)) {
            add_meeting(i, nodes);
        }
        nodes.back().straight = true;
        if (i + 1 == stretches_.size()) {
            nodes.push_back(bound_on(line, 1));
        }
    }

    void add_meeting(std::size_t i, std::vector<MeridianNode>& nodes) const {
        const ProfileStretch& before = stretches_[i - 1];
        const ProfileStretch& behind = stretches_[i];
        const Vector2d from = places_[before.last].at_mm;
        const Vector2d to = places_[behind.first].at_mm;
        const double within = 0.5 * (to - from).norm() + places_[before.last].spacing_mm;
        if (const auto at = meeting(before.line, behind.line, 0.5 * (from + to), within)) {
            nodes.push_back({.radius_mm = at->x(), .z_mm = at->y(), .crease = true});
            return;
        }
        const Vector2d a = before.line.foot_mm(from);
        const Vector2d b = behind.line.foot_mm(to);
        nodes.push_back({.radius_mm = a.x(), .z_mm = a.y(), .crease = true, .straight = true});
        if ((b - a).norm() > tolerance_mm_) {
            nodes.push_back({.radius_mm = b.x(), .z_mm = b.y(), .crease = true});
        }
    }

    void add_curve(std::size_t i, std::vector<MeridianNode>& nodes) const {
        const ProfileStretch& stretch = stretches_[i];
        std::array<CurveEnd, 2> end;
        for (std::size_t e = 0; e < 2; ++e) {
            const std::size_t beside = e == 0 ? i - 1 : i + 1;  // i - 1 wraps to none
            if (has_line(beside)) {
                end[e] = {CurveEnd::Kind::Line, Vector2d::Zero(), stretches_[beside].line};
            } else {
                end[e] = {section_.pole[e] ? CurveEnd::Kind::Pole : CurveEnd::Kind::Point,
                          section_.bound_mm[e],
                          {}};
            }
        }
        const std::span places(places_);
        const auto used = places.subspan(stretch.first, stretch.last - stretch.first + 1);
        const auto points = std::span(section_.points)
                                .subspan(used.front().first, used.back().last - used.front().first);
        std::vector<MeridianNode> curve = curve_nodes(points, used, end, tolerance_mm_);
        nodes.insert(nodes.end(), curve.begin(), curve.end());
    }

    [[nodiscard]] MeridianNode bound_on(const ProfileLine& line, std::size_t e) const {
        Vector2d at = line.foot_mm(section_.bound_mm[e]);
        if (section_.pole[e] && line.way.x() != 0.0) {
            at = {0.0, line.origin_mm.y() - line.origin_mm.x() / line.way.x() * line.way.y()};
        }
        return {.radius_mm = std::max(at.x(), 0.0), .z_mm = at.y()};
    }

    const Section& section_;
    std::vector<ProfilePlace> places_;
    double tolerance_mm_;
    std::vector<ProfileStretch> stretches_;
};

// Puts the sections together: the node at which two meet is one, a crease.
void append(std::vector<MeridianNode>& nodes, std::vector<MeridianNode> more,
            const std::optional<Vector2d>& meet, bool line_before, bool line_behind) {
    if (nodes.empty()) {
        nodes = std::move(more);
        return;
    }
    MeridianNode& crease = nodes.back();
    const MeridianNode& behind = more.front();
    if (meet) {
        crease.radius_mm = meet->x();
        crease.z_mm = meet->y();
    } else if (line_behind && !line_before) {
        crease.radius_mm = behind.radius_mm;
        crease.z_mm = behind.z_mm;
    }
    crease.crease = true;
    crease.slope_rad = behind.slope_rad;
    crease.straight = behind.straight;
    nodes.insert(nodes.end(), more.begin() + 1, more.end());
}

}  // namespace

std::vector<MeridianNode> fit_meridian(const ProfilePoints& profile) {
    const std::vector<Section> sections = sections_of(profile);
    std::vector<std::vector<ProfilePlace>> places;
    double size = 0.0;
    for (const Section& section : sections) {
        places.push_back(places_of(section.points));
        for (const ProfilePoint& p : section.points) {
            size = std::max({size, p.at_mm.x(), std::abs(p.at_mm.y())});
        }
    }
    const double precision = kSinglePrecision * size;
    const double tolerance = std::max(kScatters * scatter_mm(places), precision);
    std::vector<MeridianNode> nodes;
    std::optional<ProfileStretch> before;
    for (std::size_t i = 0; i < sections.size(); ++i) {
        if (places[i].size() < 2) {
            continue;  // a crease at an end
        }
        const SectionFit fit(sections[i], places[i], tolerance, precision);
        std::optional<Vector2d> meet;
        const bool lines = before && before->straight && fit.first().straight;
        if (lines) {
            meet = meeting(before->line, fit.first().line, sections[i].bound_mm[0],
                           places[i].front().spacing_mm);
        }
        append(nodes, fit.nodes(), meet, before && before->straight, fit.first().straight);
        before = fit.last();
    }
    return nodes;
}

}  // namespace meshwind
