#include "cli/wind.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "cli/before_planning.h"
#include "cli/check_controller.h"
#include "cli/digest.h"
#include "cli/layup_files.h"
#include "cli/output_files.h"
#include "cli/page_data.h"
#include "cli/report.h"
#include "cli/report_page.h"
#include "cli/run_files.h"
#include "core/error.h"
#include "core/text_file.h"
#include "machines/eye_inverse.h"
#include "mesh/export.h"
#include "mesh/revolution.h"
#include "mesh/thicken.h"
#include "postproc/motion_csv.h"
#include "postproc/path_csv.h"
#include "version.h"
#include "winding/build_up.h"

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
std::optional<ImportRequest> import_of(const WindRequest& request, const LayerJob& layer) {
    if (request.import || layer.kind != LayerKind::Imported) {
        return request.import;
    }
    return ImportRequest{.points = request.job.parent_path() / layer.file};
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

// Turns on pins belong to a pattern, which says how many there are and where.
void refuse_pins_not_offered(const Job& job, const fs::path& file, bool read_layers) {
    const std::string mend = "give one layer of kind \"helical\" or \"lattice\" with its angle";
    if (!read_layers) {
        not_offered(file, "/mandrel/turn", "turning on pins with landing points that are given",
                    "use \"friction\"");
    }
    if (job.layers.size() > 1) {
        not_offered(file, "/mandrel/turn", "turning on pins with several layers", mend);
    }
    const LayerKind kind = job.layers.front().kind;
    if (kind != LayerKind::Helical && kind != LayerKind::Lattice) {
        not_offered(file, "/mandrel/turn", "turning on pins with layers of other kinds", mend);
    }
}

// What the job may ask for but this version does not do is refused at once, in words. Where landing
// points are given the layers are not read.
void refuse_what_is_not_offered(const Job& job, const fs::path& file, bool read_layers) {
    if (job.mandrel.turn == TurnKind::Pins) {
        refuse_pins_not_offered(job, file, read_layers);
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

std::string layer_words(std::size_t layer) {
    return "layer " + std::to_string(layer + 1);
}

class Winder {
public:
    explicit Winder(const WindRequest& request) : request_(request), watch_(result_.timing_s) {}

    WindResult run() {
        read();
        while (wind_next()) {
        }
        result_.program_written = result_.planned() && (result_.passed() || request_.force);
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
        WoundLayer& first = result_.layers.emplace_back();
        first.setup = read_setup({.mandrel = request_.mandrel,
                                  .machine = request_.machine,
                                  .job = request_.job,
                                  .unit_mm = request_.unit_mm,
                                  .look_ahead = [this](const Setup& setup) { look_ahead(setup); }});
        const Setup& setup = first.setup;
        spare_inputs(request_.out, {request_.mandrel, request_.machine, request_.job,
                                    request_.import ? request_.import->points : fs::path()});
        folder_ = std::make_unique<OutputFolder>(request_.out);  // unusable: better known now
        header_.version = kVersion;
        header_.mandrel = setup.mandrel.file;
        header_.mandrel_digest = "sha256 " + sha256_hex(read_text_file(request_.mandrel));
        header_.job_digest = "sha256 " + sha256_hex(job_text(setup.job));
        watch_.stage("import");
    }

    // What no plan can change is refused before there is one.
    void look_ahead(const Setup& setup) {
        check_controller(setup.machine, request_.machine);
        refuse_what_is_not_offered(setup.job, request_.job, !request_.import);
        const EyeLaw& eye = setup.job.eye;
        require_main_job(setup.machine, eye.rule == EyeRule::Cylinder ? eye.radius_mm : 0.0);
        refuse_turns_not_free(setup.job, request_.job, setup.machine);
        if (request_.import) {
            return;
        }
        const PlannedTask task{setup.machine, setup.envelope,   setup.mandrel,
                               setup.job,     request_.machine, request_.job};
        require_can_be_wound(task);
        result_.remarks = remarks_before_planning(task);
        if (request_.remark) {
            std::for_each(result_.remarks.begin(), result_.remarks.end(), request_.remark);
        }
    }

    // Winds the last layer that is there; adds the next one where there is one and this one can be
    // wound on.
    bool wind_next() {
        const std::size_t number = result_.layers.size() - 1;
        WoundLayer& layer = result_.layers.back();
        const std::vector<LayerJob>& jobs = layer.setup.job.layers;
        layer.job = jobs[number];
        WindLayerOptions options;
        options.suffix = layer_suffix(number);
        options.header = header_;
        options.import = import_of(request_, layer.job);
        if (number > 0) {
            options.before = &result_.layers[number - 1];
            options.bare = &result_.layers.front().setup.mandrel;
            for (const WoundLayer& before : result_.layers) {
                options.build_up_mm +=
                    before.build_up_mm.empty()
                        ? 0.0
                        : *std::max_element(before.build_up_mm.begin(), before.build_up_mm.end());
            }
        }
        options.seed = request_.seed;
        options.effort = request_.effort;
        options.progress = [&](const std::string& step, double share) {
            tell(jobs.size() > 1 ? layer_words(number) + ", " + step : step, share);
        };
        options.remark = request_.remark;
        options.stage_done = [this](const char* stage) { watch_.stage(stage); };
        wind_layer(layer, options);
        for (Check check : layer.checks) {
            check.name += options.suffix;
            if (check.place) {
                check.place->layer = number;
            }
            result_.checks.push_back(std::move(check));
        }
        if (!layer.plan.failure.empty() || request_.import || jobs.size() == 1) {
            return false;
        }
        layer.build_up_mm = build_up_of(layer);
        return number + 1 < jobs.size() && grow_next(layer, number + 1);
    }

    // The mandrel with a layer on it, for the next one.
    bool grow_next(const WoundLayer& layer, std::size_t number) {
        const Setup& setup = layer.setup;
        WoundLayer next;
        try {
            next.setup = setup_for(setup, thicken(setup.mandrel, layer.build_up_mm));
        } catch (const InputError& error) {
            result_.checks.push_back({"plan" + layer_suffix(number),
                                      false,
                                      layer_words(number) + ": " + error.what(),
                                      {}});
            return false;
        }
        header_.mandrel = mandrel_file(number);
        grown_.push_back(mesh_file_bytes(next.setup.mandrel.whole, MeshFormat::Obj));
        header_.mandrel_digest = "sha256 " + sha256_hex(grown_.back());
        result_.layers.push_back(std::move(next));
        watch_.stage("import");
        return true;
    }

    static std::vector<double> build_up_of(const WoundLayer& layer) {
        const Surface& surface = layer.setup.mandrel.surface;
        const Job::TowJob& tow = layer.setup.job.tow;
        if (layer.plan.planner == "pattern") {
            const RevolutionFinding found = find_revolution(layer.setup.mandrel);
            if (found.body) {
                return regular_build_up_mm(surface, *found.body, layer.plan.pieces, tow.width_mm,
                                           tow.thickness_mm);
            }
        }
        return build_up_mm(surface, layer.plan.face_layers, tow.width_mm, tow.thickness_mm);
    }

    static std::string mandrel_file(std::size_t layer) {
        return "mandrel" + layer_suffix(layer) + ".obj";
    }

    void write() {
        tell("write", 0.0);
        OutputFolder& folder = *folder_;
        folder.withdraw_earlier_run();
        std::optional<Layup> layup;
        if (result_.planned()) {
            for (std::size_t i = 0; i < result_.layers.size(); ++i) {
                add_layer(i);
            }
            layup.emplace(result_.layers, request_.seed);
            for (const MadeFile& file : layup_files(result_, *layup)) {
                folder.add(file.name, file.bytes);
            }
        }
        watch_.stage("write");
        const std::string report = report_json(result_);
        folder.add("report.json", report);
        if (layup && !page_template().empty()) {
            folder.add("report.html", report_page(page_data(result_, *layup, report)));
        }
        folder.publish();
    }

    void add_layer(std::size_t number) {
        const WoundLayer& layer = result_.layers[number];
        const auto fibres = fibres_of(layer.plan.pieces);
        for (std::size_t fibre = 0; fibre < fibres.size(); ++fibre) {
            const FibreProgram& program = layer.programs[fibre];
            const std::string suffix = layer_suffix(number) + fibre_suffix(fibre);
            folder_->add("path" + suffix + ".csv", [&](const auto& write) {
                write_path_csv(fibres[fibre], program.made.eyes.path, write);
            });
            folder_->add("motion" + suffix + ".csv",
                         motion_csv(layer.setup.machine, program.made.blocks));
            if (result_.program_written) {
                folder_->add(program.file, program.text);
            }
        }
        if (number > 0) {
            folder_->add(mandrel_file(number), grown_[number - 1]);
        }
    }

    const WindRequest& request_;
    WindResult result_;
    Stopwatch watch_;
    std::unique_ptr<OutputFolder> folder_;
    ProgramHeader header_;            // of the layer that is wound
    std::vector<std::string> grown_;  // mandrels of the second layer on, as files
};

}  // namespace

bool WindResult::planned() const {
    for (const WoundLayer& layer : layers) {
        if (!layer.plan.failure.empty()) {
            return false;
        }
    }
    return layers.back().import || layers.size() == layers.front().setup.job.layers.size();
}

WindResult wind(const WindRequest& request) {
    return Winder(request).run();
}

}  // namespace meshwind
