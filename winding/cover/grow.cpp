#include "winding/cover/grow.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/index.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/units.h"
#include "winding/cover/balance.h"
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

class Grower {
public:
    Grower(const CourseRules& rules, const CoverageSamples& samples, const CoverOptions& options)
        : rules_(rules), samples_(samples), options_(options) {
        library_.reached.assign(samples.size(), 0);
        library_.closest_miss.assign(samples.size(), Refusal::None);
    }

    Library run() {
        grow();
        return std::move(library_);
    }

private:
    [[nodiscard]] std::uint64_t stream(Stream which) const {
        return seed_of(which, options_.context.seed);
    }

    void tell(double share) const { options_.context.report_progress("library", share); }

    // A candidate through a given sample; `draw` numbers the random draws of the whole run.
    Candidate candidate_at(std::int32_t sample, std::uint64_t draw) const {
        const auto pick = random_bits(stream(Stream::Steerings), draw) % kSteering.size();
        const SurfacePoint& place = samples_.at[at(sample)];
        return {place,
                draw_direction_rad(rules_, place, random_unit(stream(Stream::Angles), draw),
                                   random_unit(stream(Stream::Wishes), draw)),
                options_.tow.friction.share(kSteering[pick])};
    }

    void try_candidates(const std::vector<std::int32_t>& seeds) {
        std::vector<Candidate> candidates;
        candidates.reserve(seeds.size());
        for (const std::int32_t sample : seeds) {
            candidates.push_back(candidate_at(sample, draws_++));
        }
        const std::vector<Refusal> outcome = judge_candidates(candidates);
        for (std::size_t i = 0; i < seeds.size(); ++i) {
            library_.closest_miss[at(seeds[i])] =
                std::max(library_.closest_miss[at(seeds[i])], outcome[i]);
        }
    }

    // True when most of what sketches admit holds by all rules.
    [[nodiscard]] bool sketches_hold(std::span<const std::int32_t> seeds) const {
        std::vector<Candidate> candidates;
        for (std::size_t i = 0; i < seeds.size(); ++i) {
            candidates.push_back(candidate_at(seeds[i], i));
        }
        std::vector<Candidate> sketched;
        for (const Member& member : build_library(rules_, candidates).members) {
            sketched.push_back(member.candidate);
        }
        const std::size_t hold = build_library(rules_, sketched, Judging::Courses).members.size();
        return static_cast<double>(hold) >= kTrustedShare * static_cast<double>(sketched.size());
    }

    // Adds the admissible ones to the library; says what became of each.
    std::vector<Refusal> judge_candidates(const std::vector<Candidate>& candidates) {
        LibraryPart part = build_library(rules_, candidates, library_.judging);
        library_.candidates += static_cast<std::int64_t>(candidates.size());
        for (const Refusal refusal : part.outcome) {
            ++library_.refusals[static_cast<std::size_t>(refusal)];
        }
        for (Member& member : part.members) {
            for (const std::int32_t sample : member.footprint) {
                library_.reached[at(sample)] = 1;
            }
            library_.members.push_back(std::move(member));
        }
        return std::move(part.outcome);
    }

    void grow() {
        std::vector<std::int32_t> seeds;
        seeds.reserve(static_cast<std::size_t>(options_.candidates));
        for (int i = 0; i < options_.candidates; ++i) {
            seeds.push_back(static_cast<std::int32_t>(
                random_bits(stream(Stream::Seeds), static_cast<std::uint64_t>(i)) %
                samples_.size()));
        }
        tell(0.0);
        const std::size_t first = std::min(kFirstCandidates, seeds.size());
        library_.judging =
            sketches_hold(std::span(seeds).first(first)) ? Judging::Sketches : Judging::Courses;
        try_candidates(seeds);
        for (int round = 0; round < options_.rounds; ++round) {
            tell((round + 1.0) / (options_.rounds + 1.0));
            const std::vector<std::int32_t> missed = unreached();
            if (missed.empty()) {
                break;
            }
            seeds.clear();
            for (int i = 0; i < options_.aimed_candidates; ++i) {
                const auto draw = static_cast<std::uint64_t>(i) << 8U;
                seeds.push_back(missed[random_bits(stream(Stream::Seeds),
                                                   draw + 1 + static_cast<std::uint64_t>(round)) %
                                       missed.size()]);
            }
            try_candidates(seeds);
        }
        for (int round = 0; round < kScarceRounds; ++round) {
            grow_scarce_ways();
        }
    }

    // Ways between nodes that few courses take although many lie there: mostly those that can
    // hardly be wound in that direction. One continuous fibre needs them, so further candidates are
    // drawn near them.
    void grow_scarce_ways() {
        // Near those that can be wound, once there are any.
        std::vector<std::int32_t> near;
        for (const auto& [nodes, way] : ways_between_nodes(library_.members)) {
            if (way.windable.size() < kScarce && way.lying.size() >= kEstablished) {
                const auto& source = way.windable.empty() ? way.lying : way.windable;
                for (std::size_t i = 0; i < kShare; ++i) {
                    near.push_back(source[i % source.size()]);
                }
            }
        }
        if (near.empty()) {
            return;
        }
        const auto count = static_cast<std::size_t>(options_.scarce_candidates / kScarceRounds);
        std::vector<Candidate> candidates(count);
        parallel_for(count, kNearChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint64_t draw = draws_ + i;
                const std::uint64_t pick = random_bits(stream(Stream::Seeds), ~draw) % near.size();
                candidates[i] = candidate_near(library_.members[at(near[pick])], draw);
            }
        });
        draws_ += count;
        judge_candidates(candidates);
    }

    // A candidate through a station of a member, turned a little, with the same or another
    // steering.
    [[nodiscard]] Candidate candidate_near(const Member& member, std::uint64_t draw) const {
        const SurfacePath path = trace_both_ways(rules_, member.candidate, TraceMethod::Walk);
        const auto pick = static_cast<std::size_t>(random_unit(stream(Stream::Sampling), draw) *
                                                   static_cast<double>(path.size()));
        const PathPoint& station = path[pick];
        const double turn = (2.0 * random_unit(stream(Stream::Angles), draw) - 1.0) * kNearTurn_rad;
        Candidate candidate{station.at, direction_angle(station.normal, station.tangent) + turn,
                            member.candidate.slip_ratio};
        const auto steering = random_bits(stream(Stream::Steerings), draw) % (2 * kSteering.size());
        if (steering < kSteering.size()) {
            candidate.slip_ratio = options_.tow.friction.share(kSteering[steering]);
        }
        return candidate;
    }

    [[nodiscard]] std::vector<std::int32_t> unreached() const {
        std::vector<std::int32_t> missed;
        for (std::size_t i = 0; i < library_.reached.size(); ++i) {
            if (library_.reached[i] == 0) {
                missed.push_back(static_cast<std::int32_t>(i));
            }
        }
        return missed;
    }

    const CourseRules& rules_;
    const CoverageSamples& samples_;
    const CoverOptions& options_;
    Library library_;
    std::uint64_t draws_ = 0;
};

}  // namespace

Ways ways_between_nodes(std::span<const Member> members) {
    Ways ways;
    for (std::size_t i = 0; i < members.size(); ++i) {
        for (const bool backward : {false, true}) {
            const Member& member = members[i];
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
    return Grower(rules, samples, options).run();
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
    for (const Member& member : build_library(rules, candidates, judging).members) {
        for (const std::int32_t sample : member.footprint) {
            now[at(sample)] = 1;
        }
    }
    return reached_share(now);
}

}  // namespace meshwind
