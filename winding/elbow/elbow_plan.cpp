#include "winding/elbow/elbow_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
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
constexpr double kMostLean_rad = rad_from_deg(1.0);

class ElbowPlanner {
public:
    ElbowPlanner(const Mandrel& mandrel, const Tube& tube, const ElbowPlanOptions& options)
        : mandrel_(mandrel), tube_(tube), options_(options) {
        rule_ = options.turn;
        rule_.friction = options.tow.friction;
        rule_.band_mm = options.tow.width_mm;
        plan_.planner = Planner::Elbow;
    }

    Plan run() {
        if (is_elbow() && choose_angle() && ends_hold()) {
            lay();
            measure();
        }
        return std::move(plan_);
    }

private:
    bool fail(const std::string& words) {
        plan_.failure = words;
        return false;
    }

    bool is_elbow() {
        std::size_t bends = 0;
        for (const TubePart& part : tube_.parts) {
            if (part.kind == TubePartKind::Bend) {
                ++bends;
                shape_.ring_radius_mm = part.bend_radius_mm;
                shape_.span_rad = part.angle_rad;
                shape_.leg_mm = {part.from_mm, tube_.line.length_mm() - part.to_mm};
            } else if (part.kind == TubePartKind::Curve) {
                return fail("the tube's line is neither straight nor an arc of a circle");
            }
        }
        if (bends != 1 || tube_.radius.size() != 1) {
            return fail("an elbow has one bend and one radius, and this tube has " +
                        std::to_string(bends) + (bends == 1 ? " bend" : " bends") +
                        (tube_.radius.size() > 1 ? " and a radius that varies" : ""));
        }
        shape_.tube_radius_mm = tube_.radius.front().radius_mm;
        const double lean = std::max(tube_.lean_rad[0], tube_.lean_rad[1]);
        if (lean > kMostLean_rad) {
            return fail("a rim leans by " + degrees(lean) + " against the tube's end");
        }
        return true;
    }

    [[nodiscard]] ElbowLines lines_at(double angle_rad) const {
        ElbowOptions wanted;
        wanted.alpha0_rad = angle_rad;
        wanted.width_mm = options_.tow.width_mm;
        wanted.slip = options_.tow.friction.share(margin::kPatternSteering);
        wanted.layers = std::max(1.0, options_.layers);
        wanted.station_mm = station_on_mm(shape_.tube_radius_mm, options_.tow.width_mm);
        return elbow_lines(shape_, wanted);
    }

    bool choose_angle() {
        const double least = least_elbow_angle_rad(shape_);
        if (options_.angle_rad) {
            if (*options_.angle_rad < least || *options_.angle_rad >= 0.5 * kPi) {
                return fail("a fibre at " + degrees(*options_.angle_rad) +
                            " at the outer equator lifts off at the inner one; " + degrees(least) +
                            " or more lies on");
            }
            lines_ = lines_at(*options_.angle_rad);
            angle_rad_ = *options_.angle_rad;
            return true;
        }
        double best = std::numeric_limits<double>::infinity();
        for (double next = std::ceil(deg_from_rad(least) + kFirstAbove_deg); next <= kLastAngle_deg;
             next += 1.0) {
            ElbowLines lines = lines_at(rad_from_deg(next));
            double length = 0.0;
            for (const auto& line : lines.line) {
                length += line.back().s_mm;
            }
            if (length < best && closed(lines) && turns_hold(lines).empty()) {
                best = length;
                angle_rad_ = rad_from_deg(next);
                lines_ = std::move(lines);
            }
        }
        return best < std::numeric_limits<double>::infinity() ||
               fail("at no angle from " + degrees(least) + " to " + fixed(kLastAngle_deg, 0) +
                    " deg do a friction of " + fixed(rule_.friction.holds(), 3) + " and " +
                    fixed(rule_.extension_mm, 1) +
                    " mm of extension close the legs and turn the fibre");
    }

    [[nodiscard]] bool closed(const ElbowLines& lines) const {
        return lines.leg[0].closed_mm >= shape_.leg_mm[0] &&
               lines.leg[1].closed_mm >= shape_.leg_mm[1];
    }

    struct Frame {
        CentrePlace place;
        Vector3d outward;
        Vector3d around;  // towards growing phi
    };
    [[nodiscard]] Frame frame_at(const ElbowStation& station, bool mirrored) const {
        const double phi = mirrored ? -station.phi_rad : station.phi_rad;
        Frame frame{tube_.line.at(station.along_mm), {}, {}};
        const Vector3d across = frame.place.across();
        frame.outward = std::cos(phi) * frame.place.reference + std::sin(phi) * across;
        frame.around = std::cos(phi) * across - std::sin(phi) * frame.place.reference;
        return frame;
    }
    [[nodiscard]] Vector3d place_of(const ElbowStation& station, bool mirrored) const {
        const Frame frame = frame_at(station, mirrored);
        return frame.place.position_mm + shape_.tube_radius_mm * frame.outward;
    }

    // A line from the lower rim up, or its mirror image from the upper rim down.
    [[nodiscard]] SurfacePath path_of(const std::vector<ElbowStation>& line, bool down) const {
        SurfacePath path;
        for (const ElbowStation& station : line) {
            const Frame frame = frame_at(station, down);
            PathPoint point;
            point.position_mm = frame.place.position_mm + shape_.tube_radius_mm * frame.outward;
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
    [[nodiscard]] SurfacePath path_on(const MeshProjection& projection,
                                      const std::vector<ElbowStation>& line, bool down) const {
        SurfacePath path = path_of(line, down);
        if (!options_.on_layers) {
            projection.put(path);
            return path;
        }
        const SurfacePath on_tube = path;
        projection.settle(path, [&](std::size_t i, const Vector3d& position) {
            const CentrePlace foot = tube_.line.foot(position);
            const Vector3d out = position - foot.position_mm;
            const double radius = out.norm();
            const Vector3d& tangent = on_tube[i].tangent;
            const double along = tangent.dot(foot.tangent);
            const Vector3d around = tangent - along * foot.tangent;
            const double bend = foot.curvature_per_mm.dot(out) / radius;
            const double further = (1.0 - bend * radius) / (1.0 - bend * shape_.tube_radius_mm);
            return Vector3d(further * along * foot.tangent +
                            radius / shape_.tube_radius_mm * around);
        });
        return path;
    }

    [[nodiscard]] const Rim& rim_at(std::size_t end) const {
        return mandrel_.rims[static_cast<std::size_t>(tube_.rim[end])];
    }

    // How a line, or its mirror image, leaves the wall over a rim.
    [[nodiscard]] RimCrossing crossing(const std::vector<ElbowStation>& line, std::size_t end,
                                       bool mirrored) const {
        const SurfacePath path = path_of({end == 0 ? line.front() : line.back()}, false);
        if (!mirrored) {
            return crossing_at(rim_at(end), path.front().position_mm,
                               (end == 0 ? -1.0 : 1.0) * path.front().tangent);
        }
        const SurfacePath mirror = path_of({end == 0 ? line.front() : line.back()}, true);
        // Downward: in at the upper rim, out over the lower one.
        return crossing_at(rim_at(end), mirror.front().position_mm,
                           (end == 0 ? 1.0 : -1.0) * mirror.front().tangent);
    }

    // Empty, or why lines cannot be turned.
    [[nodiscard]] std::string turns_hold(const ElbowLines& lines) const {
        for (const auto& line : lines.line) {
            for (std::size_t end = 0; end < 2; ++end) {
                const RimCrossing over = crossing(line, end, false);
                if (!can_turn(rim_at(end), over, rule_)) {
                    return why_no_turn("rim " + std::to_string(tube_.rim[end]), rim_at(end), over,
                                       rule_);
                }
            }
        }
        return {};
    }

    bool ends_hold() {
        const std::string why_not = turns_hold(lines_);
        return why_not.empty() || fail(why_not);
    }

    // Dwell over a rim between each line and each mirror image, in the order of travel.
    [[nodiscard]] std::vector<std::vector<double>> dwells(std::size_t end) const {
        const std::size_t count = lines_.line.size();
        std::vector<RimCrossing> straight;
        std::vector<RimCrossing> mirror;
        for (const auto& line : lines_.line) {
            straight.push_back(crossing(line, end, false));
            mirror.push_back(crossing(line, end, true));
        }
        std::vector<std::vector<double>> dwell(count, std::vector<double>(count));
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t j = 0; j < count; ++j) {
                dwell[i][j] = end == 1 ? dwell_rad(rim_at(end), straight[i], mirror[j], rule_)
                                       : dwell_rad(rim_at(end), mirror[j], straight[i], rule_);
            }
        }
        return dwell;
    }

    // Sum of the dwells where line i and mirror image (shift - i) mod M meet.
    static std::vector<double> by_shift(const std::vector<std::vector<double>>& dwell) {
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
    [[nodiscard]] std::array<std::size_t, 2> shifts() const {
        const std::size_t count = lines_.line.size();
        const std::vector<double> upper = by_shift(dwells(1));
        const std::vector<double> lower = by_shift(dwells(0));
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

    void lay() {
        const std::size_t count = lines_.line.size();
        const std::array<std::size_t, 2> shift = shifts();
        const std::size_t p = shift[0];
        const std::size_t onward = (shift[1] + count - p) % count;
        const MeshProjection projection(mandrel_.surface);
        std::vector<Piece> courses(2 * count);
        parallel_for(courses.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                // The k-th pair: line i = k (q - p), then the mirror image of p - i.
                const std::size_t i = k / 2 * onward % count;
                const bool down = k % 2 == 1;
                SurfacePath path =
                    path_on(projection, lines_.line[down ? (p + count - i) % count : i], down);
                courses[k] = course_along(mandrel_.surface, std::move(path), options_.tow.friction);
                courses[k].start_rim = tube_.rim[down ? 1 : 0];
                courses[k].end_rim = tube_.rim[down ? 0 : 1];
            }
        });
        plan_.turns.assign(mandrel_.rims.size(), {});
        for (std::size_t k = 0; k < courses.size(); ++k) {
            std::optional<LaidTurn> turn;
            if (k + 1 < courses.size()) {
                turn = turn_over(rim_at(k % 2 == 0 ? 1 : 0), courses[k].path.back(),
                                 courses[k + 1].path.front(), rule_);
            }
            add_piece(std::move(courses[k]), plan_);
            if (turn) {
                add_turn(std::move(*turn), plan_);
            }
        }
        plan_.pieces.front().starts_fibre = true;
        plan_.courses = static_cast<int>(courses.size());
        plan_.fibres = 1;
        plan_.details = laid();
    }

    [[nodiscard]] double meant_layers(double phi_rad) const {
        return 2.0 * options_.tow.width_mm / lines_.spacing_mm(phi_rad);
    }

    [[nodiscard]] LaidElbow laid() const {
        LaidElbow laid;
        laid.line = tube_.line;
        laid.lines = lines_.count();
        laid.needed_by_bend = lines_.needed;
        laid.angle_rad = angle_rad_;
        laid.inner_angle_rad =
            std::acos(lines_.bend.clairaut_mm() / (shape_.ring_radius_mm - shape_.tube_radius_mm));
        laid.theta_cycle_rad = lines_.theta_cycle_rad;
        laid.thinnest_layers = meant_layers(0.0);
        laid.thickest_layers = meant_layers(kPi);
        for (std::size_t end = 0; end < 2; ++end) {
            const ElbowLeg& leg = lines_.leg[end];
            laid.leg[end] = {shape_.leg_mm[end], leg.run_mm,    leg.angle_rad, leg.even,
                             leg.slip,           leg.widest_mm, leg.closed_mm};
        }
        return laid;
    }

    // Wound is the bend with the legs as far as they are closed; regular the bend but for a tow
    // width at its ends, over which layers are averaged.
    void measure() {
        const double from = shape_.leg_mm[0] - lines_.leg[0].closed_mm;
        const double to = shape_.leg_mm[0] + shape_.bend_mm() + lines_.leg[1].closed_mm;
        const bool all = closed(lines_);
        PlanZones zones;
        zones.asked_for = [=, this](const Vector3d& position) {
            const double at = tube_.line.foot(position).arc_mm;
            return all || (at >= from && at <= to);
        };
        zones.regular = [this](const Vector3d& position) {
            const double at = tube_.line.foot(position).arc_mm - shape_.leg_mm[0];
            return at >= options_.tow.width_mm && at <= shape_.bend_mm() - options_.tow.width_mm;
        };
        zones.meant = [this](const Vector3d& position) {
            const CentrePlace foot = tube_.line.foot(position);
            const Vector3d out = position - foot.position_mm;
            return meant_layers(std::atan2(out.dot(foot.across()), out.dot(foot.reference)));
        };
        measure_plan(mandrel_.surface, mandrel_.surface, options_.tow.width_mm,
                     options_.context.seed, zones, plan_);
    }

    const Mandrel& mandrel_;
    const Tube& tube_;
    const ElbowPlanOptions& options_;
    TurnRule rule_;
    ElbowTube shape_;
    double angle_rad_ = 0.0;
    ElbowLines lines_;
    Plan plan_;
};

}  // namespace

Plan plan_elbow(const Mandrel& mandrel, const Tube& tube, const ElbowPlanOptions& options) {
    return ElbowPlanner(mandrel, tube, options).run();
}

}  // namespace meshwind
