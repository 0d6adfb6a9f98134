#include "pipeline/before_planning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/margins.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "machines/eye_range.h"
#include "mesh/revolution/revolution.h"
#include "mesh/segment/spindle_axis.h"
#include "mesh/triangle_soup.h"
#include "pipeline/job/job_friction.h"
#include "pipeline/part_room.h"
#include "pipeline/part_words.h"
#include "pipeline/plan_layer.h"
#include "pipeline/travel_words.h"
#include "winding/revolution/hoop_path.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// A fibre that is heavier than any creel: 1000 km.
constexpr double kMaxFibre_mm = 1e9;

// Share of the girth that a tow takes at most. One circuit of a pattern takes w / cos(angle) of it,
// and bands overlap by a quarter at most (pattern_constraints.h); layers without an angle are tried
// from 45 deg on, where that is 0.88. From a third on the unit is asked after.
constexpr double kMaxOfGirth = 1.25;
constexpr double kMaxOfGirthWithoutAngle = 0.9;
constexpr double kMuchOfGirth = 1.0 / 3.0;

// About an axis further off its own a body of revolution is wound as another shape.
constexpr double kOwnAxis_rad = rad_from_deg(5.0);

constexpr double kHoop_rad = 0.5 * kPi;

// What a pattern's angle may be more than asked for, so that its circuits close
// (winding/revolution/pattern_plan.cpp). One that may choose its number of circuits closes within a
// tow; over a cylinder of length l a tow comes of w / 2 l at most, and domes have their share too.
constexpr double kMoreAngle_rad = rad_from_deg(3.0);
constexpr double kTowsToClose = 10.0;

constexpr std::size_t kBodySamples = 200;

std::string name_of_file(const std::filesystem::path& file, const std::string& otherwise) {
    return file.empty() ? otherwise : file.filename().string();
}

double radius_of(const Vector3d& point) {
    return point.head<2>().norm();
}

double widest_mm(const Mandrel& mandrel) {
    double widest = 0.0;
    for (const Vector3d& point : mandrel.surface.position_mm) {
        widest = std::max(widest, radius_of(point));
    }
    return widest;
}

double girth_mm(const Mandrel& mandrel) {
    return 2.0 * kPi * widest_mm(mandrel);
}

double tow_of_girth(const PlannedTask& task) {
    return task.job.tow.width_mm / girth_mm(task.mandrel);
}

std::string tow_words(const PlannedTask& task) {
    return "a tow of " + fixed(task.job.tow.width_mm, 2) + " mm is " +
           percent(tow_of_girth(task), 0) + " of the part's girth, " +
           fixed(girth_mm(task.mandrel), 2) + " mm at its widest place" +
           unit_question(task.mandrel);
}

// What is known of a task.
struct KnownTask {
    const PlannedTask& task;
    TurnRoom turns;
    double off_wall_mm = 0.0;     // that the eye keeps at least, for the head's clearance
    std::optional<EyeReach> eye;  // none: nothing is known of it
    RevolutionFinding found;
};

std::optional<EyeReach> eye_reach(const PlannedTask& task, double off_wall_mm) {
    const FibreLimits& fibre = task.machine.fibre;
    std::optional<EyeRange> range =
        eye_range(task.machine, widest_mm(task.mandrel) + fibre.max_free_length_mm);
    if (!range) {
        return std::nullopt;
    }
    if (task.job.eye.rule == EyeRule::Cylinder) {
        range->farthest_mm = std::min(range->farthest_mm, task.job.eye.radius_mm);
    }
    return EyeReach{*range, fibre.min_free_length_mm, fibre.max_free_length_mm, off_wall_mm};
}

KnownTask known_of(const PlannedTask& task) {
    const Job& job = task.job;
    const TurnRoom turns{traits_of(job.mandrel.turn).takes_run, most_friction_of(job),
                         job.mandrel.extension_mm, job.tow.width_mm};
    const double off_wall_mm = std::max(
        0.0, job.tolerance.clearance_mm - head_gap_mm(task.machine, task.envelope) - kRoomSlack_mm);
    std::optional<EyeReach> eye = eye_reach(task, off_wall_mm);
    return {task, turns, off_wall_mm, std::move(eye), find_revolution(task.mandrel)};
}

// \pre something is known of the eye
PartReach reach_of(const KnownTask& known) {
    return {known.task.mandrel, known.found.body, known.turns, *known.eye};
}

bool plans_any(const Job& job) {
    return std::any_of(job.layers.begin(), job.layers.end(),
                       [](const LayerJob& layer) { return layer.kind != LayerKind::Imported; });
}

std::string job_place(const PlannedTask& task, const std::string& pointer) {
    return name_of_file(task.job_file, "job") + ": " + pointer;
}

std::string machine_place(const PlannedTask& task) {
    return name_of_file(task.machine_file, task.machine.name);
}

// Patterns where there are some, else courses.
bool is_any(LayerKind kind) {
    return kind == LayerKind::Auto || kind == LayerKind::Wall;
}

// Patterns need both ends of a body of revolution; courses need some rim.
bool is_pattern(LayerKind kind) {
    return kind == LayerKind::Helical || kind == LayerKind::Polar || kind == LayerKind::Lattice;
}

void check_tow(const PlannedTask& task) {
    for (const LayerJob& layer : task.job.layers) {
        const LayerKind kind = layer.kind;
        const bool free_angle = kind == LayerKind::Cover || (is_any(kind) && !layer.angle_deg);
        const bool by_angle =
            kind == LayerKind::Helical || kind == LayerKind::Polar || is_any(kind);
        const bool counts = free_angle || (by_angle && !layer.pattern);
        const double most = free_angle ? kMaxOfGirthWithoutAngle : kMaxOfGirth;
        if (counts && tow_of_girth(task) > most) {
            throw InputError("plan.tow_width", job_place(task, "/tow/width"), tow_words(task));
        }
    }
}

bool beyond_travel(const PartReach& part) {
    const auto [low, high] = needed_heights_mm(part);
    return !in_height(part.eye, low) || !in_height(part.eye, high) ||
           hoop_eye_mm(part.eye, widest_mm(part.mandrel)) > part.eye.range.farthest_mm;
}

std::array<double, 2> heights_of_wall_mm(const Mandrel& mandrel) {
    const std::vector<Vector3d>& points = mandrel.surface.position_mm;
    const auto [low, high] =
        std::minmax_element(points.begin(), points.end(),
                            [](const Vector3d& a, const Vector3d& b) { return a.z() < b.z(); });
    return {low->z(), high->z()};
}

// How the part is beyond the eye's travel.
std::string travel_words(const PartReach& part) {
    const EyeRange& range = part.eye.range;
    for (const auto& [low, high] : {needed_heights_mm(part), heights_of_wall_mm(part.mandrel)}) {
        if (low < range.low_mm - kRoomSlack_mm || high > range.high_mm + kRoomSlack_mm) {
            return along_words(range, low, high);
        }
    }
    const double needed_mm = hoop_eye_mm(part.eye, widest_mm(part.mandrel));
    if (needed_mm > range.farthest_mm) {
        return "the part is " + fixed(2.0 * widest_mm(part.mandrel), 1) + " mm wide; " +
               across_words(range, needed_mm, part.eye.longest_fibre_mm);
    }
    return nearest_words(range, part.eye.longest_fibre_mm);
}

[[noreturn]] void refuse_travel(const PlannedTask& task, const PartReach& part) {
    throw InputError("plan.travel", machine_place(task),
                     travel_words(part) + unit_question(task.mandrel));
}

void check_travel(const PlannedTask& task, const PartReach& part) {
    for (const LayerJob& layer : task.job.layers) {
        const LayerKind kind = layer.kind;
        const bool fits = is_pattern(kind)           ? !part.body || patterns_fit(part)
                          : kind == LayerKind::Cover ? courses_fit(part)
                          : is_any(kind)             ? patterns_fit(part) || courses_fit(part)
                                                     : kind != LayerKind::Hoop || hoops_fit(part);
        if (!fits) {
            refuse_travel(task, part);
        }
    }
}

[[noreturn]] void refuse_turn(const PlannedTask& task, const TurnRoom& turns, std::size_t layer) {
    const std::vector<Rim>& rims = task.mandrel.rims;
    if (rims.empty()) {
        throw InputError(
            "plan.no_turn", task.mandrel.file,
            "the part has no rim over which a fibre could be turned round, and no domes about its "
            "spindle on which it turns by itself; cut it open at its ends, or name the axis of its "
            "domes with /mandrel/axis");
    }
    const std::string place = job_place(task, "/layers/" + std::to_string(layer));
    double least_mm = std::numeric_limits<double>::infinity();
    for (const Rim& rim : rims) {
        least_mm = std::min(least_mm, needed_extension_mm(turns, rim));
    }
    const std::string by = "no rim can turn a fibre round: with a friction of " +
                           fixed(turns.friction.holds(), 3) + " ";
    if (!std::isfinite(least_mm)) {
        throw InputError("plan.no_turn", place,
                         by + "no extension is long enough; more friction would do, or \"turn\" by "
                              "\"pins\" or about a \"pole\"");
    }
    const FixedPair shown = fixed_apart(least_mm, turns.extension_mm, 1);
    throw InputError("plan.no_turn", place,
                     by + "the least turn takes " + shown.value +
                         " mm of /mandrel/extension, which is " + shown.limit);
}

void check_turns(const KnownTask& known) {
    if (!known.turns.takes_run) {
        return;
    }
    const PlannedTask& task = known.task;
    const std::optional<BodyOfRevolution>& body = known.found.body;
    const std::vector<Rim>& rims = task.mandrel.rims;
    const bool turns_itself = body && has_cap(*body, 0) && has_cap(*body, 1);
    const bool any_room = std::any_of(rims.begin(), rims.end(),
                                      [&](const Rim& rim) { return has_room(known.turns, rim); });
    for (std::size_t i = 0; i < task.job.layers.size(); ++i) {
        const LayerKind kind = task.job.layers[i].kind;
        const bool courses = kind == LayerKind::Cover || is_any(kind);
        if (any_room || !courses || (is_any(kind) && turns_itself)) {
            continue;
        }
        if (known.eye && !rims.empty() && beyond_travel(reach_of(known))) {
            // Says more: a part of another unit is too large for both.
            refuse_travel(task, reach_of(known));
        }
        refuse_turn(task, known.turns, i);
    }
}

// Where a body of the machine and the turning part meet: radius and height.
struct Meeting {
    Eigen::Vector2d circle;  // of the part
    Eigen::Vector2d place;   // on the body's axis
};

// The first along the body; none where it stands clear.
std::optional<Meeting> meeting_with(const Capsule& body, double mount_mm,
                                    const std::vector<Eigen::Vector2d>& circles) {
    for (std::size_t i = 0; i <= kBodySamples; ++i) {
        const double share = static_cast<double>(i) / kBodySamples;
        const Vector3d at = body.from_mm + share * (body.to_mm - body.from_mm);
        const Eigen::Vector2d place(radius_of(at), at.z() - mount_mm);
        for (const Eigen::Vector2d& circle : circles) {
            if ((circle - place).norm() < body.radius_mm - kRoomSlack_mm) {
                return Meeting{circle, place};
            }
        }
    }
    return std::nullopt;
}

// What stands on the base and is met by the turning part.
void check_bodies(const PlannedTask& task) {
    const Machine& machine = task.machine;
    const double mount_mm = machine.mount ? machine.mount->origin_mm.z() : 0.0;
    std::vector<Eigen::Vector2d> circles;
    for (const HeadEnvelope::Part& body : task.envelope.bodies) {
        if (body.link != kBaseLink || !body.triangles.points_mm.empty()) {
            continue;
        }
        circles = circles.empty() ? outline(task.mandrel.whole) : circles;
        if (const auto met = meeting_with(body.capsule, mount_mm, circles)) {
            throw InputError("plan.body", machine_place(task),
                             "the turning part, " + fixed(met->circle.x(), 1) + " mm wide at z " +
                                 fixed(met->circle.y(), 1) + " mm, meets a body of the machine " +
                                 fixed(std::max(0.0, met->place.x() - body.capsule.radius_mm), 1) +
                                 " mm from the spindle axis" + unit_question(task.mandrel));
        }
    }
}

// The winding angle on the widest cylinder, or more; 90 deg where it is the plan's to find.
double most_angle_rad(const LayerJob& layer, double tow_mm, const Meridian& meridian,
                      const CylinderPart& part) {
    double angle_rad = kHoop_rad;
    if (layer.kind == LayerKind::Helical && layer.angle_deg) {
        angle_rad = rad_from_deg(*layer.angle_deg);
    } else if (layer.kind == LayerKind::Polar) {
        const double opening_mm =
            std::max(meridian.at(0.0).radius_mm, meridian.at(meridian.length_mm()).radius_mm);
        angle_rad = std::asin(std::min(1.0, (opening_mm + tow_mm) / part.radius_mm));
    }
    const double more_rad = kTowsToClose * tow_mm / (part.to_mm - part.from_mm);
    return std::min(kHoop_rad, angle_rad + (layer.pattern ? kMoreAngle_rad
                                                          : std::min(kMoreAngle_rad, more_rad)));
}

// Where the eye comes off a long cylinder by too little.
void check_free_length(const PlannedTask& task, const BodyOfRevolution& body, double off_wall_mm) {
    const Meridian& meridian = body.meridian;
    const CylinderPart part = cylinder_at(meridian, meridian.widest_mm());
    const double longest_mm = task.machine.fibre.max_free_length_mm + margin::kFreeLength_mm;
    if (part.to_mm - part.from_mm < 2.0 * longest_mm) {
        return;
    }
    for (const LayerJob& layer : task.job.layers) {
        const double angle_rad = most_angle_rad(layer, task.job.tow.width_mm, meridian, part);
        const double needed_mm =
            free_length_over_cylinder_mm(part.radius_mm, off_wall_mm, std::sin(angle_rad));
        if (needed_mm > longest_mm) {
            throw InputError(
                "plan.free_length", machine_place(task),
                "on the cylinder of radius " + fixed(part.radius_mm, 1) + " mm fibre at " +
                    degrees(angle_rad, 1) + " or less leaves so flat that the eye needs " +
                    fixed(needed_mm, 1) +
                    " mm of free fibre to be off the wall; /fibre/max_free_length is " +
                    fixed(task.machine.fibre.max_free_length_mm, 1));
        }
    }
}

void check_amount(const PlannedTask& task) {
    const Surface& surface = task.mandrel.surface;
    const double tow_mm = task.job.tow.width_mm;
    const double mm2 = area_mm2({surface.position_mm, surface.face}) * kCoveredShare * 0.5;
    const double fibre_mm = mm2 / tow_mm;
    if (fibre_mm > kMaxFibre_mm) {
        throw InputError("plan.amount", job_place(task, "/tow/width"),
                         "half of the wall alone takes " + fixed(fibre_mm / 1e6, 0) +
                             " km of a tow of " + fixed(tow_mm, 3) + " mm, more than " +
                             fixed(kMaxFibre_mm / 1e6, 0) + unit_question(task.mandrel));
    }
}

// Rims that the eye does not get around: what is left to turn at is the plan's to find out.
void remark_on_rims(const KnownTask& known, std::vector<std::string>& remarks) {
    if (!plans_any(known.task.job) || !known.eye || !known.turns.takes_run) {
        return;
    }
    const PartReach part = reach_of(known);
    for (const Rim& rim : part.mandrel.rims) {
        if (!about_spindle(rim) || reaches(part, rim)) {
            continue;
        }
        const double z_mm = hoop_height_mm(part.turns, rim);
        const std::string words =
            in_height(part.eye, z_mm)
                ? across_words(part.eye.range, hoop_eye_mm(part.eye, rim.radius_mm),
                               part.eye.longest_fibre_mm)
                : along_words(part.eye.range, z_mm, z_mm);
        remarks.push_back("at the rim at z " + fixed(rim.centre_mm.z(), 1) +
                          " mm no fibre can be turned round: " + words);
    }
}

// Where the job turns the part about another axis than its own.
void remark_on_axis(const PlannedTask& task, std::vector<std::string>& remarks) {
    const TriangleSoup wall{task.mandrel.surface.position_mm, task.mandrel.surface.face};
    const SpindleFrame own = find_spindle(wall, task.mandrel.rims, std::nullopt);
    const Vector3d axis = own.mandrel_from_file.linear().row(2).transpose();
    const double off_rad = std::atan2(axis.head<2>().norm(), std::abs(axis.z()));
    const bool round = own.axis.rule == "coaxial-rims" || own.axis.rule == "revolution";
    if (round && off_rad > kOwnAxis_rad) {
        remarks.push_back("the spindle axis of /mandrel/axis is " + degrees(off_rad, 1) +
                          " off the part's own axis (" + own.axis.rule +
                          "); without the key the part turns about its own");
    }
}

}  // namespace

void require_can_be_wound(const PlannedTask& task) {
    const KnownTask known = known_of(task);
    if (!plans_any(task.job)) {
        return;
    }
    require_sound_wall(task.mandrel, known.turns.takes_run);
    check_tow(task);
    check_turns(known);
    if (known.eye) {
        check_travel(task, reach_of(known));
        check_bodies(task);
    }
    if (known.found.body) {
        check_free_length(task, *known.found.body, known.off_wall_mm);
    }
    check_amount(task);
}

std::vector<std::string> remarks_before_planning(const PlannedTask& task) {
    std::vector<std::string> remarks = task.mandrel.remarks;
    remark_on_rims(known_of(task), remarks);
    if (tow_of_girth(task) > kMuchOfGirth) {
        remarks.push_back(tow_words(task));
    }
    if (task.job.mandrel.axis) {
        remark_on_axis(task, remarks);
    }
    return remarks;
}

}  // namespace meshwind
