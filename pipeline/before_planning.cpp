#include "pipeline/before_planning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

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
#include "winding/revolution/aim_pass.h"
#include "winding/revolution/hoop_path.h"
#include "winding/turn/turn.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// What blocks may be off their stations, meshes off their circles and samples between points: no
// part is refused for less than this.
constexpr double kSlack_mm = 1.0;

// A fibre whose eye is no further out than its landing point lies along the spindle; what radii of
// meshes are off.
constexpr double kSameRadius_mm = 1e-3;

// Courses on a body between two plain rims reach all of it, and less than kCoveredShare of what
// they reach is refused in the end: so much of the wall may be out of reach.
constexpr double kMostBareBetweenRims = 0.15;

// Elsewhere nothing is planned where courses reach less than half of the wall
// (winding/cover/cover.cpp).
constexpr double kMostBare = 1.0 - kCoveredShare * 0.5;

// A fibre that is heavier than any creel: 1000 km.
constexpr double kMostFibre_mm = 1e9;

// Share of the girth that a tow takes at most. One circuit of a pattern takes w / cos(angle) of it,
// and bands overlap by a quarter at most (pattern_wish.h); layers without an angle are tried from
// 45 deg on, where that is 0.88. From a third on the unit is asked after.
constexpr double kMostOfGirth = 1.25;
constexpr double kMostOfGirthWithoutAngle = 0.9;
constexpr double kMuchOfGirth = 1.0 / 3.0;

// About an axis further off its own a body of revolution is wound as another shape.
constexpr double kOwnAxis_rad = rad_from_deg(5.0);

constexpr double kHoop_rad = 0.5 * kPi;

// What a pattern's angle may be more than asked for, so that its circuits close
// (winding/revolution/pattern_plan.cpp). One that may choose its number of circuits closes within a
// tow; over a cylinder of length l a tow comes of w / 2 l at most, and domes have their share too.
constexpr double kMoreAngle_rad = rad_from_deg(3.0);
constexpr double kTowsToClose = 10.0;

constexpr std::size_t kRimSamples = 64;
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

class BeforePlanning {
public:
    explicit BeforePlanning(const PlannedTask& task)
        : task_(task),
          machine_(task.machine),
          mandrel_(task.mandrel),
          job_(task.job),
          turn_(traits_of(task.job.mandrel.turn)),
          friction_(most_friction_of(task.job)),
          eye_(eye_range(task.machine,
                         widest_mm(task.mandrel) + task.machine.fibre.max_free_length_mm)),
          found_(find_revolution(task.mandrel)) {
        if (eye_ && job_.eye.rule == EyeRule::Cylinder) {
            eye_->farthest_mm = std::min(eye_->farthest_mm, job_.eye.radius_mm);
        }
        for (const LayerJob& layer : job_.layers) {
            planned_ = planned_ || layer.kind != LayerKind::Imported;
        }
    }

    void require() const {
        if (!planned_) {
            return;
        }
        require_sound_wall(mandrel_, turn_.takes_run);
        check_tow();
        check_turns();
        if (eye_) {
            check_travel();
            check_bodies();
        }
        check_free_length();
        check_amount();
    }

    // Rims that the eye does not get around: what is left to turn at is the plan's to find out.
    void remark_on_rims(std::vector<std::string>& remarks) const {
        for (const Rim& rim : mandrel_.rims) {
            if (!planned_ || !eye_ || !turn_.takes_run || !about_spindle(rim) || reaches(rim)) {
                continue;
            }
            const double z_mm = hoop_height_mm(rim);
            remarks.push_back("at the rim at z " + fixed(rim.centre_mm.z(), 1) +
                              " mm no fibre can be turned round: " +
                              (in_height(z_mm) ? across_words(*eye_, hoop_eye_mm(rim.radius_mm),
                                                              machine_.fibre.max_free_length_mm)
                                               : along_words(*eye_, z_mm, z_mm)));
        }
    }

private:
    [[noreturn]] void refuse(const char* code, const std::string& place,
                             const std::string& words) const {
        throw InputError(code, place, words);
    }

    [[nodiscard]] std::string job_place(const std::string& pointer) const {
        return name_of_file(task_.job_file, "job") + ": " + pointer;
    }

    [[nodiscard]] std::string machine_place() const {
        return name_of_file(task_.machine_file, machine_.name);
    }

    void check_tow() const {
        for (const LayerJob& layer : job_.layers) {
            const LayerKind kind = layer.kind;
            const bool free_angle = kind == LayerKind::Cover || (is_any(kind) && !layer.angle_deg);
            const bool by_angle =
                kind == LayerKind::Helical || kind == LayerKind::Polar || is_any(kind);
            const bool counts = free_angle || (by_angle && !layer.pattern);
            const double most = free_angle ? kMostOfGirthWithoutAngle : kMostOfGirth;
            if (counts && tow_of_girth(task_) > most) {
                refuse("plan.tow_width", job_place("/tow/width"), tow_words(task_));
            }
        }
    }

    // Whether a rim leaves room for a turn by friction at all.
    [[nodiscard]] bool has_room(const Rim& rim) const {
        return needed_extension_mm(rim) <= job_.mandrel.extension_mm;
    }

    [[nodiscard]] double needed_extension_mm(const Rim& rim) const {
        return least_run_mm(rim.radius_mm, friction_) + 0.5 * job_.tow.width_mm;
    }

    // An end at which patterns turn before they come to it.
    [[nodiscard]] bool has_cap(std::size_t end) const {
        const BodyOfRevolution& body = *found_.body;
        return cap_mm(body, end) != (end == 0 ? 0.0 : body.meridian.length_mm());
    }

    // Patterns where there are some, else courses.
    [[nodiscard]] static bool is_any(LayerKind kind) {
        return kind == LayerKind::Auto || kind == LayerKind::Wall;
    }

    // Patterns need both ends of a body of revolution; courses need some rim.
    [[nodiscard]] bool pattern_kind(LayerKind kind) const {
        return kind == LayerKind::Helical || kind == LayerKind::Polar || kind == LayerKind::Lattice;
    }

    [[nodiscard]] bool caps_at_both_ends() const { return found_.body && has_cap(0) && has_cap(1); }

    void check_turns() const {
        if (!turn_.takes_run) {
            return;
        }
        const bool turns_itself = caps_at_both_ends();
        const bool any_room = std::any_of(mandrel_.rims.begin(), mandrel_.rims.end(),
                                          [this](const Rim& rim) { return has_room(rim); });
        for (std::size_t i = 0; i < job_.layers.size(); ++i) {
            const LayerKind kind = job_.layers[i].kind;
            const bool courses = kind == LayerKind::Cover || is_any(kind);
            if (any_room || !courses || (is_any(kind) && turns_itself)) {
                continue;
            }
            if (eye_ && !mandrel_.rims.empty() && beyond_travel()) {
                refuse_travel();  // says more: a part of another unit is too large for both
            }
            refuse_turn(i);
        }
    }

    [[noreturn]] void refuse_turn(std::size_t layer) const {
        const std::string place = job_place("/layers/" + std::to_string(layer));
        if (mandrel_.rims.empty()) {
            refuse("plan.no_turn", mandrel_.file,
                   "the part has no rim over which a fibre could be turned round, and no domes "
                   "about its spindle on which it turns by itself; cut it open at its ends, or "
                   "name the axis of its domes with /mandrel/axis");
        }
        double least_mm = std::numeric_limits<double>::infinity();
        for (const Rim& rim : mandrel_.rims) {
            least_mm = std::min(least_mm, needed_extension_mm(rim));
        }
        const std::string by = "no rim can turn a fibre round: with a friction of " +
                               fixed(friction_.holds(), 3) + " ";
        if (!std::isfinite(least_mm)) {
            refuse("plan.no_turn", place,
                   by + "no extension is long enough; more friction would do, or \"turn\" by "
                        "\"pins\" or about a \"pole\"");
        }
        const FixedPair shown = fixed_apart(least_mm, job_.mandrel.extension_mm, 1);
        refuse("plan.no_turn", place,
               by + "the least turn takes " + shown.value + " mm of /mandrel/extension, which is " +
                   shown.limit);
    }

    // The height and radius that a turn at a rim takes the eye to; nothing where the rim is not
    // about the spindle.
    [[nodiscard]] bool about_spindle(const Rim& rim) const {
        return rim.axis.head<2>().norm() < kCoaxialSine &&
               rim.centre_mm.head<2>().norm() < kCoaxialSine * rim.radius_mm;
    }

    [[nodiscard]] bool in_height(double z_mm) const {
        return z_mm >= eye_->low_mm - kSlack_mm && z_mm <= eye_->high_mm + kSlack_mm;
    }

    // Height of the hoop of the least turn at a rim about the spindle.
    [[nodiscard]] double hoop_height_mm(const Rim& rim) const {
        const double run_mm = turn_.takes_run ? least_run_mm(rim.radius_mm, friction_) : 0.0;
        return rim.centre_mm.z() + std::copysign(run_mm, rim.axis.z());
    }

    // Distance from the spindle that the eye needs for a hoop of a radius.
    [[nodiscard]] double hoop_eye_mm(double radius_mm) const {
        const double free_mm =
            std::max(0.0, machine_.fibre.min_free_length_mm - margin::kFreeLength_mm);
        return std::max({std::hypot(radius_mm, free_mm), radius_mm + off_wall_mm(),
                         radius_mm + kSameRadius_mm});
    }

    // From the wall that the eye keeps at least, for the head's clearance.
    [[nodiscard]] double off_wall_mm() const {
        return std::max(
            0.0, job_.tolerance.clearance_mm - head_gap_mm(machine_, task_.envelope) - kSlack_mm);
    }

    [[nodiscard]] bool eye_gets_around(double radius_mm) const {
        return hoop_eye_mm(radius_mm) <= eye_->farthest_mm &&
               radius_mm + machine_.fibre.max_free_length_mm >= eye_->nearest_mm;
    }

    [[nodiscard]] bool reaches(const Rim& rim) const {
        if (turn_.takes_run && !has_room(rim)) {
            return true;  // that is told by the turns
        }
        if (turn_.takes_run && about_spindle(rim)) {
            return in_height(hoop_height_mm(rim)) && eye_gets_around(rim.radius_mm);
        }
        const Vector3d x = rim_reference(rim);
        const Vector3d y = rim.axis.cross(x);
        for (std::size_t i = 0; i < kRimSamples; ++i) {
            const double turn = 2.0 * kPi * static_cast<double>(i) / kRimSamples;
            const Vector3d at =
                rim.centre_mm + rim.radius_mm * (std::cos(turn) * x + std::sin(turn) * y);
            if (in_height(at.z()) && radius_of(at) < eye_->farthest_mm + kSlack_mm) {
                return true;
            }
        }
        return false;
    }

    // Whether patterns can turn at an end of the body of revolution.
    [[nodiscard]] bool reaches_end(std::size_t end) const {
        const BodyOfRevolution& body = *found_.body;
        if (has_cap(end)) {
            const MeridianPlace cap = body.meridian.at(cap_mm(body, end));
            return in_height(cap.z_mm) && cap.radius_mm < eye_->farthest_mm;
        }
        const std::int32_t rim = body.end[end].rim;
        return rim < 0 || reaches(mandrel_.rims[static_cast<std::size_t>(rim)]);
    }

    [[nodiscard]] bool widest_fits() const {
        const Meridian& meridian = found_.body->meridian;
        return meridian.at(meridian.widest_mm()).radius_mm < eye_->farthest_mm;
    }

    // Share of the wall at which no fibre lands: beyond the eye's travel, and where an end of a
    // body of revolution cannot be turned at, beyond the widest hoop.
    [[nodiscard]] double bare_share() const {
        const bool turns_inside = found_.body && !(reaches_end(0) && reaches_end(1));
        const auto bare = [&](const Vector3d& at) {
            const double radius_mm = radius_of(at);
            return !in_height(at.z()) || radius_mm > eye_->farthest_mm + kSlack_mm ||
                   radius_mm + machine_.fibre.max_free_length_mm < eye_->nearest_mm - kSlack_mm ||
                   (turns_inside && !eye_gets_around(radius_mm - 0.5 * job_.tow.width_mm));
        };
        double all_mm2 = 0.0;
        double bare_mm2 = 0.0;
        const Surface& surface = mandrel_.surface;
        for (const auto& face : surface.face) {
            const double mm2 = area_mm2(surface.position_mm, face);
            all_mm2 += mm2;
            const bool out = std::all_of(face.begin(), face.end(), [&](auto corner) {
                return bare(surface.position_mm[static_cast<std::size_t>(corner)]);
            });
            bare_mm2 += out ? mm2 : 0.0;
        }
        return bare_mm2 / all_mm2;
    }

    [[nodiscard]] bool patterns_fit() const {
        return found_.body && reaches_end(0) && reaches_end(1) && widest_fits();
    }

    [[nodiscard]] bool courses_fit() const {
        if (mandrel_.rims.empty()) {
            return true;  // for the planner to refuse
        }
        const bool any_rim = std::any_of(mandrel_.rims.begin(), mandrel_.rims.end(),
                                         [this](const Rim& rim) { return reaches(rim); });
        const bool between_rims = found_.body && !has_cap(0) && !has_cap(1);
        return any_rim && bare_share() <= (between_rims ? kMostBareBetweenRims : kMostBare);
    }

    void check_travel() const {
        for (const LayerJob& layer : job_.layers) {
            const bool fits = pattern_kind(layer.kind)         ? !found_.body || patterns_fit()
                              : layer.kind == LayerKind::Cover ? courses_fit()
                              : is_any(layer.kind)             ? patterns_fit() || courses_fit()
                                                               : hoops_fit(layer.kind);
            if (!fits) {
                refuse_travel();
            }
        }
    }

    [[nodiscard]] bool hoops_fit(LayerKind kind) const {
        if (kind != LayerKind::Hoop || !found_.body) {
            return true;
        }
        const Meridian& meridian = found_.body->meridian;
        const CylinderPart part = cylinder_at(meridian, meridian.widest_mm());
        const double inside_mm = job_.tow.width_mm;
        return in_height(meridian.at(part.from_mm).z_mm + inside_mm) &&
               in_height(meridian.at(part.to_mm).z_mm - inside_mm) && widest_fits();
    }

    // Heights that the eye has to come to: hoops at rims, the caps of domes.
    [[nodiscard]] std::array<double, 2> needed_heights_mm() const {
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        const auto add = [&](double z_mm) {
            low = std::min(low, z_mm);
            high = std::max(high, z_mm);
        };
        for (const Rim& rim : mandrel_.rims) {
            const double z_mm = hoop_height_mm(rim);
            add(std::isfinite(z_mm) ? z_mm : rim.centre_mm.z());
        }
        for (std::size_t end = 0; found_.body && end < 2; ++end) {
            if (has_cap(end)) {
                add(found_.body->meridian.at(cap_mm(*found_.body, end)).z_mm);
            }
        }
        return {low, high};
    }

    [[nodiscard]] bool beyond_travel() const {
        const auto [low, high] = needed_heights_mm();
        return !in_height(low) || !in_height(high) ||
               hoop_eye_mm(widest_mm(mandrel_)) > eye_->farthest_mm;
    }

    [[nodiscard]] std::array<double, 2> heights_of_wall_mm() const {
        const std::vector<Vector3d>& points = mandrel_.surface.position_mm;
        const auto [low, high] =
            std::minmax_element(points.begin(), points.end(),
                                [](const Vector3d& a, const Vector3d& b) { return a.z() < b.z(); });
        return {low->z(), high->z()};
    }

    [[noreturn]] void refuse_travel() const {
        for (const auto& [low, high] : {needed_heights_mm(), heights_of_wall_mm()}) {
            if (low < eye_->low_mm - kSlack_mm || high > eye_->high_mm + kSlack_mm) {
                refuse("plan.travel", machine_place(),
                       along_words(*eye_, low, high) + unit_question(mandrel_));
            }
        }
        const double needed_mm = hoop_eye_mm(widest_mm(mandrel_));
        if (needed_mm > eye_->farthest_mm) {
            refuse("plan.travel", machine_place(),
                   "the part is " + fixed(2.0 * widest_mm(mandrel_), 1) + " mm wide; " +
                       across_words(*eye_, needed_mm, machine_.fibre.max_free_length_mm) +
                       unit_question(mandrel_));
        }
        refuse("plan.travel", machine_place(),
               nearest_words(*eye_, machine_.fibre.max_free_length_mm) + unit_question(mandrel_));
    }

    // What stands on the base and is met by the turning part.
    void check_bodies() const {
        const double mount_mm = machine_.mount ? machine_.mount->origin_mm.z() : 0.0;
        std::vector<Eigen::Vector2d> circles;
        for (const HeadEnvelope::Part& body : task_.envelope.bodies) {
            if (body.link != kBaseLink || !body.triangles.points_mm.empty()) {
                continue;
            }
            circles = circles.empty() ? outline(mandrel_.whole) : circles;
            for (std::size_t i = 0; i <= kBodySamples; ++i) {
                const double share = static_cast<double>(i) / kBodySamples;
                const Vector3d at =
                    body.capsule.from_mm + share * (body.capsule.to_mm - body.capsule.from_mm);
                const Eigen::Vector2d place(radius_of(at), at.z() - mount_mm);
                for (const Eigen::Vector2d& circle : circles) {
                    if ((circle - place).norm() < body.capsule.radius_mm - kSlack_mm) {
                        refuse("plan.body", machine_place(),
                               "the turning part, " + fixed(circle.x(), 1) + " mm wide at z " +
                                   fixed(circle.y(), 1) + " mm, meets a body of the machine " +
                                   fixed(std::max(0.0, place.x() - body.capsule.radius_mm), 1) +
                                   " mm from the spindle axis" + unit_question(mandrel_));
                    }
                }
            }
        }
    }

    // The winding angle on the widest cylinder, or more; 90 deg where it is the plan's to find.
    [[nodiscard]] double most_angle_rad(const LayerJob& layer, const CylinderPart& part) const {
        const double tow_mm = job_.tow.width_mm;
        double angle_rad = kHoop_rad;
        if (layer.kind == LayerKind::Helical && layer.angle_deg) {
            angle_rad = rad_from_deg(*layer.angle_deg);
        } else if (layer.kind == LayerKind::Polar) {
            const Meridian& meridian = found_.body->meridian;
            const double opening_mm =
                std::max(meridian.at(0.0).radius_mm, meridian.at(meridian.length_mm()).radius_mm);
            angle_rad = std::asin(std::min(1.0, (opening_mm + tow_mm) / part.radius_mm));
        }
        const double more_rad = kTowsToClose * tow_mm / (part.to_mm - part.from_mm);
        return std::min(
            kHoop_rad,
            angle_rad + (layer.pattern ? kMoreAngle_rad : std::min(kMoreAngle_rad, more_rad)));
    }

    // Where the eye comes off a long cylinder by too little.
    void check_free_length() const {
        if (!found_.body) {
            return;
        }
        const Meridian& meridian = found_.body->meridian;
        const CylinderPart part = cylinder_at(meridian, meridian.widest_mm());
        const double longest_mm = machine_.fibre.max_free_length_mm + margin::kFreeLength_mm;
        if (part.to_mm - part.from_mm < 2.0 * longest_mm) {
            return;
        }
        for (const LayerJob& layer : job_.layers) {
            const double angle_rad = most_angle_rad(layer, part);
            const double needed_mm =
                free_length_over_cylinder_mm(part.radius_mm, off_wall_mm(), std::sin(angle_rad));
            if (needed_mm > longest_mm) {
                refuse("plan.free_length", machine_place(),
                       "on the cylinder of radius " + fixed(part.radius_mm, 1) + " mm fibre at " +
                           degrees(angle_rad, 1) + " or less leaves so flat that the eye needs " +
                           fixed(needed_mm, 1) +
                           " mm of free fibre to be off the wall; /fibre/max_free_length is " +
                           fixed(machine_.fibre.max_free_length_mm, 1));
            }
        }
    }

    void check_amount() const {
        const double mm2 =
            area_mm2({mandrel_.surface.position_mm, mandrel_.surface.face}) * kCoveredShare * 0.5;
        const double fibre_mm = mm2 / job_.tow.width_mm;
        if (fibre_mm > kMostFibre_mm) {
            refuse("plan.amount", job_place("/tow/width"),
                   "half of the wall alone takes " + fixed(fibre_mm / 1e6, 0) + " km of a tow of " +
                       fixed(job_.tow.width_mm, 3) + " mm, more than " +
                       fixed(kMostFibre_mm / 1e6, 0) + unit_question(mandrel_));
        }
    }

    const PlannedTask& task_;
    const Machine& machine_;
    const Mandrel& mandrel_;
    const Job& job_;
    const TurnKindTraits& turn_;
    const Friction friction_;  // what no layer has more of
    std::optional<EyeRange> eye_;
    RevolutionFinding found_;
    bool planned_ = false;
};

}  // namespace

void require_can_be_wound(const PlannedTask& task) {
    BeforePlanning(task).require();
}

std::vector<std::string> remarks_before_planning(const PlannedTask& task) {
    std::vector<std::string> remarks = task.mandrel.remarks;
    BeforePlanning(task).remark_on_rims(remarks);
    if (tow_of_girth(task) > kMuchOfGirth) {
        remarks.push_back(tow_words(task));
    }
    if (!task.job.mandrel.axis) {
        return remarks;
    }
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
    return remarks;
}

}  // namespace meshwind
