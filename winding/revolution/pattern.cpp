#include "winding/revolution/pattern.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <tuple>

#include "core/units.h"
#include "mesh/shapes/make_checks.h"

namespace meshwind {
namespace {

// Places and sums of axis steps: circuits * turns * units goes up to 1e4 * 1e9 * 1e12.
using Wide = __int128;

constexpr const char* kRange = "pattern.out_of_range";
constexpr double kTurn_rad = 2.0 * kPi;

// More circuits than any mandrel has room for (a tank of 9 m around, wound with a band of 1 mm);
// the search goes over the square of it.
constexpr std::int64_t kMaxCircuits = 10'000;
constexpr double kMaxCircuitTurns = 1e5;
constexpr std::int64_t kMaxUnits = 1'000'000'000'000;

// Overlaps and dwells within one step of these are as good as each other: a percent of the band is
// less than its width varies, 5 degrees are 4 mm of fibre on a radius of 50 mm.
constexpr double kOverlapStep = 0.01;
constexpr double kDwellStep_rad = 5.0 * kPi / 180.0;

// Share of a circuit that is no reason for one circuit more: bands that are a whole part of the
// circle come with rounding.
constexpr double kSameCount = 1e-9;

std::int64_t whole(double value) {
    return static_cast<std::int64_t>(std::llround(value));
}

std::int64_t ceil_count(double value) {
    return whole(std::ceil(value - kSameCount));
}

// a^-1 mod n by Euclid's algorithm. \pre gcd(a, n) = 1, n > 0
std::int64_t inverse(std::int64_t a, std::int64_t n) {
    std::int64_t r0 = n;
    std::int64_t r1 = a % n;
    std::int64_t x0 = 0;
    std::int64_t x1 = 1;
    while (r1 != 0) {
        const std::int64_t q = r0 / r1;
        std::tie(r0, r1) = std::pair(r1, r0 - q * r1);
        std::tie(x0, x1) = std::pair(x1, x0 - q * x1);
    }
    return (x0 % n + n) % n;
}

struct Cover {
    double band_rad = 0.0;
    int layers = 1;
};

Pattern closed(std::int64_t circuits, std::int64_t turns, const Cover& cover) {
    Pattern p;
    p.circuits = circuits;
    p.turns = turns;
    const std::int64_t ahead = inverse(turns, circuits);  // its band lies one step on
    p.order = 2 * ahead <= circuits ? BandOrder::Leading : BandOrder::Lagging;
    p.starts = std::max<std::int64_t>(1, p.order == BandOrder::Leading ? ahead : circuits - ahead);
    p.skip = (p.starts * turns - (p.order == BandOrder::Leading ? 1 : -1)) / circuits;
    const auto n = static_cast<double>(circuits);
    p.turn_rad = kTurn_rad * static_cast<double>(turns) / n;
    p.step_rad = kTurn_rad / n;

    const double deep = n * cover.band_rad / kTurn_rad;  // layers on average
    p.overlap = deep / cover.layers - 1.0;
    p.least_layers = whole(std::floor(deep + kSameCount));
    p.most_layers = ceil_count(deep);
    const double share = std::max(0.0, deep - static_cast<double>(p.least_layers));  // one more
    p.ripple = std::sqrt(share * (1.0 - share)) / deep;
    return p;
}

void set_dwell(Pattern& pattern, double circuit_rad, double least_dwell_rad,
               double most_dwell_rad) {
    const double extra_rad = pattern.turn_rad - circuit_rad;
    pattern.dwell_rad = std::clamp(extra_rad, least_dwell_rad, most_dwell_rad);
    pattern.change_rad = extra_rad - pattern.dwell_rad;
}

std::int64_t steps(double value, double step) {
    return whole(std::floor(value / step + kSameCount));
}

bool better(const Pattern& a, const Pattern& b, std::int64_t wanted_starts) {
    const auto key = [&](const Pattern& p) {
        const double added_rad = p.dwell_rad + std::abs(p.change_rad);
        const std::int64_t off_wish = wanted_starts > 0 ? std::abs(p.starts - wanted_starts) : 0;
        return std::tuple(steps(std::abs(p.overlap), kOverlapStep), p.overlap < 0.0,
                          steps(added_rad, kDwellStep_rad), off_wish, std::abs(p.overlap),
                          added_rad, p.turns);
    };
    return key(a) < key(b);
}

// Keeps the best of any number of patterns.
class Best {
public:
    explicit Best(const PatternRequest& request)
        : most_(static_cast<std::size_t>(request.most_patterns)), starts_(request.wanted_starts) {}

    void add(const Pattern& pattern) {
        patterns_.push_back(pattern);
        if (patterns_.size() >= 2 * most_ + kSpare) {
            cut();
        }
    }
    std::vector<Pattern> take() {
        cut();
        return std::move(patterns_);
    }

private:
    static constexpr std::size_t kSpare = 1000;

    void cut() {
        std::sort(patterns_.begin(), patterns_.end(),
                  [&](const Pattern& a, const Pattern& b) { return better(a, b, starts_); });
        patterns_.resize(std::min(patterns_.size(), most_));
    }

    std::size_t most_;
    std::int64_t starts_;
    std::vector<Pattern> patterns_;
};

// round(value / divisor), halves up. \pre divisor > 0
Wide rounded(Wide value, Wide divisor) {
    const Wide twice = 2 * value + divisor;
    const Wide rest = twice % (2 * divisor);
    return (twice - (rest < 0 ? rest + 2 * divisor : rest)) / (2 * divisor);
}

void require_finite_at_least_0(const char* name, double value) {
    require(value >= 0.0 && std::isfinite(value), kRange, name, value, "a finite number from", 0.0);
}

void require_band(double band_rad) {
    require(band_rad > 0.0 && std::isfinite(band_rad), kRange, "band_rad", band_rad,
            "a finite number above", 0.0);
}

void require_circuit(double turn_rad) {
    const double most_rad = kTurn_rad * kMaxCircuitTurns;
    require(turn_rad <= most_rad, kRange, "circuit_rad", turn_rad, "with all dwell at most",
            most_rad);
}

// N from which on, and up to which, patterns are looked for.
std::pair<std::int64_t, std::int64_t> circuits_to_try(const PatternRequest& r) {
    if (r.circuits > 0) {
        return {r.circuits, r.circuits};
    }
    const double per_overlap = r.layers * kTurn_rad / r.band_rad;
    const std::int64_t first =
        std::max<std::int64_t>(1, ceil_count(per_overlap * (1.0 + r.least_overlap)));
    const double most = per_overlap * (1.0 + r.most_overlap);
    return {first, std::max(first, whole(std::floor(most + kSameCount)))};
}

bool wished_for(const Pattern& p, const PatternRequest& r) {
    const bool both = p.circuits <= 2;
    return (r.starts == 0 || p.starts == r.starts) && (!r.order || p.order == *r.order || both);
}

}  // namespace

void PatternRequest::validate() const {
    require_finite_at_least_0("circuit_rad", circuit_rad);
    require_finite_at_least_0("most_dwell_rad", most_dwell_rad);
    require_finite_at_least_0("most_change_rad", most_change_rad);
    require_circuit(circuit_rad + most_dwell_rad + most_change_rad);
    require_band(band_rad);
    require(layers >= 1, kRange, "layers", layers, "at least", 1.0);
    require(least_overlap > -1.0, kRange, "least_overlap", least_overlap, "above", -1.0);
    require(most_overlap >= least_overlap && std::isfinite(most_overlap), kRange, "most_overlap",
            most_overlap, "finite and at least", least_overlap);
    require(wanted_starts >= 0, kRange, "wanted_starts", wanted_starts, "at least", 0.0);
    require(most_patterns >= 1, kRange, "most_patterns", most_patterns, "at least", 1.0);
    require_finite_at_least_0("least_dwell_rad", least_dwell_rad);
    require(least_dwell_rad <= most_dwell_rad, kRange, "least_dwell_rad", least_dwell_rad,
            "at most", most_dwell_rad);
    require(circuits >= 0, kRange, "circuits", static_cast<double>(circuits), "at least", 0.0);
    require(circuits <= kMaxCircuits, kRange, "circuits", static_cast<double>(circuits), "at most",
            static_cast<double>(kMaxCircuits));
    require(starts >= 0, kRange, "starts", static_cast<double>(starts), "at least", 0.0);
    const double least_rad =
        layers * kTurn_rad * (1.0 + most_overlap) / static_cast<double>(kMaxCircuits);
    require(band_rad >= least_rad, "pattern.band_too_narrow", "band_rad", band_rad, "at least",
            least_rad);
}

std::vector<Pattern> find_patterns(const PatternRequest& request) {
    request.validate();
    const Cover cover{request.band_rad, request.layers};
    const double least_rad =
        request.circuit_rad + request.least_dwell_rad - request.most_change_rad - kSameTurn_rad;
    const double most_rad =
        request.circuit_rad + request.most_change_rad + request.most_dwell_rad + kSameTurn_rad;
    const auto [first, last] = circuits_to_try(request);
    Best best(request);
    for (std::int64_t n = first; n <= last; ++n) {
        const double per_turn = static_cast<double>(n) / kTurn_rad;
        const auto from = std::max<std::int64_t>(0, whole(std::ceil(least_rad * per_turn)));
        const std::int64_t to = whole(std::floor(most_rad * per_turn));
        for (std::int64_t k = from; k <= to; ++k) {
            if (std::gcd(n, k) == 1) {
                Pattern pattern = closed(n, k, cover);
                set_dwell(pattern, request.circuit_rad, request.least_dwell_rad,
                          request.most_dwell_rad);
                if (wished_for(pattern, request)) {
                    best.add(pattern);
                }
            }
        }
    }
    return best.take();
}

Pattern lattice(double circuit_rad, int circuits, double band_rad) {
    require_finite_at_least_0("circuit_rad", circuit_rad);
    require_circuit(circuit_rad + kTurn_rad);
    require_band(band_rad);
    require(circuits >= 1, kRange, "circuits", circuits, "at least", 1.0);
    require(circuits <= kMaxCircuits, kRange, "circuits", circuits, "at most",
            static_cast<double>(kMaxCircuits));
    const double least = (circuit_rad - kSameTurn_rad) * circuits / kTurn_rad;
    auto turns = std::max<std::int64_t>(0, whole(std::ceil(least)));
    while (std::gcd<std::int64_t, std::int64_t>(circuits, turns) != 1) {
        ++turns;  // of any N numbers in a row one has no factor in common with N
    }
    Pattern pattern = closed(circuits, turns, {band_rad, 1});
    set_dwell(pattern, circuit_rad, 0.0, kTurn_rad);
    return pattern;
}

Series fill_lattice(const Pattern& lattice, double band_rad) {
    require_band(band_rad);
    Series series;
    series.count = std::max<std::int64_t>(1, ceil_count(lattice.step_rad / band_rad));
    const auto count = static_cast<double>(series.count);
    series.offset_rad = band_rad;
    series.overlap = count * band_rad / lattice.step_rad - 1.0;
    series.even_rad = lattice.step_rad / count;
    series.total_rad = count * (kTurn_rad * static_cast<double>(lattice.turns) + band_rad);
    series.circuits = series.count * lattice.circuits;
    return series;
}

std::vector<std::int64_t> circuits_around(const Pattern& pattern) {
    std::vector<std::int64_t> circuit(static_cast<std::size_t>(pattern.circuits));
    std::int64_t place = 0;
    for (std::int64_t i = 0; i < pattern.circuits; ++i) {
        circuit[static_cast<std::size_t>(place)] = i;
        place = (place + pattern.turns) % pattern.circuits;
    }
    return circuit;
}

StepClosure closure_in_steps(const Pattern& pattern, const AxisStep& step) {
    require(step.units_per_turn >= 1 && step.units_per_turn <= kMaxUnits, kRange, "units_per_turn",
            static_cast<double>(step.units_per_turn), "at least 1 and at most",
            static_cast<double>(kMaxUnits));
    require(step.units_per_step >= 1 && step.units_per_step <= step.units_per_turn, kRange,
            "units_per_step", static_cast<double>(step.units_per_step), "at least 1 and at most",
            static_cast<double>(step.units_per_turn));
    const Wide n = pattern.circuits;
    const Wide advance = Wide{pattern.turns} * step.units_per_turn;  // N times that of a circuit
    const Wide step_n = n * step.units_per_step;
    const auto rad = [&](Wide units_n) {
        return kTurn_rad * static_cast<double>(units_n) / static_cast<double>(n) /
               static_cast<double>(step.units_per_turn);
    };
    StepClosure closure;
    Wide last = 0;
    for (Wide i = 1; i <= n; ++i) {
        const Wide place = rounded(i * advance, step_n);
        closure.increments.push_back(static_cast<std::int64_t>(place - last));
        last = place;
        const double off_rad = rad(place * step_n - i * advance);
        closure.worst_rad = std::max(closure.worst_rad, std::abs(off_rad));
        closure.closure_rad = off_rad;
    }
    closure.separate_rad = rad(n * (rounded(advance, step_n) * step_n - advance));
    return closure;
}

}  // namespace meshwind
