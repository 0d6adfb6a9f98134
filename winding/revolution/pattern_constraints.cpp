#include "winding/revolution/pattern_constraints.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/text/text_number.h"
#include "core/units.h"

namespace meshwind {
namespace {

constexpr double kTurn_rad = 2.0 * kPi;

// Overlap up to which patterns are looked for unless the job says: there is nearly always one.
constexpr double kMaxOverlap = 0.25;

// Looked through for patterns near a wish, and told.
constexpr int kLooked = 2000;
constexpr std::size_t kTold = 5;

// Share of a band that is no gap, and of a step that is no crossing: rounding.
constexpr double kNothing = 1e-9;

const char* word_of(BandOrder order) {
    return order == BandOrder::Leading ? "leading" : "lagging";
}

// Between bands that lie side by side.
double offset_mm_of(const CircuitToClose& circuit, const PatternConstraints& wish) {
    return wish.band_offset_mm > 0.0 ? wish.band_offset_mm : circuit.band_mm;
}

// A circuit, and what is wished for of its patterns.
struct WishedCircuit {
    const CircuitToClose& circuit;
    const PatternConstraints& wish;

    [[nodiscard]] double offset_mm() const { return offset_mm_of(circuit, wish); }

    // Over the distance that bands are to have.
    [[nodiscard]] double overlap_of(std::int64_t circuits) const {
        return static_cast<double>(circuits) * offset_mm() /
                   (kTurn_rad * circuit.mm_per_rad * circuit.layers) -
               1.0;
    }
    [[nodiscard]] bool is_lattice(const PatternRequest& asked) const {
        return asked.circuits > 0 && wish.circuits == 0;
    }
};

// Empty, or why the fibre cannot dwell as asked for.
std::string why_no_dwell(const WishedCircuit& wished) {
    if (wished.wish.least_dwell_rad > 0.0 && wished.circuit.dwelling_ends == 0) {
        return "a dwell of " + degrees(wished.wish.least_dwell_rad) +
               " at each rim is asked for, and the fibre turns by itself at both "
               "ends; leave \"dwell_deg\" out";
    }
    return {};
}

PatternRequest request_of(const WishedCircuit& wished) {
    const auto& [circuit, wish] = wished;
    PatternRequest asked;
    asked.circuit_rad = circuit.turn_rad;
    asked.band_rad = wished.offset_mm() / circuit.mm_per_rad;
    asked.layers = circuit.layers;
    asked.most_change_rad = circuit.most_change_rad;
    asked.least_dwell_rad = circuit.dwelling_ends * wish.least_dwell_rad;
    if (circuit.dwelling_ends > 0) {
        asked.most_dwell_rad = wish.most_dwell_rad ? circuit.dwelling_ends * *wish.most_dwell_rad
                                                   : asked.least_dwell_rad + kTurn_rad;
    }
    asked.most_overlap = wish.most_overlap.value_or(kMaxOverlap);
    asked.circuits = wish.circuits;
    asked.starts = wish.starts;
    asked.order = wish.order;
    asked.most_patterns = kLooked;
    return asked;
}

// Whether the circuits asked for close the wall, and not with more overlap than allowed.
bool fulfils_overlap(const WishedCircuit& wished) {
    const PatternConstraints& wish = wished.wish;
    if (wish.circuits == 0) {  // none are asked for
        return true;
    }
    const double overlap = wished.overlap_of(wish.circuits);
    return overlap >= -kNothing && (!wish.most_overlap || overlap <= *wish.most_overlap);
}

// Requests that give up some of the wishes: each set of wishes that may be given up.
std::vector<PatternRequest> loosened(const PatternRequest& asked, int dwelling_ends, bool lattice) {
    std::vector<PatternRequest> looser;
    const auto add = [&](auto loosen) {
        PatternRequest request = asked;
        loosen(request);
        looser.push_back(request);
    };
    const auto any_dwell = [&](PatternRequest& r) {
        r.least_dwell_rad = 0.0;
        r.most_dwell_rad = dwelling_ends > 0 ? kTurn_rad : 0.0;
    };
    const auto any_starts = [](PatternRequest& r) {
        r.wanted_starts = static_cast<int>(r.starts);
        r.starts = 0;
    };
    add([](PatternRequest& r) { r.order.reset(); });
    add(any_starts);
    add(any_dwell);
    add([&](PatternRequest& r) {
        any_starts(r);
        r.order.reset();
    });
    add([&](PatternRequest& r) {
        any_starts(r);
        any_dwell(r);
        r.order.reset();
    });
    if (lattice) {
        for (const std::int64_t more : {-2, -1, 1, 2}) {
            add([&](PatternRequest& r) {
                r.circuits = std::max<std::int64_t>(1, r.circuits + more);
            });
        }
    } else {
        add([](PatternRequest& r) { r.circuits = 0; });
        add([&](PatternRequest& r) {
            any_starts(r);
            any_dwell(r);
            r.order.reset();
            r.circuits = 0;
            r.most_overlap += kMaxOverlap;
        });
    }
    return looser;
}

// Patterns that lack some of the wishes.
std::vector<Pattern> near_patterns(const WishedCircuit& wished, const PatternRequest& asked) {
    const bool lattice = wished.is_lattice(asked);
    std::vector<Pattern> found;
    std::set<std::pair<std::int64_t, std::int64_t>> known;
    for (const PatternRequest& request : loosened(asked, wished.circuit.dwelling_ends, lattice)) {
        for (const Pattern& pattern : find_patterns(request)) {
            const bool closes = wished.overlap_of(pattern.circuits) >= -kNothing;
            if (closes != lattice && known.insert({pattern.circuits, pattern.turns}).second) {
                found.push_back(pattern);
            }
        }
    }
    return found;
}

// Fewest wishes lacked, then the nearest by circuits, starts, dwell.
auto distance_to(const PatternRequest& asked, const PatternConstraints& wish, const Pattern& p) {
    const std::int64_t circuits = asked.circuits > 0 ? std::abs(p.circuits - asked.circuits) : 0;
    const std::int64_t starts = asked.starts > 0 ? std::abs(p.starts - asked.starts) : 0;
    const bool order = asked.order && p.circuits > 2 && p.order != *asked.order;
    const double added_rad = p.dwell_rad + std::abs(p.change_rad);
    const bool dwell = p.dwell_rad > asked.most_dwell_rad + kSameTurn_rad ||
                       p.dwell_rad < asked.least_dwell_rad - kSameTurn_rad;
    const bool overlap =
        p.overlap > asked.most_overlap && (asked.circuits == 0 || wish.most_overlap.has_value());
    const int lacking = static_cast<int>(circuits > 0) + static_cast<int>(starts > 0) +
                        static_cast<int>(order) + static_cast<int>(dwell) +
                        static_cast<int>(overlap);
    return std::tuple(lacking, circuits, starts, std::abs(p.overlap), added_rad, p.turns);
}

std::string words_of_request(const WishedCircuit& wished, const PatternRequest& asked) {
    const CircuitToClose& circuit = wished.circuit;
    std::string words = "circuits that turn the mandrel by " + degrees(circuit.turn_rad);
    if (asked.circuits > 0) {
        words += ", " + std::to_string(asked.circuits) + " of them";
    }
    if (asked.starts > 0) {
        words += ", " + std::to_string(asked.starts) + " starts";
    }
    if (asked.order) {
        words += std::string(", ") + word_of(*asked.order);
    }
    if (asked.circuits == 0 || wished.wish.most_overlap) {
        words += ", overlap up to " + percent(asked.most_overlap, 1);
    }
    if (circuit.dwelling_ends > 0) {
        words += ", dwell of " + degrees(asked.least_dwell_rad) + " to " +
                 degrees(asked.most_dwell_rad) + " a circuit";
    } else {
        words += ", no rim to dwell at, given way to by " + degrees(asked.most_change_rad);
    }
    return words;
}

std::string why_no_pattern(const WishedCircuit& wished, const PatternRequest& asked) {
    std::vector<Pattern> patterns = near_patterns(wished, asked);
    std::sort(patterns.begin(), patterns.end(), [&](const Pattern& a, const Pattern& b) {
        return distance_to(asked, wished.wish, a) < distance_to(asked, wished.wish, b);
    });
    std::string words = "no pattern is as asked for: " + words_of_request(wished, asked);
    if (asked.circuits > 0 && wished.overlap_of(asked.circuits) < 0.0 && wished.wish.circuits > 0) {
        words += "; so few leave gaps between bands " + fixed(wished.offset_mm(), 2) +
                 " mm apart, which a larger \"band_offset_mm\" or a \"lattice\" allow";
    }
    if (patterns.empty()) {
        return words + "; none is near, another angle or tow width would have some";
    }
    words += "; nearest:";
    for (std::size_t i = 0; i < std::min(kTold, patterns.size()); ++i) {
        const Pattern p = with_bands_of(wished.circuit, patterns[i]);
        words += (i == 0 ? " " : "; ") + std::to_string(p.circuits) + " circuits, " +
                 std::to_string(p.starts) + " starts " + word_of(p.order) + ", overlap " +
                 percent(p.overlap, 1) + ", dwell " + degrees(p.dwell_rad) + " a circuit";
    }
    return words;
}

// The first of the patterns as it is laid, or why there is none.
FoundPattern first_found(const WishedCircuit& wished, const PatternRequest& asked,
                         const std::vector<Pattern>& patterns) {
    FoundPattern found;
    if (patterns.empty()) {
        found.failure = why_no_pattern(wished, asked);
    } else {
        found.pattern = with_bands_of(wished.circuit, patterns.front());
    }
    return found;
}

// Empty, or why the ribs of a lattice leave no holes.
std::string why_no_holes(const WishedCircuit& wished, const LatticeConstraints& lattice) {
    const CircuitToClose& circuit = wished.circuit;
    const double step_mm = kTurn_rad / lattice.circuits * circuit.mm_per_rad;
    const double rib_mm = circuit.band_mm + (std::max(1, lattice.series) - 1) * wished.offset_mm();
    if (rib_mm > step_mm * (1.0 + kNothing)) {
        return "ribs of " + fixed(rib_mm, 2) + " mm, " + std::to_string(lattice.circuits) +
               " of either hand, are " + fixed(step_mm, 2) +
               " mm apart at the widest place and close the wall; ask for fewer "
               "circuits or series, or for \"helical\"";
    }
    return {};
}

// How often the way on top changes along a row, for two.
std::int64_t diamonds_in_row(const std::vector<std::int64_t>& circuit_at, std::size_t apart) {
    const std::size_t n = circuit_at.size();
    const auto back_on_top = [&](std::size_t place) {
        return circuit_at[(place + apart) % n] >= circuit_at[place];
    };
    std::int64_t changes = 0;
    for (std::size_t place = 0; place < n; ++place) {
        changes += back_on_top(place) != back_on_top((place + 1) % n) ? 1 : 0;
    }
    return changes / 2;
}

}  // namespace

Pattern with_bands_of(const CircuitToClose& circuit, Pattern pattern) {
    const double band_rad = circuit.band_mm / circuit.mm_per_rad;
    const double deep = static_cast<double>(pattern.circuits) * band_rad / kTurn_rad;
    pattern.overlap = deep / circuit.layers - 1.0;
    pattern.least_layers = static_cast<std::int64_t>(std::floor(deep + kNothing));
    pattern.most_layers = static_cast<std::int64_t>(std::ceil(deep - kNothing));
    const double share = std::max(0.0, deep - static_cast<double>(pattern.least_layers));
    pattern.ripple = std::sqrt(share * (1.0 - share)) / deep;
    return pattern;
}

FoundPattern find_wished_pattern(const CircuitToClose& circuit, const PatternConstraints& wish) {
    const WishedCircuit wished{circuit, wish};
    FoundPattern found{{}, why_no_dwell(wished)};
    if (!found.failure.empty()) {
        return found;
    }
    const PatternRequest asked = request_of(wished);
    return first_found(wished, asked,
                       fulfils_overlap(wished) ? find_patterns(asked) : std::vector<Pattern>{});
}

FoundPattern find_wished_lattice(const CircuitToClose& circuit, const LatticeConstraints& lattice,
                                 const PatternConstraints& wish) {
    PatternConstraints rest = wish;
    rest.circuits = 0;
    rest.most_overlap.reset();
    const WishedCircuit wished{circuit, rest};
    FoundPattern found{{}, why_no_dwell(wished)};
    if (found.failure.empty()) {
        found.failure = why_no_holes(wished, lattice);
    }
    if (!found.failure.empty()) {
        return found;
    }
    PatternRequest asked = request_of(wished);
    asked.circuits = lattice.circuits;
    return first_found(wished, asked, find_patterns(asked));
}

LaidLattice laid_lattice(const Pattern& pattern, const CircuitToClose& circuit,
                         const LatticeConstraints& lattice, const PatternConstraints& wish) {
    LaidLattice laid;
    laid.series = lattice.series;
    laid.plies = lattice.plies;
    laid.offset_mm = offset_mm_of(circuit, wish);
    laid.rib_spacing_mm = pattern.step_rad * circuit.mm_per_rad;
    if (lattice.series == 0) {
        const Series series = fill_lattice(pattern, laid.offset_mm / circuit.mm_per_rad);
        laid.series = series.count;
        laid.offset_mm = series.even_rad * circuit.mm_per_rad;
        laid.filled = true;
    }
    laid.offset_rad = laid.offset_mm / circuit.mm_per_rad;
    laid.rib_mm = circuit.band_mm + static_cast<double>(laid.series - 1) * laid.offset_mm;
    return laid;
}

std::vector<double> circuit_starts_rad(const Pattern& pattern,
                                       const std::optional<LaidLattice>& lattice) {
    const std::int64_t series = lattice ? lattice->series : 1;
    const std::int64_t all = series * (lattice ? lattice->plies : 1);
    std::vector<double> starts;
    for (std::int64_t wound = 0; wound < all; ++wound) {
        const double moved_rad =
            lattice ? static_cast<double>(wound % series) * lattice->offset_rad : 0.0;
        for (std::int64_t i = 0; i < pattern.circuits; ++i) {
            const std::int64_t place = i * pattern.turns % pattern.circuits;
            starts.push_back(static_cast<double>(place) * pattern.step_rad + moved_rad);
        }
    }
    return starts;
}

Interlacing interlacing_of(const Pattern& pattern, double pass_rad, double upper_turn_rad) {
    const double n = static_cast<double>(pattern.circuits);
    const auto before = static_cast<std::int64_t>(
        std::ceil(-upper_turn_rad / kTurn_rad * n - kNothing));  // the first that is beyond the top
    const auto after = static_cast<std::int64_t>(
        std::floor(-(2.0 * pass_rad + upper_turn_rad) / kTurn_rad * n + kNothing));
    Interlacing found;
    found.crossing_rows = std::max<std::int64_t>(0, before - after - 1);
    found.crossings = found.crossing_rows * pattern.circuits;
    const std::vector<std::int64_t> circuit_at = circuits_around(pattern);
    // Rows N apart are alike.
    for (std::int64_t row = 0; row < std::min(found.crossing_rows, pattern.circuits); ++row) {
        const std::int64_t apart = (after + 1 + row) % pattern.circuits;
        const auto places = static_cast<std::size_t>(apart < 0 ? apart + pattern.circuits : apart);
        found.diamonds_around =
            std::max(found.diamonds_around, diamonds_in_row(circuit_at, places));
    }
    return found;
}

}  // namespace meshwind
