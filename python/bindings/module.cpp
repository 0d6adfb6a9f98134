#include <algorithm>
#include <csignal>
#include <exception>
#include <functional>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/error.h"
#include "core/files/project_files.h"
#include "core/interrupt.h"
#include "core/parallel.h"
#include "core/text/text_file.h"
#include "core/version.h"
#include "mesh/mandrel/load_mandrel.h"
#include "pipeline/load_inputs.h"
#include "pipeline/trials/trials.h"
#include "pipeline/verify_text.h"
#include "python/bindings/bindings.h"
#include "report/report_study.h"
#include "report/report_verify.h"
#include "study/study_run.h"

namespace meshwind {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

// While functions of ours run, in one thread or several, Ctrl-C ends them at their next
// cancellation points. Python's own handler only makes a note, which nobody reads before they
// return.
class EndsOnInterrupt {
public:
    EndsOnInterrupt() {
        const std::lock_guard lock(mutex_);
        if (++running_ == 1) {
            withdraw_interrupt();
            struct sigaction ours {};
            ours.sa_handler = [](int number) { request_interrupt(number); };
            sigemptyset(&ours.sa_mask);
            sigaction(SIGINT, &ours, &before_);
        }
    }
    ~EndsOnInterrupt() {
        const std::lock_guard lock(mutex_);
        if (--running_ == 0) {
            sigaction(SIGINT, &before_, nullptr);
            withdraw_interrupt();
        }
    }
    EndsOnInterrupt(const EndsOnInterrupt&) = delete;
    EndsOnInterrupt& operator=(const EndsOnInterrupt&) = delete;

private:
    static inline std::mutex mutex_;
    static inline int running_ = 0;
    static inline struct sigaction before_ {};
};

// The job of a file, or of a dictionary that Python has made a text.
struct JobSource {
    fs::path file;
    std::string text;

    [[nodiscard]] Job read() const {
        return text.empty() ? load_job(file) : job_of_text(text, "job", {});
    }
};

// A unit's word, or none: as the job and the file have it.
using Units = std::optional<std::string>;

double mm_of(const Units& units) {
    const std::optional<double> known = mm_per(units.value_or("auto"));
    if (!known) {
        throw std::invalid_argument("units are auto, um, mm, cm, m or in, not '" + *units + "'");
    }
    return *known;
}

std::function<void(const std::string&, double)> progress_of(const py::object& called) {
    if (called.is_none()) {
        return {};
    }
    // Contexts are copied by threads that do not have Python's lock.
    const std::shared_ptr<py::object> held(new py::object(called), [](const py::object* object) {
        const py::gil_scoped_acquire lock;
        delete object;
    });
    return [held](const std::string& step, double share) {
        const py::gil_scoped_acquire lock;
        (*held)(step, share);
    };
}

std::shared_ptr<Mandrel> load(const fs::path& file, const JobSource& job, const Units& units) {
    const EndsOnInterrupt ends;
    const py::gil_scoped_release unlock;
    return std::make_shared<Mandrel>(
        load_mandrel(find_input(file.string()), mandrel_options(job.read(), mm_of(units))));
}

// As the command line winds (cli/commands.cpp).
std::shared_ptr<OwnedRun> wind_file(const fs::path& mandrel, const fs::path& machine,
                                    const JobSource& source, const Units& units, std::uint64_t seed,
                                    double effort, bool force, const py::object& progress) {
    const EndsOnInterrupt ends;
    WindOptions options;
    options.context.seed = seed;
    options.context.effort = effort;
    options.context.progress = progress_of(progress);
    options.force = force;
    const py::gil_scoped_release unlock;
    const fs::path file = find_input(mandrel.string());
    options.files = {.machine = find_input(machine.string()), .job = source.file};
    require_machine_file(options.files.machine);
    const Machine loaded = load_machine(options.files.machine);
    const Job job = source.read();
    const MandrelOf read = mandrel_reader(file, mm_of(units), options.mandrel_digest);
    return std::make_shared<OwnedRun>(wind(read, loaded, job, options));
}

std::string verify_file(const fs::path& program, const fs::path& mandrel, const fs::path& machine,
                        const JobSource& source, const fs::path& plan, const Units& units,
                        std::uint64_t seed) {
    const EndsOnInterrupt ends;
    const py::gil_scoped_release unlock;
    const InputFiles files{.machine = find_input(machine.string()), .job = source.file};
    require_machine_file(files.machine);
    const Job job = source.read();
    Setup setup =
        make_setup(load_mandrel(find_input(mandrel.string()), mandrel_options(job, mm_of(units))),
                   load_machine(files.machine), job, files);
    VerifyInputs inputs;
    inputs.program = {program.string(), read_text_file(program)};
    if (!plan.empty()) {
        inputs.path = plan_table(plan, program, "path");
        inputs.motion = plan_table(plan, program, "motion");
    }
    RunContext context;
    context.seed = seed;
    return verify_json(verify_text(std::move(setup), inputs, context), 0.0);
}

std::shared_ptr<TracedPath> trace_on(const std::shared_ptr<Mandrel>& mandrel,
                                     const TraceRequest& request) {
    const EndsOnInterrupt ends;
    const py::gil_scoped_release unlock;
    return std::make_shared<TracedPath>(trace_path(*mandrel, request));
}

std::string study(const std::vector<fs::path>& files, const Units& units, MeshSizeOptions options,
                  const py::object& progress) {
    const EndsOnInterrupt ends;
    options.context.progress = progress_of(progress);
    const py::gil_scoped_release unlock;
    options.validate();
    const double shortest_mm = *std::min_element(options.edges_mm.begin(), options.edges_mm.end());
    std::vector<StudyMandrel> mandrels;
    for (const fs::path& file : files) {
        const std::string name = file.string();
        std::vector<StudyMandrel> known = known_studies(name, kStudyRadii_mm);
        if (known.empty()) {
            known.push_back(study_of_file(find_input(name), mm_of(units), shortest_mm));
        }
        std::move(known.begin(), known.end(), std::back_inserter(mandrels));
    }
    return study_json(run_study(mandrels, options));
}

// Python's own classes (python/meshwind/errors.py), found at the time of need.
void raise(const char* kind, const Error& error) {
    const py::object made = py::module_::import("meshwind.errors")
                                .attr(kind)(error.code(), error.place(), error.words());
    PyErr_SetObject(py::type::of(made).ptr(), made.ptr());
}

void translate(std::exception_ptr thrown) {
    try {
        std::rethrow_exception(std::move(thrown));
    } catch (const Interrupted&) {
        PyErr_SetNone(PyExc_KeyboardInterrupt);
    } catch (const InputError& error) {
        raise("InputError", error);
    } catch (const IoError& error) {
        raise("IoError", error);
    } catch (const NumericalError& error) {
        raise("NumericalError", error);
    } catch (const Error& error) {
        raise("Error", error);
    }
}

}  // namespace
}  // namespace meshwind

PYBIND11_MODULE(_meshwind, module) {
    using namespace meshwind;
    py::register_exception_translator(&translate);
    module.attr("__version__") = std::string(kVersion);
    bind_mandrel(module);
    bind_run(module);
    py::class_<JobSource>(module, "JobSource")
        .def(py::init<fs::path, std::string>(), py::arg("file"), py::arg("text"));
    module.def("set_threads", &set_thread_count, py::arg("threads"));
    module.def("load_mandrel", &load);
    module.def("wind", &wind_file);
    module.def("verify", &verify_file);
    module.def(
        "trace", [](const std::shared_ptr<Mandrel>& mandrel, const Eigen::Vector3d& start,
                    const std::optional<Eigen::Vector3d>& direction,
                    std::optional<double> angle_deg, const std::optional<Eigen::Vector3d>& to,
                    double slip_ratio, double length_mm, bool walk) {
            return trace_on(mandrel, {.start = start,
                                      .direction = direction,
                                      .angle_deg = angle_deg,
                                      .to = to,
                                      .slip_ratio = slip_ratio,
                                      .length_mm = length_mm,
                                      .method = walk ? TraceMethod::Walk : TraceMethod::Patches});
        });
    module.def("study_mesh_size", [](const std::vector<fs::path>& mandrels, const Units& units,
                                     const std::vector<double>& edges_mm, std::optional<int> paths,
                                     std::uint64_t seed, const py::object& progress) {
        MeshSizeOptions options;
        if (!edges_mm.empty()) {
            options.edges_mm = edges_mm;
        }
        options.paths = paths.value_or(options.paths);
        options.context.seed = seed;
        return study(mandrels, units, std::move(options), progress);
    });
}
