#include "mesh/revolution/meridian.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/units.h"
#include "mesh/nearest_parameter.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Nodes = std::vector<MeridianNode>;
using Pieces = std::vector<MeridianPiece>;

// Nodes this share of the whole curve's size off a line are on it: what is left of twelve digits.
constexpr double kOnLineShare = 1e-12;

// Lengths closer than this share are the same: below what any fit or file tells apart.
constexpr double kSameShare = 1e-9;

constexpr std::size_t kLineNodes = 4;  // three may lie on a line by chance, at an inflexion

Vector2d point_of(const MeridianNode& node) {
    return {node.radius_mm, node.z_mm};
}

Vector2d tangent_of(double slope_rad) {
    return {std::sin(slope_rad), std::cos(slope_rad)};
}

void check(const Nodes& nodes) {
    const auto refuse = [](std::size_t i, const std::string& what) {
        throw InputError("meridian.node", "node " + std::to_string(i), what);
    };
    if (nodes.size() < 2) {
        refuse(nodes.size(), "is missing: a meridian needs two nodes or more");
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const MeridianNode& node = nodes[i];
        if (!std::isfinite(node.radius_mm) || !std::isfinite(node.z_mm) ||
            !std::isfinite(node.slope_rad.value_or(0.0)) ||
            !std::isfinite(node.slope_before_rad.value_or(0.0))) {
            refuse(i, "is not finite: give numbers");
        }
        if (node.radius_mm < 0.0) {
            refuse(i, "has a radius below 0: give the distance from the axis");
        }
        if (node.radius_mm == 0.0 && i > 0 && i + 1 < nodes.size()) {
            refuse(i, "lies on the axis between the ends: end the meridian there");
        }
        if (i > 0 && point_of(node) == point_of(nodes[i - 1])) {
            refuse(i, "is the same point as the one before: remove one");
        }
    }
}

double size_of(const Nodes& nodes) {
    double size = 0.0;
    for (const MeridianNode& node : nodes) {
        size = std::max({size, node.radius_mm, std::abs(node.z_mm)});
    }
    return size;
}

// Whether the nodes first..last lie in order on one line.
bool on_line(const Nodes& nodes, std::size_t first, std::size_t last, double within_mm) {
    const Vector2d from = point_of(nodes[first]);
    const Vector2d way = (point_of(nodes[last]) - from).normalized();
    double reached = 0.0;
    for (std::size_t i = first + 1; i <= last; ++i) {
        const Vector2d arm = point_of(nodes[i]) - from;
        if (std::abs(way.x() * arm.y() - way.y() * arm.x()) > within_mm || arm.dot(way) < reached) {
            return false;
        }
        reached = arm.dot(way);
    }
    return true;
}

void mark_lines(Nodes& nodes) {
    const double within = kOnLineShare * size_of(nodes);
    const auto mark = [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            nodes[i].straight = true;
        }
    };
    for (std::size_t first = 0; first + 1 < nodes.size();) {
        std::size_t last = first + 1;
        while (last + 1 < nodes.size() && !nodes[last].crease && !nodes[last].joint &&
               on_line(nodes, first, last + 1, within)) {
            ++last;
        }
        const auto breaks = [&](std::size_t i) {
            return i == 0 || i + 1 == nodes.size() || nodes[i].crease;
        };
        const bool whole_run = breaks(first) && breaks(last) && !nodes[first].slope_rad &&
                               !nodes[last].slope_rad && !nodes[last].slope_before_rad;
        if (last - first + 1 >= kLineNodes || whole_run) {
            mark(first, last);
        }
        first = last - first + 1 >= kLineNodes || whole_run ? last : first + 1;
    }
}

// Derivatives at the nodes of a run of n steps by the continuity of the second derivative.
struct Run {
    std::vector<Vector2d> point;
    std::vector<double> step;
    std::optional<Vector2d> start;  // unit tangents, where known
    std::optional<Vector2d> end;
};

// One row per node of a tridiagonal system in the derivatives.
struct Row {
    double left = 0.0;
    double middle = 1.0;
    double right = 0.0;
    Vector2d value = Vector2d::Zero();
};

// How a run ends whose slope is not known: the first two steps are one cubic, else, with too few
// nodes for that, the first step is a parabola. `h`, `d`: steps and difference quotients from the
// end inwards.
Row free_end(bool parabola, const std::array<double, 2>& h, const std::array<Vector2d, 2>& d) {
    if (parabola) {
        return {0.0, 1.0, 1.0, 2.0 * d[0]};
    }
    const double both = h[0] + h[1];
    return {0.0, h[1], both, ((h[0] + 2.0 * both) * h[1] * d[0] + h[0] * h[0] * d[1]) / both};
}

std::vector<Vector2d> derivatives(const Run& run) {
    const std::size_t n = run.step.size();
    std::vector<Vector2d> d(n);
    for (std::size_t i = 0; i < n; ++i) {
        d[i] = (run.point[i + 1] - run.point[i]) / run.step[i];
    }
    if (n == 1 && !run.start && !run.end) {
        return {d[0], d[0]};
    }
    const bool parabola = n == 1 || (n == 2 && !run.start && !run.end);
    const std::size_t next = n > 1 ? 1 : 0;
    std::vector<Row> rows(n + 1);
    rows[0] = run.start ? Row{0.0, 1.0, 0.0, *run.start}
                        : free_end(parabola, {run.step[0], run.step[next]}, {d[0], d[next]});
    for (std::size_t i = 1; i < n; ++i) {
        const double before = run.step[i - 1];
        const double behind = run.step[i];
        rows[i] = {behind, 2.0 * (before + behind), before,
                   3.0 * (behind * d[i - 1] + before * d[i])};
    }
    rows[n] = run.end ? Row{0.0, 1.0, 0.0, *run.end}
                      : free_end(parabola, {run.step[n - 1], run.step[n - 1 - next]},
                                 {d[n - 1], d[n - 1 - next]});
    std::swap(rows[n].left, rows[n].right);
    for (std::size_t i = 1; i <= n; ++i) {
        const double share = rows[i].left / rows[i - 1].middle;
        rows[i].middle -= share * rows[i - 1].right;
        rows[i].value -= share * rows[i - 1].value;
    }
    std::vector<Vector2d> tangent(n + 1);
    tangent[n] = rows[n].value / rows[n].middle;
    for (std::size_t i = n; i-- > 0;) {
        tangent[i] = (rows[i].value - rows[i].right * tangent[i + 1]) / rows[i].middle;
    }
    return tangent;
}

struct Local {
    Vector2d point;
    Vector2d first;  // derivatives by the parameter
    Vector2d second;
};

Local local(const MeridianPiece& piece, double u) {
    const double h = piece.step_mm;
    const double t = u / h;
    const Vector2d way = piece.to_mm - piece.from_mm;
    if (piece.straight) {
        return {piece.from_mm + t * way, way / h, Vector2d::Zero()};
    }
    // Newton's form about the start: rounding stays that of the points.
    const Vector2d mean = way / h;
    const Vector2d c2 = (3.0 * mean - 2.0 * piece.tangent0 - piece.tangent1) / h;
    const Vector2d c3 = (piece.tangent0 + piece.tangent1 - 2.0 * mean) / (h * h);
    return {piece.from_mm + u * (piece.tangent0 + u * (c2 + u * c3)),
            piece.tangent0 + u * (2.0 * c2 + 3.0 * u * c3), 2.0 * c2 + 6.0 * u * c3};
}

// Gauss's five points: the speed of a piece is smooth and nearly 1.
double length_to(const MeridianPiece& piece, double u) {
    constexpr std::array<double, 3> kNode = {0.0, 0.5384693101056831, 0.9061798459386640};
    constexpr std::array<double, 3> kWeight = {0.5688888888888889, 0.4786286704993665,
                                               0.2369268850561891};
    const double half = 0.5 * u;
    double sum = kWeight[0] * local(piece, half).first.norm();
    for (std::size_t i = 1; i < 3; ++i) {
        sum += kWeight[i] * (local(piece, half * (1.0 - kNode[i])).first.norm() +
                             local(piece, half * (1.0 + kNode[i])).first.norm());
    }
    return half * sum;
}

double parameter_at(const MeridianPiece& piece, double arc) {
    double u = piece.step_mm * arc / piece.length_mm;
    if (piece.straight) {
        return u;
    }
    constexpr int kMaxSteps = 8;  // two do: the parameter is nearly the arc length
    constexpr double kDone = 1e-14;
    for (int i = 0; i < kMaxSteps; ++i) {
        const double speed = local(piece, u).first.norm();
        const double miss = length_to(piece, u) - arc;
        if (!(speed > 0.0) || std::abs(miss) <= kDone * piece.length_mm) {
            break;
        }
        u = std::clamp(u - miss / speed, 0.0, piece.step_mm);
    }
    return u;
}

void set_run(Pieces& pieces, std::size_t first, const Run& run) {
    const std::vector<Vector2d> tangent = derivatives(run);
    for (std::size_t i = 0; i < run.step.size(); ++i) {
        MeridianPiece& piece = pieces[first + i];
        piece.step_mm = run.step[i];
        piece.tangent0 = tangent[i];
        piece.tangent1 = tangent[i + 1];
        piece.length_mm = length_to(piece, piece.step_mm);
    }
}

// The spline through the nodes first..last, with its own arc length as parameter.
void fit_run(Pieces& pieces, std::size_t first, std::size_t last,
             const std::optional<Vector2d>& start, const std::optional<Vector2d>& end) {
    Run run{{}, {}, start, end};
    for (std::size_t i = first; i < last; ++i) {
        run.point.push_back(pieces[i].from_mm);
        run.step.push_back((pieces[i].to_mm - pieces[i].from_mm).norm());
    }
    run.point.push_back(pieces[last - 1].to_mm);
    // Each pass takes the misfit of parameter and arc length down by two orders of h / R; after
    // four the rest is that of the cubic itself.
    constexpr int kPasses = 4;
    for (int pass = 0; pass < kPasses; ++pass) {
        set_run(pieces, first, run);
        for (std::size_t i = first; i < last; ++i) {
            run.step[i - first] = pieces[i].length_mm;
        }
    }
    set_run(pieces, first, run);
}

Vector2d direction(const MeridianPiece& piece) {
    return (piece.to_mm - piece.from_mm).normalized();
}

// What ends runs at the nodes, with the tangents there.
class Ends {
public:
    Ends(const Nodes& nodes, const Pieces& pieces) : nodes_(nodes), pieces_(pieces) {}

    [[nodiscard]] bool between(std::size_t node) const {
        return node == 0 || node == pieces_.size() || nodes_[node].crease || nodes_[node].joint ||
               pieces_[node - 1].straight != pieces_[node].straight;
    }

    [[nodiscard]] std::optional<Vector2d> behind(std::size_t node) const {
        const MeridianNode& at = nodes_[node];
        if (node > 0 && !at.crease && pieces_[node - 1].straight) {
            return direction(pieces_[node - 1]);
        }
        if (node == 0 && at.radius_mm == 0.0 && !at.slope_rad) {
            return Vector2d(1.0, 0.0);
        }
        return at.slope_rad ? std::optional(tangent_of(*at.slope_rad)) : std::nullopt;
    }

    [[nodiscard]] std::optional<Vector2d> before(std::size_t node) const {
        const MeridianNode& at = nodes_[node];
        if (at.crease) {
            return at.slope_before_rad ? std::optional(tangent_of(*at.slope_before_rad))
                                       : std::nullopt;
        }
        if (node < pieces_.size() && pieces_[node].straight) {
            return direction(pieces_[node]);
        }
        if (node == pieces_.size() && at.radius_mm == 0.0 && !at.slope_rad) {
            return Vector2d(-1.0, 0.0);
        }
        return at.slope_rad ? std::optional(tangent_of(*at.slope_rad)) : std::nullopt;
    }

private:
    const Nodes& nodes_;
    const Pieces& pieces_;
};

void fit_runs(Pieces& pieces, const Ends& ends,
              const std::vector<std::optional<Vector2d>>& at_joint) {
    for (std::size_t first = 0; first < pieces.size();) {
        std::size_t last = first + 1;
        while (!ends.between(last)) {
            ++last;
        }
        if (!pieces[first].straight) {
            const auto start = ends.behind(first);
            const auto end = ends.before(last);
            fit_run(pieces, first, last, start ? start : at_joint[first],
                    end ? end : at_joint[last]);
        }
        first = last;
    }
}

Pieces fitted(const Nodes& nodes) {
    Pieces pieces(nodes.size() - 1);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        MeridianPiece& piece = pieces[i];
        piece.from_mm = point_of(nodes[i]);
        piece.to_mm = point_of(nodes[i + 1]);
        piece.step_mm = piece.length_mm = (piece.to_mm - piece.from_mm).norm();
        piece.tangent0 = piece.tangent1 = direction(piece);
        piece.straight = nodes[i].straight;
    }
    const Ends ends(nodes, pieces);
    std::vector<std::optional<Vector2d>> at_joint(nodes.size());
    fit_runs(pieces, ends, at_joint);
    // Two curved runs that meet in a joint of unknown slope agree on the mean of their own.
    bool unknown = false;
    for (std::size_t i = 1; i < pieces.size(); ++i) {
        if (nodes[i].joint && !nodes[i].crease && !ends.behind(i) && !ends.before(i)) {
            at_joint[i] = (pieces[i - 1].tangent1.normalized() + pieces[i].tangent0.normalized())
                              .normalized();
            unknown = true;
        }
    }
    if (unknown) {
        fit_runs(pieces, ends, at_joint);
    }
    for (MeridianPiece& piece : pieces) {
        piece.middle_mm = local(piece, 0.5 * piece.step_mm).point;
        const double half = length_to(piece, 0.5 * piece.step_mm);
        piece.reach_mm = (1.0 + kSameShare) * std::max(half, piece.length_mm - half);
    }
    return pieces;
}

// The zeros of a quadratic inside a range, for the extremes of a cubic.
std::vector<double> extremes(const MeridianPiece& piece) {
    const Local start = local(piece, 0.0);
    const double half = 0.5 * start.second.x();
    const double third =
        0.5 * (local(piece, piece.step_mm).second.x() - start.second.x()) / piece.step_mm;
    // start.first + 2 half u + third u^2 = 0
    const double under = half * half - third * start.first.x();
    if (under < 0.0) {
        return {};
    }
    const double q = -(half + std::copysign(std::sqrt(under), half));
    std::vector<double> zeros;
    for (const double u :
         {third != 0.0 ? q / third : -1.0, q != 0.0 ? start.first.x() / q : -1.0}) {
        if (u > 0.0 && u < piece.step_mm) {
            zeros.push_back(u);
        }
    }
    return zeros;
}

MeridianFoot foot_on(const MeridianPiece& piece, const Vector2d& p) {
    if (piece.straight) {
        const Vector2d way = direction(piece);
        const double arc = std::clamp((p - piece.from_mm).dot(way), 0.0, piece.length_mm);
        return {arc, (piece.from_mm + arc * way - p).norm()};
    }
    const double u = nearest_parameter(
        {0.0, piece.step_mm}, [&](double t) { return (local(piece, t).point - p).squaredNorm(); },
        [&](double t) {
            const Local at = local(piece, t);
            return (at.point - p).dot(at.first);
        });
    return {length_to(piece, u), (local(piece, u).point - p).norm()};
}

}  // namespace

Meridian::Meridian(std::vector<MeridianNode> nodes) {
    check(nodes);
    mark_lines(nodes);
    constexpr double kTurnRad = 1e-9;  // less is rounding: the straight pieces are one line
    for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
        if (nodes[i - 1].straight && nodes[i].straight) {
            const Vector2d before = (point_of(nodes[i]) - point_of(nodes[i - 1])).normalized();
            const Vector2d behind = (point_of(nodes[i + 1]) - point_of(nodes[i])).normalized();
            nodes[i].crease = nodes[i].crease || (before - behind).norm() > kTurnRad;
        }
    }
    pieces_ = fitted(nodes);
    arc_mm_.assign(1, 0.0);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        arc_mm_.push_back(arc_mm_.back() + pieces_[i].length_mm);
        if (i + 1 < pieces_.size() && nodes[i + 1].crease) {
            creases_mm_.push_back(arc_mm_.back());
        }
    }
}

MeridianPlace Meridian::at(double arc_mm) const {
    const auto above = std::upper_bound(arc_mm_.begin() + 1, arc_mm_.end() - 1, arc_mm);
    const auto index = static_cast<std::size_t>(above - arc_mm_.begin()) - 1;
    const MeridianPiece& piece = pieces_[index];
    const double arc = std::clamp(arc_mm - arc_mm_[index], 0.0, piece.length_mm);
    const Local place = local(piece, parameter_at(piece, arc));
    const double speed = place.first.norm();
    return {std::max(place.point.x(), 0.0), place.point.y(),
            std::atan2(place.first.x(), place.first.y()),
            (place.second.y() * place.first.x() - place.second.x() * place.first.y()) /
                (speed * speed * speed)};
}

double Meridian::widest_mm() const {
    double widest = -1.0;
    double place = 0.0;
    const auto offer = [&](double radius, double arc) {
        if (radius > widest + kSameShare * std::max(widest, 0.0)) {
            widest = radius;
            place = arc;
        }
    };
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        offer(pieces_[i].from_mm.x(), arc_mm_[i]);
        for (const double u : pieces_[i].straight ? std::vector<double>{} : extremes(pieces_[i])) {
            offer(local(pieces_[i], u).point.x(), arc_mm_[i] + length_to(pieces_[i], u));
        }
        offer(pieces_[i].to_mm.x(), arc_mm_[i + 1]);
    }
    const auto as_wide = [&](const MeridianPiece& piece) {
        const double least = widest * (1.0 - 2.0 * kSameShare);
        return piece.straight && piece.from_mm.x() >= least && piece.to_mm.x() >= least;
    };
    const auto first = std::find_if(pieces_.begin(), pieces_.end(), as_wide);
    if (first == pieces_.end()) {
        return place;
    }
    const auto last = std::find_if_not(first, pieces_.end(), as_wide);
    return 0.5 * (arc_mm_[static_cast<std::size_t>(first - pieces_.begin())] +
                  arc_mm_[static_cast<std::size_t>(last - pieces_.begin())]);
}

MeridianFoot Meridian::foot(double radius_mm, double z_mm) const {
    const Vector2d p(radius_mm, z_mm);
    const auto least_mm = [&](const MeridianPiece& piece) {
        return (p - piece.middle_mm).norm() - piece.reach_mm;
    };
    const auto guess = std::min_element(
        pieces_.begin(), pieces_.end(),
        [&](const MeridianPiece& a, const MeridianPiece& b) { return least_mm(a) < least_mm(b); });
    const MeridianFoot guessed = foot_on(*guess, p);
    MeridianFoot best{0.0, std::numeric_limits<double>::max()};
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        const MeridianPiece& piece = pieces_[i];
        if (&piece != &*guess &&
            least_mm(piece) > std::min(best.distance_mm, guessed.distance_mm)) {
            continue;
        }
        const MeridianFoot foot = &piece == &*guess ? guessed : foot_on(piece, p);
        if (foot.distance_mm < best.distance_mm) {
            best = {arc_mm_[i] + foot.arc_mm, foot.distance_mm};
        }
    }
    return best;
}

}  // namespace meshwind
