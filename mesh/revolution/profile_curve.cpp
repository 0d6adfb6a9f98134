#include "mesh/revolution/profile_curve.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include "core/small_linear.h"
#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Points = std::span<const ProfilePoint>;
using Places = std::span<const ProfilePlace>;

constexpr int kMaxTerms = 5;

struct Weighted {
    Vector2d at;
    double weight;
};

// The polynomial of so many terms over a line.
ProfilePolynomial fit(const std::vector<Weighted>& points, const ProfileLine& line, int terms,
                      double reach_mm) {
    const auto n = static_cast<Eigen::Index>(points.size());
    Eigen::MatrixXd matrix(n, terms);
    Eigen::VectorXd value(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Weighted& p = points[static_cast<std::size_t>(i)];
        const double root = std::sqrt(p.weight);
        double power = root;
        for (int k = 0; k < terms; ++k) {
            matrix(i, k) = power;
            power *= line.along_mm(p.at) / reach_mm;
        }
        value[i] = root * line.off_mm(p.at);
    }
    const Eigen::VectorXd solved = matrix.colPivHouseholderQr().solve(value);
    ProfilePolynomial polynomial;
    polynomial.line = line;
    polynomial.reach_mm = reach_mm;
    double scale = 1.0;
    for (int k = 0; k < terms; ++k) {
        polynomial.off[static_cast<std::size_t>(k)] = solved[k] * scale;
        scale /= reach_mm;
    }
    return polynomial;
}

Points between(Points points, double low, double high) {
    const auto by_arc = [](const ProfilePoint& p, double arc) { return p.arc_mm < arc; };
    const auto first = std::lower_bound(points.begin(), points.end(), low, by_arc);
    const auto last = std::lower_bound(first, points.end(), high, by_arc);
    return {first, last};
}

// In how many of sixteen equal parts there are points: rings are told apart, scatter fills all.
int filled_parts(Points points, double low, double high) {
    std::array<bool, 16> filled{};
    for (const ProfilePoint& p : points) {
        const double share = (p.arc_mm - low) / (high - low);
        filled[static_cast<std::size_t>(std::clamp(share * 16.0, 0.0, 15.0))] = true;
    }
    return static_cast<int>(std::count(filled.begin(), filled.end(), true));
}

double spacing_near(Points points, double arc) {
    const auto above =
        std::lower_bound(points.begin(), points.end(), arc,
                         [](const ProfilePoint& p, double value) { return p.arc_mm < value; });
    constexpr std::ptrdiff_t kBeside = 8;
    const auto first = above - std::min(kBeside, above - points.begin());
    const auto last = above + std::min(kBeside, points.end() - above);
    std::vector<double> spacing;
    for (auto p = first; p != last; ++p) {
        spacing.push_back(p->spacing_mm);
    }
    const auto middle = spacing.begin() + static_cast<std::ptrdiff_t>(spacing.size() / 2);
    std::nth_element(spacing.begin(), middle, spacing.end());
    return *middle;
}

// Each ring's points lie together and the rings apart, so that the rings are the nodes.
bool in_rings(Places places) {
    constexpr double kTogether = 0.1;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double extent = places[i].high_mm - places[i].low_mm;
        if ((i > 0 && extent > kTogether * (places[i].arc_mm - places[i - 1].arc_mm)) ||
            (i + 1 < places.size() &&
             extent > kTogether * (places[i + 1].arc_mm - places[i].arc_mm))) {
            return false;
        }
    }
    return true;
}

MeridianNode node_at(const Vector2d& p) {
    return {.radius_mm = std::max(p.x(), 0.0), .z_mm = p.y()};
}

double slope_of(const ProfileLine& line) {
    return std::atan2(line.way.x(), line.way.y());
}

// The height of a pole: of a vertex on the axis, else of the even polynomial about it.
double pole_z_mm(Points points, bool at_start, const Vector2d& about) {
    constexpr double kOnAxis = 1e-4;  // of the spacing
    constexpr double kReach = 8.0;    // edges
    const double end = at_start ? points.front().arc_mm : points.back().arc_mm;
    const double reach = kReach * spacing_near(points, end);
    std::vector<ProfilePoint> both;
    for (const ProfilePoint& p : between(points, end - reach, end + reach)) {
        if (p.at_mm.x() <= kOnAxis * p.spacing_mm) {
            return p.at_mm.y();
        }
        both.push_back(p);
        both.back().arc_mm = at_start ? p.at_mm.x() : -p.at_mm.x();
        both.push_back(both.back());
        both.back().at_mm.x() = -p.at_mm.x();
        both.back().arc_mm = -both.back().arc_mm;
    }
    std::sort(both.begin(), both.end(),
              [](const ProfilePoint& a, const ProfilePoint& b) { return a.arc_mm < b.arc_mm; });
    constexpr std::size_t kFewest = 10;
    if (both.size() < kFewest) {
        return about.y();
    }
    const ProfilePolynomial polynomial = polynomial_near(both, 0.0);
    const double x = -polynomial.line.origin_mm.x() / polynomial.line.way.x();
    return polynomial.at_mm(x).y();
}

// Where the curve is parallel to the line that it joins, or crosses it.
struct Joint {
    double along_mm = 0.0;  // on the line
    bool crease = false;
    double slope_rad = 0.0;  // of the curve, at a crease
};

Joint joint_of_rings(Places places, bool at_start, const ProfileLine& line) {
    std::vector<MeridianNode> nodes;
    for (const ProfilePlace& place : places) {
        nodes.push_back(node_at(place.at_mm));
    }
    const Meridian free(nodes);
    const ProfilePlace& beside = at_start ? places[1] : places[places.size() - 2];
    const ProfilePlace& last = at_start ? places.front() : places.back();
    const MeridianPlace place = free.at(at_start ? 0.0 : free.length_mm());
    const double kink = std::abs(std::remainder(place.slope_rad - slope_of(line), 2.0 * kPi));
    // A curve that leaves the line between two rings seems kinked by half of what it turns there.
    constexpr double kOfTurn = 0.75;
    constexpr double kMinRad = 2e-3;
    const double turn = std::abs(place.curvature_per_mm) * std::abs(beside.arc_mm - last.arc_mm);
    return {line.along_mm(last.at_mm), kink > kOfTurn * turn + kMinRad, place.slope_rad};
}

// A zero near x by Newton's method, at most `within` away.
template <class Value, class Slope>
std::optional<double> zero_near(double x, double within, const Value& value, const Slope& slope) {
    const double start = x;
    constexpr int kSteps = 20;
    for (int i = 0; i < kSteps; ++i) {
        const double steep = slope(x);
        if (steep == 0.0) {
            return std::nullopt;
        }
        x -= value(x) / steep;
        if (!(std::abs(x - start) <= within)) {
            return std::nullopt;
        }
    }
    return x;
}

Joint joint_of_scatter(Points points, bool at_start, const ProfileLine& line, double tolerance_mm) {
    constexpr double kReach = 5.0;   // edges that the polynomial sees
    constexpr double kWithin = 2.0;  // edges from where the points leave the line to the joint
    const double end = at_start ? points.front().arc_mm : points.back().arc_mm;
    const double spacing = spacing_near(points, end);
    ProfileLine frame = line;
    frame.origin_mm = line.foot_mm(at_start ? points.front().at_mm : points.back().at_mm);
    Joint joint{line.along_mm(frame.origin_mm), false, slope_of(line)};
    double x = 0.0;
    // The second pass leaves out points that turned out to lie on the line.
    for (int pass = 0; pass < 2; ++pass) {
        std::vector<Weighted> near;
        for (const ProfilePoint& p :
             between(points, end - kReach * spacing, end + kReach * spacing)) {
            const double along = frame.along_mm(p.at_mm);
            if (at_start ? along >= x : along <= x) {
                near.push_back({p.at_mm, 1.0});
            }
        }
        if (near.size() < 4U * kMaxTerms) {
            return joint;
        }
        const ProfilePolynomial curve = fit(near, frame, kMaxTerms, kReach * spacing);
        const auto parallel = zero_near(
            0.0, kWithin * spacing, [&](double u) { return curve.slope(u); },
            [&](double u) { return curve.bend_per_mm(u); });
        const double bend = parallel ? std::abs(curve.bend_per_mm(*parallel)) : 0.0;
        // A tangent curve misses the line by the error of the fit, a kinked one by more than it
        // bends within a fifth of an edge.
        constexpr double kMiss = 0.02;
        if (parallel &&
            std::abs(curve.off_mm(*parallel)) <= tolerance_mm + kMiss * bend * spacing * spacing) {
            x = *parallel;
            joint = {line.along_mm(frame.origin_mm) + x, false, slope_of(line)};
            continue;
        }
        const auto crossing = zero_near(
            0.0, kWithin * spacing, [&](double u) { return curve.off_mm(u); },
            [&](double u) { return curve.slope(u); });
        if (crossing) {
            return {line.along_mm(frame.origin_mm) + *crossing, true, curve.slope_rad(*crossing)};
        }
        return joint;
    }
    return joint;
}

struct EndNode {
    MeridianNode node;
    double arc_mm = 0.0;  // nodes beyond it are not wanted
};

EndNode end_node(Points points, Places places, const CurveEnd& end, bool at_start, bool rings,
                 double tolerance_mm) {
    const ProfilePoint& last = at_start ? points.front() : points.back();
    if (end.kind == CurveEnd::Kind::Pole) {
        return {node_at({0.0, pole_z_mm(points, at_start, end.at_mm)}),
                last.arc_mm + (at_start ? -last.at_mm.x() : last.at_mm.x())};
    }
    if (end.kind == CurveEnd::Kind::Point) {
        EndNode result{node_at(end.at_mm), last.arc_mm};
        if (!rings) {
            const ProfilePolynomial near = polynomial_near(points, last.arc_mm);
            const double slope = near.slope_rad(near.line.along_mm(end.at_mm));
            result.node.slope_rad = result.node.slope_before_rad = slope;
        }
        return result;
    }
    const Joint joint = rings ? joint_of_rings(places, at_start, end.line)
                              : joint_of_scatter(points, at_start, end.line, tolerance_mm);
    const Vector2d at = end.line.origin_mm + joint.along_mm * end.line.way;
    EndNode result{node_at(at), last.arc_mm + joint.along_mm - end.line.along_mm(last.at_mm)};
    result.node.crease = joint.crease;
    if (joint.crease && !rings) {
        (at_start ? result.node.slope_rad : result.node.slope_before_rad) = joint.slope_rad;
    }
    return result;
}

// With the mirror image of what lies near a pole, so that fits there are not one-sided.
std::vector<ProfilePoint> with_mirror_image(Points points, const std::array<CurveEnd, 2>& end,
                                            const std::array<EndNode, 2>& at) {
    std::vector<ProfilePoint> all(points.begin(), points.end());
    for (std::size_t e = 0; e < 2; ++e) {
        if (end[e].kind != CurveEnd::Kind::Pole) {
            continue;
        }
        for (const ProfilePoint& p : points) {
            ProfilePoint image = p;
            image.at_mm.x() = -p.at_mm.x();
            image.arc_mm = 2.0 * at[e].arc_mm - p.arc_mm;
            all.push_back(image);
        }
    }
    std::sort(all.begin(), all.end(),
              [](const ProfilePoint& a, const ProfilePoint& b) { return a.arc_mm < b.arc_mm; });
    return all;
}

std::vector<MeridianNode> nodes_in_scatter(Points points, const std::array<CurveEnd, 2>& end,
                                           const std::array<EndNode, 2>& at) {
    constexpr double kStep = 0.5;    // of the reach of a fit: about an edge
    constexpr double kBeside = 0.6;  // of a step: no node so near to the end
    const std::vector<ProfilePoint> all = with_mirror_image(points, end, at);
    const Points used =
        between(all, 2.0 * at[0].arc_mm - at[1].arc_mm, 2.0 * at[1].arc_mm - at[0].arc_mm);
    const bool pole0 = end[0].kind == CurveEnd::Kind::Pole;
    const bool pole1 = end[1].kind == CurveEnd::Kind::Pole;
    const Points inside = between(used, pole0 ? used.front().arc_mm : at[0].arc_mm,
                                  (pole1 ? used.back().arc_mm : at[1].arc_mm) + 1e-9);
    std::vector<MeridianNode> nodes;
    double arc = at[0].arc_mm;
    while (inside.size() > 1) {
        const double step = kStep * polynomial_near(inside, arc).reach_mm;
        arc += step;
        if (arc > at[1].arc_mm - kBeside * step) {
            break;
        }
        const ProfilePolynomial near = polynomial_near(inside, arc);
        const MeridianNode node = node_at(near.at_mm(0.0));
        const MeridianNode& before = nodes.empty() ? at[0].node : nodes.back();
        const Vector2d way(node.radius_mm - before.radius_mm, node.z_mm - before.z_mm);
        if (way.norm() > 0.1 * step) {
            nodes.push_back(node);
        }
    }
    return nodes;
}

}  // namespace

double ProfilePolynomial::off_mm(double x) const {
    return off[0] + x * (off[1] + x * (off[2] + x * (off[3] + x * off[4])));
}

double ProfilePolynomial::slope(double x) const {
    return off[1] + x * (2.0 * off[2] + x * (3.0 * off[3] + x * 4.0 * off[4]));
}

double ProfilePolynomial::bend_per_mm(double x) const {
    return 2.0 * off[2] + x * (6.0 * off[3] + x * 12.0 * off[4]);
}

Vector2d ProfilePolynomial::at_mm(double x) const {
    const Vector2d outward(line.way.y(), -line.way.x());
    return line.origin_mm + x * line.way + off_mm(x) * outward;
}

double ProfilePolynomial::slope_rad(double x) const {
    const Vector2d outward(line.way.y(), -line.way.x());
    const Vector2d tangent = line.way + slope(x) * outward;
    return std::atan2(tangent.x(), tangent.y());
}

ProfilePolynomial polynomial_near(Points points, double arc_mm) {
    constexpr double kEdges = 2.5;  // to both sides, at least
    constexpr double kWiden = 1.3;
    constexpr int kMaxWidenings = 24;
    double reach = kEdges * spacing_near(points, arc_mm);
    Points near = between(points, arc_mm - reach, arc_mm + reach);
    const auto parts = [&] { return filled_parts(near, arc_mm - reach, arc_mm + reach); };
    for (int i = 0; i < kMaxWidenings && parts() < kMaxTerms && near.size() < points.size(); ++i) {
        reach *= kWiden;
        near = between(points, arc_mm - reach, arc_mm + reach);
    }
    std::vector<Weighted> weighted;
    Vector2d mean = Vector2d::Zero();
    double sum = 0.0;
    for (const ProfilePoint& p : near) {
        constexpr double kLeast = 0.01;  // so that points at the edge still count
        const double share = (p.arc_mm - arc_mm) / reach;
        const double weight = std::max(kLeast, (1.0 - share * share) * (1.0 - share * share));
        weighted.push_back({p.at_mm, weight});
        mean += weight * p.at_mm;
        sum += weight;
    }
    mean /= sum;
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const Weighted& p : weighted) {
        spread += p.weight * (p.at - mean) * (p.at - mean).transpose();
    }
    ProfileLine line{mean, principal_axes(spread).vectors.col(1)};
    if (line.along_mm(near.back().at_mm) < line.along_mm(near.front().at_mm)) {
        line.way = -line.way;
    }
    return fit(weighted, line, std::clamp(parts(), 2, kMaxTerms), reach);
}

std::vector<MeridianNode> curve_nodes(Points points, Places places,
                                      const std::array<CurveEnd, 2>& end, double tolerance_mm) {
    const bool rings = in_rings(places);
    const std::array<EndNode, 2> at = {
        end_node(points, places, end[0], true, rings, tolerance_mm),
        end_node(points, places, end[1], false, rings, tolerance_mm)};
    std::vector<MeridianNode> nodes{at[0].node};
    if (rings) {
        for (const ProfilePlace& place : places) {
            // What lies at an end is the end itself.
            const double near = 0.25 * place.spacing_mm;
            if (place.arc_mm > at[0].arc_mm + near && place.arc_mm < at[1].arc_mm - near) {
                nodes.push_back(node_at(place.at_mm));
            }
        }
    } else {
        const std::vector<MeridianNode> inner = nodes_in_scatter(points, end, at);
        nodes.insert(nodes.end(), inner.begin(), inner.end());
    }
    nodes.push_back(at[1].node);
    return nodes;
}

}  // namespace meshwind
