#include "winding/elbow/elbow_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/margins.h"
#include "core/parallel.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "geodesic/trace.h"
#include "winding/elbow/elbow_lines.h"
#include "winding/laminate/measure_plan.h"
#include "winding/plan/assemble.h"
#include "winding/revolution/mesh_projection.h"
#include "winding/turn/laid_turn.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Where no angle is asked for, degrees above the least one that does not lift off, and the last.
constexpr double kFirstAbove_deg = 1.0;
constexpr double kLastAngle_deg = 82.0;

// Rims that lean by more than this are no ends of a leg: turns are laid on a coaxial cylinder.
constexpr double kMaxLean_rad = rad_from_deg(1.0);

// An elbow on its mandrel, and how fibres turn over its rims.
struct Elbow {
    const Mandrel& mandrel;
    const Tube& tube;
    ElbowTube shape;
    TurnRule rule;

    [[nodiscard]] const Rim& rim(std::size_t end) const {
        return mandrel.rims[static_cast<std::size_t>(tube.rim[end])];
    }
};

// The lines of one hand, and their angle at the outer equator.
struct ChosenLines {
    double angle_rad = 0.0;
    ElbowLines lines;
};

// The tube as an elbow. None: `why_not` says what it has that an elbow has not.
std::optional<ElbowTube> elbow_of(const Tube& tube, std::string& why_not) {
    ElbowTube shape;
    std::size_t bends = 0;
    for (const TubePart& part : tube.parts) {
        if (part.kind == TubePartKind::Bend) {
            ++bends;
            shape.ring_radius_mm = part.bend_radius_mm;
            shape.span_rad = part.angle_rad;
            shape.leg_mm = {part.from_mm, tube.line.length_mm() - part.to_mm};
        } else if (part.kind == TubePartKind::Curve) {
            why_not = "the tube's line is neither straight nor an arc of a circle";
            return std::nullopt;
        }
    }
    if (bends != 1 || tube.radius.size() != 1) {
        why_not = "an elbow has one bend and one radius, and this tube has " +
                  std::to_string(bends) + (bends == 1 ? " bend" : " bends") +
                  (tube.radius.size() > 1 ? " and a radius that varies" : "");
        return std::nullopt;
    }
    shape.tube_radius_mm = tube.radius.front().radius_mm;
    const double lean = std::max(tube.lean_rad[0], tube.lean_rad[1]);
    if (lean > kMaxLean_rad) {
        why_not = "a rim leans by " + degrees(lean) + " against the tube's end";
        return std::nullopt;
    }
    return shape;
}

TurnRule rule_of_turns(const ElbowPlanOptions& options) {
    TurnRule rule = options.turn;
    rule.friction = options.tow.friction;
    rule.band_mm = options.tow.width_mm;
    return rule;
}

ElbowLines lines_at(const ElbowTube& shape, const ElbowPlanOptions& options, double angle_rad) {
    ElbowOptions wanted;
    wanted.alpha0_rad = angle_rad;
    wanted.width_mm = options.tow.width_mm;
    wanted.slip = options.tow.friction.share(margin::kPatternSteering);
    wanted.layers = std::max(1.0, options.layers);
    wanted.station_mm = station_on_mm(shape.tube_radius_mm, options.tow.width_mm);
    return elbow_lines(shape, wanted);
}

bool closes_legs(const ElbowTube& shape, const ElbowLines& lines) {
    return lines.leg[0].closed_mm >= shape.leg_mm[0] && lines.leg[1].closed_mm >= shape.leg_mm[1];
}

double fibre_mm(const ElbowLines& lines) {
    double length = 0.0;
    for (const auto& line : lines.line) {
        length += line.back().s_mm;
    }
    return length;
}

struct TubeFrame {
    CentrePlace place;
    Vector3d outward;
    Vector3d around;  // towards growing phi
};

TubeFrame frame_at(const Tube& tube, const ElbowStation& station, bool mirrored) {
    const double phi = mirrored ? -station.phi_rad : station.phi_rad;
    TubeFrame frame{tube.line.at(station.along_mm), {}, {}};
    const Vector3d across = frame.place.across();
    frame.outward = std::cos(phi) * frame.place.reference + std::sin(phi) * across;
    frame.around = std::cos(phi) * across - std::sin(phi) * frame.place.reference;
    return frame;
}

// A line from the lower rim up, or its mirror image from the upper rim down.
SurfacePath path_of(const Elbow& elbow, const std::vector<ElbowStation>& line, bool down) {
    SurfacePath path;
    for (const ElbowStation& station : line) {
        const TubeFrame frame = frame_at(elbow.tube, station, down);
        PathPoint point;
        point.position_mm = frame.place.position_mm + elbow.shape.tube_radius_mm * frame.outward;
        point.normal = frame.outward;
        point.tangent = std::cos(station.angle_rad) * frame.place.tangent +
                        (down ? -1.0 : 1.0) * std::sin(station.angle_rad) * frame.around;
        point.s_mm = station.s_mm;
        point.kn_per_mm = station.kn_per_mm;
        path.push_back(point);
    }
    return down ? reversed(path) : path;
}

// The same over the mesh. Where layers lie on the tube, the angle to its line changes as much
// as both parts of the way do that are gone further out.
SurfacePath path_on(const Elbow& elbow, const MeshProjection& projection, bool on_layers,
                    const std::vector<ElbowStation>& line, bool down) {
    SurfacePath path = path_of(elbow, line, down);
    if (!on_layers) {
        projection.put(path);
        return path;
    }
    const SurfacePath on_tube = path;
    projection.settle(path, [&](std::size_t i, const Vector3d& position) {
        const CentrePlace foot = elbow.tube.line.foot(position);
        const Vector3d out = position - foot.position_mm;
        const double radius = out.norm();
        const Vector3d& tangent = on_tube[i].tangent;
        const double along = tangent.dot(foot.tangent);
        const Vector3d around = tangent - along * foot.tangent;
        const double bend = foot.curvature_per_mm.dot(out) / radius;
        const double further = (1.0 - bend * radius) / (1.0 - bend * elbow.shape.tube_radius_mm);
        return Vector3d(further * along * foot.tangent +
                        radius / elbow.shape.tube_radius_mm * around);
    });
    return path;
}

// How a line, or its mirror image, leaves the wall over a rim.
RimCrossing crossing(const Elbow& elbow, const std::vector<ElbowStation>& line, std::size_t end,
                     bool mirrored) {
    const SurfacePath path = path_of(elbow, {end == 0 ? line.front() : line.back()}, false);
    if (!mirrored) {
        return crossing_at(elbow.rim(end), path.front().position_mm,
                           (end == 0 ? -1.0 : 1.0) * path.front().tangent);
    }
    const SurfacePath mirror = path_of(elbow, {end == 0 ? line.front() : line.back()}, true);
    // Downward: in at the upper rim, out over the lower one.
    return crossing_at(elbow.rim(end), mirror.front().position_mm,
                       (end == 0 ? 1.0 : -1.0) * mirror.front().tangent);
}

// Empty, or why lines cannot be turned.
std::string why_not_turned(const Elbow& elbow, const ElbowLines& lines) {
    for (const auto& line : lines.line) {
        for (std::size_t end = 0; end < 2; ++end) {
            const RimCrossing over = crossing(elbow, line, end, false);
            if (!can_turn(elbow.rim(end), over, elbow.rule)) {
                return why_no_turn("rim " + std::to_string(elbow.tube.rim[end]), elbow.rim(end),
                                   over, elbow.rule);
            }
        }
    }
    return {};
}

// Of whole degrees the lines with the least fibre among those that close the legs and turn.
std::optional<ChosenLines> shortest_lines(const Elbow& elbow, const ElbowPlanOptions& options,
                                          double least_rad) {
    std::optional<ChosenLines> chosen;
    double best = std::numeric_limits<double>::infinity();
    for (double next = std::ceil(deg_from_rad(least_rad) + kFirstAbove_deg); next <= kLastAngle_deg;
         next += 1.0) {
        ElbowLines lines = lines_at(elbow.shape, options, rad_from_deg(next));
        const double length = fibre_mm(lines);
        if (length < best && closes_legs(elbow.shape, lines) &&
            why_not_turned(elbow, lines).empty()) {
            best = length;
            chosen = ChosenLines{rad_from_deg(next), std::move(lines)};
        }
    }
    return chosen;
}

// At the angle asked for, or else at the best. None: `why_not` says what cannot be.
std::optional<ChosenLines> choose_lines(const Elbow& elbow, const ElbowPlanOptions& options,
                                        std::string& why_not) {
    const double least = least_elbow_angle_rad(elbow.shape);
    std::optional<ChosenLines> chosen;
    if (!options.angle_rad) {
        chosen = shortest_lines(elbow, options, least);
        if (!chosen) {
            why_not = "at no angle from " + degrees(least) + " to " + fixed(kLastAngle_deg, 0) +
                      " deg do a friction of " + fixed(elbow.rule.friction.holds(), 3) + " and " +
                      fixed(elbow.rule.extension_mm, 1) +
                      " mm of extension close the legs and turn the fibre";
        }
        return chosen;
    }
    if (*options.angle_rad < least || *options.angle_rad >= 0.5 * kPi) {
        why_not = "a fibre at " + degrees(*options.angle_rad) +
                  " at the outer equator lifts off at the inner one; " + degrees(least) +
                  " or more lies on";
        return chosen;
    }
    chosen = ChosenLines{*options.angle_rad, lines_at(elbow.shape, options, *options.angle_rad)};
    why_not = why_not_turned(elbow, chosen->lines);
    return why_not.empty() ? chosen : std::nullopt;
}

// Dwell over a rim between each line and each mirror image, in the order of travel.
std::vector<std::vector<double>> dwells(const Elbow& elbow, const ElbowLines& lines,
                                        std::size_t end) {
    const std::size_t count = lines.line.size();
    std::vector<RimCrossing> straight;
    std::vector<RimCrossing> mirror;
    for (const auto& line : lines.line) {
        straight.push_back(crossing(elbow, line, end, false));
        mirror.push_back(crossing(elbow, line, end, true));
    }
    std::vector<std::vector<double>> dwell(count, std::vector<double>(count));
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < count; ++j) {
            dwell[i][j] = end == 1 ? dwell_rad(elbow.rim(end), straight[i], mirror[j], elbow.rule)
                                   : dwell_rad(elbow.rim(end), mirror[j], straight[i], elbow.rule);
        }
    }
    return dwell;
}

// Sum of the dwells where line i and mirror image (shift - i) mod M meet.
std::vector<double> by_shift(const std::vector<std::vector<double>>& dwell) {
    const std::size_t count = dwell.size();
    std::vector<double> sum(count, 0.0);
    for (std::size_t shift = 0; shift < count; ++shift) {
        for (std::size_t i = 0; i < count; ++i) {
            sum[shift] += dwell[i][(shift + count - i) % count];
        }
    }
    return sum;
}

// p and q of the header.
std::array<std::size_t, 2> shifts(const Elbow& elbow, const ElbowLines& lines) {
    const std::size_t count = lines.line.size();
    const std::vector<double> upper = by_shift(dwells(elbow, lines, 1));
    const std::vector<double> lower = by_shift(dwells(elbow, lines, 0));
    std::array<std::size_t, 2> best{0, 1 % count};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t p = 0; p < count; ++p) {
        for (std::size_t q = 0; q < count; ++q) {
            if (std::gcd((q + count - p) % count, count) == 1 && upper[p] + lower[q] < least) {
                least = upper[p] + lower[q];
                best = {p, q};
            }
        }
    }
    return best;
}

// All lines and mirror images on the mesh, in the order in which the fibre takes them.
std::vector<Piece> courses_along(const Elbow& elbow, const ElbowLines& lines,
                                 const ElbowPlanOptions& options) {
    const std::size_t count = lines.line.size();
    const std::array<std::size_t, 2> shift = shifts(elbow, lines);
    const std::size_t p = shift[0];
    const std::size_t onward = (shift[1] + count - p) % count;
    const Surface& surface = elbow.mandrel.surface;
    const MeshProjection projection(surface);
    std::vector<Piece> courses(2 * count);
    parallel_for(courses.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            // The k-th pair: line i = k (q - p), then the mirror image of p - i.
            const std::size_t i = k / 2 * onward % count;
            const bool down = k % 2 == 1;
            SurfacePath path = path_on(elbow, projection, options.on_layers,
                                       lines.line[down ? (p + count - i) % count : i], down);
            courses[k] = course_along(surface, std::move(path), options.tow.friction);
            courses[k].start_rim = elbow.tube.rim[down ? 1 : 0];
            courses[k].end_rim = elbow.tube.rim[down ? 0 : 1];
        }
    });
    return courses;
}

// The courses as one fibre, with a turn between each and the next.
void add_fibre(const Elbow& elbow, std::vector<Piece> courses, Plan& plan) {
    plan.turns.assign(elbow.mandrel.rims.size(), {});
    for (std::size_t k = 0; k < courses.size(); ++k) {
        std::optional<LaidTurn> turn;
        if (k + 1 < courses.size()) {
            turn = turn_over(elbow.rim(k % 2 == 0 ? 1 : 0), courses[k].path.back(),
                             courses[k + 1].path.front(), elbow.rule);
        }
        add_piece(std::move(courses[k]), plan);
        if (turn) {
            add_turn(std::move(*turn), plan);
        }
    }
    plan.pieces.front().starts_fibre = true;
    plan.courses = static_cast<int>(courses.size());
    plan.fibres = 1;
}

double meant_layers(const ElbowLines& lines, double width_mm, double phi_rad) {
    return 2.0 * width_mm / lines.spacing_mm(phi_rad);
}

LaidElbow laid_elbow(const Elbow& elbow, const ChosenLines& chosen, double width_mm) {
    const ElbowTube& shape = elbow.shape;
    const ElbowLines& lines = chosen.lines;
    LaidElbow laid;
    laid.line = elbow.tube.line;
    laid.lines = lines.count();
    laid.needed_by_bend = lines.needed;
    laid.angle_rad = chosen.angle_rad;
    laid.inner_angle_rad =
        std::acos(lines.bend.clairaut_mm() / (shape.ring_radius_mm - shape.tube_radius_mm));
    laid.theta_cycle_rad = lines.theta_cycle_rad;
    laid.thinnest_layers = meant_layers(lines, width_mm, 0.0);
    laid.thickest_layers = meant_layers(lines, width_mm, kPi);
    for (std::size_t end = 0; end < 2; ++end) {
        const ElbowLeg& leg = lines.leg[end];
        laid.leg[end] = {shape.leg_mm[end], leg.run_mm,    leg.angle_rad, leg.even,
                         leg.slip,          leg.widest_mm, leg.closed_mm};
    }
    return laid;
}

// Wound is the bend with the legs as far as they are closed; regular the bend but for a tow
// width at its ends, over which layers are averaged.
PlanZones zones_of(const Elbow& elbow, const ElbowLines& lines, double width_mm) {
    const Tube& tube = elbow.tube;
    const ElbowTube& shape = elbow.shape;
    const double from = shape.leg_mm[0] - lines.leg[0].closed_mm;
    const double to = shape.leg_mm[0] + shape.bend_mm() + lines.leg[1].closed_mm;
    const bool all = closes_legs(shape, lines);
    PlanZones zones;
    zones.asked_for = [&tube, from, to, all](const Vector3d& position) {
        const double at = tube.line.foot(position).arc_mm;
        return all || (at >= from && at <= to);
    };
    zones.regular = [&tube, &shape, width_mm](const Vector3d& position) {
        const double at = tube.line.foot(position).arc_mm - shape.leg_mm[0];
        return at >= width_mm && at <= shape.bend_mm() - width_mm;
    };
    zones.meant = [&tube, &lines, width_mm](const Vector3d& position) {
        const CentrePlace foot = tube.line.foot(position);
        const Vector3d out = position - foot.position_mm;
        return meant_layers(lines, width_mm,
                            std::atan2(out.dot(foot.across()), out.dot(foot.reference)));
    };
    return zones;
}

}  // namespace

Plan plan_elbow(const Mandrel& mandrel, const Tube& tube, const ElbowPlanOptions& options) {
    Plan plan;
    plan.planner = Planner::Elbow;
    const std::optional<ElbowTube> shape = elbow_of(tube, plan.failure);
    if (!shape) {
        return plan;
    }
    const Elbow elbow{mandrel, tube, *shape, rule_of_turns(options)};
    const std::optional<ChosenLines> chosen = choose_lines(elbow, options, plan.failure);
    if (!chosen) {
        return plan;
    }
    const double width_mm = options.tow.width_mm;
    add_fibre(elbow, courses_along(elbow, chosen->lines, options), plan);
    plan.details = laid_elbow(elbow, *chosen, width_mm);
    measure_plan(mandrel.surface, mandrel.surface, width_mm, options.context.seed,
                 zones_of(elbow, chosen->lines, width_mm), plan);
    return plan;
}

}  // namespace meshwind
