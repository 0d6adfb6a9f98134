#include "winding/cover/anneal.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/index.h"
#include "core/parallel.h"
#include "core/random.h"
#include "winding/cover/fit_course.h"
#include "winding/cover/rim_joints.h"

namespace meshwind {
namespace {

// Proposals that are drawn and judged against the same state, and those that one task takes.
// Those proved take fifty times as long as others: a group holds some of both for every core.
constexpr std::size_t kGroup = 128;
constexpr std::size_t kTask = 2;

// Kinds of proposals, as shares of all.
constexpr double kFreshShare = 0.10;      // a course somewhere, mostly where layers are missing
constexpr double kNeighbourShare = 0.12;  // a course beside another
constexpr double kJoinShare = 0.06;       // a course from a surplus node to a deficit node
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

// What each fibre beyond the first costs that is allowed, as a share of what a course covers:
// somebody has to cut it and tie it on.
constexpr double kCutShare = 0.5;

// What a course costs that belongs to no family of parallel ones, as a share of what a course
// covers. Among families the layers are more even, too.
constexpr double kAloneShare = 0.5;

// What courses are annealed on, by which rules, and where others come from.
struct AnnealTask {
    CourseRules rules;  // with the footprints of the ground
    const AnnealGround& ground;
    std::span<const LibraryCourse> members;  // of the library
    std::span<const char> allowed;           // per member
    const AnnealOptions& options;
};

// What courses cost at a time of the annealing: 1 for a layer too many or too few at a sample.
struct AnnealPrices {
    double course = 1.0;  // samples that a course covers
    double heat = 0.0;    // a change for the worse by so much has a chance of 1/e
    LayerCosts layers;
};

// An exchange that is drawn, and whether it is taken.
struct Proposal {
    CourseExchange exchange;
    bool holds = false;
    double chance = 0.0;
    bool fit = false;
};

// What a group of proposals is drawn from and judged against.
struct AnnealState {
    const AnnealTask& task;
    const AnnealPrices& prices;
    const AnnealedCourses& courses;
};

// Samples that a course covers, by the library: at first there may be no course at all.
double samples_of_a_course(const AnnealTask& task) {
    double covered = 0.0;
    for (const LibraryCourse& member : task.members) {
        covered += member.length_mm * task.rules.tow.width_mm / task.ground.samples.area_mm2;
    }
    return std::max(1.0, covered / std::max<double>(1.0, static_cast<double>(task.members.size())));
}

// \param share of the proposals that are done
AnnealPrices prices_at(const AnnealOptions& options, double course, double share) {
    return {course, course * options.hot * std::pow(options.cold / options.hot, share),
            LayerCosts(options.beyond_layers,
                       options.bare_hot * std::pow(options.bare_cold / options.bare_hot, share))};
}

// What the courses leave open is worth the proposal that closes it.
double open_cost(const AnnealState& now, const RimJoints& joints) {
    const AnnealOptions& options = now.task.options;
    const int fibres = joints.fibres();
    const int allowed = std::min(fibres, options.fibres);
    return now.prices.course *
           (options.fibre_share * (fibres - allowed) + kCutShare * std::max(0, allowed - 1));
}

// Of the fibre of a course's turns.
double turn_cost(const AnnealTask& task, const LibraryCourse& member) {
    return task.options.turn_share * member.turn_mm * task.rules.tow.width_mm /
           task.ground.samples.area_mm2;
}

// Of fibre off the wanted winding angle.
double angle_cost(const AnnealTask& task, const LibraryCourse& member) {
    return task.options.select.angle_weight * member.off_angle_mm * task.rules.tow.width_mm /
           task.ground.samples.area_mm2;
}

double alone_cost(const AnnealPrices& prices) {
    return kAloneShare * prices.course;
}

// What else a change may save: hardly any helps more than two others to a family.
double slack(const AnnealPrices& prices) {
    return 2.0 * alone_cost(prices);
}

// What the courses without a family cost more, or less. Looks for the neighbours of what is put in.
double alone_change(const AnnealState& now, CourseExchange& exchange) {
    return alone_cost(now.prices) * now.courses.more_alone(exchange);
}

void forget(const PlacedCourse& course, AnnealScratch& scratch) {
    for (const std::int32_t sample : course.member.footprint) {
        scratch.shift[at(sample)] = 0;
    }
}

// What the objective changes by, but for the families.
double change(const AnnealState& now, const CourseExchange& exchange, AnnealScratch& scratch) {
    const GroundLayers& layers = now.courses.layers();
    const LayerCosts& cost = now.prices.layers;
    double sum = 0.0;
    RimJoints joints = now.courses.joints();
    if (exchange.out) {
        const PlacedCourse& course = now.courses[*exchange.out];
        for (const std::int32_t sample : course.member.footprint) {
            const std::int32_t over = layers.over(sample) + scratch.shift[at(sample)]--;
            sum += cost.of(over - 1) - cost.of(over);
        }
        sum -= turn_cost(now.task, course.member) + angle_cost(now.task, course.member);
        joints.add(course.member, course.backward, -1);
    }
    if (exchange.in) {
        const LibraryCourse& member = exchange.in->member;
        for (const std::int32_t sample : member.footprint) {
            const std::int32_t over = layers.over(sample) + scratch.shift[at(sample)]++;
            sum += cost.of(over + 1) - cost.of(over);
        }
        sum += turn_cost(now.task, member) + angle_cost(now.task, member);
        joints.add(member, exchange.in->backward, 1);
    }
    if (exchange.out) {
        forget(now.courses[*exchange.out], scratch);
    }
    if (exchange.in) {
        forget(*exchange.in, scratch);
    }
    return sum + open_cost(now, joints) - open_cost(now, now.courses.joints());
}

bool is_taken(const AnnealPrices& prices, const Proposal& proposal, double change_by) {
    return change_by <= 0.0 || proposal.chance < std::exp(-change_by / prices.heat);
}

Candidate fresh(const AnnealState& now, Draws& draws) {
    const CourseRules& rules = now.task.rules;
    const AnnealGround& ground = now.task.ground;
    if (ground.images.size() > 0 && !now.courses.empty() && draws.unit() < kImageShare) {
        const PlacedCourse& course = now.courses[now.courses.any(draws)];
        return ground.images.of(course.member.candidate, draws.below(ground.images.size()));
    }
    const std::size_t place = now.courses.layers().needy_place(draws);
    const auto& passing = ground.passing[place];
    if (draws.unit() < kLibraryShare && !passing.empty()) {
        const std::size_t member = at(passing[draws.below(passing.size())]);
        if (now.task.allowed[member] != 0) {
            return now.task.members[member].candidate;
        }
    }
    const SurfacePoint& seed = ground.samples.at[place];
    const double unit = draws.unit();
    return {seed, draw_direction_rad(rules, seed, unit, draws.unit()),
            rules.tow.friction.share(kSteering[draws.below(kSteering.size())])};
}

// Whether a fibre comes where a course begins and goes on where it ends.
bool leads(const AnnealOptions& options, const PlacedCourse& course) {
    return !options.way || options.way(nodes_of(course.member, course.backward));
}

bool holds(const CourseRules& rules, PlacedCourse& course) {
    const SurfacePath way = course.backward ? reversed(course.path) : course.path;
    bool& windable =
        course.backward ? course.member.windable_backward : course.member.windable_forward;
    windable = is_windable(rules, way, taut_string(way), kSketchStep_mm);
    return windable;
}

// The proposal to put in a course, if it is worth it and can be wound.
Proposal weighed(const AnnealState& now, PlacedCourse course, Proposal proposal,
                 AnnealScratch& scratch) {
    const AnnealOptions& options = now.task.options;
    const AnnealPrices& prices = now.prices;
    if (!leads(options, course)) {
        return proposal;
    }
    proposal.exchange.in = std::move(course);
    const double by = change(now, proposal.exchange, scratch);
    if (!is_taken(prices, proposal, by - slack(prices)) ||
        !is_taken(prices, proposal, by + alone_change(now, proposal.exchange)) ||
        !holds(now.task.rules, *proposal.exchange.in) ||
        (options.verify && !options.verify(*proposal.exchange.in))) {
        return proposal;
    }
    if (options.verify) {
        proposal.exchange.shape.reset();  // the path is exact now
        proposal.exchange.in->member.footprint =
            now.task.ground.footprints.footprint(proposal.exchange.in->path, scratch.footprint);
    }
    proposal.holds = true;
    return proposal;
}

// What the layers cost more without a course.
double taken_out(const AnnealState& now, std::optional<std::size_t> out) {
    const LayerCosts& cost = now.prices.layers;
    double sum = 0.0;
    if (out) {
        for (const std::int32_t sample : now.courses[*out].member.footprint) {
            const std::int32_t over = now.courses.layers().over(sample);
            sum += cost.of(over - 1) - cost.of(over);
        }
    }
    return sum;
}

// The move to where a course saves most with another taken out.
Fit fitted(const AnnealState& now, const PlacedCourse& course, std::optional<std::size_t> out,
           AnnealScratch& scratch) {
    const LayerCosts& cost = now.prices.layers;
    const Strip strip = now.task.ground.strips.strip(course.path, scratch.footprint);
    if (out) {
        for (const std::int32_t sample : now.courses[*out].member.footprint) {
            --scratch.shift[at(sample)];
        }
    }
    std::vector<float> saving(strip.sample.size());
    for (std::size_t i = 0; i < saving.size(); ++i) {
        const std::int32_t sample = strip.sample[i];
        const std::int32_t over = now.courses.layers().over(sample) + scratch.shift[at(sample)];
        saving[i] = static_cast<float>(cost.of(over) - cost.of(over + 1));
    }
    if (out) {
        forget(now.courses[*out], scratch);
    }
    return fit_course(now.task.rules, course, strip, saving);
}

// Sketches a candidate; what costs more comes later.
Proposal judged(const AnnealState& now, const Candidate& candidate, bool backward,
                Proposal proposal, AnnealScratch& scratch) {
    const CourseRules& rules = now.task.rules;
    DraftCourse sketch;
    if (draw_path(rules, candidate, sketch) != CandidateFault::None) {
        return proposal;
    }
    PlacedCourse course{std::move(sketch.course), std::move(sketch.path), backward, false};
    if (!proposal.fit) {
        if (!leads(now.task.options, course)) {
            return proposal;
        }
        course.member.footprint =
            now.task.ground.footprints.footprint(course.path, scratch.footprint);
        return weighed(now, std::move(course), std::move(proposal), scratch);
    }
    const Fit fit = fitted(now, course, proposal.exchange.out, scratch);
    if (!is_taken(now.prices, proposal,
                  taken_out(now, proposal.exchange.out) - fit.saved - slack(now.prices)) ||
        draw_sketch(rules, moved(rules, course, seed_station(course), fit.move), scratch.footprint,
                    sketch) != CandidateFault::None) {
        return proposal;
    }
    return weighed(now, {std::move(sketch.course), std::move(sketch.path), backward, false},
                   std::move(proposal), scratch);
}

// The same, wound either way.
Proposal judged(const AnnealState& now, const Candidate& candidate, Draws& draws, Proposal proposal,
                AnnealScratch& scratch) {
    return judged(now, candidate, draws.unit() < 0.5, std::move(proposal), scratch);
}

// A member of the library that leads from a node where too many courses arrive to one where too
// many depart, or to another part of the plan.
Proposal joining(const AnnealState& now, Draws& draws, Proposal proposal, AnnealScratch& scratch) {
    const std::vector<ArrivingWay> ways =
        ways_that_join(now.task.ground.ways, now.courses.joints());
    if (ways.empty()) {
        return proposal;
    }
    const ArrivingWay& which = ways[draws.below(ways.size())];
    const auto& members = which.way->windable;
    const std::size_t number = at(members[draws.below(members.size())]);
    const LibraryCourse& member = now.task.members[number];
    const bool backward = arrival_node(end_of(member, true)) == which.arrival;
    if (now.task.allowed[number] == 0) {
        return proposal;
    }
    return judged(now, member.candidate, backward, std::move(proposal), scratch);
}

// The same course, wound the other way.
PlacedCourse turned_round(PlacedCourse course) {
    course.backward = !course.backward;
    course.wound = false;
    return course;
}

// Draws a proposal and judges it against the courses as they are.
Proposal propose(const AnnealState& now, std::int64_t number, AnnealScratch& scratch) {
    const AnnealedCourses& courses = now.courses;
    const CourseRules& rules = now.task.rules;
    Draws draws(now.task.options.seed, static_cast<std::uint64_t>(number) << 8U);
    Proposal proposal;
    proposal.chance = draws.unit();
    proposal.fit = draws.unit() < kFitShare;
    double kind = draws.unit();
    const auto falls = [&kind](double share) {
        kind -= share;
        return kind < 0.0;
    };
    if (courses.empty() || falls(kFreshShare)) {
        return judged(now, fresh(now, draws), draws, std::move(proposal), scratch);
    }
    if (falls(kJoinShare)) {
        return joining(now, draws, std::move(proposal), scratch);
    }
    const std::size_t one = courses.any(draws);
    if (falls(kNeighbourShare)) {
        return judged(now, moved_beside(rules, courses[one], draws), draws, std::move(proposal),
                      scratch);
    }
    if (courses[one].link >= 0) {
        return proposal;
    }
    proposal.exchange.out = one;
    if (falls(kDropShare)) {
        proposal.holds = true;
        return proposal;
    }
    if (falls(kReverseShare)) {
        return weighed(now, turned_round(courses[one]), std::move(proposal), scratch);
    }
    if (falls(kNudgeShare)) {
        return judged(now, nudged(rules, courses[one], draws), draws, std::move(proposal), scratch);
    }
    if (falls(kBesideShare)) {
        return judged(now, moved_beside(rules, courses[courses.any(draws)], draws), draws,
                      std::move(proposal), scratch);
    }
    return judged(now, fresh(now, draws), draws, std::move(proposal), scratch);
}

// The others' proposals for a course that has been changed are void; those for the ones behind it
// move up when it is gone.
void outdate(std::vector<Proposal>& group, std::size_t course, bool gone) {
    for (Proposal& proposal : group) {
        if (proposal.exchange.out == course) {
            proposal.holds = false;
        } else if (gone && proposal.exchange.out && *proposal.exchange.out > course) {
            --*proposal.exchange.out;
        }
    }
}

// Takes what still holds after those before it in the group, one for each course. Returns how many
// are taken.
std::int64_t take_group(const AnnealTask& task, const AnnealPrices& prices,
                        std::vector<Proposal>& group, AnnealedCourses& courses,
                        AnnealScratch& scratch) {
    const AnnealState now{task, prices, courses};
    std::int64_t accepted = 0;
    for (Proposal& proposal : group) {
        if (!proposal.holds || !is_taken(prices, proposal,
                                         change(now, proposal.exchange, scratch) +
                                             alone_change(now, proposal.exchange))) {
            continue;
        }
        ++accepted;
        const std::optional<std::size_t> out = proposal.exchange.out;
        courses.take(proposal.exchange);
        if (out) {
            outdate(group, *out, !proposal.exchange.in);
        }
    }
    return accepted;
}

// Draws and judges a group of proposals in parallel. \param first its number
void propose_group(const AnnealState& now, std::int64_t first, AnnealScratchPool& scratches,
                   std::vector<Proposal>& group) {
    parallel_for(group.size(), kTask, [&](std::size_t begin, std::size_t end) {
        std::unique_ptr<AnnealScratch> scratch = scratches.take();
        for (std::size_t i = begin; i < end; ++i) {
            group[i] = propose(now, first + static_cast<std::int64_t>(i), *scratch);
        }
        scratches.put_back(std::move(scratch));
    });
}

AnnealEffort anneal_courses(const AnnealTask& task, std::vector<PlacedCourse>& placed) {
    AnnealScratchPool scratches(task.ground);
    std::unique_ptr<AnnealScratch> scratch = scratches.take();
    AnnealedCourses courses(task.rules, task.ground, task.options.select, *scratch, placed);
    const double course = samples_of_a_course(task);
    const AnnealOptions& options = task.options;
    std::vector<Proposal> group(kGroup);
    AnnealEffort effort;
    while (effort.proposals < options.proposals) {
        const double share =
            static_cast<double>(effort.proposals) / static_cast<double>(options.proposals);
        const AnnealPrices prices = prices_at(options, course, share);
        if (options.progress) {
            options.progress(share);
        }
        propose_group({task, prices, courses}, effort.proposals, scratches, group);
        effort.proposals += static_cast<std::int64_t>(kGroup);
        effort.accepted += take_group(task, prices, group, courses, *scratch);
    }
    return effort;
}

}  // namespace

AnnealEffort anneal(const CourseRules& rules, const AnnealGround& ground,
                    std::span<const LibraryCourse> library, std::span<const char> allowed,
                    std::vector<PlacedCourse>& courses, const AnnealOptions& options) {
    const AnnealTask task{
        {rules.mandrel, rules.obstacles, ground.footprints, rules.tow, rules.turns,
         rules.free_fibre, rules.max_half_length_mm, rules.angle_rad},
        ground,
        library,
        allowed,
        options};
    const AnnealEffort effort = anneal_courses(task, courses);
    FootprintFinder::Scratch scratch = rules.footprints.make_scratch();
    for (PlacedCourse& course : courses) {
        course.member.footprint = rules.footprints.footprint(course.path, scratch);
    }
    return effort;
}

}  // namespace meshwind
