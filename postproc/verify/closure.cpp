#include "postproc/verify/closure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/parallel.h"

namespace meshwind {
namespace {

// Parallels, evenly between the ends of the passes but for this share of the way at either: where
// the fibre turns by itself it runs along them.
constexpr int kParallels = 21;
constexpr double kLeftOut = 0.1;

// Pairs of circuits that are compared, about; of more circuits only some.
constexpr std::size_t kPairs = 200'000;

// Azimuths are known no better: the laid path is made of chords (postproc/verify/laydown.h).
constexpr double kKnown_rad = 1e-6;

// Corrections of a crossing from the chord to the cubic: each leaves a small share of the last.
constexpr int kSecants = 3;

constexpr std::size_t kChunk = 256;

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) {
        return *middle;
    }
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double azimuth(const PathPoint& point) {
    return std::atan2(point.position_mm.y(), point.position_mm.x());
}

// Azimuths at which a path crosses the parallel, in order.
std::vector<double> crossings(std::span<const PathPoint> path, double z_mm) {
    std::vector<double> found;
    for (std::size_t i = 1; i < path.size(); ++i) {
        const double before = path[i - 1].position_mm.z() - z_mm;
        const double after = path[i].position_mm.z() - z_mm;
        if ((before < 0.0) != (after < 0.0)) {
            const double from = azimuth(path[i - 1]);
            const double turn = std::remainder(azimuth(path[i]) - from, 2.0 * kPi);
            found.push_back(from + turn * before / (before - after));
        }
    }
    return found;
}

// Off its place, per circuit and by parallel and way; what does not count is left out.
struct Crossed {
    std::vector<std::vector<double>> off_rad;  // first those of the way back, then of the way out
    std::size_t parallels = 0;
};

Crossed crossed(std::span<const PathPoint> laid, std::span<const double> starts_rad, double low_mm,
                double high_mm) {
    const std::size_t n = starts_rad.size();
    Crossed found;
    found.off_rad.resize(n);
    std::vector<std::vector<double>> on;
    for (int k = 0; k < kParallels; ++k) {
        const double share = kLeftOut + (1.0 - 2.0 * kLeftOut) * k / (kParallels - 1);
        const std::vector<double> at = crossings(laid, low_mm + share * (high_mm - low_mm));
        if (at.size() >= 2 * n) {  // what comes before has led there
            on.emplace_back(at.end() - static_cast<std::ptrdiff_t>(2 * n), at.end());
        }
    }
    found.parallels = on.size();
    for (const std::size_t way : {std::size_t{1}, std::size_t{0}}) {
        const std::size_t first = 1 - way;  // the very first pass is left out
        for (const std::vector<double>& at : on) {
            const double some = at[2 * first + way] - starts_rad[first];
            for (std::size_t i = first; i < n; ++i) {
                found.off_rad[i].push_back(
                    std::remainder(at[2 * i + way] - starts_rad[i] - some, 2.0 * kPi));
            }
        }
    }
    return found;
}

struct Apart {
    double mean_rad = 0.0;
    double scatter_rad = 0.0;
};

Apart apart(const std::vector<double>& a, const std::vector<double>& b) {
    const std::size_t n = std::min(a.size(), b.size());
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
        sum += b[k] - a[k];
        squares += (b[k] - a[k]) * (b[k] - a[k]);
    }
    const double mean = sum / static_cast<double>(n);
    return {mean, std::sqrt(std::max(0.0, squares / static_cast<double>(n) - mean * mean))};
}

void measure_closure(const std::vector<std::vector<double>>& off_rad, LaidClosure& closure) {
    const std::size_t n = off_rad.size();
    const std::size_t step = 1 + n * n / 2 / kPairs;
    double moved = 0.0;
    double weights = 0.0;
    closure.resolution_rad = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; j += step) {
            const Apart found = apart(off_rad[i], off_rad[j]);
            const auto lag = static_cast<double>(j - i);
            const double known = std::hypot(found.scatter_rad, kKnown_rad);
            moved += lag * found.mean_rad / (known * known);
            weights += lag * lag / (known * known);
            closure.resolution_rad =
                std::min(closure.resolution_rad, known * static_cast<double>(n) / lag);
        }
    }
    closure.closure_rad = std::abs(moved / weights) * static_cast<double>(n);
}

// Medians per parallel and way, then per circuit.
void measure_drift(std::vector<std::vector<double>> off_rad, LaidClosure& closure) {
    const std::size_t ways = off_rad.back().size();
    for (std::size_t k = 0; k < ways; ++k) {
        std::vector<double> here;
        for (const std::vector<double>& circuit : off_rad) {
            if (k < circuit.size()) {
                here.push_back(circuit[k]);
            }
        }
        const double usual = median(here);
        for (std::vector<double>& circuit : off_rad) {
            if (k < circuit.size()) {
                circuit[k] -= usual;
            }
        }
    }
    for (std::size_t i = 0; i < off_rad.size(); ++i) {
        const double off = std::abs(median(off_rad[i]));
        if (off > closure.drift_rad) {
            closure.drift_rad = off;
            closure.drift_circuit = i;
        }
    }
}

// A path seen from a tube's line: how far along it its points are.
struct AlongTube {
    std::span<const PathPoint> path;
    std::vector<double> along_mm;
};

AlongTube along_tube(std::span<const PathPoint> path, const CentreLine& line) {
    AlongTube seen{path, std::vector<double>(path.size())};
    parallel_for(path.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            seen.along_mm[i] = line.foot(path[i].position_mm).arc_mm;
        }
    });
    return seen;
}

// Between two stations, by the cubic that their directions give.
Eigen::Vector3d between(const PathPoint& a, const PathPoint& b, double share) {
    const double length = (b.position_mm - a.position_mm).norm();
    const double r = 1.0 - share;
    return r * r * (1.0 + 2.0 * share) * a.position_mm +
           share * share * (3.0 - 2.0 * share) * b.position_mm +
           share * r * length * (r * a.tangent - share * b.tangent);
}

// Angles about the line at which a path crosses the section there, in order.
std::vector<double> crossings(const AlongTube& seen, const CentreLine& line, double along_mm) {
    const CentrePlace section = line.at(along_mm);
    std::vector<double> found;
    for (std::size_t i = 1; i < seen.path.size(); ++i) {
        const double before = seen.along_mm[i - 1] - along_mm;
        const double after = seen.along_mm[i] - along_mm;
        if ((before < 0.0) == (after < 0.0)) {
            continue;
        }
        const PathPoint& a = seen.path[i - 1];
        const PathPoint& b = seen.path[i];
        double share = before / (before - after);
        for (int step = 0; step < kSecants; ++step) {
            // The chord's slope will do for corrections as small as the bulge.
            const double off = line.foot(between(a, b, share)).arc_mm - along_mm;
            share = std::clamp(share + off / (before - after), 0.0, 1.0);
        }
        const Eigen::Vector3d out = between(a, b, share) - section.position_mm;
        found.push_back(std::atan2(out.dot(section.across()), out.dot(section.reference)));
    }
    return found;
}

}  // namespace

LaidClosure laid_closure(std::span<const PathPoint> laid, std::span<const double> starts_rad,
                         double low_mm, double high_mm) {
    LaidClosure closure;
    Crossed found = crossed(laid, starts_rad, low_mm, high_mm);
    closure.parallels = found.parallels;
    if (found.parallels == 0) {
        closure.failure = "the laid fibre crosses no parallel as often as the " +
                          std::to_string(starts_rad.size()) + " circuits of its pattern do";
        return closure;
    }
    measure_closure(found.off_rad, closure);
    measure_drift(std::move(found.off_rad), closure);
    return closure;
}

LaidClosure laid_tube_closure(std::span<const PathPoint> laid, std::span<const PathPoint> meant,
                              std::size_t circuits, const CentreLine& line,
                              std::span<const double> sections_mm) {
    const AlongTube of_laid = along_tube(laid, line);
    const AlongTube of_meant = along_tube(meant, line);
    const std::size_t passes = 2 * circuits;
    LaidClosure closure;
    std::vector<std::vector<double>> off_rad(circuits);
    for (const double section : sections_mm) {
        const std::vector<double> is = crossings(of_laid, line, section);
        const std::vector<double> was = crossings(of_meant, line, section);
        if (is.size() < passes || was.size() < passes) {
            continue;
        }
        ++closure.parallels;
        const auto off = [&](std::size_t pass) {
            return std::remainder(is[is.size() - passes + pass] - was[was.size() - passes + pass],
                                  2.0 * kPi);
        };
        for (std::size_t i = 0; i < circuits; ++i) {
            off_rad[i].push_back(0.5 * (off(2 * i) + off(2 * i + 1)));
        }
    }
    if (closure.parallels == 0) {
        closure.failure = "the laid fibre crosses no section of the tube as often as its " +
                          std::to_string(circuits) + " circuits do";
        return closure;
    }
    measure_closure(off_rad, closure);
    measure_drift(off_rad, closure);
    return closure;
}

}  // namespace meshwind
