#include "winding/cover/grow_library.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/units.h"
#include "winding/cover/balance_courses.h"
#include "winding/cover/placed_course.h"

namespace meshwind {
namespace {

// A way between two nodes is scarce with fewer courses than this, and worth the search when at
// least so many lie there, windable or not.
constexpr std::size_t kScarce = 48;
constexpr std::size_t kEstablished = 8;
constexpr int kScarceRounds = 4;
constexpr std::size_t kShare = 240;  // of every scarce way in the draw: all count the same

// Of so many candidates first, this share of the sketches admitted must hold for sketches to be
// relied on. On tees of fine meshes nine in ten do.
constexpr std::size_t kFirstCandidates = 500;
constexpr double kTrustedShare = 0.7;

// Candidates that are tried under other rules.
constexpr std::uint64_t kOtherwise = 2000;

// Candidates near members that one task draws.
constexpr std::size_t kNearChunk = 32;

// How far a candidate near a member is turned at most.
constexpr double kNearTurn_rad = 5.0 * kPi / 180.0;

// What a library is grown by.
struct GrowthTask {
    const CourseRules& rules;
    const CoverageSamples& samples;
    const CoverOptions& options;

    [[nodiscard]] std::uint64_t stream(Stream which) const {
        return seed_of(which, options.context.seed);
    }
    void tell(double share) const { options.context.report_progress("library", share); }
};

// A library and the random draws made for it.
struct Growth {
    Library grown;
    std::uint64_t draws = 0;
};

// A candidate through a given sample; `draw` numbers the random draws of the whole run.
Candidate candidate_at(const GrowthTask& task, std::int32_t sample, std::uint64_t draw) {
    const auto pick = random_bits(task.stream(Stream::Steerings), draw) % kSteering.size();
    const SurfacePoint& place = task.samples.at[at(sample)];
    return {place,
            draw_direction_rad(task.rules, place, random_unit(task.stream(Stream::Angles), draw),
                               random_unit(task.stream(Stream::Wishes), draw)),
            task.options.tow.friction.share(kSteering[pick])};
}

// True when most of what sketches admit holds by all rules.
bool sketches_hold(const GrowthTask& task, std::span<const std::int32_t> seeds) {
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        candidates.push_back(candidate_at(task, seeds[i], i));
    }
    std::vector<Candidate> sketched;
    for (const LibraryCourse& member : build_library(task.rules, candidates).members) {
        sketched.push_back(member.candidate);
    }
    const std::size_t hold = build_library(task.rules, sketched, Judging::Courses).members.size();
    return static_cast<double>(hold) >= kTrustedShare * static_cast<double>(sketched.size());
}

// Adds the admissible ones to the library; says what became of each.
std::vector<CandidateFault> judge_candidates(const CourseRules& rules,
                                             const std::vector<Candidate>& candidates,
                                             Library& library) {
    LibraryPart part = build_library(rules, candidates, library.judging);
    library.candidates += static_cast<std::int64_t>(candidates.size());
    for (const CandidateFault refusal : part.outcome) {
        ++library.refusals[static_cast<std::size_t>(refusal)];
    }
    for (LibraryCourse& member : part.members) {
        for (const std::int32_t sample : member.footprint) {
            library.reached[at(sample)] = 1;
        }
        library.members.push_back(std::move(member));
    }
    return std::move(part.outcome);
}

// Tries a candidate through each seed.
void try_candidates(const GrowthTask& task, const std::vector<std::int32_t>& seeds,
                    Growth& growth) {
    std::vector<Candidate> candidates;
    candidates.reserve(seeds.size());
    for (const std::int32_t sample : seeds) {
        candidates.push_back(candidate_at(task, sample, growth.draws++));
    }
    const std::vector<CandidateFault> outcome =
        judge_candidates(task.rules, candidates, growth.grown);
    std::vector<CandidateFault>& closest_miss = growth.grown.closest_miss;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        closest_miss[at(seeds[i])] = std::max(closest_miss[at(seeds[i])], outcome[i]);
    }
}

std::vector<std::int32_t> unreached(std::span<const char> reached) {
    std::vector<std::int32_t> missed;
    for (std::size_t i = 0; i < reached.size(); ++i) {
        if (reached[i] == 0) {
            missed.push_back(static_cast<std::int32_t>(i));
        }
    }
    return missed;
}

// Seeds over the whole wall.
std::vector<std::int32_t> first_seeds(const GrowthTask& task) {
    std::vector<std::int32_t> seeds;
    seeds.reserve(static_cast<std::size_t>(task.options.candidates));
    for (int i = 0; i < task.options.candidates; ++i) {
        seeds.push_back(static_cast<std::int32_t>(
            random_bits(task.stream(Stream::Seeds), static_cast<std::uint64_t>(i)) %
            task.samples.size()));
    }
    return seeds;
}

// Seeds where no member passes.
std::vector<std::int32_t> aimed_seeds(const GrowthTask& task,
                                      const std::vector<std::int32_t>& missed, int round) {
    std::vector<std::int32_t> seeds;
    for (int i = 0; i < task.options.aimed_candidates; ++i) {
        const auto draw = static_cast<std::uint64_t>(i) << 8U;
        seeds.push_back(missed[random_bits(task.stream(Stream::Seeds),
                                           draw + 1 + static_cast<std::uint64_t>(round)) %
                               missed.size()]);
    }
    return seeds;
}

// A candidate through a station of a member, turned a little, with the same or another steering.
Candidate candidate_near(const GrowthTask& task, const LibraryCourse& member, std::uint64_t draw) {
    const SurfacePath path = trace_both_ways(task.rules, member.candidate, TraceMethod::Walk);
    const auto pick = static_cast<std::size_t>(random_unit(task.stream(Stream::Sampling), draw) *
                                               static_cast<double>(path.size()));
    const PathPoint& station = path[pick];
    const double turn =
        (2.0 * random_unit(task.stream(Stream::Angles), draw) - 1.0) * kNearTurn_rad;
    Candidate candidate{station.at, direction_angle(station.normal, station.tangent) + turn,
                        member.candidate.slip_ratio};
    const auto steering =
        random_bits(task.stream(Stream::Steerings), draw) % (2 * kSteering.size());
    if (steering < kSteering.size()) {
        candidate.slip_ratio = task.options.tow.friction.share(kSteering[steering]);
    }
    return candidate;
}

// Members of the ways between nodes that few courses take although many lie there: of all such
// ways equally many, of some members several times.
std::vector<std::int32_t> members_of_scarce_ways(std::span<const LibraryCourse> members) {
    // Those that can be wound, once there are any.
    std::vector<std::int32_t> near;
    for (const auto& [nodes, way] : ways_between_nodes(members)) {
        if (way.windable.size() < kScarce && way.lying.size() >= kEstablished) {
            const auto& source = way.windable.empty() ? way.lying : way.windable;
            for (std::size_t i = 0; i < kShare; ++i) {
                near.push_back(source[i % source.size()]);
            }
        }
    }
    return near;
}

// Ways between nodes that few courses take although many lie there: mostly those that can
// hardly be wound in that direction. One continuous fibre needs them, so further candidates are
// drawn near them.
void grow_scarce_ways(const GrowthTask& task, Growth& growth) {
    const std::vector<std::int32_t> near = members_of_scarce_ways(growth.grown.members);
    if (near.empty()) {
        return;
    }
    const auto count = static_cast<std::size_t>(task.options.scarce_candidates / kScarceRounds);
    std::vector<Candidate> candidates(count);
    parallel_for(count, kNearChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint64_t draw = growth.draws + i;
            const std::uint64_t pick = random_bits(task.stream(Stream::Seeds), ~draw) % near.size();
            candidates[i] = candidate_near(task, growth.grown.members[at(near[pick])], draw);
        }
    });
    growth.draws += count;
    judge_candidates(task.rules, candidates, growth.grown);
}

// Rounds through samples that no member reaches.
void grow_to_unreached(const GrowthTask& task, Growth& growth) {
    const int rounds = task.options.rounds;
    for (int round = 0; round < rounds; ++round) {
        task.tell((round + 1.0) / (rounds + 1.0));
        const std::vector<std::int32_t> missed = unreached(growth.grown.reached);
        if (missed.empty()) {
            break;
        }
        try_candidates(task, aimed_seeds(task, missed, round), growth);
    }
}

}  // namespace

Ways ways_between_nodes(std::span<const LibraryCourse> members) {
    Ways ways;
    for (std::size_t i = 0; i < members.size(); ++i) {
        for (const bool backward : {false, true}) {
            const LibraryCourse& member = members[i];
            Way& way = ways[nodes_of(member, backward)];
            way.lying.push_back(static_cast<std::int32_t>(i));
            if (backward ? member.windable_backward : member.windable_forward) {
                way.windable.push_back(static_cast<std::int32_t>(i));
            }
        }
    }
    return ways;
}

Library grow_library(const CourseRules& rules, const CoverageSamples& samples,
                     const CoverOptions& options) {
    const GrowthTask task{rules, samples, options};
    Growth growth;
    growth.grown.reached.assign(samples.size(), 0);
    growth.grown.closest_miss.assign(samples.size(), CandidateFault::None);
    const std::vector<std::int32_t> seeds = first_seeds(task);
    task.tell(0.0);
    const std::size_t first = std::min(kFirstCandidates, seeds.size());
    growth.grown.judging =
        sketches_hold(task, std::span(seeds).first(first)) ? Judging::Sketches : Judging::Courses;
    try_candidates(task, seeds, growth);
    grow_to_unreached(task, growth);
    for (int round = 0; round < kScarceRounds; ++round) {
        grow_scarce_ways(task, growth);
    }
    return std::move(growth.grown);
}

double reached_share(std::span<const char> reached) {
    return static_cast<double>(std::count(reached.begin(), reached.end(), 1)) /
           static_cast<double>(std::max<std::size_t>(1, reached.size()));
}

double reach_with(const CourseRules& rules, const CoverageSamples& samples,
                  std::span<const char> reached, Judging judging, std::uint64_t seed) {
    std::vector<char> now(reached.begin(), reached.end());
    std::vector<std::size_t> missed;
    for (std::size_t i = 0; i < now.size(); ++i) {
        if (now[i] == 0) {
            missed.push_back(i);
        }
    }
    std::vector<Candidate> candidates;
    for (std::uint64_t draw = 0; !missed.empty() && draw < kOtherwise; ++draw) {
        const std::size_t sample = missed[random_bits(seed, 3 * draw) % missed.size()];
        const double share = kSteering[random_bits(seed, 3 * draw + 1) % kSteering.size()];
        candidates.push_back({samples.at[sample], kPi * random_unit(seed, 3 * draw + 2),
                              rules.tow.friction.share(share)});
    }
    for (const LibraryCourse& member : build_library(rules, candidates, judging).members) {
        for (const std::int32_t sample : member.footprint) {
            now[at(sample)] = 1;
        }
    }
    return reached_share(now);
}

}  // namespace meshwind
