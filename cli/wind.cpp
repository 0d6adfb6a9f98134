#include "cli/wind.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "cli/digest.h"
#include "cli/layup_vtu.h"
#include "cli/output_files.h"
#include "cli/report.h"
#include "core/error.h"
#include "core/text_file.h"
#include "core/text_number.h"
#include "core/units.h"
#include "machines/kinematics.h"
#include "postproc/choose_blocks.h"
#include "postproc/dialect.h"
#include "postproc/motion_csv.h"
#include "postproc/path_csv.h"
#include "version.h"
#include "winding/cover.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

// Where the head has more room than that the corner may be cut by up to this much.
constexpr double kMostBetweenBlocks_mm = 2.0;

// And where a plan leaves less than nothing, blocks are not cut to crumbs for it: it is refused.
constexpr double kLeastBetweenBlocks_mm = 0.1;

// Laid fibre against the plan. For the choice of blocks a quarter is left for what the choice does
// not see: rounding to the axes' resolution (0.005 mm at 300 mm from the spindle) and the first
// order.
constexpr double kChoiceShare = 0.75;

// Share of the friction that is planned with: the rest is for what the blocks add.
constexpr double kPlannedFriction = 0.96;

// Share of the friction that plan and blocks may use together: the rest is for measuring it.
constexpr double kUsedFriction = 0.995;

// Share of the head's spare clearance that blocks may use: between two points it may be less.
constexpr double kUsedRoom = 0.5;

// Where the simulation finds blocks too coarse they get this share of the tolerance they had, so
// many times.
constexpr double kTighter = 0.5;
constexpr int kTighterRounds = 4;

// After so many rounds the same pieces still found too coarse are taken for beyond mending.
constexpr int kRoundsInVain = 1;

// Turns of less than this per mm (radius 100 m) are none.
constexpr double kStraight_per_mm = 1e-5;

// Share of the reachable wall that a plan must cover to count as one.
constexpr double kCoveredShare = 0.9;

class Stopwatch {
public:
    explicit Stopwatch(std::map<std::string, double>& timing) : timing_(timing) {}

    // Adds the time since the last call to a stage.
    void stage(const std::string& name) {
        const auto now = std::chrono::steady_clock::now();
        timing_[name] += std::chrono::duration<double>(now - last_).count();
        timing_["total"] = std::chrono::duration<double>(now - first_).count();
        last_ = now;
    }

private:
    std::map<std::string, double>& timing_;
    std::chrono::steady_clock::time_point first_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point last_ = first_;
};

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

class Winder {
public:
    explicit Winder(const WindRequest& request) : request_(request), watch_(result_.timing_s) {}

    WindResult run() {
        read();
        plan();
        if (result_.plan.failure.empty()) {
            if (!holds_) {
                (void)wind_through(result_.plan.pieces);
            }
            check();
        } else {
            result_.checks.push_back({"plan", false, result_.plan.failure, {}});
        }
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
        setup_ = read_setup({request_.mandrel, request_.machine, request_.job, request_.unit_mm});
        refuse_what_is_not_offered(setup_.job, request_.job);
        const SpindleWristInverse inverse(setup_.machine);       // refuses what cannot be solved
        folder_ = std::make_unique<OutputFolder>(request_.out);  // unusable: better known now
        watch_.stage("import");
    }

    // What the machine does for some pieces, point by point.
    struct Motion {
        EyePathResult eyes;  // at the stations
        EyePath path;        // with points between stations where the axes need them
        JointPath joints;    // along that path
    };

    [[nodiscard]] Motion motion_for(std::span<const Piece> pieces) const {
        constexpr RedundancyPolicy kPolicy = RedundancyPolicy::CentralAngle;
        Motion motion;
        motion.eyes = equal_free_length(pieces, *setup_.obstacles, setup_.rule.free_fibre);
        motion.path = refine_path(setup_.machine, motion.eyes.path, kPolicy, block_tolerance());
        motion.joints = solve_joints(setup_.machine, motion.path, kPolicy);
        return motion;
    }

    [[nodiscard]] BlockTolerance block_tolerance() const {
        BlockTolerance tolerance;
        tolerance.sideways_mm = kChoiceShare * setup_.job.tolerance.laydown_mm;
        tolerance.angle_rad = kChoiceShare * rad_from_deg(setup_.job.tolerance.laydown_angle_deg);
        tolerance.eye_mm = kMostBetweenBlocks_mm;
        return tolerance;
    }

    [[nodiscard]] CollisionReport collisions_of(const Motion& motion,
                                                const CollisionRule& rule) const {
        return check_collisions(setup_.machine, setup_.envelope, *setup_.obstacles, motion.path,
                                motion.joints, rule);
    }

    // Pieces, in a stretch of the plan, that the machine cannot wind, each with the first reason:
    // no free length, beyond an axis' travel, or hitting something.
    [[nodiscard]] std::map<std::size_t, Rejection> refused_pieces(
        std::span<const Piece> pieces) const {
        const Motion motion = motion_for(pieces);
        std::map<std::size_t, Rejection> refused;
        const auto refuse = [&](const EyePoint& point, Rejection reason) {
            refused.emplace(static_cast<std::size_t>(point.piece), reason);
        };
        for (const std::size_t point : motion.eyes.blocked) {
            refuse(motion.eyes.path[point], Rejection::FreeLength);
        }
        for (const LimitViolation& violation : motion.joints.violations) {
            refuse(motion.path[violation.point], Rejection::AxisTravel);
        }
        if (refused.empty()) {
            CollisionRule rule = setup_.rule;
            rule.told_mm = rule.clearance_mm;
            const CollisionReport report = collisions_of(motion, rule);
            for (const std::size_t point : report.fibre_hits) {
                refuse(motion.path[point], Rejection::FibreHit);
            }
            for (const std::size_t point : report.head_hits) {
                refuse(motion.path[point], Rejection::HeadHit);
            }
        }
        return refused;
    }

    void plan() {
        const Job& job = setup_.job;
        CoverOptions options;
        options.tow = {job.tow.width_mm, job.tow.thickness_mm, kPlannedFriction * job.tow.friction,
                       job.tow.bridging_tolerance_mm};
        options.turn.extension_mm = job.mandrel.extension_mm;
        options.free_fibre = setup_.rule.free_fibre;
        options.select.target_layers =
            static_cast<int>(std::ceil(job.layers.front().target_layers));
        if (const auto angle_deg = job.layers.front().angle_deg) {
            options.angle_rad = rad_from_deg(*angle_deg);
        }
        options.seed = request_.seed;
        options.effort = request_.effort;
        options.accept = [this](const Piece& piece) {
            const auto refused = refused_pieces({&piece, 1});
            return refused.empty() ? Rejection::None : refused.begin()->second;
        };
        options.refused = [this](std::span<const Piece> pieces) {
            std::vector<std::size_t> refused;
            for (const auto& [piece, reason] : refused_pieces(pieces)) {
                refused.push_back(piece);
            }
            if (refused.empty()) {
                refused = wind_through(pieces);
                holds_ = refused.empty();
            }
            return refused;
        };
        options.progress = [this](const char* step, double share) { tell(step, share); };
        result_.plan = plan_cover(setup_.mandrel, *setup_.obstacles, options);
        pieces_ = result_.plan.pieces;
        watch_.stage("plan");
    }

    // The way from a plan to its program, and back: the program is read from its text and wound
    // again, a few times where its blocks turn out too coarse. Returns the pieces that it does not
    // lay as they are planned.
    std::vector<std::size_t> wind_through(std::span<const Piece> pieces) {
        watch_.stage("plan");
        pieces_ = pieces;
        post_process();
        watch_.stage("post");
        std::set<std::size_t> refused;
        const bool one_fibre = std::count_if(pieces.begin(), pieces.end(), [](const Piece& piece) {
                                   return piece.starts_fibre;
                               }) == 1;
        for (int round = 0; one_fibre; ++round) {
            tell("verify", static_cast<double>(round) / kTighterRounds);
            read_ = setup_.dialect->read(result_.program, result_.program_file, setup_.machine);
            result_.verification = verify_program(setup_, read_, planned_fibre(pieces_));
            std::set<std::size_t> coarse;
            for (const std::size_t block : result_.verification.coarse_blocks) {
                coarse.insert(static_cast<std::size_t>(result_.blocks.blocks[block].piece));
            }
            const bool in_vain = round > kRoundsInVain && coarse == refused;
            refused = std::move(coarse);
            if (round == kTighterRounds || in_vain || !tighten()) {
                break;
            }
            make_program();
        }
        watch_.stage("verify");
        return {refused.begin(), refused.end()};
    }

    void post_process() {
        tell("post", 0.0);
        motion_ = motion_for(pieces_);
        result_.eyes = motion_.eyes;
        result_.path_points = motion_.path.size();
        tell("collisions", 0.5);
        room_mm_ = collisions_of(motion_, setup_.rule).clearance_mm;
        for (double& room : room_mm_) {
            room = std::clamp(kUsedRoom * (room - setup_.rule.clearance_mm), kLeastBetweenBlocks_mm,
                              kMostBetweenBlocks_mm);
        }
        share_.assign(motion_.path.size(), 1.0);
        make_program();
    }

    // Blocks for the motion, and their text.
    void make_program() {
        const std::vector<double> turn_room = turn_room_per_mm();
        result_.choice = choose_blocks(setup_.machine,
                                       {.path = motion_.path,
                                        .joints = motion_.joints,
                                        .room_mm = room_mm_,
                                        .turn_room_per_mm = turn_room,
                                        .share = share_},
                                       block_tolerance());
        const std::span<const std::size_t> ends = result_.choice.ends;
        const EyePath path = points_at(motion_.path, ends);
        const JointPath joints = points_at(motion_.joints, ends);
        const TimeLawOptions time{.fibre_speed_mm_s = setup_.job.speed.fibre_m_min * 1000.0 / 60.0};
        TimedBlocks timed =
            make_blocks(setup_.machine, path, joints, result_.choice.fibre_mm, time);
        result_.duration_s = timed.time.duration_s;
        result_.binding = std::move(timed.time.binding);
        // What the program runs, repeated circuits included.
        FoldedProgram folded = setup_.dialect->fold(setup_.dialect->prepare(std::move(timed.list)));
        result_.blocks = std::move(folded.list);
        result_.layout = std::move(folded.layout);
        write_program();
    }

    // Asks for finer blocks where the simulation found some too coarse; false where it found none.
    bool tighten() {
        const auto key = [](const auto& at) { return std::pair(at.piece, at.point); };
        bool any = false;
        std::size_t point = 0;
        for (const std::size_t block : result_.verification.coarse_blocks) {
            const auto from = key(result_.blocks.blocks[block > 0 ? block - 1 : 0]);
            const auto to = key(result_.blocks.blocks[block]);
            while (point < motion_.path.size() && key(motion_.path[point]) < from) {
                ++point;
            }
            for (; point < motion_.path.size() && key(motion_.path[point]) <= to; ++point) {
                share_[point] *= kTighter;
                any = true;
            }
        }
        return any;
    }

    // How much the blocks may turn the fibre on top of the plan without using up the friction, per
    // point; where the plan lifts the fibre off, as they like.
    [[nodiscard]] std::vector<double> turn_room_per_mm() const {
        std::vector<double> room;
        for (const EyePoint& point : motion_.path) {
            const Piece& piece = pieces_[static_cast<std::size_t>(point.piece)];
            const auto i = static_cast<std::size_t>(point.point);
            const double spare = kUsedFriction * setup_.job.tow.friction - piece.slip[i];
            room.push_back(piece.string.gap_mm[i] > 0.0
                               ? std::numeric_limits<double>::infinity()
                               : std::max(spare * piece.path[i].kn_per_mm, kStraight_per_mm));
        }
        return room;
    }

    [[nodiscard]] static std::string place_of(const EyePoint& eye) {
        const Eigen::Vector3d& p = eye.landing_mm;
        return "piece " + std::to_string(eye.piece) + ", point " + std::to_string(eye.point) +
               " at (" + fixed(p.x(), 1) + ", " + fixed(p.y(), 1) + ", " + fixed(p.z(), 1) + ")";
    }

    void check() {
        check_fibres();
        check_coverage();
        check_eyes();
        if (result_.plan.fibres == 1) {
            check_program();
        } else {
            check_planned_slip();
        }
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
            area_mm2[bare.rule] += bare.area_mm2;
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

    void check_eyes() {
        const std::vector<std::size_t>& blocked = result_.eyes.blocked;
        Check check{"eye", blocked.empty(), {}, {}};
        check.numbers = {{"blocked_points", static_cast<double>(blocked.size())}};
        if (!check.ok) {
            check.words = "no free fibre length between " +
                          fixed(setup_.rule.free_fibre.min_mm, 0) + " and " +
                          fixed(setup_.rule.free_fibre.max_mm, 0) + " mm is clear at " +
                          place_of(result_.eyes.path[blocked.front()]);
        }
        result_.checks.push_back(check);
    }

    // Several fibres make no program that could be wound again: what the plan says of itself.
    void check_planned_slip() {
        const Plan& plan = result_.plan;
        const Job::TowJob& tow = setup_.job.tow;
        Check slip{"slip", plan.worst_slip <= tow.friction, {}, {}};
        slip.numbers = {{"limit", tow.friction}, {"worst", plan.worst_slip}};
        Check bridging{"bridging", plan.worst_bridge_mm <= tow.bridging_tolerance_mm, {}, {}};
        bridging.numbers = {{"limit_mm", tow.bridging_tolerance_mm},
                            {"worst_mm", plan.worst_bridge_mm}};
        Check laydown{"laydown", false, "not wound again: one program winds one fibre", {}};
        for (Check* const check : {&slip, &bridging}) {
            check->words = check->ok ? "" : "the plan exceeds the limit";
        }
        result_.checks.insert(result_.checks.end(), {slip, bridging, laydown});
    }

    void check_program() {
        check_rounding();
        const std::vector<Check>& found = result_.verification.checks;
        result_.checks.insert(result_.checks.end(), found.begin(), found.end());
        write_program();  // with what failed, for --force
    }

    void check_rounding() {
        Check check{"rounding", read_.nano == result_.blocks.nano, {}, {}};
        check.numbers["blocks"] = static_cast<double>(read_.blocks.size());
        if (!check.ok) {
            check.words = "the program read back does not give the positions that were planned";
        }
        result_.checks.push_back(check);
    }

    void write_program() {
        ProgramHeader header;
        header.version = kVersion;
        header.mandrel = setup_.mandrel.file;
        header.mandrel_digest = "sha256 " + sha256_hex(read_text_file(request_.mandrel));
        header.job_digest = "sha256 " + sha256_hex(job_text(setup_.job));
        header.fibre_length_mm = result_.plan.fibre_length_mm;
        header.tie_on_mm = result_.eyes.path.front().landing_mm;
        for (const Check& check : result_.checks) {
            if (!check.ok) {
                header.notes.push_back("CHECK FAILED, written by force: " + check.name);
            }
        }
        result_.program_file = "program" + setup_.dialect->extension();
        result_.program =
            setup_.dialect->write(setup_.machine, result_.blocks, result_.layout, header);
    }

    [[nodiscard]] std::string vtu() const {
        const Surface& surface = setup_.mandrel.surface;
        const Plan& plan = result_.plan;
        std::vector<double> thickness;
        std::vector<double> angle_deg;
        for (std::size_t f = 0; f < plan.face_layers.size(); ++f) {
            thickness.push_back(plan.face_layers[f] * setup_.job.tow.thickness_mm);
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
            folder.add("motion.csv", motion_csv(setup_.machine, result_.blocks));
            folder.add("layup.vtu", vtu());
        } else {
            for (const char* const name : {"path.csv", "motion.csv", "layup.vtu"}) {
                folder.withdraw(name);
            }
        }
        if (result_.program_written) {
            folder.add(result_.program_file, result_.program);
        } else {
            folder.withdraw("program" + setup_.dialect->extension());
        }
        watch_.stage("write");
        folder.add("report.json", report_json(result_));
        folder.publish();
    }

    const WindRequest& request_;
    WindResult result_;
    Setup& setup_ = result_.setup;
    Stopwatch watch_;
    std::unique_ptr<OutputFolder> folder_;
    std::span<const Piece> pieces_;  // of the plan that is wound
    bool holds_ = false;             // the last plan that was wound is laid as it is planned
    Motion motion_;
    BlockList read_;               // the program as read back
    std::vector<double> room_mm_;  // per point of the motion: how far the eye may be off
    std::vector<double> share_;    // per point: of the tolerance, for blocks
};

}  // namespace

WindResult wind(const WindRequest& request) {
    return Winder(request).run();
}

}  // namespace meshwind
