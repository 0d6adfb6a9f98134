#include "pipeline/wind.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "core/counted.h"
#include "core/error.h"
#include "core/text/digest.h"
#include "core/text/text_number.h"
#include "core/version.h"
#include "machines/eye_inverse.h"
#include "mesh/io/export.h"
#include "mesh/mandrel/thicken.h"
#include "mesh/revolution/revolution.h"
#include "pipeline/before_planning.h"
#include "pipeline/check_controller.h"
#include "pipeline/code_digest.h"
#include "pipeline/more_room.h"
#include "pipeline/part_words.h"
#include "pipeline/plan_layer.h"
#include "pipeline/run_names.h"
#include "postproc/verify/check_kinds.h"
#include "winding/laminate/build_up.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

// Radii that are tried where the blend is yet to be chosen, in tow widths.
constexpr std::array kBlendsInTows{0.0, 1.0, 2.0, 3.0, 4.0};

// To the micrometre: a few digits then name them.
constexpr double kBlendsPerMm = 1000.0;

// Under so much of the wall a larger blend is tried, although the plan can be wound.
constexpr double kWellCovered = 0.95;

// More fibres and longer extensions are tried so many times at most.
constexpr int kMostMends = 2;

// A cover of less of what courses reach does not fail by chance. What does is planned with so many
// seeds at most, and with fewer where other blends, fibres and extensions are tried too.
constexpr double kCoversMost = 0.75;
constexpr std::uint64_t kMostSeeds = 3;
constexpr std::uint64_t kSeedsOfTries = 2;

// By so much of the wall covers with two seeds differ; by .2 % mostly.
constexpr double kSeedsDiffer = 0.005;

// A plan of more fibres covers so much more of the wall, or it is not worth them.
constexpr double kWorthAFibre = 0.005;

// What is planned later to join the courses covers no more than this share on top.
constexpr double kJoinsCover = 0.02;

class Stopwatch {
public:
    Stopwatch(std::map<std::string, double>& timing, double reading_s)
        : timing_(timing), reading_s_(reading_s) {
        timing_["import"] = reading_s;
    }

    // Adds the time since the last call to a stage.
    void stage(const std::string& name) {
        const auto now = std::chrono::steady_clock::now();
        timing_[name] += std::chrono::duration<double>(now - last_).count();
        timing_["total"] = reading_s_ + std::chrono::duration<double>(now - first_).count();
        last_ = now;
    }

private:
    std::map<std::string, double>& timing_;
    double reading_s_;
    std::chrono::steady_clock::time_point first_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point last_ = first_;
};

[[noreturn]] void not_offered(const fs::path& job, const std::string& pointer,
                              const std::string& value, const std::string& mend) {
    throw InputError("job.not_offered", job.string() + ": " + pointer,
                     value + " is not offered yet; " + mend);
}

// The landing points to wind: those of the caller, or of the job's layer.
std::optional<ImportRequest> import_of(const WindOptions& options, const LayerJob& layer) {
    if (options.import || layer.kind != LayerKind::Imported) {
        return options.import;
    }
    return ImportRequest{.points = layer.points};
}

void refuse_layers_not_offered(const Job& job, const fs::path& file) {
    if (job.eye.lengths.empty()) {
        return;
    }
    if (job.layers.size() > 1) {
        not_offered(file, "/eye/lengths", "a free length by stretches for several layers",
                    "give one layer");
    }
    if (job.layers.front().kind != LayerKind::Imported) {
        not_offered(file, "/eye/lengths",
                    "a free length by stretches of fibre that is yet to be planned",
                    "plan without it, then give path.csv and this job to meshwind post");
    }
}

void refuse_turns_not_offered(const Job& job, const fs::path& file, bool read_layers) {
    const TurnKindTraits& turn = traits_of(job.mandrel.turn);
    const std::string why_not =
        turn.why_not != nullptr ? turn.why_not(job, !read_layers) : std::string();
    if (!why_not.empty()) {
        throw InputError("job.not_offered", file.string() + ": /mandrel/turn", why_not);
    }
}

// What the job may ask for but this version does not do is refused at once, in words. Where landing
// points are given the layers are not read.
void refuse_what_is_not_offered(const Job& job, const fs::path& file, bool read_layers) {
    refuse_turns_not_offered(job, file, read_layers);
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

std::string layer_words(std::size_t layer) {
    return "layer " + std::to_string(layer + 1);
}

class Winder {
public:
    explicit Winder(const WindOptions& options)
        : options_(options), watch_(run_.timing_s, options.reading_s) {
        run_.seed = options.context.seed;
    }

    Run wind(Mandrel&& mandrel, const Machine& machine, const Job& job) {
        begin(std::move(mandrel), machine, job);
        while (wind_next()) {
        }
        run_.usable = run_.planned() && (run_.passed() || options_.force);
        return std::move(run_);
    }

private:
    void begin(Mandrel&& mandrel, const Machine& machine, const Job& job) {
        WoundLayer& first = run_.layers.emplace_back();
        first.setup = make_setup(std::move(mandrel), machine, job, options_.files,
                                 [this](const Setup& setup) { look_ahead(setup); });
        header_.version = kVersion;
        header_.mandrel = first.setup.mandrel.file;
        header_.mandrel_digest = options_.mandrel_digest.empty() ? mesh_digest(first.setup.mandrel)
                                                                 : options_.mandrel_digest;
        header_.job_digest = job_digest(first.setup.job);
        watch_.stage("import");
    }

    static std::string mesh_digest(const Mandrel& mandrel) {
        return "sha256 " + sha256_hex(mesh_file_bytes(mandrel.whole, MeshFormat::Obj));
    }

    // What no plan can change is refused before there is one.
    void look_ahead(const Setup& setup) {
        const InputFiles& files = options_.files;
        check_controller(setup.machine, files.machine);
        refuse_what_is_not_offered(setup.job, files.job, !options_.import);
        const EyeLaw& eye = setup.job.eye;
        require_main_job(setup.machine, eye.rule == EyeRule::Cylinder ? eye.radius_mm : 0.0);
        refuse_turns_not_free(setup.job, files.job, setup.machine);
        if (options_.import) {
            return;
        }
        for (std::size_t i = 0; i < setup.job.layers.size(); ++i) {
            if (setup.job.layers[i].kind == LayerKind::Wall) {
                require_wall(setup.mandrel, setup.job, i, files.job);
            }
        }
        const PlannedTask task{setup.machine, setup.envelope, setup.mandrel,
                               setup.job,     files.machine,  files.job};
        require_can_be_wound(task);
        run_.remarks = remarks_before_planning(task);
        for (const std::string& remark : run_.remarks) {
            options_.context.report_remark(remark);
        }
    }

    // Winds the last layer that is there, a layer of the job or a stage of its wall; adds the next
    // one where there is one and this one can be wound on.
    bool wind_next() {
        const std::size_t number = run_.layers.size() - 1;
        WoundLayer& layer = run_.layers.back();
        const std::vector<LayerJob>& jobs = layer.setup.job.layers;
        layer.job = jobs[job_layer_];
        if (layer.job.kind == LayerKind::Wall && !wall_) {
            wall_.emplace(layer.setup.mandrel, layer.setup.job, job_layer_, options_.context.seed,
                          options_.files.job);
            run_.walls.push_back({number, number, wall_->figures(), wall_->asked_of_faces()});
        }
        std::optional<StageAsk> stage;
        WindLayerOptions options;
        if (wall_) {
            options.stage = &stage.emplace(wall_->next());
        }
        options.suffix = layer_suffix(number);
        options.header = header_;
        options.import = import_of(options_, layer.job);
        if (number > 0) {
            options.before = &run_.layers[number - 1];
            options.bare = &run_.layers.front().setup.mandrel;
            for (const WoundLayer& before : run_.layers) {
                options.build_up_mm +=
                    before.build_up_mm.empty()
                        ? 0.0
                        : *std::max_element(before.build_up_mm.begin(), before.build_up_mm.end());
            }
        }
        options.context = options_.context;
        if (jobs.size() > 1 || wall_) {
            options.context.progress = [&](const std::string& step, double share) {
                options_.context.report_progress(layer_words(number) + ", " + step, share);
            };
        }
        options.stage_done = [this](const char* stage) { watch_.stage(stage); };
        options.least_covered = number == 0 ? options_.least_covered : 0.0;
        wind_layer(layer, options);
        if (wall_ && wall_->laid() && !layer.plan.failure.empty()) {
            return give_up_stage();
        }
        if (!layer.plan.failure.empty()) {
            layer.checks.back().words += so_far();
        }
        if (number == 0 && !options_.import) {
            propose_mends(layer);
        }
        for (Check check : layer.checks) {
            check.name += options.suffix;
            if (check.place) {
                check.place->layer = number;
            }
            run_.checks.push_back(std::move(check));
        }
        if (!layer.plan.failure.empty() || options_.import) {
            return false;
        }
        if (wall_) {
            end_stage(layer, number);
        }
        job_layer_ += wall_ ? 0 : 1;
        run_.complete = job_layer_ == jobs.size();
        if (run_.complete && number == 0) {
            return false;
        }
        layer.build_up_mm = build_up_of(layer);
        return !run_.complete && grow_next(layer, number + 1);
    }

    // Of a wall that cannot be finished, what of it can be wound.
    [[nodiscard]] std::string so_far() const {
        return !wall_ || wall_->stages() == 0
                   ? std::string()
                   : "; the " + counted(wall_->stages(), "stage") +
                         " before can be wound, which are " + fixed(wall_->layers_so_far(), 1) +
                         " layers of the wall";
    }

    // A wall is laid but for a few places, for which there are no courses. What is next in the job
    // lies on the same mandrel.
    bool give_up_stage() {
        end_wall();
        ++job_layer_;
        run_.complete = job_layer_ == run_.layers.front().setup.job.layers.size();
        WoundLayer again;
        again.setup = std::move(run_.layers.back().setup);
        run_.layers.pop_back();
        if (!run_.complete) {
            run_.layers.push_back(std::move(again));
        }
        return !run_.complete;
    }

    void end_wall() {
        const WoundWall& wall = run_.walls.back();
        const double most_below = run_.layers.back().setup.job.tolerance.bare;
        Check& check = run_.checks.emplace_back(wall_check(wall.figures, most_below));
        check.name += layer_suffix(wall.first);
        wall_.reset();
    }

    // What lies there now, and the wall's check where that was the last stage.
    void end_stage(const WoundLayer& layer, std::size_t number) {
        wall_->enter(layer.setup.mandrel.surface, layer.plan);
        WoundWall& wall = run_.walls.back();
        wall.last = number;
        wall.figures = wall_->figures();
        if (wall_->done()) {
            end_wall();
        }
    }

    // What may help where little of the bare mandrel is covered.
    void propose_mends(const WoundLayer& layer) {
        if (layer.plan.failure.empty() && layer.plan.coverage.fraction >= kCoveredShare) {
            return;
        }
        const std::size_t told = run_.remarks.size();
        propose_blend(layer.setup.mandrel, layer.setup.job.tow.width_mm, run_.remarks);
        for (std::size_t i = told; i < run_.remarks.size(); ++i) {
            options_.context.report_remark(run_.remarks[i]);
        }
    }

    // The mandrel with a layer on it, for the next one.
    bool grow_next(const WoundLayer& layer, std::size_t number) {
        const Setup& setup = layer.setup;
        WoundLayer next;
        try {
            next.setup = setup_for(setup, thicken(setup.mandrel, layer.build_up_mm), number);
        } catch (const InputError& error) {
            Check& check = run_.checks.emplace_back(
                check_kind::kPlan, false, layer_words(number) + ": " + error.what() + so_far());
            check.name += layer_suffix(number);
            return false;
        }
        header_.mandrel = grown_mandrel_name(number);
        header_.mandrel_digest = mesh_digest(next.setup.mandrel);
        run_.layers.push_back(std::move(next));
        watch_.stage("import");
        return true;
    }

    static std::vector<double> build_up_of(const WoundLayer& layer) {
        const Surface& surface = layer.setup.mandrel.surface;
        const Job::TowJob& tow = layer.setup.job.tow;
        if (layer.plan.planner == Planner::Pattern) {
            const RevolutionFinding found = find_revolution(layer.setup.mandrel);
            if (found.body) {
                return regular_build_up_mm(surface, *found.body, layer.plan.pieces, tow.width_mm,
                                           tow.thickness_mm);
            }
        }
        return build_up_mm(surface, layer.plan.face_layers, tow.width_mm, tow.thickness_mm);
    }

    const WindOptions& options_;
    Run run_;
    Stopwatch watch_;
    ProgramHeader header_;            // of the layer that is wound
    std::size_t job_layer_ = 0;       // of the job, that is wound
    std::optional<WallStages> wall_;  // while that is one
};

const Plan& first_plan(const Run& run) {
    return run.layers.front().plan;
}

double covered_share(const Run& run) {
    return first_plan(run).coverage.fraction;
}

// A cover that was too bare to be wound (WindOptions::least_covered).
bool was_too_bare(const Run& run) {
    const Plan& plan = first_plan(run);
    return plan.planner == Planner::Cover && !plan.failure.empty() && plan.coverage.fraction > 0.0;
}

bool stands(const Run& run) {
    return run.planned() && run.passed();
}

// A fibre more is a stop of the machine more.
bool is_better(const Run& run, const Run& than) {
    if (stands(run) != stands(than)) {
        return stands(run);
    }
    const bool pays = stands(run) && first_plan(run).fibres > first_plan(than).fibres;
    return covered_share(run) > covered_share(than) + (pays ? kWorthAFibre : 0.0);
}

// A cover that is wound, covers most of what it can, and fails: courses that the machine refuses
// in their places, which another choice of courses has elsewhere, leave wall bare or fail
// themselves. What fails for bare wall alone does so by chance where little lacks.
bool fails_by_chance(const Run& run) {
    const Plan& plan = first_plan(run);
    if (plan.planner != Planner::Cover || !run.walls.empty() || !run.planned() || run.passed()) {
        return false;
    }
    const bool covers_alone = std::all_of(
        run.checks.begin(), run.checks.end(),
        [](const Check& check) { return check.ok || check.name == check_kind::kCoverage.name; });
    const double bare = run.layers.front().setup.job.tolerance.bare;
    return plan.coverage.fraction >= (covers_alone
                                          ? least_covered(plan.coverage, bare) - kSeedsDiffer
                                          : kCoversMost * plan.coverage.reachable);
}

// "with 2 fibres, extensions of 150 mm and a blend of 6.0 mm 97.1 % of the wall is covered, ..."
std::string tried_words(const Run& run) {
    const Job& job = run.layers.front().setup.job;
    const auto failed = std::count_if(run.checks.begin(), run.checks.end(),
                                      [](const Check& check) { return !check.ok; });
    return "with " + std::to_string(job.fibres) + (job.fibres == 1 ? " fibre" : " fibres") +
           ", extensions of " + fixed(job.mandrel.extension_mm, 0) + " mm and " +
           (job.mandrel.blend_mm > 0.0 ? "a blend of " + fixed(*job.mandrel.blend_mm, 1) + " mm "
                                       : std::string("no blend ")) +
           percent(covered_share(run), 1) + " of the wall " +
           (was_too_bare(run) ? "can be covered, and nothing is wound"
                              : "is covered, and " + counted(failed, "check") +
                                    (failed == 1 ? " fails" : " fail"));
}

// What the job has to say for the same run.
std::string settings_words(const Job& job) {
    std::string words = "--set fibres=" + std::to_string(job.fibres) + " --set mandrel.extension=";
    append_shortest(words, job.mandrel.extension_mm);
    if (job.mandrel.blend_mm > 0.0) {
        words += " --set mandrel.blend=";
        append_shortest(words, *job.mandrel.blend_mm);
    }
    return words;
}

// Runs of the main job on one file, of which the best stands.
class Trials {
public:
    Trials(const MandrelOf& mandrel, const Machine& machine, const WindOptions& options)
        : mandrel_(mandrel), machine_(machine), options_(options) {}

    enum class Depth { Full, WhereItCovers };

    /// Once, and where that fails by chance with the next seeds. \throws as wind() does for the
    /// first job
    void run(const Job& job, Depth depth) {
        const std::uint64_t seeds = depth == Depth::Full ? kMostSeeds : kSeedsOfTries;
        by_chance_ = true;
        for (std::uint64_t k = 0; by_chance_ && k < seeds; ++k) {
            try {
                take(once(job, depth, options_.context.seed + k));
            } catch (const InputError& error) {
                if (!best_) {
                    throw;
                }
                tried_.push_back(settings_words(job) + " cannot be wound: " + error.what());
                return;  // of no use for what stands
            }
        }
    }

    // More room for the best run, and for what comes of it.
    void mend() {
        next_ = room_for(*best_);
        for (int mend = 0; mend < kMostMends && next_; ++mend) {
            run(*std::exchange(next_, std::nullopt), Depth::WhereItCovers);
        }
    }

    [[nodiscard]] bool done() const { return stands(*best_); }

    /// Share of the wall that the best covers.
    [[nodiscard]] double covered() const { return covered_share(*best_); }

    [[nodiscard]] Run best() && {
        const bool cut_short = was_too_bare(*best_);
        if (cut_short) {
            best_ = once(Job(best_->layers.front().setup.job), Depth::Full, best_->seed);
        }
        if (tried_.size() > 1) {
            if (!cut_short) {
                options_.context.report_remark(tried_.back());
            }
            tried_.push_back(
                "what stands is the job with " + settings_words(best_->layers.front().setup.job) +
                (best_->seed == options_.context.seed ? ""
                                                      : " --seed " + std::to_string(best_->seed)));
            options_.context.report_remark(tried_.back());
            best_->remarks.insert(best_->remarks.end(), tried_.begin(), tried_.end());
        }
        return *std::move(best_);
    }

private:
    static std::optional<Job> room_for(const Run& run) {
        const Job& job = run.layers.front().setup.job;
        return stands(run) ? more_fibres(job, first_plan(run)) : more_room(job, first_plan(run));
    }

    void take(Run&& run) {
        tried_.push_back(tried_words(run) + (run.seed == options_.context.seed
                                                 ? ""
                                                 : ", with seed " + std::to_string(run.seed)));
        next_ = room_for(run);
        by_chance_ = fails_by_chance(run);
        if (!best_ || is_better(run, *best_)) {
            best_ = std::move(run);
        }
    }

    [[nodiscard]] Run once(const Job& job, Depth depth, std::uint64_t seed) {
        if (!tried_.empty()) {
            options_.context.report_remark(tried_.back());
        }
        const auto begun = std::chrono::steady_clock::now();
        Mandrel read = mandrel_(job);
        WindOptions options = options_;
        options.context.remark = [this](const std::string& words) {
            if (said_.insert(words).second) {
                options_.context.report_remark(words);
            }
        };
        options.context.seed = seed;
        options.least_covered = depth == Depth::Full ? 0.0 : kCoveredShare - kJoinsCover;
        options.reading_s +=
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
        return wind(std::move(read), machine_, job, options);
    }

    const MandrelOf& mandrel_;
    const Machine& machine_;
    const WindOptions& options_;
    std::optional<Run> best_;
    std::optional<Job> next_;  // that may mend the last run that was wound
    bool by_chance_ = false;   // did that fail
    std::set<std::string> said_;
    std::vector<std::string> tried_;
};

}  // namespace

Run wind(const MandrelOf& mandrel, const Machine& machine, const Job& job,
         const WindOptions& options) {
    Trials trials(mandrel, machine, options);
    if (job.mandrel.blend_mm || options.import) {
        trials.run(job, Trials::Depth::Full);
    } else {
        // A blend does more than fibres and extensions do, and takes no longer: all of them before.
        // One that can be wound is the last, where it covers well or no more than a smaller one.
        double covered_before = 0.0;
        for (const double widths : kBlendsInTows) {
            Job asked = job;
            asked.mandrel.blend_mm =
                std::round(kBlendsPerMm * widths * job.tow.width_mm) / kBlendsPerMm;
            trials.run(asked, Trials::Depth::WhereItCovers);
            const double gained =
                trials.covered() - std::exchange(covered_before, trials.covered());
            if (trials.done() && (covered_before >= kWellCovered || gained < kSeedsDiffer)) {
                break;
            }
        }
    }
    trials.mend();
    return std::move(trials).best();
}

bool Run::planned() const {
    for (const WoundLayer& layer : layers) {
        if (!layer.plan.failure.empty()) {
            return false;
        }
    }
    return layers.back().import || complete;
}

Run wind(Mandrel mandrel, const Machine& machine, const Job& job, const WindOptions& options) {
    return Winder(options).wind(std::move(mandrel), machine, job);
}

}  // namespace meshwind
