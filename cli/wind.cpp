#include "cli/wind.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "cli/digest.h"
#include "cli/fibre_files.h"
#include "cli/layup_vtu.h"
#include "cli/output_files.h"
#include "cli/plan_layer.h"
#include "cli/report.h"
#include "core/error.h"
#include "core/text_file.h"
#include "core/text_number.h"
#include "core/units.h"
#include "machines/eye_inverse.h"
#include "postproc/choose_blocks.h"
#include "postproc/dialect.h"
#include "postproc/motion_csv.h"
#include "postproc/path_csv.h"
#include "version.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

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

// The landing points to wind: those of the command, or of the job's layer.
std::optional<ImportRequest> import_of(const WindRequest& request, const Job& job) {
    if (request.import || job.layers.front().kind != LayerKind::Imported) {
        return request.import;
    }
    return ImportRequest{.points = request.job.parent_path() / job.layers.front().file};
}

void refuse_layers_not_offered(const Job& job, const fs::path& file) {
    if (job.layers.size() != 1) {
        not_offered(file, "/layers", "more than one layer", "give one layer");
    }
    const LayerKind kind = job.layers.front().kind;
    if (kind != LayerKind::Imported && !job.eye.lengths.empty()) {
        not_offered(file, "/eye/lengths",
                    "a free length by stretches of fibre that is yet to be planned",
                    "plan without it, then give path.csv and this job to meshwind post");
    }
}

// What the job may ask for but this version does not do is refused at once, in words. Where landing
// points are given the layers are not read.
void refuse_what_is_not_offered(const Job& job, const fs::path& file, bool read_layers) {
    if (job.mandrel.turn != TurnKind::Friction) {
        not_offered(file, "/mandrel/turn", "turning on pins or over a pole", "use \"friction\"");
    }
    if (read_layers) {
        refuse_layers_not_offered(job, file);
    }
}

// A job that says nothing gets the best that the machine can do; one that asks for a turn that the
// machine cannot choose is refused.
void refuse_turns_not_free(const Job& job, const fs::path& file, const Machine& machine) {
    const bool asks =
        job.redundancy == RedundancyRule::Hold || job.redundancy == RedundancyRule::Oscillate;
    if (asks && !machine_class(machine).free_turn) {
        throw InputError("job.turn_forced", file.string() + ": /redundancy",
                         machine.name +
                             " has fewer than three linear axes, so that the place of "
                             "the eye says how the mandrel turns; remove "
                             "\"redundancy\"");
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
        setup_.dialect->check(setup_.machine);
        mandrel_digest_ = "sha256 " + sha256_hex(read_text_file(request_.mandrel));
        refuse_what_is_not_offered(setup_.job, request_.job, !request_.import);
        const EyeLaw& eye = setup_.job.eye;
        require_main_job(setup_.machine, eye.rule == EyeRule::Cylinder ? eye.radius_mm : 0.0);
        refuse_turns_not_free(setup_.job, request_.job, setup_.machine);
        folder_ = std::make_unique<OutputFolder>(request_.out);  // unusable: better known now
        watch_.stage("import");
    }

    void plan() {
        if (const auto import = import_of(request_, setup_.job)) {
            tell("plan", 0.0);
            result_.plan = import_plan(setup_, *import, request_.seed, result_.import.emplace());
            watch_.stage("plan");
            return;
        }
        LayerPlanOptions options;
        options.seed = request_.seed;
        options.effort = request_.effort;
        options.refused = [this](std::span<const Piece> pieces) {
            return wind_whole(pieces, false);
        };
        options.progress = [this](const std::string& step, double share) { tell(step, share); };
        result_.plan = plan_layer(setup_, setup_.job.layers.front(), options);
        watch_.stage("plan");
    }

    // The way from a plan to its programs, and back: each is read from its text and wound again.
    // Returns the pieces that they do not lay as they are planned.
    std::vector<std::size_t> wind_whole(std::span<const Piece> pieces, bool in_spite) {
        watch_.stage("plan");
        result_.programs.clear();
        std::vector<std::size_t> refused;
        std::size_t before = 0;  // pieces
        for (const std::span<const Piece> fibre : fibres_of(pieces)) {
            FibreProgram& program = result_.programs.emplace_back();
            program.file = program_file(result_.programs.size() - 1);
            wind_fibre(fibre, in_spite, program);
            for (const auto& [piece, reason] : program.made.refused) {
                refused.push_back(before + piece);
            }
            before += fibre.size();
        }
        holds_ = refused.empty();
        return refused;
    }

    [[nodiscard]] std::string program_file(std::size_t fibre) const {
        return "program" + fibre_suffix(fibre) + setup_.dialect->extension();
    }

    void wind_fibre(std::span<const Piece> pieces, bool in_spite, FibreProgram& program) {
        PieceProgramOptions options;
        options.in_spite = in_spite;
        options.optimal = wants_least_time(setup_);
        options.through_text = [&](const PieceProgram& made) {
            return setup_.dialect->read(text_of(made), program.file, setup_.machine);
        };
        options.progress = [this](const char* step, double share) { tell(step, share); };
        options.stage_done = [this](const char* stage) { watch_.stage(stage); };
        program.made = program_of(setup_, pieces, options);
    }

    [[nodiscard]] static std::string place_of(const EyePoint& eye) {
        const Eigen::Vector3d& p = eye.landing_mm;
        return "piece " + std::to_string(eye.piece) + ", point " + std::to_string(eye.point) +
               " at (" + fixed(p.x(), 1) + ", " + fixed(p.y(), 1) + ", " + fixed(p.z(), 1) + ")";
    }

    void check() {
        check_fibres();
        if (result_.import) {
            check_import();
        } else {
            check_coverage();
        }
        for (std::size_t fibre = 0; fibre < result_.programs.size(); ++fibre) {
            std::vector<Check> found = checks_of(result_.programs[fibre].made);
            for (Check& check : found) {
                check.name += fibre_suffix(fibre);
                result_.checks.push_back(std::move(check));
            }
        }
        for (FibreProgram& program : result_.programs) {
            program.text = text_of(program.made);  // with what failed, for --force
        }
    }

    void check_fibres() {
        Check check{"continuity", result_.plan.fibres <= setup_.job.fibres, {}, {}};
        check.numbers = {{"fibres", static_cast<double>(result_.plan.fibres)},
                         {"limit", static_cast<double>(setup_.job.fibres)},
                         {"worst_joint_mm", result_.plan.worst_joint_mm}};
        if (!check.ok) {
            check.words =
                "the plan takes " + std::to_string(result_.plan.fibres) +
                " separate fibres; a slimmer head, less clearance, a longer extension or more "
                "friction gives more courses to join them";
        }
        result_.checks.push_back(check);
    }

    // Points too far off are refused before; how far they were tells of their mandrel.
    void check_import() {
        const ImportFit& fit = *result_.import;
        Check check{"import", true, {}, {}};
        check.numbers = {{"worst_mm", fit.worst_mm},
                         {"mean_mm", fit.mean_mm},
                         {"limit_mm", fit.limit_mm},
                         {"worst_line", static_cast<double>(fit.worst_line)}};
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

    [[nodiscard]] std::vector<Check> checks_of(const PieceProgram& made) const {
        std::vector<Check> checks{eye_check(made), rounding_check(made)};
        const std::vector<Check>& found = made.verification.checks;
        checks.insert(checks.end(), found.begin(), found.end());
        return checks;
    }

    [[nodiscard]] Check eye_check(const PieceProgram& made) const {
        const std::vector<std::size_t>& blocked = made.eyes.blocked;
        Check check{"eye", blocked.empty(), {}, {}};
        check.numbers = {{"blocked_points", static_cast<double>(blocked.size())}};
        if (!check.ok) {
            check.words = made.eyes.words + " at " + place_of(made.eyes.path[blocked.front()]);
        }
        return check;
    }

    [[nodiscard]] static Check rounding_check(const PieceProgram& made) {
        Check check{"rounding", made.read.nano == made.blocks.nano, {}, {}};
        check.numbers["blocks"] = static_cast<double>(made.read.blocks.size());
        if (!check.ok) {
            check.words = "the program read back does not give the positions that were planned";
        }
        return check;
    }

    [[nodiscard]] std::string text_of(const PieceProgram& made) const {
        ProgramHeader header;
        header.version = kVersion;
        header.mandrel = setup_.mandrel.file;
        header.mandrel_digest = mandrel_digest_;
        header.job_digest = "sha256 " + sha256_hex(job_text(setup_.job));
        header.fibre_length_mm = made.eyes.path.back().s_mm;
        header.tie_on_mm = made.eyes.path.front().landing_mm;
        for (const Check& check : result_.checks) {
            if (!check.ok) {
                header.notes.push_back("CHECK FAILED, written by force: " + check.name);
            }
        }
        return setup_.dialect->write(setup_.machine, made.blocks, made.layout, header);
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
        const auto fibres = fibres_of(result_.plan.pieces);
        for (std::size_t fibre = 0; fibre < kMostFibres; ++fibre) {
            const std::string path_file = "path" + fibre_suffix(fibre) + ".csv";
            const std::string motion_file = "motion" + fibre_suffix(fibre) + ".csv";
            const bool made = planned && fibre < fibres.size();
            if (made) {
                const PieceProgram& program = result_.programs[fibre].made;
                folder.add(path_file, path_csv(fibres[fibre], program.eyes.path));
                folder.add(motion_file, motion_csv(setup_.machine, program.blocks));
            } else {
                folder.withdraw(path_file);
                folder.withdraw(motion_file);
            }
            if (made && result_.program_written) {
                folder.add(program_file(fibre), result_.programs[fibre].text);
            } else {
                folder.withdraw(program_file(fibre));
            }
        }
        if (planned) {
            folder.add("layup.vtu", vtu());
        } else {
            folder.withdraw("layup.vtu");
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
