#include "winding/cover/anneal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/units.h"
#include "winding/cover/balance.h"
#include "winding/cover/fit.h"
#include "winding/cover/joints.h"
#include "winding/laminate/families.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Proposals that are drawn and judged against the same state, and those that one task takes.
// Those proved take fifty times as long as others: a group holds some of both for every core.
constexpr std::size_t kGroup = 128;
constexpr std::size_t kTask = 2;

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

// Of the fresh courses, images of others.
constexpr double kImageShare = 0.4;

// Of the courses proposed, those fitted first. A fit takes as long as three that are not; of 0,
// 0.15, 0.3 and 1 this gave the most even plans of four tees in equal time.
constexpr double kFitShare = 0.3;

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

// What each fibre beyond the first costs that is allowed, as a share of what a course covers:
// somebody has to cut it and tie it on.
constexpr double kCutShare = 0.5;

// What a course costs that belongs to no family of parallel ones, as a share of what a course
// covers. Among families the layers are more even, too.
constexpr double kAloneShare = 0.5;

// Layers off the target from which on more make no difference.
constexpr std::int32_t kMostOff = 64;

class Annealer {
public:
    Annealer(const CourseRules& rules, const AnnealGround& ground, std::span<const Member> library,
             std::span<const char> allowed, std::vector<PlacedCourse>& courses,
             const AnnealOptions& options)
        : rules_{rules.mandrel, rules.obstacles,  ground.footprints,        rules.tow,
                 rules.turns,   rules.free_fibre, rules.max_half_length_mm, rules.angle_rad},
          ground_(ground),
          samples_(ground.samples),
          library_(library),
          allowed_(allowed),
          courses_(courses),
          options_(options),
          joints_(2 * rules.mandrel.rims.size()),
          scratch_(*this) {
        weigh(options.bare_hot);
        for (std::size_t i = 0; i < ground.samples.size(); ++i) {
            over_.push_back(-options.select.target(static_cast<std::int32_t>(i)));
        }
        const std::unique_ptr<Scratch> scratch = scratch_.take();
        for (PlacedCourse& course : courses) {
            course.member.footprint = ground.footprints.footprint(course.path, scratch->footprint);
            lay(course, 1);
            CourseShape shape = shape_of(course);
            const std::vector<char> row = neighbours_.beside(shape);
            neighbours_.add(std::move(shape), row);
        }
        // Of the library: at first there may be no course at all.
        double covered = 0.0;
        for (const Member& member : library) {
            covered += member.length_mm * rules.tow.width_mm / samples_.area_mm2;
        }
        typical_ =
            std::max(1.0, covered / std::max<double>(1.0, static_cast<double>(library.size())));
        alone_ = neighbours_.without_family();
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
        std::optional<CourseShape> shape;  // of `in`
        std::vector<char> beside;          // neighbours of `in`, per course
        double chance = 0.0;
        bool fit = false;
    };

    void weigh(double bare) {
        for (std::size_t i = 0; i < cost_.size(); ++i) {
            const std::int32_t over = static_cast<std::int32_t>(i) - kMostOff;
            const double off = over - options_.beyond_layers;
            cost_[i] = off * off + bare * std::max(0, -over);
        }
    }

    void lay(const PlacedCourse& course, int times) {
        for (const std::int32_t sample : course.member.footprint) {
            over_[at(sample)] += times;
        }
        joints_.add(course.member, course.backward, times);
    }

    // What the courses leave open is worth the proposal that closes it.
    [[nodiscard]] double open_cost(const Joints& joints) const {
        const int fibres = joints.fibres();
        const int allowed = std::min(fibres, options_.fibres);
        return typical_ *
               (options_.fibre_share * (fibres - allowed) + kCutShare * std::max(0, allowed - 1));
    }

    // Of the fibre of a course's turns.
    [[nodiscard]] double turn_cost(const Member& member) const {
        return options_.turn_share * member.turn_mm * rules_.tow.width_mm / samples_.area_mm2;
    }

    // Of fibre off the wanted winding angle.
    [[nodiscard]] double angle_cost(const Member& member) const {
        return options_.select.angle_weight * member.off_angle_mm * rules_.tow.width_mm /
               samples_.area_mm2;
    }

    // Of a sample by the layers that it has over its target.
    [[nodiscard]] double cost(std::int32_t over) const {
        return cost_[at(std::clamp(over, -kMostOff, kMostOff) + kMostOff)];
    }

    [[nodiscard]] CourseShape shape_of(const PlacedCourse& course) const {
        return CourseShape(course.path, rules_.tow.width_mm);
    }

    // What the courses without a family cost more, or less. Looks for the neighbours of what is put
    // in.
    [[nodiscard]] double alone_change(Proposal& proposal) const {
        if (proposal.in) {
            if (!proposal.shape) {
                proposal.shape = shape_of(*proposal.in);
            }
            proposal.beside = neighbours_.beside(*proposal.shape);
        }
        return alone_cost() *
               (neighbours_.without_family(proposal.out, proposal.in ? &proposal.beside : nullptr) -
                alone_);
    }

    [[nodiscard]] double alone_cost() const { return kAloneShare * typical_; }

    // What the objective changes by, but for the families.
    double change(const Proposal& proposal, Scratch& scratch) const {
        double sum = 0.0;
        Joints joints = joints_;
        if (proposal.out) {
            const PlacedCourse& course = courses_[*proposal.out];
            for (const std::int32_t sample : course.member.footprint) {
                const std::int32_t now = over_[at(sample)] + scratch.shift[at(sample)]--;
                sum += cost(now - 1) - cost(now);
            }
            sum -= turn_cost(course.member) + angle_cost(course.member);
            joints.add(course.member, course.backward, -1);
        }
        if (proposal.in) {
            for (const std::int32_t sample : proposal.in->member.footprint) {
                const std::int32_t now = over_[at(sample)] + scratch.shift[at(sample)]++;
                sum += cost(now + 1) - cost(now);
            }
            sum += turn_cost(proposal.in->member) + angle_cost(proposal.in->member);
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
        for (int i = 0; i < kPlacesTried && over_[best] >= 0; ++i) {
            const std::size_t place = draws.below(samples_.size());
            best = over_[place] < over_[best] ? place : best;
        }
        return best;
    }

    [[nodiscard]] Candidate fresh(Draws& draws) const {
        if (ground_.images.size() > 0 && !courses_.empty() && draws.unit() < kImageShare) {
            const PlacedCourse& course = courses_[draws.below(courses_.size())];
            return ground_.images.of(course.member.candidate, draws.below(ground_.images.size()));
        }
        const std::size_t place = needy_place(draws);
        const auto& passing = ground_.passing[place];
        if (draws.unit() < kLibraryShare && !passing.empty()) {
            const std::size_t member = at(passing[draws.below(passing.size())]);
            if (allowed_[member] != 0) {
                return library_[member].candidate;
            }
        }
        const double unit = draws.unit();
        return {samples_.at[place],
                draw_direction_rad(rules_, samples_.at[place], unit, draws.unit()),
                rules_.tow.friction.share(kSteering[draws.below(kSteering.size())])};
    }

    // From any of its stations. Where it is steered in two ways, from the one where they meet.
    [[nodiscard]] Candidate moved_from_any(const PlacedCourse& course, const CourseMove& move,
                                           Draws& draws) const {
        const std::size_t any = draws.below(course.path.size());
        const bool anywhere = course.member.candidate.more_behind == 0.0;
        return moved(rules_, course, anywhere ? any : seed_station(course), move);
    }

    [[nodiscard]] Candidate nudged(const PlacedCourse& course, Draws& draws) const {
        const double scale = std::pow(kNudgeRange, -draws.unit());
        const double steering = rules_.tow.friction.share(scale * kNudgeSteering);
        CourseMove move{scale * kNudgeBands * rules_.tow.width_mm * draws.normal(),
                        scale * kNudgeTurn_rad * draws.normal()};
        const double how = draws.unit();
        if (how > 0.5) {
            move.steering = steering * draws.normal();
            move.behind = how > 0.75 ? steering * draws.normal() : move.steering;
        }
        return moved_from_any(course, move, draws);
    }

    [[nodiscard]] Candidate beside(const PlacedCourse& course, Draws& draws) const {
        const bool turned = draws.unit() < 0.5;
        const double left = draws.either() * rules_.tow.width_mm;
        return moved_from_any(
            course, {left, turned ? kBesideTurn_rad * (2.0 * draws.unit() - 1.0) : 0.0}, draws);
    }

    // Draws a proposal and judges it against the courses as they are.
    Proposal propose(std::int64_t number, Scratch& scratch) const {
        Draws draws(options_.seed, static_cast<std::uint64_t>(number) << 8U);
        Proposal proposal;
        proposal.chance = draws.unit();
        proposal.fit = draws.unit() < kFitShare;
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
        if (courses_[one].link >= 0) {
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
            course.wound = false;
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
        if (draw_path(rules_, candidate, sketch) != Refusal::None) {
            return proposal;
        }
        PlacedCourse course{std::move(sketch.course), std::move(sketch.path), backward, false};
        if (!proposal.fit) {
            if (!leads(course)) {
                return proposal;
            }
            course.member.footprint = ground_.footprints.footprint(course.path, scratch.footprint);
            return weighed(std::move(course), std::move(proposal), scratch);
        }
        const Fit fit = fitted(course, proposal.out, scratch);
        if (!is_taken(proposal, taken_out(proposal.out) - fit.saved - slack()) ||
            draw_sketch(rules_, moved(rules_, course, seed_station(course), fit.move),
                        scratch.footprint, sketch) != Refusal::None) {
            return proposal;
        }
        return weighed({std::move(sketch.course), std::move(sketch.path), backward, false},
                       std::move(proposal), scratch);
    }

    // What the layers cost more without a course.
    [[nodiscard]] double taken_out(std::optional<std::size_t> out) const {
        double sum = 0.0;
        if (out) {
            for (const std::int32_t sample : courses_[*out].member.footprint) {
                const std::int32_t now = over_[at(sample)];
                sum += cost(now - 1) - cost(now);
            }
        }
        return sum;
    }

    // The move to where a course saves most with another taken out.
    Fit fitted(const PlacedCourse& course, std::optional<std::size_t> out, Scratch& scratch) const {
        const Strip strip = ground_.strips.strip(course.path, scratch.footprint);
        if (out) {
            for (const std::int32_t sample : courses_[*out].member.footprint) {
                --scratch.shift[at(sample)];
            }
        }
        std::vector<float> saving(strip.sample.size());
        for (std::size_t i = 0; i < saving.size(); ++i) {
            const std::int32_t sample = strip.sample[i];
            const std::int32_t now = over_[at(sample)] + scratch.shift[at(sample)];
            saving[i] = static_cast<float>(cost(now) - cost(now + 1));
        }
        if (out) {
            forget(courses_[*out], scratch);
        }
        return fit_course(rules_, course, strip, saving);
    }

    // What else a change may save: hardly any helps more than two others to a family.
    [[nodiscard]] double slack() const { return 2.0 * alone_cost(); }

    // Whether a fibre comes where a course begins and goes on where it ends.
    [[nodiscard]] bool leads(const PlacedCourse& course) const {
        return !options_.way || options_.way(nodes_of(course.member, course.backward));
    }

    // The proposal to put in a course, if it is worth it and can be wound.
    Proposal weighed(PlacedCourse course, Proposal proposal, Scratch& scratch) const {
        if (!leads(course)) {
            return proposal;
        }
        proposal.in = std::move(course);
        const double by = change(proposal, scratch);
        if (!is_taken(proposal, by - slack()) || !is_taken(proposal, by + alone_change(proposal)) ||
            !holds(*proposal.in) || (options_.verify && !options_.verify(*proposal.in))) {
            return proposal;
        }
        if (options_.verify) {
            proposal.shape.reset();  // the path is exact now
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

    // Takes what still holds after those before it in the group, one for each course.
    void take(std::vector<Proposal>& group) {
        std::unique_ptr<Scratch> scratch = scratch_.take();
        for (Proposal& proposal : group) {
            if (!proposal.holds ||
                !is_taken(proposal, change(proposal, *scratch) + alone_change(proposal))) {
                continue;
            }
            ++effort_.accepted;
            const std::optional<std::size_t> out = proposal.out;
            if (out) {
                lay(courses_[*out], -1);
            }
            if (proposal.in) {
                lay(*proposal.in, 1);
            }
            if (proposal.in && out) {
                courses_[*out] = std::move(*proposal.in);
                neighbours_.replace(*out, std::move(*proposal.shape), proposal.beside);
            } else if (proposal.in) {
                courses_.push_back(std::move(*proposal.in));
                neighbours_.add(std::move(*proposal.shape), proposal.beside);
            } else {
                courses_.erase(courses_.begin() + static_cast<std::ptrdiff_t>(*out));
                neighbours_.remove(*out);
            }
            alone_ = neighbours_.without_family();
            if (out) {
                outdate(group, *out, !proposal.in);
            }
        }
        scratch_.put_back(std::move(scratch));
    }

    // The others' proposals for a course that has been changed are void; those for the ones behind
    // it move up when it is gone.
    static void outdate(std::vector<Proposal>& group, std::size_t course, bool gone) {
        for (Proposal& proposal : group) {
            if (proposal.out == course) {
                proposal.holds = false;
            } else if (gone && proposal.out && *proposal.out > course) {
                --*proposal.out;
            }
        }
    }

    const CourseRules rules_;  // with the footprints of the ground
    const AnnealGround& ground_;
    const CoverageSamples& samples_;
    std::span<const Member> library_;
    std::span<const char> allowed_;
    std::vector<PlacedCourse>& courses_;
    const AnnealOptions& options_;
    std::array<double, 2 * kMostOff + 1> cost_{};  // by layers over the target, from -kMostOff
    double typical_ = 1.0;                         // samples that a course covers
    double heat_ = 0.0;
    std::vector<std::int32_t> over_;  // per sample: layers over its target
    Joints joints_;
    Neighbourhood neighbours_;
    int alone_ = 0;  // courses without a family
    Pool scratch_;
    AnnealEffort effort_;
};

}  // namespace

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
