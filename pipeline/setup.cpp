#include "pipeline/setup.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/margins.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "geodesic/bridge.h"
#include "machines/eye_inverse.h"
#include "mesh/mandrel/extension.h"
#include "pipeline/job/job_friction.h"
#include "postproc/ringhead/krl.h"
#include "postproc/robot/dialects.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

// The free fibre's ray starts two mesh edges along the tangent: nearer, the facet that holds the
// landing point itself may stand in the way; a wall within that distance would bridge first.
constexpr double kRayStartEdges = 2.0;

// Clearances are tabulated this far around the mandrel: further out nothing of a head is in the
// way.
constexpr double kTableReach_mm = 60.0;

// Reports tell clearances up to so much more than is kept; to measure larger ones takes time.
constexpr double kToldClearance_mm = 20.0;

// A distance is written with so many digits at least.
constexpr double kSameDistance_mm = 1e-3;

// True when some axis that carries the part turns it off the line away from the spindle; a roll
// about that line does not.
bool swings(const Machine& machine, char link) {
    constexpr double kParallel = 1e-9;
    for (const Axis& axis : machine.eye_chain) {
        if (axis.type == AxisType::Rotary &&
            axis.direction.cross(machine.eye.exit).norm() > kParallel) {
            return true;
        }
        if (axis.letter == link) {
            break;
        }
    }
    return false;
}

// The head as planning sees it: a ball around the eye that holds every part which turns with a
// wrist axis, however that turns, and the other parts as capsules on the line away from the
// spindle, on which the central-angle policy keeps them. Of a robot what its flange carries; its
// links are far from the eye and are looked at when the motion is known.
void describe_head(const Machine& machine, const HeadEnvelope& envelope, FreeFibreRule& rule) {
    const Eigen::Vector3d& eye = machine.eye.position_mm;
    const Eigen::Vector3d outward = -machine.eye.exit;
    rule.head_radius_mm = 0.0;
    rule.arm.clear();
    const bool robot = machine_class(machine).arm;
    for (const HeadEnvelope::Part& part : envelope.parts) {
        std::vector<Eigen::Vector3d> points = part.triangles.points_mm;
        double thickness = 0.0;
        if (points.empty()) {
            points = {part.capsule.from_mm, part.capsule.to_mm};
            thickness = part.capsule.radius_mm;
        }
        double reach = 0.0;
        ArmPart arm{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest(), 0.0};
        for (const Eigen::Vector3d& point : points) {
            const double along = outward.dot(point - eye);
            reach = std::max(reach, (point - eye).norm() + thickness);
            arm.from_mm = std::min(arm.from_mm, along);
            arm.to_mm = std::max(arm.to_mm, along);
            arm.radius_mm =
                std::max(arm.radius_mm, (point - eye - along * outward).norm() + thickness);
        }
        if (robot) {
            if (part.link == machine.eye_chain.back().letter) {
                rule.arm.push_back(arm);
            }
        } else if (swings(machine, part.link)) {
            rule.head_radius_mm = std::max(rule.head_radius_mm, reach);
        } else {
            rule.arm.push_back(arm);
        }
    }
}

void check_free_length(const FreeFibreRule& free, double length_mm, const std::string& place) {
    if (length_mm < free.min_mm || length_mm > free.max_mm) {
        throw InputError("job.free_length", place,
                         fixed(length_mm, 1) + " mm is outside the " + fixed(free.min_mm, 1) +
                             " to " + fixed(free.max_mm, 1) +
                             " mm of the machine; choose a length between");
    }
}

CollisionRule collision_rule(const Setup& setup, const fs::path& job_file) {
    CollisionRule rule;
    rule.clearance_mm = setup.job.tolerance.clearance_mm;
    rule.report_within_mm = rule.clearance_mm + kToldClearance_mm;
    FreeFibreRule& free = rule.free_fibre;
    free.min_mm = setup.machine.fibre.min_free_length_mm;
    free.max_mm = setup.machine.fibre.max_free_length_mm;
    free.preferred_mm = setup.job.eye.free_length_mm;
    const std::string eye = job_file.string() + ": /eye/";
    if (traits_of(setup.job.eye.rule).reads_free_length) {
        check_free_length(free, free.preferred_mm, eye + "free_length");
    }
    free.preferred_mm = std::clamp(free.preferred_mm, free.min_mm, free.max_mm);
    const std::vector<LengthPiece>& lengths = setup.job.eye.lengths;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        check_free_length(free, lengths[i].free_length_mm,
                          eye + "lengths/" + std::to_string(i) + "/free_length");
    }
    describe_head(setup.machine, setup.envelope, free);
    free.clearance_mm = rule.clearance_mm + margin::kBetweenBlocks_mm;
    free.start_mm =
        std::min(kRayStartEdges * setup.mandrel.surface.mean_edge_mm, 0.5 * free.min_mm);
    return rule;
}

std::unique_ptr<RayQuery> obstacles_of(const Machine& machine, const Mandrel& mandrel,
                                       double extension_mm, std::span<const Pin> pins) {
    std::vector<TriangleSoup> parts{mandrel.whole};
    for (const Rim& rim : mandrel.rims) {
        if (extension_mm > 0.0) {
            parts.push_back(extension_of(rim, extension_mm));
        }
    }
    for (TriangleSoup& body : bodies_on_mandrel(machine)) {
        parts.push_back(std::move(body));
    }
    for (const Pin& pin : pins) {
        parts.push_back(mesh_of(pin));
    }
    return std::make_unique<RayQuery>(parts, kTableReach_mm);
}

// An eye that a carriage alone moves keeps its distance from the spindle axis: that is the rule,
// unless the job names another one, which is refused later.
bool take_rule_of_machine(const Machine& machine, EyeLaw& eye) {
    const double kept_mm = machine_class(machine).eye_distance_mm;
    if (kept_mm == 0.0) {
        return false;
    }
    if (eye.rule == EyeRule::Cylinder && std::abs(eye.radius_mm - kept_mm) <= kSameDistance_mm) {
        eye.radius_mm = kept_mm;
        return false;
    }
    if (eye.rule != EyeRule::Adaptive) {
        return false;
    }
    eye.rule = EyeRule::Cylinder;
    eye.radius_mm = kept_mm;
    return true;
}

// A unit that was given beside the job counts as the job's.
void take_given_unit(const Mandrel& mandrel, Job& job) {
    if (mandrel.unit_rule == "given") {
        job.mandrel.units = length_unit(mandrel.unit_mm);
    }
}

// What follows from machine, job and mandrel.
void complete(Setup& setup, const fs::path& job_file) {
    setup.rule = collision_rule(setup, job_file);
    setup.obstacles =
        obstacles_of(setup.machine, setup.mandrel, setup.job.mandrel.extension_mm, {});
    Surface wall = extended_surface(setup.mandrel, setup.job.mandrel.extension_mm);
    const double reach_mm = bridge_reach_mm(setup.mandrel.surface);
    setup.wall = std::make_unique<LaydownSurface>(std::move(wall), reach_mm);
}

}  // namespace

MandrelOptions mandrel_options(const Job& job, double unit_mm) {
    MandrelOptions options;
    options.unit_mm = unit_mm > 0.0 ? unit_mm : mm_per(job.mandrel.units);
    if (job.mandrel.axis) {
        options.axis = {job.mandrel.axis->origin, job.mandrel.axis->direction};
    }
    options.keep_regions = job.mandrel.keep_regions;
    options.keep_faces = job.mandrel.keep_faces;
    if (!options.keep_regions.empty() && !options.keep_faces.empty()) {
        throw InputError("job.keep_twice", "job: /mandrel/keep_faces",
                         "stands beside \"keep_regions\"; give one of them");
    }
    options.cut_ends_mm = job.mandrel.cut_ends_mm;
    options.remove_details_mm = job.mandrel.remove_details_mm;
    if (!job.mandrel.blend_mm) {
        throw InputError(
            "job.blend_open", "job: /mandrel/blend",
            "is \"auto\", which the main job alone can choose; give the radius that its "
            "report has as mandrel.winding_mesh.blend_mm, --set mandrel.blend=8");
    }
    options.blend_mm = *job.mandrel.blend_mm;
    options.mesh = job.mandrel.mesh;
    options.solid = job.mandrel.solid;
    options.edge_mm = job.mandrel.edge_mm.value_or(0.0);
    return options;
}

std::unique_ptr<Dialect> dialect_of(const Machine& machine, const fs::path& file) {
    const std::string& name = machine.controller.dialect;
    const std::string place = file.string() + ": /controller/dialect";
    if (carries_frames(machine)) {
        throw InputError("dialect.unknown", place,
                         "is \"" + name +
                             "\", which meshwind carry writes; for this command choose a machine "
                             "with another");
    }
    try {
        return make_dialect(name);
    } catch (const InputError& error) {
        throw InputError(error.code(), place, error.what());
    }
}

Setup make_setup(Mandrel mandrel, const Machine& machine, const Job& job, const InputFiles& files,
                 const std::function<void(const Setup&)>& look_ahead) {
    Setup setup;
    setup.machine = machine;
    setup.job = job;
    setup.friction = friction_of(job, 0);
    setup.rule_of_machine = take_rule_of_machine(setup.machine, setup.job.eye);
    setup.dialect = dialect_of(setup.machine, files.machine);
    setup.envelope = head_envelope(setup.machine);
    setup.mandrel = std::move(mandrel);
    take_given_unit(setup.mandrel, setup.job);
    if (look_ahead) {
        look_ahead(setup);
    }
    complete(setup, files.job);
    return setup;
}

Setup setup_for(const Setup& setup, Mandrel mandrel, std::size_t layer) {
    Setup next;
    next.machine = setup.machine;
    next.job = setup.job;
    next.friction = friction_of(setup.job, layer);
    next.rule_of_machine = setup.rule_of_machine;
    next.dialect = make_dialect(next.machine.controller.dialect);
    next.envelope = setup.envelope;
    next.mandrel = std::move(mandrel);
    complete(next, {});
    return next;
}

Tow planned_tow(const Setup& setup) {
    const Job::TowJob& tow = setup.job.tow;
    return {tow.width_mm, tow.thickness_mm, setup.friction.planned(), tow.bridging_tolerance_mm};
}

void put_pins(Setup& setup, std::span<const PinRing> rings) {
    std::vector<Pin> pins;
    double needed_mm = 0.0;
    for (const PinRing& ring : rings) {
        needed_mm = std::max(needed_mm, pin_extension_mm(ring, setup.job.tow.width_mm));
        const std::vector<Pin> more =
            pins_of(ring, setup.mandrel.rims[static_cast<std::size_t>(ring.rim)]);
        pins.insert(pins.end(), more.begin(), more.end());
    }
    Job::MandrelJob& job = setup.job.mandrel;
    const bool shortens = !job.extension_given && !rings.empty();
    if (shortens) {
        job.extension_mm = std::ceil(needed_mm);
    }
    setup.obstacles = obstacles_of(setup.machine, setup.mandrel, job.extension_mm, pins);
    setup.pins.assign(rings.begin(), rings.end());
    setup.wall = std::make_unique<LaydownSurface>(
        shortens ? extended_surface(setup.mandrel, job.extension_mm) : setup.wall->surface(),
        setup.wall->bridge_reach_mm(), std::move(pins));
}

bool wants_least_time(const Setup& setup) {
    return setup.job.redundancy == RedundancyRule::Optimal &&
           machine_class(setup.machine).free_turn;
}

Verification verify_program(const Setup& setup, const BlockList& program, const PlannedFibre& plan,
                            const std::function<void(double share)>& progress) {
    const Job& job = setup.job;
    const VerifyRules rules{.collision = setup.rule,
                            .friction = setup.friction,
                            .bridging_tolerance_mm = job.tow.bridging_tolerance_mm,
                            .tow_width_mm = job.tow.width_mm,
                            .most_twist_per_m = job.tow.most_twist_per_m,
                            .path_mode = setup.dialect->path_mode(setup.machine),
                            .laydown = {.deviation_mm = job.tolerance.laydown_mm,
                                        .angle_rad = rad_from_deg(job.tolerance.laydown_angle_deg)},
                            .simulation = {.progress = progress}};
    Verification found = verify({.program = program,
                                 .machine = setup.machine,
                                 .envelope = setup.envelope,
                                 .wall = *setup.wall,
                                 .obstacles = *setup.obstacles,
                                 .rules = rules,
                                 .plan = plan});
    // What the blocks say is not what a controller takes that slows down at corners.
    found.duration_s = setup.dialect->run_time_s(setup.machine, program);
    return found;
}

}  // namespace meshwind
