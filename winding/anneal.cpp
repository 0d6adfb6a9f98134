#include "winding/anneal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "core/parallel.h"
#include "core/units.h"
#include "mesh/nearest.h"
#include "winding/balance.h"
#include "winding/random.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Proposals that are drawn and judged against the same state, and those that one task takes.
// Those proved take fifty times as long as others: a group holds some of both for every core.
constexpr std::size_t kGroup = 256;
constexpr std::size_t kTask = 4;

// Kinds of proposals, as shares of all.
constexpr double kFreshShare = 0.10;      // a course somewhere, mostly where layers are missing
constexpr double kNeighbourShare = 0.12;  // a course beside another
constexpr double kJoinShare = 0.06;  // a course from where fibres arrive in vain to where they lack
constexpr double kDropShare = 0.08;
constexpr double kReverseShare = 0.04;  // a course wound the other way
constexpr double kNudgeShare = 0.40;    // a course moved a little
constexpr double kBesideShare = 0.12;   // a course moved beside another; the rest: moved anywhere

// Of the fresh courses, those from the library.
constexpr double kLibraryShare = 0.5;

// Places tried for one that is short of layers.
constexpr int kPlacesTried = 24;

// Spread of a nudge at its widest: sideways in bands, turned in rad, steered in shares of the
// friction. Its narrowest is this many times less.
constexpr double kNudgeBands = 1.0;
constexpr double kNudgeTurn_rad = 0.1;
constexpr double kNudgeSteering = 0.1;
constexpr double kNudgeRange = 16.0;

// Neighbours are turned by this much at most, on some of the proposals.
constexpr double kBesideTurn_rad = 0.02;

// Steering of new courses as shares of the friction.
constexpr std::array<double, 7> kSteering = {0.0, 0.31, -0.31, 0.62, -0.62, 0.92, -0.92};
constexpr double kMostSteering = 0.92;

// A course costs its turn's fibre, by this share of what layers too many would.
constexpr double kTurnShare = 0.1;

// What each end costs that is not joined to another, as a share of what a course covers, and twice
// that each part of the plan that is apart. Two ends are free: those of the fibre.
constexpr double kOpenShare = 0.6;
constexpr int kFreeEnds = 2;

// Layers from which on more make no difference.
constexpr std::size_t kMostLayers = 64;

// Samples per band width. With 2.5 what is covered there is 0.7 % more than what is covered on
// others, with 4 it is 0.25 %.
constexpr double kSamplesPerBand = 4.0;
constexpr std::size_t kSampleChunk = 256;

std::size_t at(std::int32_t i) {
    return static_cast<std::size_t>(i);
}

// The random numbers of one proposal.
class Draws {
public:
    Draws(std::uint64_t seed, std::int64_t proposal)
        : seed_(seed), index_(static_cast<std::uint64_t>(proposal) << 8U) {}

    double unit() { return random_unit(seed_, index_++); }
    double either() { return unit() < 0.5 ? -1.0 : 1.0; }
    std::size_t below(std::size_t count) {
        return static_cast<std::size_t>(random_bits(seed_, index_++) % count);
    }
    // Irwin and Hall's sum of twelve: variance 1.
    double normal() {
        double sum = -6.0;
        for (int i = 0; i < 12; ++i) {
            sum += unit();
        }
        return sum;
    }

private:
    std::uint64_t seed_;
    std::uint64_t index_;
};

// How many courses lead from node to node (see balance.h).
class Joints {
public:
    explicit Joints(std::size_t nodes) : nodes_(nodes), courses_(nodes * nodes, 0) {}

    void add(const Member& member, bool backward, int times) {
        courses_[departure_node(start_of(member, backward)) * nodes_ +
                 arrival_node(end_of(member, backward))] += times;
    }

    // Arrivals less departures.
    [[nodiscard]] int excess(std::size_t node) const {
        int excess = 0;
        for (std::size_t other = 0; other < nodes_; ++other) {
            excess += courses_[other * nodes_ + node] - courses_[node * nodes_ + other];
        }
        return excess;
    }

    [[nodiscard]] int loose_ends() const {
        int loose = 0;
        for (std::size_t node = 0; node < nodes_; ++node) {
            loose += std::abs(excess(node));
        }
        return loose;
    }

    // Per node the lowest one that courses join it to; its own number where there are none.
    [[nodiscard]] std::vector<std::size_t> part_of() const {
        std::vector<std::size_t> part(nodes_);
        std::iota(part.begin(), part.end(), std::size_t{0});
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t i = 0; i < nodes_; ++i) {
                for (std::size_t j = 0; j < nodes_; ++j) {
                    if (courses_[i * nodes_ + j] > 0 && part[i] != part[j]) {
                        part[i] = part[j] = std::min(part[i], part[j]);
                        changed = true;
                    }
                }
            }
        }
        return part;
    }

    [[nodiscard]] bool has_courses(std::size_t node) const {
        for (std::size_t other = 0; other < nodes_; ++other) {
            if (courses_[other * nodes_ + node] + courses_[node * nodes_ + other] > 0) {
                return true;
            }
        }
        return false;
    }

    // Groups of nodes that no course joins; at least one.
    [[nodiscard]] int parts() const {
        const std::vector<std::size_t> part = part_of();
        int parts = 0;
        for (std::size_t node = 0; node < nodes_; ++node) {
            parts += part[node] == node && has_courses(node) ? 1 : 0;
        }
        return std::max(1, parts);
    }

private:
    std::size_t nodes_;
    std::vector<int> courses_;
};

class Annealer {
public:
    Annealer(const CourseRules& rules, const AnnealGround& ground, std::span<const Member> library,
             std::span<const char> allowed, std::vector<PlacedCourse>& courses,
             const AnnealOptions& options)
        : rules_{rules.mandrel, rules.obstacles,  ground.footprints,       rules.tow,
                 rules.turn,    rules.free_fibre, rules.max_half_length_mm},
          ground_(ground),
          samples_(ground.samples),
          library_(library),
          allowed_(allowed),
          courses_(courses),
          options_(options),
          layers_(ground.samples.size(), 0),
          joints_(2 * rules.mandrel.rims.size()),
          scratch_(*this) {
        weigh(options.bare_hot);
        const std::unique_ptr<Scratch> scratch = scratch_.take();
        for (PlacedCourse& course : courses) {
            course.member.footprint = ground.footprints.footprint(course.path, scratch->footprint);
            lay(course, 1);
        }
        // Of the library: at first there may be no course at all.
        double covered = 0.0;
        for (const Member& member : library) {
            covered += member.length_mm * rules.tow.width_mm / samples_.area_mm2;
        }
        typical_ =
            std::max(1.0, covered / std::max<double>(1.0, static_cast<double>(library.size())));
        turn_cost_ = kTurnShare * options.select.turn_mm * rules.tow.width_mm / samples_.area_mm2;
    }

    AnnealEffort run() {
        std::vector<Proposal> group(kGroup);
        for (effort_.proposals = 0; effort_.proposals < options_.proposals;) {
            const double share =
                static_cast<double>(effort_.proposals) / static_cast<double>(options_.proposals);
            heat_ = typical_ * options_.hot * std::pow(options_.cold / options_.hot, share);
            weigh(options_.bare_hot * std::pow(options_.bare_cold / options_.bare_hot, share));
            if (options_.progress) {
                options_.progress(share);
            }
            parallel_for(kGroup, kTask, [&](std::size_t begin, std::size_t end) {
                std::unique_ptr<Scratch> scratch = scratch_.take();
                for (std::size_t i = begin; i < end; ++i) {
                    group[i] = propose(effort_.proposals + static_cast<std::int64_t>(i), *scratch);
                }
                scratch_.put_back(std::move(scratch));
            });
            effort_.proposals += static_cast<std::int64_t>(kGroup);
            take(group);
        }
        return effort_;
    }

private:
    struct Scratch {
        Scratch(FootprintFinder::Scratch path, std::vector<std::int32_t> zeros)
            : footprint(std::move(path)), shift(std::move(zeros)) {}

        FootprintFinder::Scratch footprint;
        std::vector<std::int32_t> shift;  // of layers, while a change is weighed; else 0
    };

    // As many as there are tasks at a time; all are alike while they lie here.
    class Pool {
    public:
        explicit Pool(const Annealer& annealer) : annealer_(annealer) {}

        std::unique_ptr<Scratch> take() {
            const std::lock_guard lock(mutex_);
            if (idle_.empty()) {
                return std::make_unique<Scratch>(
                    annealer_.rules_.footprints.make_scratch(),
                    std::vector<std::int32_t>(annealer_.samples_.size(), 0));
            }
            std::unique_ptr<Scratch> scratch = std::move(idle_.back());
            idle_.pop_back();
            return scratch;
        }
        void put_back(std::unique_ptr<Scratch> scratch) {
            const std::lock_guard lock(mutex_);
            idle_.push_back(std::move(scratch));
        }

    private:
        const Annealer& annealer_;
        std::mutex mutex_;
        std::vector<std::unique_ptr<Scratch>> idle_;
    };

    // A course to put in, one to take out, or both.
    struct Proposal {
        bool holds = false;
        std::optional<std::size_t> out;
        std::optional<PlacedCourse> in;
        double chance = 0.0;
    };

    void weigh(double bare) {
        const double wanted = options_.select.target_layers + 1.0;
        for (std::size_t l = 0; l < kMostLayers; ++l) {
            const double off = static_cast<double>(l) - wanted;
            const int missing = options_.select.target_layers - static_cast<int>(l);
            cost_[l] = off * off + bare * std::max(0, missing);
        }
    }

    void lay(const PlacedCourse& course, int times) {
        for (const std::int32_t sample : course.member.footprint) {
            layers_[at(sample)] += times;
        }
        joints_.add(course.member, course.backward, times);
    }

    // What the courses leave open is worth the proposal that closes it.
    [[nodiscard]] double open_cost(const Joints& joints) const {
        return kOpenShare * typical_ *
               (std::max(0, joints.loose_ends() - kFreeEnds) + 2 * (joints.parts() - 1));
    }

    [[nodiscard]] double cost(std::int32_t layers) const {
        return cost_[std::min(at(layers), kMostLayers - 1)];
    }

    // What the objective changes by.
    double change(const Proposal& proposal, Scratch& scratch) const {
        double sum = 0.0;
        Joints joints = joints_;
        if (proposal.out) {
            const PlacedCourse& course = courses_[*proposal.out];
            for (const std::int32_t sample : course.member.footprint) {
                const std::int32_t layers = layers_[at(sample)] + scratch.shift[at(sample)]--;
                sum += cost(layers - 1) - cost(layers);
            }
            sum -= turn_cost_;
            joints.add(course.member, course.backward, -1);
        }
        if (proposal.in) {
            for (const std::int32_t sample : proposal.in->member.footprint) {
                const std::int32_t layers = layers_[at(sample)] + scratch.shift[at(sample)]++;
                sum += cost(layers + 1) - cost(layers);
            }
            sum += turn_cost_;
            joints.add(proposal.in->member, proposal.in->backward, 1);
        }
        if (proposal.out) {
            forget(courses_[*proposal.out], scratch);
        }
        if (proposal.in) {
            forget(*proposal.in, scratch);
        }
        return sum + open_cost(joints) - open_cost(joints_);
    }

    static void forget(const PlacedCourse& course, Scratch& scratch) {
        for (const std::int32_t sample : course.member.footprint) {
            scratch.shift[at(sample)] = 0;
        }
    }

    [[nodiscard]] bool is_taken(const Proposal& proposal, double change) const {
        return change <= 0.0 || proposal.chance < std::exp(-change / heat_);
    }

    // A sample, rather one short of layers.
    [[nodiscard]] std::size_t needy_place(Draws& draws) const {
        std::size_t best = draws.below(samples_.size());
        for (int i = 0; i < kPlacesTried && layers_[best] >= options_.select.target_layers; ++i) {
            const std::size_t place = draws.below(samples_.size());
            best = layers_[place] < layers_[best] ? place : best;
        }
        return best;
    }

    [[nodiscard]] Candidate fresh(Draws& draws) const {
        const std::size_t place = needy_place(draws);
        const auto& passing = ground_.passing[place];
        if (draws.unit() < kLibraryShare && !passing.empty()) {
            const std::size_t member = at(passing[draws.below(passing.size())]);
            if (allowed_[member] != 0) {
                return library_[member].candidate;
            }
        }
        return {samples_.at[place], kPi * draws.unit(),
                kSteering[draws.below(kSteering.size())] * rules_.tow.friction};
    }

    // How a candidate is moved: to its left, turned, and steered otherwise ahead and behind.
    struct Move {
        double left_mm = 0.0;
        double turn_rad = 0.0;
        double steering = 0.0;
        double behind = 0.0;
    };

    // From a place of a course. Where it is steered in two ways, that is where they meet.
    [[nodiscard]] Candidate moved(const PlacedCourse& course, const Move& move,
                                  Draws& draws) const {
        const Surface& surface = rules_.mandrel.surface;
        const Candidate& from = course.member.candidate;
        const std::size_t any = draws.below(course.path.size());
        const std::size_t station = from.more_behind == 0.0 ? any : seed_station(course);
        const PathPoint& start = course.path[station];
        const Vector3d left = start.normal.cross(start.tangent);
        const double side = move.left_mm < 0.0 ? -1.0 : 1.0;
        const TraceResult way = trace(surface, start.at, side * left, {},
                                      {.max_length_mm = std::max(std::abs(move.left_mm), 1e-3)});
        const PathPoint& place = way.path.back();
        const Vector3d normal = smooth_normal(surface, place.at);
        const double most = kMostSteering * rules_.tow.friction;
        const double ahead = std::clamp(from.slip_ratio + move.steering, -most, most);
        const double behind =
            std::clamp(from.slip_ratio + from.more_behind + move.behind, -most, most);
        return {place.at,
                direction_angle(normal, side * place.tangent.cross(normal)) + move.turn_rad, ahead,
                behind - ahead};
    }

    static std::size_t seed_station(const PlacedCourse& course) {
        const auto found =
            std::find_if(course.path.begin(), course.path.end(), [&](const PathPoint& point) {
                return point.at.face == course.member.candidate.seed.face;
            });
        return static_cast<std::size_t>(std::min(found, course.path.end() - 1) -
                                        course.path.begin());
    }

    [[nodiscard]] Candidate nudged(const PlacedCourse& course, Draws& draws) const {
        const double scale = std::pow(kNudgeRange, -draws.unit());
        const double steering = scale * kNudgeSteering * rules_.tow.friction;
        Move move{scale * kNudgeBands * rules_.tow.width_mm * draws.normal(),
                  scale * kNudgeTurn_rad * draws.normal()};
        const double how = draws.unit();
        if (how > 0.5) {
            move.steering = steering * draws.normal();
            move.behind = how > 0.75 ? steering * draws.normal() : move.steering;
        }
        return moved(course, move, draws);
    }

    [[nodiscard]] Candidate beside(const PlacedCourse& course, Draws& draws) const {
        const bool turned = draws.unit() < 0.5;
        const double left = draws.either() * rules_.tow.width_mm;
        return moved(course, {left, turned ? kBesideTurn_rad * (2.0 * draws.unit() - 1.0) : 0.0},
                     draws);
    }

    // Draws a proposal and judges it against the courses as they are.
    Proposal propose(std::int64_t number, Scratch& scratch) const {
        Draws draws(options_.seed, number);
        Proposal proposal;
        proposal.chance = draws.unit();
        double kind = draws.unit();
        const auto falls = [&kind](double share) {
            kind -= share;
            return kind < 0.0;
        };
        if (courses_.empty() || falls(kFreshShare)) {
            return judged(fresh(draws), draws, std::move(proposal), scratch);
        }
        if (falls(kJoinShare)) {
            return joining(draws, std::move(proposal), scratch);
        }
        const std::size_t one = draws.below(courses_.size());
        if (falls(kNeighbourShare)) {
            return judged(beside(courses_[one], draws), draws, std::move(proposal), scratch);
        }
        if (courses_[one].fixed) {
            return proposal;
        }
        proposal.out = one;
        if (falls(kDropShare)) {
            proposal.holds = true;
            return proposal;
        }
        if (falls(kReverseShare)) {
            PlacedCourse course = courses_[one];
            course.backward = !course.backward;
            return weighed(std::move(course), std::move(proposal), scratch);
        }
        if (falls(kNudgeShare)) {
            return judged(nudged(courses_[one], draws), draws, std::move(proposal), scratch);
        }
        if (falls(kBesideShare)) {
            return judged(beside(courses_[draws.below(courses_.size())], draws), draws,
                          std::move(proposal), scratch);
        }
        return judged(fresh(draws), draws, std::move(proposal), scratch);
    }

    // A member of the library that leads from a node where too many courses arrive to one where too
    // many depart, or to another part of the plan.
    Proposal joining(Draws& draws, Proposal proposal, Scratch& scratch) const {
        const std::vector<std::size_t> part = joints_.part_of();
        std::vector<const Way*> ways;
        std::vector<std::size_t> arrivals;
        for (const auto& [nodes, way] : ground_.ways) {
            const auto& [from, to] = nodes;
            const bool evens = joints_.excess(from) > 0 && joints_.excess(to) < 0;
            const bool joins =
                part[from] != part[to] && joints_.has_courses(from) && joints_.has_courses(to);
            if ((evens || joins) && !way.windable.empty()) {
                ways.push_back(&way);
                arrivals.push_back(to);
            }
        }
        if (ways.empty()) {
            return proposal;
        }
        const std::size_t which = draws.below(ways.size());
        const auto& members = ways[which]->windable;
        const std::size_t member = at(members[draws.below(members.size())]);
        const bool backward = arrival_node(end_of(library_[member], true)) == arrivals[which];
        if (allowed_[member] == 0) {
            return proposal;
        }
        return judged(library_[member].candidate, backward, std::move(proposal), scratch);
    }

    Proposal judged(const Candidate& candidate, Draws& draws, Proposal proposal,
                    Scratch& scratch) const {
        return judged(candidate, draws.unit() < 0.5, std::move(proposal), scratch);
    }

    // Sketches a candidate; what costs more comes later.
    Proposal judged(const Candidate& candidate, bool backward, Proposal proposal,
                    Scratch& scratch) const {
        Sketch sketch;
        if (draw_sketch(rules_, candidate, scratch.footprint, sketch) != Refusal::None) {
            return proposal;
        }
        return weighed({std::move(sketch.course), std::move(sketch.path), backward, false},
                       std::move(proposal), scratch);
    }

    // The proposal to put in a course, if it is worth it and can be wound.
    Proposal weighed(PlacedCourse course, Proposal proposal, Scratch& scratch) const {
        if (options_.way && !options_.way(departure_node(start_of(course.member, course.backward)),
                                          arrival_node(end_of(course.member, course.backward)))) {
            return proposal;
        }
        proposal.in = std::move(course);
        if (!is_taken(proposal, change(proposal, scratch)) || !holds(*proposal.in) ||
            (options_.verify && !options_.verify(*proposal.in))) {
            return proposal;
        }
        if (options_.verify) {
            proposal.in->member.footprint =
                ground_.footprints.footprint(proposal.in->path, scratch.footprint);
        }
        proposal.holds = true;
        return proposal;
    }

    [[nodiscard]] bool holds(PlacedCourse& course) const {
        const SurfacePath way = course.backward ? reversed(course.path) : course.path;
        bool& windable =
            course.backward ? course.member.windable_backward : course.member.windable_forward;
        windable = is_windable(rules_, way, taut_string(way), kSketchStep_mm);
        return windable;
    }

    // Takes what still holds after those before it in the group.
    void take(std::vector<Proposal>& group) {
        std::vector<std::size_t> touched;
        std::vector<std::size_t> dropped;
        std::unique_ptr<Scratch> scratch = scratch_.take();
        for (Proposal& proposal : group) {
            if (!proposal.holds ||
                (proposal.out &&
                 std::find(touched.begin(), touched.end(), *proposal.out) != touched.end()) ||
                !is_taken(proposal, change(proposal, *scratch))) {
                continue;
            }
            ++effort_.accepted;
            if (proposal.out) {
                touched.push_back(*proposal.out);
                lay(courses_[*proposal.out], -1);
            }
            if (proposal.in) {
                lay(*proposal.in, 1);
            }
            if (proposal.in && proposal.out) {
                courses_[*proposal.out] = std::move(*proposal.in);
            } else if (proposal.in) {
                courses_.push_back(std::move(*proposal.in));
            } else {
                dropped.push_back(*proposal.out);
            }
        }
        scratch_.put_back(std::move(scratch));
        std::sort(dropped.begin(), dropped.end(), std::greater<>());
        for (const std::size_t i : dropped) {
            courses_.erase(courses_.begin() + static_cast<std::ptrdiff_t>(i));
        }
    }

    const CourseRules rules_;  // with the footprints of the ground
    const AnnealGround& ground_;
    const CoverageSamples& samples_;
    std::span<const Member> library_;
    std::span<const char> allowed_;
    std::vector<PlacedCourse>& courses_;
    const AnnealOptions& options_;
    std::array<double, kMostLayers> cost_{};
    double typical_ = 1.0;  // samples that a course covers
    double turn_cost_ = 0.0;
    double heat_ = 0.0;
    std::vector<std::int32_t> layers_;  // per sample
    Joints joints_;
    Pool scratch_;
    AnnealEffort effort_;
};

}  // namespace

AnnealGround::AnnealGround(const CourseRules& rules, const CoverageSamples& measured,
                           std::span<const Member> library, std::uint64_t seed)
    : samples(sample_surface(
          rules.mandrel.surface,
          std::max(rules.tow.width_mm / kSamplesPerBand, std::sqrt(measured.area_mm2)), seed)),
      footprints(rules.mandrel.surface, samples, rules.tow.width_mm),
      passing(samples.size()),
      ways(ways_between_nodes(library)) {
    const NearestPoints index(samples.position_mm);
    std::vector<std::int32_t> beside(measured.size(), -1);
    parallel_for(measured.size(), kSampleChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            beside[i] = index.nearest(measured.position_mm[i]);
        }
    });
    for (std::size_t i = 0; i < library.size(); ++i) {
        for (const std::int32_t sample : library[i].footprint) {
            auto& here = passing[at(beside[at(sample)])];
            if (here.empty() || here.back() != static_cast<std::int32_t>(i)) {
                here.push_back(static_cast<std::int32_t>(i));
            }
        }
    }
}

AnnealEffort anneal(const CourseRules& rules, const AnnealGround& ground,
                    std::span<const Member> library, std::span<const char> allowed,
                    std::vector<PlacedCourse>& courses, const AnnealOptions& options) {
    const AnnealEffort effort = Annealer(rules, ground, library, allowed, courses, options).run();
    FootprintFinder::Scratch scratch = rules.footprints.make_scratch();
    for (PlacedCourse& course : courses) {
        course.member.footprint = rules.footprints.footprint(course.path, scratch);
    }
    return effort;
}

}  // namespace meshwind
