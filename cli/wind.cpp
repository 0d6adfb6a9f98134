#include "cli/wind.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <sstream>

#include "cli/digest.h"
#include "cli/layup_vtu.h"
#include "cli/output_files.h"
#include "cli/report.h"
#include "core/error.h"
#include "core/text_number.h"
#include "core/units.h"
#include "machines/kinematics.h"
#include "machines/machine_json.h"
#include "mesh/import.h"
#include "postproc/dialect.h"
#include "postproc/motion_csv.h"
#include "postproc/path_csv.h"
#include "version.h"
#include "winding/cover.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

// The free fibre's ray starts two mesh edges along the tangent: nearer, the facet that holds the
// landing point itself may stand in the way; a wall within that distance would bridge first.
constexpr double kRayStartEdges = 2.0;

// Added to the clearance where free lengths are chosen: between two blocks the axes cut the corner
// of the eye's curve by up to this much, and the clearance must hold there as well.
constexpr double kBetweenBlocks_mm = 0.5;

// Clearances are tabulated this far around the mandrel: further out nothing of a head is in the
// way.
constexpr double kTableReach_mm = 60.0;

// Share of the reachable wall that a plan must cover to count as one.
constexpr double kCoveredShare = 0.9;

class Stopwatch {
public:
    explicit Stopwatch(std::map<std::string, double>& timing) : timing_(timing) {}

    void stage(const std::string& name) {
        const auto now = std::chrono::steady_clock::now();
        timing_[name] = std::chrono::duration<double>(now - last_).count();
        timing_["total"] = std::chrono::duration<double>(now - first_).count();
        last_ = now;
    }

private:
    std::map<std::string, double>& timing_;
    std::chrono::steady_clock::time_point first_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point last_ = first_;
};

std::string read_bytes(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream bytes;
    bytes << in.rdbuf();
    return bytes.str();
}

[[noreturn]] void not_offered(const fs::path& job, const std::string& pointer,
                              const std::string& value, const std::string& mend) {
    throw InputError("job.not_offered", job.string() + ": " + pointer,
                     value + " is not offered yet; " + mend);
}

// What the job may ask for but this version does not do is refused at once, in words.
void refuse_what_is_not_offered(const Job& job, const fs::path& file) {
    if (job.mandrel.turn != TurnKind::Friction) {
        not_offered(file, "/mandrel/turn", "turning on pins or over a pole", "use \"friction\"");
    }
    if (job.layers.size() != 1) {
        not_offered(file, "/layers", "more than one layer", "give one layer");
    }
    const LayerJob& layer = job.layers.front();
    if (layer.kind != LayerKind::Auto && layer.kind != LayerKind::Cover) {
        not_offered(file, "/layers/0/kind", "this kind of layer", "use \"cover\" or \"auto\"");
    }
    if (job.eye.rule != EyeRule::EqualFreeLength) {
        not_offered(file, "/eye/rule", "this rule", "use \"equal-free-length\"");
    }
    if (job.redundancy != RedundancyRule::CentralAngle) {
        not_offered(file, "/redundancy", "this rule", "use \"central-angle\"");
    }
}

MandrelOptions mandrel_options(const Job& job, double unit_mm) {
    MandrelOptions options;
    options.unit_mm = unit_mm > 0.0 ? unit_mm : mm_per(job.mandrel.units);
    if (job.mandrel.axis) {
        options.axis = {job.mandrel.axis->origin, job.mandrel.axis->direction};
    }
    options.keep_regions = job.mandrel.keep_regions;
    return options;
}

// The head as planning sees it: a ball around the eye that holds every part which turns with the
// last wrist axis, however that turns, and the other parts as capsules on the line away from the
// spindle, on which the central-angle policy keeps them.
void describe_head(const Machine& machine, const HeadEnvelope& envelope, FreeFibreRule& rule) {
    const Eigen::Vector3d& eye = machine.eye.position_mm;
    const Eigen::Vector3d outward = -machine.eye.exit;
    rule.head_radius_mm = 0.0;
    rule.arm.clear();
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
        if (part.link == machine.eye_chain.back().letter) {
            rule.head_radius_mm = std::max(rule.head_radius_mm, reach);
        } else {
            rule.arm.push_back(arm);
        }
    }
}

class Winder {
public:
    explicit Winder(const WindRequest& request) : request_(request), watch_(result_.timing_s) {}

    WindResult run() {
        read();
        plan();
        if (result_.plan.failure.empty()) {
            post_process();
            check();
        } else {
            result_.checks.push_back({"plan", false, result_.plan.failure, {}});
        }
        watch_.stage("post");
        write();
        return std::move(result_);
    }

private:
    void tell(const std::string& step, double share) const {
        if (request_.progress) {
            request_.progress(step, share);
        }
    }

    void read() {
        tell("import", 0.0);
        result_.machine = read_machine(request_.machine.string());
        if (!request_.job.empty()) {
            result_.job = read_job(request_.job);
        }
        refuse_what_is_not_offered(result_.job, request_.job);
        inverse_ = std::make_unique<SpindleWristInverse>(result_.machine);
        dialect_ = make_dialect(result_.machine.controller.dialect);
        envelope_ = head_envelope(result_.machine,
                                  [](const std::string& file) { return read_triangles(file); });
        result_.mandrel =
            load_mandrel(request_.mandrel, mandrel_options(result_.job, request_.unit_mm));
        set_up_rules();
        folder_ = std::make_unique<OutputFolder>(request_.out);  // unusable: better known now
        watch_.stage("import");
    }

    void set_up_rules() {
        const Job& job = result_.job;
        const Mandrel& mandrel = result_.mandrel;
        const FibreLimits& fibre = result_.machine.fibre;
        rule_.clearance_mm = job.tolerance.clearance_mm;
        FreeFibreRule& free = rule_.free_fibre;
        free.min_mm = fibre.min_free_length_mm;
        free.max_mm = fibre.max_free_length_mm;
        free.preferred_mm = job.eye.free_length_mm;
        if (free.preferred_mm < free.min_mm || free.preferred_mm > free.max_mm) {
            throw InputError("job.free_length", request_.job.string() + ": /eye/free_length",
                             fixed(free.preferred_mm, 1) + " mm is outside the " +
                                 fixed(free.min_mm, 1) + " to " + fixed(free.max_mm, 1) +
                                 " mm of the machine; choose a length between");
        }
        describe_head(result_.machine, envelope_, free);
        free.clearance_mm = job.tolerance.clearance_mm + kBetweenBlocks_mm;
        free.start_mm = std::min(kRayStartEdges * mandrel.surface.mean_edge_mm, 0.5 * free.min_mm);
        std::vector<TriangleSoup> parts{mandrel.whole};
        for (const Rim& rim : mandrel.rims) {
            if (job.mandrel.extension_mm > 0.0) {
                parts.push_back(extension_of(rim, job.mandrel.extension_mm));
            }
        }
        obstacles_ = std::make_unique<RayQuery>(parts, kTableReach_mm);
    }

    // Pieces, in a stretch of the plan, that the machine cannot wind, each with the first reason:
    // no free length, beyond an axis' travel, or hitting something.
    [[nodiscard]] std::map<std::size_t, Rejection> refused_pieces(
        std::span<const Piece> pieces) const {
        const EyePathResult eyes = equal_free_length(pieces, *obstacles_, rule_.free_fibre);
        std::map<std::size_t, Rejection> refused;
        const auto refuse = [&](std::size_t point, Rejection reason) {
            refused.emplace(static_cast<std::size_t>(eyes.path[point].piece), reason);
        };
        for (const std::size_t point : eyes.blocked) {
            refuse(point, Rejection::FreeLength);
        }
        const JointPath joints =
            solve_joints(result_.machine, eyes.path, RedundancyPolicy::CentralAngle);
        for (const LimitViolation& violation : joints.violations) {
            refuse(violation.point, Rejection::AxisTravel);
        }
        if (refused.empty()) {
            const CollisionReport report =
                check_collisions(result_.machine, envelope_, *obstacles_, eyes.path, joints, rule_);
            for (const std::size_t point : report.fibre_hits) {
                refuse(point, Rejection::FibreHit);
            }
            for (const std::size_t point : report.head_hits) {
                refuse(point, Rejection::HeadHit);
            }
        }
        return refused;
    }

    void plan() {
        const Job& job = result_.job;
        CoverOptions options;
        options.tow = {job.tow.width_mm, job.tow.thickness_mm, job.tow.friction,
                       job.tow.bridging_tolerance_mm};
        options.turn.extension_mm = job.mandrel.extension_mm;
        options.free_fibre = rule_.free_fibre;
        options.select.target_layers =
            static_cast<int>(std::ceil(job.layers.front().target_layers));
        options.seed = request_.seed;
        options.accept = [this](const Piece& piece) {
            const auto refused = refused_pieces({&piece, 1});
            return refused.empty() ? Rejection::None : refused.begin()->second;
        };
        options.refused = [this](std::span<const Piece> pieces) {
            std::vector<std::size_t> indices;
            for (const auto& [piece, reason] : refused_pieces(pieces)) {
                indices.push_back(piece);
            }
            return indices;
        };
        options.progress = [this](const char* step, double share) { tell(step, share); };
        result_.plan = plan_cover(result_.mandrel, *obstacles_, options);
        watch_.stage("plan");
    }

    void post_process() {
        tell("post", 0.0);
        const Plan& plan = result_.plan;
        result_.eyes = equal_free_length(plan.pieces, *obstacles_, rule_.free_fibre);
        joints_ = solve_joints(result_.machine, result_.eyes.path, RedundancyPolicy::CentralAngle);
        const TimeLawOptions time{.fibre_speed_mm_s =
                                      result_.job.speed.fibre_m_min * 1000.0 / 60.0};
        const TimedPath timed = time_path(result_.machine, result_.eyes.path, joints_, time);
        result_.duration_s = timed.duration_s;
        result_.binding = timed.binding;
        result_.blocks =
            dialect_->prepare(make_blocks(result_.machine, result_.eyes.path, joints_, timed));
        fold();
        tell("collisions", 0.5);
        collisions_ = check_collisions(result_.machine, envelope_, *obstacles_, result_.eyes.path,
                                       joints_, rule_);
    }

    // From here on the blocks are those that the program runs, repeated circuits included.
    void fold() {
        FoldedProgram folded = dialect_->fold(std::move(result_.blocks));
        result_.blocks = std::move(folded.list);
        result_.layout = std::move(folded.layout);
    }

    [[nodiscard]] std::string place_of(std::size_t point) const {
        const EyePoint& eye = result_.eyes.path[point];
        const Eigen::Vector3d& p = eye.landing_mm;
        return "piece " + std::to_string(eye.piece) + ", point " + std::to_string(eye.point) +
               " at (" + fixed(p.x(), 1) + ", " + fixed(p.y(), 1) + ", " + fixed(p.z(), 1) + ")";
    }

    void check() {
        check_fibres();
        check_coverage();
        check_slip();
        check_bridging();
        check_collision();
        check_limits();
        check_payout();
        check_rounding();
    }

    void check_fibres() {
        Check check{"continuity", result_.plan.fibres == 1, {}, {}};
        check.numbers = {{"fibres", static_cast<double>(result_.plan.fibres)},
                         {"worst_joint_mm", result_.plan.worst_joint_mm}};
        if (!check.ok) {
            check.words =
                "the plan takes " + std::to_string(result_.plan.fibres) +
                " separate fibres, one program winds one; a slimmer head, less clearance, a "
                "longer extension or more friction gives more courses to join them";
        }
        result_.checks.push_back(check);
    }

    // ": 12.3 cm2 are bare, for ..." with the reason that keeps most wall bare.
    [[nodiscard]] std::string largest_bare_wall() const {
        std::map<std::string, double> area_mm2;
        for (const Uncovered& bare : result_.plan.uncovered) {
            area_mm2[bare.reason] += bare.area_mm2;
        }
        const auto largest =
            std::max_element(area_mm2.begin(), area_mm2.end(),
                             [](const auto& a, const auto& b) { return a.second < b.second; });
        return largest == area_mm2.end() ? ""
                                         : "; " + fixed(largest->second / 100.0, 2) +
                                               " cm2 are bare for this: " + largest->first;
    }

    void check_coverage() {
        const Coverage& coverage = result_.plan.coverage;
        const double limit = kCoveredShare * coverage.reachable;
        Check check{"coverage", coverage.fraction >= limit, {}, {}};
        check.numbers = {{"limit", limit}, {"fraction", coverage.fraction}};
        if (!check.ok) {
            check.words = "only " + fixed(100.0 * coverage.fraction, 1) +
                          " % of the wall is covered although single courses reach " +
                          fixed(100.0 * coverage.reachable, 1) + " %" + largest_bare_wall();
        }
        result_.checks.push_back(check);
    }

    void check_slip() {
        const Plan& plan = result_.plan;
        const double limit = result_.job.tow.friction;
        Check check{"slip", plan.worst_slip <= limit, {}, {}};
        check.numbers = {{"limit", limit}, {"worst", plan.worst_slip}};
        if (!check.ok) {
            check.words = "slip ratio " + fixed(plan.worst_slip, 4) + " exceeds the friction " +
                          fixed(limit, 4);
        }
        result_.checks.push_back(check);
    }

    void check_bridging() {
        const Plan& plan = result_.plan;
        const double limit = result_.job.tow.bridging_tolerance_mm;
        Check check{"bridging", plan.worst_bridge_mm <= limit, {}, {}};
        check.numbers = {{"limit_mm", limit}, {"worst_mm", plan.worst_bridge_mm}};
        if (!check.ok) {
            check.words = "the fibre bridges by " + fixed(plan.worst_bridge_mm, 3) +
                          " mm, more than " + fixed(limit, 3) + " mm";
        }
        result_.checks.push_back(check);
    }

    void check_collision() {
        Check check{"collision", true, {}, {}};
        check.numbers = {{"fibre_hits", static_cast<double>(collisions_.fibre_hits.size())},
                         {"head_hits", static_cast<double>(collisions_.head_hits.size())},
                         {"blocked_points", static_cast<double>(result_.eyes.blocked.size())},
                         {"min_clearance_mm", collisions_.min_clearance_mm}};
        if (!result_.eyes.blocked.empty()) {
            check.ok = false;
            check.words = "no free fibre length between " + fixed(rule_.free_fibre.min_mm, 0) +
                          " and " + fixed(rule_.free_fibre.max_mm, 0) + " mm is clear at " +
                          place_of(result_.eyes.blocked.front());
        } else if (!collisions_.fibre_hits.empty()) {
            check.ok = false;
            check.words =
                "the free fibre meets the mandrel at " + place_of(collisions_.fibre_hits.front());
        } else if (!collisions_.head_hits.empty()) {
            check.ok = false;
            check.words = "the head comes within " + fixed(rule_.clearance_mm, 1) +
                          " mm of the mandrel at " + place_of(collisions_.head_hits.front());
        }
        result_.checks.push_back(check);
    }

    void check_limits() {
        Check check{"limits", joints_.violations.empty(), {}, {}};
        check.numbers["violations"] = static_cast<double>(joints_.violations.size());
        if (!check.ok) {
            const LimitViolation& worst = joints_.violations.front();
            const auto joint = result_.machine.joint_of(worst.axis).value_or(0);
            const bool rotary = result_.machine.axis(joint).type == AxisType::Rotary;
            const auto shown = [&](double value) {
                return rotary ? fixed(deg_from_rad(value), 2) + " deg" : fixed(value, 2) + " mm";
            };
            check.words = std::string("axis ") + worst.axis + " would go to " + shown(worst.value) +
                          ", past its end at " + shown(worst.limit) + ", at " +
                          place_of(worst.point);
        }
        result_.checks.push_back(check);
    }

    void check_payout() {
        const double back_mm = largest_take_back_mm(result_.eyes.path);
        const double limit = result_.machine.fibre.take_up_mm;
        Check check{"payout", back_mm <= limit, {}, {}};
        check.numbers = {{"limit_mm", limit}, {"worst_mm", back_mm}};
        if (!check.ok) {
            check.words = "the tensioner would have to take back " + fixed(back_mm, 1) +
                          " mm of fibre, more than its " + fixed(limit, 1) + " mm";
        }
        result_.checks.push_back(check);
    }

    // The program is read back from its text: every position must be the planned one within half a
    // step.
    void check_rounding() {
        tell("write", 0.0);
        write_program();
        const BlockList read =
            dialect_->read(result_.program, result_.program_file, result_.machine);
        Check check{"rounding", read.nano == result_.blocks.nano, {}, {}};
        check.numbers["blocks"] = static_cast<double>(read.blocks.size());
        if (!check.ok) {
            check.words = "the program read back does not give the positions that were planned";
        }
        result_.checks.push_back(check);
    }

    void write_program() {
        ProgramHeader header;
        header.version = kVersion;
        header.mandrel = result_.mandrel.file;
        header.mandrel_digest = "sha256 " + sha256_hex(read_bytes(request_.mandrel));
        header.job_digest = "sha256 " + sha256_hex(job_text(result_.job));
        header.fibre_length_mm = result_.plan.fibre_length_mm;
        header.tie_on_mm = result_.eyes.path.front().landing_mm;
        for (const Check& check : result_.checks) {
            if (!check.ok) {
                header.notes.push_back("CHECK FAILED, written by force: " + check.name);
            }
        }
        result_.program_file = "program" + dialect_->extension();
        result_.program = dialect_->write(result_.machine, result_.blocks, result_.layout, header);
    }

    [[nodiscard]] std::string vtu() const {
        const Surface& surface = result_.mandrel.surface;
        const Plan& plan = result_.plan;
        std::vector<double> thickness;
        std::vector<double> angle_deg;
        for (std::size_t f = 0; f < plan.face_layers.size(); ++f) {
            thickness.push_back(plan.face_layers[f] * result_.job.tow.thickness_mm);
            angle_deg.push_back(deg_from_rad(plan.face_angle_rad[f]));
        }
        const std::vector<CellArray> cells{
            {"layers", std::span<const double>(plan.face_layers)},
            {"thickness_mm", std::span<const double>(thickness)},
            {"fibre_angle_to_spindle_deg", std::span<const double>(angle_deg)},
            {"region", std::span<const std::int32_t>(surface.region)}};
        return layup_vtu(surface.position_mm, surface.face, cells);
    }

    void write() {
        const bool planned = result_.plan.failure.empty();
        result_.program_written = planned && (result_.passed() || request_.force);
        OutputFolder& folder = *folder_;
        if (planned) {
            folder.add("path.csv", path_csv(result_.plan.pieces, result_.eyes.path));
            folder.add("motion.csv", motion_csv(result_.machine, result_.blocks));
            folder.add("layup.vtu", vtu());
        } else {
            for (const char* const name : {"path.csv", "motion.csv", "layup.vtu"}) {
                folder.withdraw(name);
            }
        }
        if (result_.program_written) {
            folder.add(result_.program_file, result_.program);
        } else {
            folder.withdraw("program" + dialect_->extension());
        }
        watch_.stage("write");
        folder.add("report.json", report_json(result_));
        folder.publish();
    }

    const WindRequest& request_;
    WindResult result_;
    Stopwatch watch_;
    std::unique_ptr<SpindleWristInverse> inverse_;
    std::unique_ptr<Dialect> dialect_;
    std::unique_ptr<RayQuery> obstacles_;
    std::unique_ptr<OutputFolder> folder_;
    HeadEnvelope envelope_;
    CollisionRule rule_;
    JointPath joints_;
    CollisionReport collisions_;
};

}  // namespace

WindResult wind(const WindRequest& request) {
    return Winder(request).run();
}

}  // namespace meshwind
