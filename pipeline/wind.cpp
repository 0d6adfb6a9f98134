#include "pipeline/wind.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
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
#include "pipeline/part_words.h"
#include "pipeline/run_names.h"
#include "postproc/verify/check_kinds.h"
#include "winding/laminate/build_up.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

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
        run_.effort = options.context.effort;
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
        tell_origin(first.setup, job);
        watch_.stage("import");
    }

    // What the same run needs. The setup's job is what became of the job on this machine.
    void tell_origin(const Setup& setup, Job job) {
        job.mandrel.units = setup.job.mandrel.units;
        header_.job = told_job_text(job);
        run_.job = header_.job;
        if (options_.files.machine != InputFiles{}.machine) {
            header_.machine_file = options_.files.machine.filename().string();
        }
        if (!options_.import) {
            header_.run =
                MainJobRun{setup.mandrel.file, options_.context.seed, options_.context.effort};
        }
    }

    static std::string mesh_digest(const Mandrel& mandrel) {
        return short_digest(mesh_file_bytes(mandrel.whole, MeshFormat::Obj));
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
        options.least_joined = number == 0 ? options_.least_joined : 0.0;
        options.patterns_first = number == 0 && options_.patterns_first;
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

}  // namespace

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
