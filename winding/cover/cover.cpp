#include "winding/cover/cover.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/random.h"
#include "core/text/text_number.h"
#include "winding/cover/cover_courses.h"
#include "winding/cover/fibre_routes.h"
#include "winding/cover/grow_library.h"
#include "winding/cover/join_courses.h"
#include "winding/cover/lay_out_plan.h"
#include "winding/cover/order_to_follow.h"
#include "winding/cover/prove_courses.h"
#include "winding/cover/uncovered.h"
#include "winding/laminate/course_character.h"
#include "winding/laminate/coverage.h"
#include "winding/laminate/measure_plan.h"

namespace meshwind {
namespace {

// Routes of so many fibres are looked for, at most.
constexpr std::size_t kRoutesLookedFor = 9;

// Below this reachable share of the wall no plan is made.
constexpr double kWorthPlanning = 0.5;

// Attempts that refuse as many courses as before, or more, before no others are put there; none are
// before the last attempts either.
constexpr int kMaxInVain = 2;
constexpr int kAttemptsWithoutOthers = 2;

// Courses in winding order.
struct CoverOrder {
    std::vector<OrderedCourse> courses;  // of the library and the courses of the plan behind it
    ClosedTurns closed;                  // found while that was looked for
    int turns_refused = 0;
    int courses_out_of_reach = 0;
};

// What came of the courses.
struct CoverOutcome {
    std::vector<std::int32_t> layers{};  // per sample; empty where none are laid
    std::vector<char> joinable{};        // per sample
    std::unique_ptr<TrialWinding> trial{};
    std::string failure{};  // not empty: why nothing is wound
};

// What courses reach that hold, per sample; behind the last stage none are chosen.
std::vector<char> proven_reach(const CoverTask& task, ReachProver& prover, ProvenLibrary& library) {
    if (task.stage.stages_left == 0) {
        return library.reached();
    }
    task.report_progress("prove", 0.0);
    std::vector<char> reached = prover.prove(library.members());
    for (const auto& [member, rejection] : prover.refused()) {
        library.strike_off(at(member), rejection);
    }
    return reached;
}

void strike_off_what_is_apart(const PlanRoutes& routes, ProvenLibrary& library) {
    const std::span<LibraryCourse> members = library.members();
    for (std::size_t i = 0; i < members.size(); ++i) {
        LibraryCourse& member = members[i];
        for (const bool backward : {false, true}) {
            bool& windable = backward ? member.windable_backward : member.windable_forward;
            windable = windable && routes.hold(nodes_of(member, backward));
        }
        if (library.allowed()[i] != 0 && !is_windable(member)) {
            library.strike_off(i, CourseFault::Apart);
        }
    }
}

// Which ways between nodes are open to the machine, and the routes that the fibres take best. What
// lies off them is struck off the library. \param courses the links between stages are added
PlanRoutes find_routes(const CoverTask& task, ProvenLibrary& library, PlanCourses& courses,
                       std::vector<double>& reach_of_fibres) {
    const Ways ways = ways_between_nodes(library.members());
    const auto [known, refused] = prove_ways(
        library.members(), ways,
        [&task](PlacedCourse& course) { return task.prover.prove(course); },
        [&task](double share) { task.report_progress("route", share); });
    for (const auto& [member, rejection] : refused) {
        library.note_refused(library.members()[at(member)].footprint, rejection);
    }
    PlanRoutes found{
        best_routes(library.members(), known, task.nodes(), task.samples.size(), kRoutesLookedFor),
        task.options.fibres};
    std::vector<FibreRoute>& routes = found.routes;
    for (const FibreRoute& route : routes) {
        reach_of_fibres.push_back(route.reach);
    }
    routes.resize(std::min(routes.size(), static_cast<std::size_t>(task.options.fibres)));
    if (known.empty()) {  // nothing of what was tried holds, wherever it leads
        library.strike_off_all(commonest_rejection(library.effort()));
        return found;
    }
    for (const FibreRoute& route : routes) {
        for (std::size_t stage = 0; stage < route.links.size(); ++stage) {
            courses.placed.push_back(library.placed(route.links[stage]));
            courses.placed.back().link = static_cast<std::int32_t>(courses.spare_links.size());
            courses.spare_links.push_back(
                spare_links(library.members(), ways, known, route, stage));
        }
    }
    strike_off_what_is_apart(found, library);
    return found;
}

// Adds proven members of the library until as many courses arrive as depart, wherever there is a
// way.
void join_to(const CoverTask& task, const PlanRoutes& routes, int fibres, CourseJoiner& joiner,
             ProvenLibrary& library, PlanCourses& courses) {
    const auto place = [&](const DirectedCourse& course, PlacedCourse& in_place) {
        in_place = library.placed(course);
        return prove_to_stay(task, courses, in_place);
    };
    const auto strike = [&](std::size_t member, CourseFault why) {
        library.strike_off(member, why);
    };
    joiner.join({library.members_and_placed(), library.size(), library.allowed(),
                 task.mandrel.rims.size(), task.samples.size(), task.select,
                 std::min(fibres, routes.fibres_needed()), fibres, place, strike},
                courses.placed);
}

CoverOrder put_in_order(const CoverTask& task, const PlanRoutes& routes,
                        std::span<const PlacedCourse> courses, ProvenLibrary& library) {
    std::vector<LibraryCourse>& members = library.members_and_placed();
    gather(courses, library.size(), members);
    std::vector<DirectedCourse> laid;
    std::vector<double> lateness;
    for (const PlacedCourse& course : courses) {
        laid.push_back({static_cast<std::int32_t>(library.size() + laid.size()), course.backward});
        lateness.push_back(character_of(task.mandrel.surface, course.path).lateness());
    }
    const auto most = static_cast<std::size_t>(routes.fibres());
    auto followed = order_to_follow(task.rules, task.machine, members, laid, lateness, most);
    CoverOrder order;
    order.courses = longest_fibres(members, followed.courses, most);
    order.closed = std::move(followed.closed);
    order.turns_refused = followed.turns_refused;
    order.courses_out_of_reach = static_cast<int>(followed.courses.size() - order.courses.size());
    return order;
}

// Adds what it takes to join the courses, and puts them in order. Fibres to be cut where the
// machine cannot follow a turn are not spent on what does not join.
CoverOrder joined_to_fibres(const CoverTask& task, const PlanRoutes& routes, CourseJoiner& joiner,
                            ProvenLibrary& library, PlanCourses& courses) {
    const int fibres = routes.fibres();
    join_to(task, routes, fibres, joiner, library, courses);
    CoverOrder order = put_in_order(task, routes, courses.placed, library);
    if (order.turns_refused > 0 && fibres > 1) {
        join_to(task, routes, std::max(1, fibres - order.turns_refused), joiner, library, courses);
        order = put_in_order(task, routes, courses.placed, library);
    }
    return order;
}

void lay_out_order(const CoverTask& task, const CoverOrder& order, ProvenLibrary& library,
                   Plan& plan) {
    plan.effort.turns_refused = order.turns_refused;
    plan.effort.courses_out_of_reach = order.courses_out_of_reach;
    lay_out(task.rules, library.members_and_placed(), order.courses, plan);
}

// A plan's order and its trial, which is null where none stands.
struct TriedOrder {
    std::vector<OrderedCourse> courses;
    std::unique_ptr<TrialWinding> trial;
};

// Joins the courses, winds the whole, and plans again without the courses that the machine refuses
// in their place. Where putting others there leads nowhere they are only left out; if all is in
// vain, the plan with the fewest of them stands.
TriedOrder order_that_holds(const CoverTask& task, const AnnealGround& ground,
                            const FibreReach& reach, ProvenLibrary& library, PlanCourses courses,
                            Plan& plan) {
    std::vector<PlacedCourse> best;
    std::size_t least = 0;
    int in_vain = 0;
    for (int attempt = 0; attempt < kMaxAttempts && !courses.placed.empty(); ++attempt) {
        CourseJoiner joiner;  // what it keeps was proven against other turns
        CoverOrder order = joined_to_fibres(task, reach.routes, joiner, library, courses);
        lay_out_order(task, order, library, plan);
        std::unique_ptr<TrialWinding> trial = task.machine != nullptr && !order.courses.empty()
                                                  ? task.machine->wind_all(plan)
                                                  : nullptr;
        if (!trial || trial->refused.empty()) {
            return {std::move(order.courses), std::move(trial)};
        }
        const auto refused =
            refused_courses(*trial, plan, order.courses, order.closed, library.size());
        trial.reset();
        const bool better = best.empty() || refused.size() < least;
        in_vain += better ? 0 : 1;
        if (better) {
            best = courses.placed;
            least = refused.size();
        }
        give_up_courses(task, refused, library, courses);
        // Else those that the machine cannot turn would come again, from the next places of a rim.
        courses.turned_with = courses.placed;
        if (in_vain < kMaxInVain && attempt + kAttemptsWithoutOthers < kMaxAttempts) {
            replace_lost_courses(task, ground, reach, library, courses);
        }
    }
    CoverOrder order = put_in_order(task, reach.routes, best, library);
    lay_out_order(task, order, library, plan);
    return {std::move(order.courses), nullptr};
}

// Whether a plan that covers so much is wound.
bool is_enough(const CoverTask& task, double share, std::span<const char> reached) {
    return share >= task.options.least_covered * reached_share(reached);
}

// Returns why a plan that covers as much as `coverage` says is not wound.
std::string too_bare(const std::string& words, std::span<const char> reached,
                     std::span<const char> joinable, Coverage& coverage) {
    coverage.reachable = reached_share(reached);
    coverage.joinable = reached_share(joinable);
    return words + percent(coverage.fraction, 1) + " of the wall where " +
           percent(coverage.reachable, 1) + " is in reach";
}

std::string hardly_reachable(const ProvenLibrary& library) {
    return "courses reach only " + fixed(100.0 * reached_share(library.grown().reached), 1) +
           " % of the wall, under " + fixed(100.0 * kWorthPlanning, 0) +
           " % nothing is planned; refused most often, " + refused_most(library.effort());
}

// Layers per sample of the courses that are laid. What they cover is in reach.
std::vector<std::int32_t> measured_layers(const CoverTask& task,
                                          std::span<const OrderedCourse> order,
                                          std::vector<char>& joinable, ProvenLibrary& library,
                                          Plan& plan) {
    std::vector<char>& reached = library.reached();
    std::vector<std::int32_t> layers(task.samples.size(), 0);
    for (const OrderedCourse& laid : order) {
        for (const std::int32_t sample :
             library.members_and_placed()[at(laid.course.member)].footprint) {
            reached[at(sample)] = joinable[at(sample)] = 1;
            ++layers[at(sample)];
        }
    }
    plan.coverage = measure_coverage(layers, reached);
    plan.coverage.reachable = reached_share(reached);
    plan.coverage.joinable = reached_share(joinable);
    plan.face_layers = layers_per_face(task.mandrel.surface, task.samples, layers);
    describe_courses(task.mandrel.surface, task.options.tow.width_mm, task.options.angle_rad, plan);
    return layers;
}

// Of a stage of a wall it is the wall that says where it is thin.
void describe_uncovered(const CoverTask& task, CoverOutcome& outcome, ProvenLibrary& library,
                        Plan& plan) {
    if (task.options.stage != nullptr) {
        plan.reached = library.reached();
        plan.joinable = outcome.joinable;
        return;
    }
    outcome.layers.resize(task.samples.size(), 0);
    library.append_refused();
    plan.uncovered = uncovered_wall(task.mandrel.surface, task.samples, library.grown(),
                                    library.rejection(), outcome.layers);
}

// Proves which of the wall courses reach, and what of it the fibres can join.
FibreReach proven_fibre_reach(const CoverTask& task, ProvenLibrary& library, PlanCourses& links,
                              Plan& plan) {
    ReachProver prover(task.samples.size(),
                       [&task](PlacedCourse& course) { return task.prover.prove(course); });
    const double sketched = reached_share(library.reached());
    library.reached() = proven_reach(task, prover, library);
    // The answers are what sketches reach: what they bring is told beside what holds.
    for (RelaxedRule& what_if : plan.what_if) {
        what_if.reachable -= sketched - reached_share(library.reached());
    }
    FibreReach reach;
    reach.routes = find_routes(task, library, links, plan.reach_of_fibres);
    reach.joinable = proven_reach(task, prover, library);
    return reach;
}

// Plans courses of a library in which there are some.
CoverOutcome plan_courses(const CoverTask& task, ProvenLibrary& library, Plan& plan) {
    plan.what_if = coverage_if_relaxed(task.rules, task.samples, library.grown(),
                                       seed_of(Stream::Otherwise, task.options.context.seed));
    if (reached_share(library.reached()) < kWorthPlanning) {
        library.strike_off_all(CourseFault::NotPlanned);
        return {.failure = hardly_reachable(library)};
    }
    const AnnealGround ground(task.rules, samples_at(task.mandrel.surface, task.stage.weighed.at),
                              task.samples, library.members());
    PlanCourses courses;
    FibreReach reach = proven_fibre_reach(task, library, courses, plan);
    if (const double share = reached_share(reach.joinable);
        !is_enough(task, share, library.reached()) || share < task.options.least_joined) {
        plan.coverage.fraction = share;
        std::string why = too_bare("the courses that the fibres can join reach only ",
                                   library.reached(), reach.joinable, plan.coverage);
        return {.joinable = std::move(reach.joinable), .failure = std::move(why)};
    }
    plan.least_fibre_mm = choose_courses(task, reach.joinable, library, courses);
    make_courses_even(task, ground, reach, library, courses);
    keep_courses_that_wind(task, ground, reach, library, courses);
    if (std::vector<std::int32_t> layers = layers_of(courses.placed, task.samples.size());
        !is_enough(task, measure_coverage(layers).fraction, library.reached())) {
        plan.coverage = measure_coverage(layers);
        std::string why =
            too_bare("courses cover only ", library.reached(), reach.joinable, plan.coverage);
        return {std::move(layers), std::move(reach.joinable), nullptr, std::move(why)};
    }
    TriedOrder order = order_that_holds(task, ground, reach, library, std::move(courses), plan);
    if (order.courses.empty()) {
        return {.joinable = std::move(reach.joinable),
                .failure = "every course was refused, " + rejected_most(library.effort())};
    }
    std::vector<std::int32_t> layers =
        measured_layers(task, order.courses, reach.joinable, library, plan);
    return {std::move(layers), std::move(reach.joinable), std::move(order.trial), {}};
}

}  // namespace

TriedPlan plan_cover(const Mandrel& mandrel, const RayQuery& obstacles, const CoverOptions& options,
                     const Windability* machine) {
    Plan plan;
    plan.planner = Planner::Cover;
    if (mandrel.rims.empty()) {
        plan.failure =
            "the mandrel has no rim: courses have nowhere to turn back (a closed body needs a "
            "polar opening or an open end)";
        return {std::move(plan), nullptr};
    }
    const CoverTask task(mandrel, obstacles, options, machine);
    plan.effort.seed = options.context.seed;
    plan.effort.effort = options.context.effort;
    ProvenLibrary library(grow_library(task.rules, task.samples, options), plan.effort);
    plan.effort.candidates = library.grown().candidates;
    plan.effort.refusals = library.grown().refusals;
    task.report_progress("library", 1.0);
    CoverOutcome outcome =
        library.size() > 0
            ? plan_courses(task, library, plan)
            : CoverOutcome{.failure = "no admissible course: " + refused_most(plan.effort)};
    plan.failure = std::move(outcome.failure);
    describe_uncovered(task, outcome, library, plan);
    return {std::move(plan), std::move(outcome.trial)};
}

}  // namespace meshwind
