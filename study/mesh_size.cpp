#include "study/mesh_size.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>

#include "core/error.h"
#include "core/parallel.h"
#include "core/text/text_number.h"
#include "study/path_errors.h"

namespace meshwind {
namespace {

constexpr std::array kMethods{
    PathMethod{"walk", TraceMethod::Walk},
    PathMethod{"patches", TraceMethod::Patches},
};

// Fibre on one mesh: its exact points, every 0.1 mm, still fit into memory.
constexpr double kLongestFibreMm = 2e5;

// No fibre holds on more friction than its own weight of pressure.
constexpr double kLargestSlipRatio = 1.0;

// Traces are timed so many times; the fastest counts.
constexpr int kTimedRuns = 3;

// The exact paths of one mandrel: per slip ratio, per start.
using Exact = std::vector<std::vector<ReferencePath>>;

struct MandrelPaths {
    std::vector<CurveState> starts;
    Exact exact;
};

MandrelPaths exact_paths(const StudyMandrel& mandrel, const MeshSizeOptions& options) {
    MandrelPaths paths{random_starts(mandrel, options.paths, options.context.seed), {}};
    for (const double slip_ratio : options.slip_ratios) {
        std::vector<ReferencePath> exact(paths.starts.size());
        parallel_for(exact.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                exact[i] =
                    mandrel.reference->follow(paths.starts[i], slip_ratio, options.length_mm);
            }
        });
        paths.exact.push_back(std::move(exact));
    }
    return paths;
}

// One mesh and what was found on it, in the order of `for_each_case`.
struct MeshOutcome {
    double mean_edge_mm = 0.0;
    std::size_t triangles = 0;
    std::vector<PathErrors> errors;
    std::vector<MeshSizeTiming> timing;
    std::string remark;  // why there is no mesh
};

// Calls `use(method, index of the slip ratio)`.
template <class Use>
void for_each_case(const MeshSizeOptions& options, const Use& use) {
    for (const PathMethod& method : path_methods()) {
        for (std::size_t s = 0; s < options.slip_ratios.size(); ++s) {
            use(method, s);
        }
    }
}

class MeshStudy {
public:
    MeshStudy(const StudyMandrel& mandrel, const MandrelPaths& paths,
              const MeshSizeOptions& options)
        : mandrel_(mandrel), paths_(paths), options_(options) {}

    [[nodiscard]] MeshOutcome run(double edge_mm) const {
        MeshOutcome outcome;
        Surface surface;
        try {
            surface = mandrel_.mesh({edge_mm, options_.irregular, options_.context.seed});
        } catch (const InputError& error) {
            outcome.remark = error.what();
            return outcome;
        }
        const RayQuery query = query_of(surface);
        outcome.mean_edge_mm = surface.mean_edge_mm;
        outcome.triangles = surface.face.size();
        for_each_case(options_, [&](const PathMethod& method, std::size_t s) {
            std::vector<TraceResult> traced(paths_.starts.size());
            const auto trace_one = [&](std::size_t i) {
                const TraceOptions trace_options{.max_length_mm = options_.length_mm,
                                                 .method = method.method};
                const CurveState& start = paths_.starts[i];
                const double slip_ratio = options_.slip_ratios[s];
                traced[i] = trace(surface,
                                  start_at(surface, query, start.position_mm, trace_options.method),
                                  start.tangent, {slip_ratio, slip_ratio}, trace_options);
            };
            parallel_for(traced.size(), 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    trace_one(i);
                }
            });
            outcome.errors.push_back(errors_of(surface, traced, s, method.method));
            if (options_.timing) {
                outcome.timing.push_back(timed(traced, trace_one));
                outcome.timing.back().method = method.name;
                outcome.timing.back().slip_ratio = options_.slip_ratios[s];
                outcome.timing.back().edge_mm = edge_mm;
                outcome.timing.back().triangles = outcome.triangles;
            }
        });
        return outcome;
    }

private:
    [[nodiscard]] PathErrors errors_of(const Surface& surface,
                                       const std::vector<TraceResult>& traced, std::size_t s,
                                       TraceMethod method) const {
        const PathErrorOptions measure{.slip_ratio = options_.slip_ratios[s],
                                       .free_length_mm = options_.free_length_mm,
                                       .method = method,
                                       .pressed_kn_per_mm = pressed_kn_per_mm(traced)};
        std::vector<PathErrors> each(traced.size());
        parallel_for(traced.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                each[i] = path_errors(surface, traced[i].path, paths_.exact[s][i],
                                      *mandrel_.reference, measure);
            }
        });
        PathErrors all;
        for (const PathErrors& one : each) {
            all.add(one);
        }
        return all;
    }

    template <class TraceOne>
    [[nodiscard]] MeshSizeTiming timed(const std::vector<TraceResult>& traced,
                                       const TraceOne& trace_one) const {
        using Clock = std::chrono::steady_clock;
        double best_s = std::numeric_limits<double>::infinity();
        double length_mm = 0.0;
        std::size_t crossings = 0;
        for (const TraceResult& result : traced) {
            length_mm += result.path.back().s_mm;
            crossings += result.path.size() - 1;
        }
        for (int run = 0; run < kTimedRuns; ++run) {
            const auto begin = Clock::now();
            for (std::size_t i = 0; i < traced.size(); ++i) {
                trace_one(i);
            }
            best_s = std::min(best_s, std::chrono::duration<double>(Clock::now() - begin).count());
        }
        MeshSizeTiming timing;
        timing.mandrel = mandrel_.name;
        timing.ns_per_crossing = 1e9 * best_s / static_cast<double>(crossings);
        timing.ms_per_metre = 1e6 * best_s / length_mm;
        return timing;
    }

    const StudyMandrel& mandrel_;
    const MandrelPaths& paths_;
    const MeshSizeOptions& options_;
};

double log_slope(const MeshSizePoint& coarse, const MeshSizePoint& fine) {
    return std::log(coarse.rms / fine.rms) / std::log(coarse.mean_edge_mm / fine.mean_edge_mm);
}

void add_orders(MeshSizeLine& line) {
    for (std::size_t i = 1; i < line.points.size(); ++i) {
        const MeshSizePoint& coarse = line.points[i - 1];
        MeshSizePoint& fine = line.points[i];
        if (coarse.rms > 0.0 && fine.rms > 0.0 && coarse.mean_edge_mm > fine.mean_edge_mm) {
            fine.order = log_slope(coarse, fine);
        }
    }
}

std::vector<MeshSizeLine> lines_of(const StudyMandrel& mandrel, const MeshSizeOptions& options,
                                   std::span<const double> edges_mm,
                                   std::span<const MeshOutcome> meshes) {
    std::vector<MeshSizeLine> lines;
    std::size_t c = 0;
    for_each_case(options, [&](const PathMethod& method, std::size_t s) {
        const auto add = [&](Quantity quantity, std::optional<TangentRule> rule,
                             const auto& error_of) {
            MeshSizeLine line{mandrel.name, method.name, options.slip_ratios[s],
                              quantity,     rule,        {}};
            for (std::size_t m = 0; m < meshes.size(); ++m) {
                if (!meshes[m].remark.empty()) {
                    continue;
                }
                const ErrorSum& sum = error_of(meshes[m].errors[c]);
                if (sum.count > 0) {
                    line.points.push_back({edges_mm[m],
                                           meshes[m].mean_edge_mm,
                                           meshes[m].triangles,
                                           sum.rms(),
                                           sum.worst,
                                           {}});
                }
            }
            add_orders(line);
            lines.push_back(std::move(line));
        };
        add(Quantity::PathEnd, {}, [](const PathErrors& e) { return e.path_end_mm; });
        add(Quantity::WindingAngle, {}, [](const PathErrors& e) { return e.winding_angle_rad; });
        add(Quantity::Slip, {}, [](const PathErrors& e) { return e.slip; });
        for (std::size_t r = 0; r < kTangentRules.size(); ++r) {
            add(Quantity::SpindleAngle, kTangentRules[r],
                [r](const PathErrors& e) { return e.spindle_angle_rad[r]; });
            add(Quantity::EyePoint, kTangentRules[r],
                [r](const PathErrors& e) { return e.eye_mm[r]; });
        }
        ++c;
    });
    return lines;
}

class Steps {
public:
    Steps(const MeshSizeOptions& options, std::size_t count) : options_(options), count_(count) {}

    void begin(const std::string& step) {
        const std::scoped_lock lock(mutex_);
        options_.context.report_progress(step,
                                         static_cast<double>(done_) / static_cast<double>(count_));
    }
    void end() {
        const std::scoped_lock lock(mutex_);
        ++done_;
    }

private:
    const MeshSizeOptions& options_;
    std::size_t count_;
    std::size_t done_ = 0;
    std::mutex mutex_;
};

}  // namespace

std::span<const PathMethod> path_methods() {
    return kMethods;
}

const char* name_of(Quantity quantity) {
    switch (quantity) {
        case Quantity::PathEnd:
            return "path-end";
        case Quantity::WindingAngle:
            return "winding-angle";
        case Quantity::Slip:
            return "slip";
        case Quantity::SpindleAngle:
            return "spindle-angle";
        case Quantity::EyePoint:
            return "eye-point";
    }
    return "";
}

void MeshSizeOptions::validate() const {
    const auto positive = [](const std::string& name, double value) {
        if (!(value > 0.0) || !std::isfinite(value)) {
            throw InputError("study.not_positive", name, "must be a positive, finite number");
        }
    };
    for (const double edge_mm : edges_mm) {
        positive("edges", edge_mm);
    }
    positive("paths", paths);
    positive("length", length_mm);
    positive("free length", free_length_mm);
    if (edges_mm.empty()) {
        throw InputError("study.not_positive", "edges", "give at least one edge length");
    }
    if (paths * length_mm > kLongestFibreMm) {
        throw InputError("study.too_long", "paths times length",
                         fixed(1e-3 * paths * length_mm, 0) +
                             " m of fibre on a mesh; take at most " +
                             fixed(1e-3 * kLongestFibreMm, 0) + " m");
    }
    if (slip_ratios.empty() || !std::all_of(slip_ratios.begin(), slip_ratios.end(), [](double x) {
            return std::abs(x) <= kLargestSlipRatio;
        })) {
        throw InputError("study.slip_ratio", "lambda",
                         "give at least one, each from -" + fixed(kLargestSlipRatio, 0) + " to " +
                             fixed(kLargestSlipRatio, 0));
    }
}

MeshSizeStudy mesh_size_study(std::span<const StudyMandrel> mandrels,
                              const MeshSizeOptions& options) {
    options.validate();
    MeshSizeStudy study;
    study.edges_mm = options.edges_mm;
    std::vector<double>& edges_mm = study.edges_mm;
    std::sort(edges_mm.begin(), edges_mm.end(), std::greater<>());
    edges_mm.erase(std::unique(edges_mm.begin(), edges_mm.end()), edges_mm.end());
    const std::size_t meshes = edges_mm.size();
    Steps steps(options, mandrels.size() * (meshes + 1));
    std::vector<MandrelPaths> paths(mandrels.size());
    for (std::size_t m = 0; m < mandrels.size(); ++m) {
        steps.begin(mandrels[m].name + ", exact paths");
        paths[m] = exact_paths(mandrels[m], options);
        steps.end();
    }
    std::vector<MeshOutcome> outcomes(mandrels.size() * meshes);
    const auto run = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const StudyMandrel& mandrel = mandrels[i / meshes];
            const double edge_mm = edges_mm[i % meshes];
            steps.begin(mandrel.name + ", edges of " + fixed(edge_mm, 2) + " mm");
            outcomes[i] = MeshStudy(mandrel, paths[i / meshes], options).run(edge_mm);
            steps.end();
        }
    };
    if (options.timing) {
        run(0, outcomes.size());  // nothing else may run beside what is timed
    } else {
        parallel_for(outcomes.size(), 1, run);
    }
    for (std::size_t m = 0; m < mandrels.size(); ++m) {
        const auto mine = std::span(outcomes).subspan(m * meshes, meshes);
        std::size_t made = 0;
        for (const MeshOutcome& mesh : mine) {
            made += mesh.remark.empty() ? 1 : 0;
            study.timing.insert(study.timing.end(), mesh.timing.begin(), mesh.timing.end());
            if (!mesh.remark.empty()) {
                study.remarks.push_back(mandrels[m].name + " left out: " + mesh.remark);
            }
        }
        if (made == 0) {
            throw InputError("study.no_mesh", mandrels[m].name,
                             "none of the edge lengths can be used: " + mine.front().remark);
        }
        for (MeshSizeLine& line : lines_of(mandrels[m], options, edges_mm, mine)) {
            study.lines.push_back(std::move(line));
        }
    }
    return study;
}

std::optional<double> fitted_order(const MeshSizeLine& line) {
    double n = 0.0;
    double x = 0.0;
    double y = 0.0;
    double xx = 0.0;
    double xy = 0.0;
    for (const MeshSizePoint& p : line.points) {
        if (p.rms > 0.0) {
            const double u = std::log(p.mean_edge_mm);
            const double v = std::log(p.rms);
            n += 1.0;
            x += u;
            y += v;
            xx += u * u;
            xy += u * v;
        }
    }
    const double spread = n * xx - x * x;
    if (n < 2.0 || !(spread > 0.0)) {
        return {};
    }
    return (n * xy - x * y) / spread;
}

}  // namespace meshwind
