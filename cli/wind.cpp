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

// Share of the friction that is planned with: the rest is for what the blocks add.
constexpr double kPlannedFriction = 0.96;

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
                (void)wind_whole(result_.plan.pieces, true);
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
        mandrel_digest_ = "sha256 " + sha256_hex(read_text_file(request_.mandrel));
        refuse_what_is_not_offered(setup_.job, request_.job);
        const SpindleWristInverse inverse(setup_.machine);       // refuses what cannot be solved
        folder_ = std::make_unique<OutputFolder>(request_.out);  // unusable: better known now
        watch_.stage("import");
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
            return first_of(refused_by_machine(setup_, {&piece, 1}));
        };
        options.wind = [this](const Piece& piece) {
            return first_of(program_of(setup_, {&piece, 1}).refused);
        };
        options.refused = [this](std::span<const Piece> pieces) {
            std::vector<std::size_t> refused;
            for (const auto& [piece, reason] : wind_whole(pieces, false)) {
                refused.push_back(piece);
            }
            return refused;
        };
        options.progress = [this](const char* step, double share) { tell(step, share); };
        result_.plan = plan_cover(setup_.mandrel, *setup_.obstacles, options);
        watch_.stage("plan");
    }

    [[nodiscard]] static Rejection first_of(const std::map<std::size_t, Rejection>& refused) {
        return refused.empty() ? Rejection::None : refused.begin()->second;
    }

    // The way from a plan to its program, and back: the program is read from its text and wound
    // again. Returns the pieces that it does not lay as they are planned.
    const std::map<std::size_t, Rejection>& wind_whole(std::span<const Piece> pieces,
                                                       bool in_spite) {
        watch_.stage("plan");
        PieceProgramOptions options;
        options.in_spite = in_spite;
        options.through_text = [this](const PieceProgram& made) {
            write_program(made);
            return setup_.dialect->read(result_.program, result_.program_file, setup_.machine);
        };
        options.progress = [this](const char* step, double share) { tell(step, share); };
        options.stage_done = [this](const char* stage) { watch_.stage(stage); };
        result_.made = program_of(setup_, pieces, options);
        holds_ = result_.made.refused.empty();
        return result_.made.refused;
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
        write_program(result_.made);  // with what failed, for --force
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
        const std::vector<std::size_t>& blocked = result_.made.eyes.blocked;
        Check check{"eye", blocked.empty(), {}, {}};
        check.numbers = {{"blocked_points", static_cast<double>(blocked.size())}};
        if (!check.ok) {
            check.words = "no free fibre length between " +
                          fixed(setup_.rule.free_fibre.min_mm, 0) + " and " +
                          fixed(setup_.rule.free_fibre.max_mm, 0) + " mm is clear at " +
                          place_of(result_.made.eyes.path[blocked.front()]);
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
        const std::vector<Check>& found = result_.made.verification.checks;
        result_.checks.insert(result_.checks.end(), found.begin(), found.end());
    }

    void check_rounding() {
        Check check{"rounding", result_.made.read.nano == result_.made.blocks.nano, {}, {}};
        check.numbers["blocks"] = static_cast<double>(result_.made.read.blocks.size());
        if (!check.ok) {
            check.words = "the program read back does not give the positions that were planned";
        }
        result_.checks.push_back(check);
    }

    void write_program(const PieceProgram& made) {
        ProgramHeader header;
        header.version = kVersion;
        header.mandrel = setup_.mandrel.file;
        header.mandrel_digest = mandrel_digest_;
        header.job_digest = "sha256 " + sha256_hex(job_text(setup_.job));
        header.fibre_length_mm = result_.plan.fibre_length_mm;
        header.tie_on_mm = made.eyes.path.front().landing_mm;
        for (const Check& check : result_.checks) {
            if (!check.ok) {
                header.notes.push_back("CHECK FAILED, written by force: " + check.name);
            }
        }
        result_.program_file = "program" + setup_.dialect->extension();
        result_.program = setup_.dialect->write(setup_.machine, made.blocks, made.layout, header);
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
            folder.add("path.csv", path_csv(result_.plan.pieces, result_.made.eyes.path));
            folder.add("motion.csv", motion_csv(setup_.machine, result_.made.blocks));
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
    std::string mandrel_digest_;
    bool holds_ = false;  // the last plan that was wound is laid as it is planned
};

}  // namespace

WindResult wind(const WindRequest& request) {
    return Winder(request).run();
}

}  // namespace meshwind
